//! A step allocates nothing once contact has been met and the buffers have grown.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Integration, Law, Plane, Sliding};
use carom_dynamics::scheme::{CentralDifference, Newmark, Theta};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};
use carom_testing::allocations;

/// A cube resting on a plane under gravity: contact all the time, statuses settled.
fn resting_cube(scheme: Scheme, law: Law, integration: Integration) -> Driver {
    let mesh = generate::box_("cube", [0.0; 3], [1.0; 3], [4, 4, 4], false);
    let cells = mesh.groups["cube"].elements.clone();
    let model = Model {
        gravity: [0.0, 0.0, -1e6],
        contacts: vec![ModelContact {
            sliding: Sliding::Finite,
            integration,
            ..ModelContact::new(
                "ground",
                Surface::new(&mesh, &mesh.groups["cube.bottom"], &cells).unwrap(),
                ModelTarget::rigid(Plane {
                    point: [0.0; 3],
                    normal: [0.0, 0.0, 1.0],
                }),
                law,
            )
        }],
        ..Model::new(
            vec![ModelBody {
                velocity: [0.0, 0.0, -1.0],
                ..ModelBody::new(BodySpec::new(
                    "cube",
                    cells.clone(),
                    Kinematics::Solid,
                    Elastic {
                        density: 1000.0,
                        young: 1e9,
                        poisson: 0.3,
                    },
                ))
            }],
            mesh,
            scheme,
            5e-5,
        )
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

#[test]
fn a_step_in_contact_allocates_nothing() {
    let velocity = Law::Velocity(Velocity {
        capture: Capture::Now,
        reading: Reading::Closed,
    });
    let (node, weak) = (Integration::Node, Integration::Weak { r: 1e6 });
    let runs = [
        (Scheme::Theta(Theta { theta: 1.0 }), velocity, node),
        (Scheme::Theta(Theta { theta: 1.0 }), velocity, weak),
        (
            Scheme::Newmark(Newmark {
                beta: 0.49,
                gamma: 0.9,
            }),
            Law::Displacement(Displacement::default()),
            node,
        ),
        (
            Scheme::CentralDifference(CentralDifference {}),
            velocity,
            node,
        ),
    ];
    for (scheme, law, integration) in runs {
        let mut driver = resting_cube(scheme, law, integration);
        for _ in 0..40 {
            driver.step().unwrap();
        }
        let mut fewest = usize::MAX;
        let mut closed = 0;
        // statuses may still change in some steps, and a new closed set has a new factor: most steps must be clean
        for _ in 0..20 {
            let before = allocations();
            driver.step().unwrap();
            fewest = fewest.min(allocations() - before);
            closed = closed.max(driver.report().contacts[0].closed);
        }
        assert_eq!(fewest, 0, "{scheme:?}");
        assert!(closed > 0, "{scheme:?}: in contact");
    }
}
