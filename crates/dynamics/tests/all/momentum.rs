//! Momentum of bodies of revolution: only the axial one is a momentum.

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Initial, Integration, Law, Plane, Sliding};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

#[test]
fn a_cylinder_that_bulges_as_it_strikes_keeps_its_axial_momentum_balance() {
    let mesh = generate::rectangle("cylinder", [0.0, 0.0], [1.0, 2.0], [4, 8], false);
    let cells = mesh.groups["cylinder"].elements.clone();
    let model = Model {
        bodies: vec![ModelBody {
            spec: BodySpec {
                name: "cylinder".into(),
                cells: cells.clone(),
                kinematics: Kinematics::Axisymmetric,
                material: Elastic {
                    density: 1000.0,
                    young: 1e9,
                    poisson: 0.3,
                }
                .into(),
                formulation: Formulation::Full,
                weights: None,
            },
            mass: MassKind::Lumped,
            velocity: [0.0, -5.0, 0.0],
            displacement: [0.0; 3],
        }],
        supports: Vec::new(),
        gravity: [0.0; 3],
        contacts: vec![ModelContact {
            name: "ground".into(),
            secondary: Surface::new(&mesh, &mesh.groups["cylinder.bottom"], &cells).unwrap(),
            primary: ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [0.0, 1.0, 0.0],
            }),
            law: Law::Velocity(Velocity {
                capture: Capture::Half,
                reading: Reading::Closed,
            }),
            sliding: Sliding::Finite,
            integration: Integration::Node,
            massless: false,
            friction: 0.0,
            initial: Initial::Keep,
            depth: None,
        }],
        scheme: Scheme::Theta(Theta { theta: 0.5 }),
        dt: 5e-5,
        adaptive: None,
        nonlinear: carom_dynamics::Nonlinear::default(),
        mesh,
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
