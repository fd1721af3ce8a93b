//! Bodies that overlap an obstacle at the start, and obstacles that move.

use std::sync::Arc;

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::Displacement;
use carom_contact::{Initial, Law, Motion, Obstacle, Plane, Sliding};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

/// A unit square of 16 cells whose lower side is 0.01 m under the ground.
fn sunk(initial: Initial, motion: Motion) -> Result<Arc<System>, carom_system::Error> {
    let mesh = generate::rectangle("block", [0.0; 2], [1.0; 2], [4; 2], false);
    let cells = mesh.groups["block"].elements.clone();
    let ground = Plane {
        point: [0.0, 0.01, 0.0],
        normal: [0.0, 1.0, 0.0],
    };
    System::new(Model {
        contacts: vec![ModelContact {
            sliding: Sliding::Finite,
            initial,
            ..ModelContact::new(
                "ground",
                Surface::new(&mesh, &mesh.groups["block.bottom"], &cells).unwrap(),
                ModelTarget::rigid(Obstacle {
                    motion,
                    ..ground.into()
                }),
                Law::Displacement(Displacement::default()),
            )
        }],
        ..Model::new(
            vec![ModelBody::new(BodySpec::new(
                "block",
                cells.clone(),
                Kinematics::PlaneStrain { thickness: 1.0 },
                Elastic {
                    density: 1000.0,
                    young: 1e9,
                    poisson: 0.3,
                },
            ))],
            mesh,
            Scheme::Theta(Theta { theta: 1.0 }),
            1e-4,
        )
    })
}

/// Highest node of the lower row, and the largest contact force of the first step.
fn after_a_step(system: Arc<System>) -> (f64, f64) {
    let low = system.x.iter().map(|x| x[1]).filter(|y| *y < 0.1);
    let low = low.fold(0.0, f64::max);
    let mut driver = Driver::new(system).unwrap();
    driver.step().unwrap();
    let forces = driver.state().interface.force.iter();
    (low, forces.fold(0.0, |largest, force| largest.max(*force)))
}

#[test]
fn penetration_at_the_start_is_kept_refused_offset_or_removed() {
    let start = |initial| sunk(initial, Motion::default());
    match start(Initial::Refuse) {
        Err(carom_system::Error::Penetration {
            contact,
            points,
            node,
            depth,
        }) => {
            assert_eq!((contact.as_str(), points), ("ground", 5));
            assert!(node < 5 && (depth - 0.01).abs() < 1e-15);
        }
        other => panic!("{other:?}"),
    }
    // pushed out in one step: the 30 kg of a lower node by 0.01 m in 1e-4 s
    let (low, force) = after_a_step(start(Initial::Keep).unwrap());
    assert!(low == 0.0 && force > 1e6, "{low} {force}");
    assert_eq!(after_a_step(start(Initial::Offset).unwrap()), (0.0, 0.0));
    let system = start(Initial::Remove).unwrap();
    assert_eq!(system.x.len(), 25);
    let (low, force) = after_a_step(system);
    // what is left of the gap is rounding: of the size 1.4e-16 m
    assert!((low - 0.01).abs() < 1e-17 && force < 1e-3, "{low} {force}");
}
