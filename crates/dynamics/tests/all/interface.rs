//! A contact problem that cannot be solved leaves itself behind.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::Displacement;
use carom_contact::{Law, Plane};
use carom_dynamics::scheme::Theta;
use carom_dynamics::{
    Driver, Error, FailedProblem, InterfaceProblem, Model, ModelBody, ModelContact, ModelTarget,
    Scheme, Stepper, System,
};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

#[test]
fn a_problem_with_the_same_contact_twice_is_saved_reloaded_and_solved_once_it_is_regular() {
    let mesh = generate::line("bar", [0.0; 3], [1.0, 0.0, 0.0], 4, 1);
    let cells = mesh.groups["bar"].elements.clone();
    let wall = |name: &str| {
        ModelContact::new(
            name,
            Surface::new(&mesh, &mesh.groups["bar.left"], &cells).unwrap(),
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [1.0, 0.0, 0.0],
            }),
            Law::Displacement(Displacement { projection: false }),
        )
    };
    let model = Model {
        contacts: vec![wall("one"), wall("same")],
        ..Model::new(
            vec![ModelBody {
                velocity: [-1.0, 0.0, 0.0],
                ..ModelBody::new(BodySpec::new(
                    "bar",
                    cells.clone(),
                    Kinematics::Bar { area: 1.0 },
                    Elastic {
                        density: 1.0,
                        young: 1.0,
                        poisson: 0.0,
                    },
                ))
            }],
            mesh.clone(),
            Scheme::Theta(Theta { theta: 1.0 }),
            0.1,
        )
    };
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    let before = driver.state().clone();
    assert!(matches!(
        driver.step(),
        Err(Error::Interface {
            step: 1,
            points: 2,
            ..
        })
    ));
    assert_eq!(driver.state(), &before, "the last good state stands");
    let Some(FailedProblem::Normal(failed)) = driver.failed_problem() else {
        panic!("the contact problem that failed is kept");
    };
    let saved = serde_json::to_string(failed).unwrap();
    let mut problem: InterfaceProblem = serde_json::from_str(&saved).unwrap();
    assert_eq!(&problem, failed);
    assert!(problem.names[1].contains("same") && problem.names[1].contains("node 0"));
    assert!(problem.solve().is_err());
    // a little compliance of their own makes the two contacts share the force
    let alone = problem.compliance[0];
    problem.compliance[0] *= 1.0 + 1e-6;
    problem.compliance[3] *= 1.0 + 1e-6;
    let solution = problem.solve().unwrap();
    let total: f64 = solution.forces.iter().sum();
    let exact = -problem.candidates[0].local.gap_free / (problem.factors[0] * alone);
    assert!((total / exact - 1.0).abs() < 1e-6);
    assert!((solution.forces[0] / solution.forces[1] - 1.0).abs() < 1e-9);
}
