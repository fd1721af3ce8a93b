//! Momentum of bodies of revolution: only the axial one is a momentum.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Law, Plane, Sliding};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

#[test]
fn a_cylinder_that_bulges_as_it_strikes_keeps_its_axial_momentum_balance() {
    let mesh = generate::rectangle("cylinder", [0.0, 0.0], [1.0, 2.0], [4, 8], false);
    let cells = mesh.groups["cylinder"].elements.clone();
    let model = Model {
        contacts: vec![ModelContact {
            sliding: Sliding::Finite,
            ..ModelContact::new(
                "ground",
                Surface::new(&mesh, &mesh.groups["cylinder.bottom"], &cells).unwrap(),
                ModelTarget::rigid(Plane {
                    point: [0.0; 3],
                    normal: [0.0, 1.0, 0.0],
                }),
                Law::Velocity(Velocity {
                    capture: Capture::Half,
                    reading: Reading::Closed,
                }),
            )
        }],
        ..Model::new(
            vec![ModelBody {
                velocity: [0.0, -5.0, 0.0],
                ..ModelBody::new(BodySpec::new(
                    "cylinder",
                    cells.clone(),
                    Kinematics::Axisymmetric,
                    Elastic {
                        density: 1000.0,
                        young: 1e9,
                        poisson: 0.3,
                    },
                ))
            }],
            mesh,
            Scheme::Theta(Theta { theta: 0.5 }),
            5e-5,
        )
    };
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..100 {
        driver.step().unwrap();
    }
    let ledger = &driver.state().ledger;
    assert!(ledger.largest_momentum_residual < 1e-12 * ledger.largest_momentum);
    let mass = 1000.0 * std::f64::consts::PI * 2.0;
    assert!(
        ledger.balance.impulse_contact.linear[1] > 0.5 * mass * 5.0,
        "it struck"
    );
}
