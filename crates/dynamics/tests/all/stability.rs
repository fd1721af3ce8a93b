//! The critical step of central differences, with a compliant contact.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::Law;
use carom_contact::law::{Adhesion, Damped};
use carom_dynamics::scheme::CentralDifference;
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System};
use carom_materials::Elastic;
use carom_mesh::{Surface, generate};

/// Two bars of 20 elements of 0.05 m, E = rho = A = 1, so that c = 1 and the bars alone allow dt = h.
fn bars(law: Law, dt: f64) -> Result<Driver, carom_dynamics::Error> {
    let mut mesh = generate::line("a", [-1.0, 0.0, 0.0], [0.0; 3], 20, 1);
    mesh.merge("b", generate::line("b", [0.0; 3], [1.0, 0.0, 0.0], 20, 1))
        .unwrap();
    let body = |name: &str, speed: f64| ModelBody {
        velocity: [speed, 0.0, 0.0],
        ..ModelBody::new(BodySpec::new(
            name,
            mesh.groups[name].elements.clone(),
            Kinematics::Bar { area: 1.0 },
            Elastic {
                density: 1.0,
                young: 1.0,
                poisson: 0.0,
            },
        ))
    };
    let bodies = vec![body("a", 1.0), body("b", 0.0)];
    let surface = |group: &str, k: usize| {
        Surface::new(&mesh, &mesh.groups[group], &bodies[k].spec.cells).unwrap()
    };
    let contacts = vec![ModelContact::new(
        "shock",
        surface("a.right", 0),
        ModelTarget::Surface(surface("b.left", 1)),
        law,
    )];
    let model = Model {
        contacts,
        ..Model::new(
            bodies.clone(),
            mesh.clone(),
            Scheme::CentralDifference(CentralDifference {}),
            dt,
        )
    };
    Driver::new(System::new(model)?)
}

#[test]
fn a_stiff_contact_lowers_the_critical_step_and_the_run_below_it_keeps_its_energy() {
    let h = 0.05;
    // k_p = E/h on the half masses of the tips, m = h/2 each: omega² <= 4/h² + 2 k_p/m = 8/h², so dt = h/sqrt(2)
    let law = Law::Damped(Damped {
        stiffness: 1.0 / h,
        damping: 0.0,
        adhesion: Adhesion::Clip,
    });
    let critical = bars(law, 1e-3).unwrap().system().critical_step();
    assert!(
        (critical / (h / 2.0_f64.sqrt()) - 1.0).abs() < 2e-3,
        "{critical}"
    );
    assert!(bars(law, 0.8 * h).is_err());
    let mut driver = bars(law, 0.999 * critical).unwrap();
    for _ in 0..200 {
        driver.step().unwrap();
    }
    let ledger = &driver.state().ledger;
    let energy = ledger.balance.energy() + ledger.balance.scheme_energy;
    assert!(energy < 0.5 * 1.01 && energy > 0.4, "{energy}");
}
