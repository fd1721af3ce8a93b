//! A block that falls past the edge of another, 1 mm beside it: free fall, whatever pairs the two.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Basis, Integration, Law, Sliding};
use carom_dynamics::scheme::{CentralDifference, Theta};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, Support, System,
};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

const FALL: f64 = -10.0;
/// A quarter of an element in ten steps; half an element's time for a wave.
const DT: f64 = 5e-4;

fn model(scheme: Scheme, whole: bool) -> Model {
    let mut mesh = generate::rectangle("low", [0.0; 2], [1.0; 2], [4, 4], false);
    let high = generate::rectangle("high", [1.001, 1.01], [0.5; 2], [4, 4], false);
    mesh.merge("high", high).unwrap();
    let material = Elastic {
        density: 1000.0,
        young: 1e7,
        poisson: 0.3,
    };
    let body = |name: &str, fall: f64| {
        let cells = mesh.groups[name].elements.clone();
        let plane = Kinematics::PlaneStrain { thickness: 1.0 };
        ModelBody {
            velocity: [0.0, fall, 0.0],
            ..ModelBody::new(BodySpec::new(name, cells, plane, material))
        }
    };
    let bodies = vec![body("low", 0.0), body("high", FALL)];
    let side = |k: usize, group: &str| match whole {
        true => Surface::outer(&mesh, &bodies[k].spec.cells),
        false => Surface::new(&mesh, &mesh.groups[group], &bodies[k].spec.cells).unwrap(),
    };
    let law = Law::Velocity(Velocity {
        capture: Capture::Half,
        reading: Reading::Closed,
    });
    let target = ModelTarget::Surface(side(0, "low.top"));
    let contact = ModelContact {
        depth: whole.then_some(0.4),
        ..ModelContact::new("faces", side(1, "high.bottom"), target, law)
    };
    let floor = Support {
        nodes: mesh.group_nodes(&mesh.groups["low.bottom"]),
        fix: [true, true, false],
        fix_rotations: [false; 3],
    };
    Model {
        contacts: vec![contact],
        supports: vec![floor],
        ..Model::new(bodies, mesh.clone(), scheme, DT)
    }
}

/// Falls by 0.3 m, more than an element.
fn assert_falls(model: Model) {
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..60 {
        driver.step().unwrap();
        let state = driver.state();
        let forces = &state.interface.force;
        assert!(forces.iter().all(|force| *force == 0.0), "{forces:?}");
    }
    let (system, state) = (driver.system(), driver.state());
    assert_eq!(state.records.contacts[0].impulse(), 0.0);
    let velocity = system.mean_velocity(1, &state.motion.v);
    // rounding of 60 solves whose matrix has a condition of some hundred
    assert!((velocity[1] - FALL).abs() < 1e-10, "{velocity:?}");
}

const SCHEMES: [Scheme; 2] = [
    Scheme::Theta(Theta { theta: 0.5 }),
    Scheme::CentralDifference(CentralDifference {}),
];

#[test]
fn a_block_that_falls_beside_another_is_not_touched_whichever_way_it_slides_and_is_integrated() {
    for scheme in SCHEMES {
        for sliding in [Sliding::Finite, Sliding::Small] {
            for integration in [
                Integration::Node,
                Integration::Weak { r: 1e6 },
                Integration::Mortar { basis: Basis::Dual },
            ] {
                let mut model = model(scheme, false);
                model.contacts[0].sliding = sliding;
                model.contacts[0].integration = integration;
                assert_falls(model);
            }
        }
    }
}

#[test]
fn a_block_whose_whole_surface_faces_that_of_another_falls_beside_it() {
    for scheme in SCHEMES {
        assert_falls(model(scheme, true));
    }
}
