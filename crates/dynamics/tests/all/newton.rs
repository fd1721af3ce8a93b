//! The nonlinear solver against what is known of its steps.

use carom_bodies::{BodySpec, Formulation, Kinematics, MassKind};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Integration, Law, Plane, Sliding};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Newton, Scheme, Stepper, System, scheme,
};
use carom_materials::{Elastic, Law as Material};
use carom_mesh::{Surface, generate};

const DISPLACEMENT: Law = Law::Displacement(Displacement { projection: false });
const VELOCITY: Law = Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});
pub(crate) const SOFT: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.3,
};

/// A square that falls on a plane.
pub(crate) fn square(scheme: Scheme, law: Law, material: Material, n: usize) -> Model {
    let mesh = generate::rectangle("a", [0.0; 2], [1.0; 2], [n, n], false);
    let cells = mesh.groups["a"].elements.clone();
    Model {
        bodies: vec![ModelBody {
            spec: BodySpec {
                name: "a".into(),
                cells: cells.clone(),
                kinematics: Kinematics::PlaneStrain { thickness: 0.5 },
                material,
                formulation: Formulation::Full,
                weights: None,
            },
            mass: MassKind::Lumped,
            velocity: [0.0, -0.2, 0.0],
            displacement: [0.0; 3],
        }],
        supports: Vec::new(),
        gravity: [0.0, -0.1, 0.0],
        contacts: vec![ModelContact {
            name: "ground".into(),
            secondary: Surface::new(&mesh, &mesh.groups["a.bottom"], &cells).unwrap(),
            primary: ModelTarget::Plane(Plane {
                point: [0.0, -0.01, 0.0],
                normal: [0.0, 1.0, 0.0],
            }),
            law,
            sliding: Sliding::Finite,
            integration: Integration::Node,
            massless: false,
            friction: 0.0,
        }],
        scheme,
        dt: 0.05,
        adaptive: None,
        nonlinear: carom_dynamics::Nonlinear::default(),
        mesh,
    }
}

#[test]
fn a_linear_system_takes_the_steps_of_the_linear_driver() {
    let pairs = [
        (
            Scheme::Newmark(scheme::Newmark {
                beta: 0.25,
                gamma: 0.5,
            }),
            DISPLACEMENT,
        ),
        (
            Scheme::Newmark(scheme::Newmark {
                beta: 0.49,
                gamma: 0.9,
            }),
            VELOCITY,
        ),
        (Scheme::Theta(scheme::Theta { theta: 0.5 }), VELOCITY),
        (Scheme::Theta(scheme::Theta { theta: 0.75 }), DISPLACEMENT),
        (
            Scheme::GeneralisedAlpha(scheme::GeneralisedAlpha { rho_inf: 0.8 }),
            DISPLACEMENT,
        ),
        (Scheme::LaursenChawla(scheme::LaursenChawla), VELOCITY),
        (
            Scheme::CentralDifference(scheme::CentralDifference),
            VELOCITY,
        ),
    ];
    for (scheme, law) in pairs {
        let system = System::new(square(scheme, law, SOFT.into(), 3)).unwrap();
        let mut linear = Driver::new(system.clone()).unwrap();
        let mut newton = Newton::new(system).unwrap();
        let mut largest = 0.0_f64;
        for _ in 0..40 {
            linear.step().unwrap();
            Stepper::step(&mut newton).unwrap();
            let [one, other] =
                [linear.report(), newton.report()].map(|report| report.contacts[0].force);
            largest = largest.max(one);
            // both solve the same linear equations to rounding, again at each step
            assert!(
                (one - other).abs() < 1e-9 * largest.max(1e-3),
                "{}: {one} {other}",
                scheme.get().name()
            );
        }
        assert!(largest > 0.0, "{} never touches", scheme.get().name());
        let [one, other] = [linear.state(), newton.state()].map(|state| &state.motion.u);
        let size = one.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        for (a, b) in one.iter().zip(other) {
            assert!((a - b).abs() < 1e-10 * size, "{}", scheme.get().name());
        }
        let ledger = &newton.state().ledger;
        assert!(
            ledger.largest_energy_residual < 1e-11 * ledger.largest_energy,
            "{}: {:e} of {:e}",
            scheme.get().name(),
            ledger.largest_energy_residual,
            ledger.largest_energy
        );
        assert!(
            ledger.largest_momentum_residual < 1e-11 * ledger.largest_momentum,
            "{}: momentum",
            scheme.get().name()
        );
    }
}
