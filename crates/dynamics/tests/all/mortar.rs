//! Mortar contact of meshes that do not match.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Basis, Integration, Law, Sliding};
use carom_dynamics::{Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, System, scheme};
use carom_materials::Elastic;
use carom_mesh::{Mesh, Surface, generate};

const STEEL: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.0,
};

/// Two blocks of side 1, one above the other and touching, that approach each other. `across`: elements along the
/// sides of each; both have four over their height.
fn blocks(dim: usize, across: [usize; 2], scheme: Scheme, law: Law) -> Model {
    let block = |name: &str, low: f64, n: usize| match dim {
        2 => generate::rectangle(name, [0.0, low], [1.0; 2], [n, 4], false),
        _ => generate::box_(name, [0.0, 0.0, low], [1.0; 3], [n, n + 1, 4], false),
    };
    let mut mesh: Mesh = block("a", 1.0, across[0]);
    mesh.merge("b", block("b", 0.0, across[1])).unwrap();
    let body = |name: &str, speed: f64| {
        let mut velocity = [0.0; 3];
        velocity[dim - 1] = speed;
        ModelBody {
            velocity,
            ..ModelBody::new(BodySpec::new(
                name,
                mesh.groups[name].elements.clone(),
                match dim {
                    2 => Kinematics::PlaneStrain { thickness: 0.5 },
                    _ => Kinematics::Solid,
                },
                STEEL,
            ))
        }
    };
    let side = |body: &str, side: &str| {
        let group = &mesh.groups[&format!("{body}.{side}")];
        Surface::new(&mesh, group, &mesh.groups[body].elements).unwrap()
    };
    Model {
        contacts: vec![ModelContact::new(
            "joint",
            side("a", "bottom"),
            ModelTarget::Surface(side("b", "top")),
            law,
        )],
        ..Model::new(
            vec![body("a", -1.0), body("b", 1.0)],
            mesh,
            scheme, // c = 2 m/s, h = 0.25 m: CFL 0.5 along the body
            0.0625,
        )
    }
}

/// Of steps that stay whole: in the first one the blocks go half an element into each other.
fn driver(mut model: Model, integration: Integration, sliding: Sliding) -> Driver {
    model.nonlinear.iteration.halvings = 0;
    model.contacts[0].integration = integration;
    model.contacts[0].sliding = sliding;
    Driver::new(System::new(model).unwrap()).unwrap()
}

#[test]
fn blocks_of_meshes_that_do_not_match_strike_like_bars() {
    let newmark = Scheme::Newmark(scheme::Newmark {
        beta: 0.25,
        gamma: 0.5,
    });
    let displacement = Law::Displacement(Displacement { projection: false });
    let velocity = Law::Velocity(Velocity {
        capture: Capture::Now,
        reading: Reading::Closed,
    });
    for (law, dim) in [(velocity, 2), (displacement, 2), (velocity, 3)] {
        for basis in [Basis::Standard, Basis::Dual] {
            let made = |across| blocks(dim, across, newmark, law);
            // matching meshes with nodal contact: ν = 0, so bars side by side
            let mut bars = driver(made([2, 2]), Integration::Node, Sliding::Small);
            let mortar = Integration::Mortar { basis };
            let mut small = driver(made([3, 2]), mortar, Sliding::Small);
            let mut finite = driver(made([3, 2]), mortar, Sliding::Finite);
            let mut largest = 0.0_f64;
            for step in 0..24 {
                for driver in [&mut bars, &mut small, &mut finite] {
                    driver.step().unwrap();
                }
                let force = |driver: &Driver| driver.report().contacts[0].force;
                largest = largest.max(force(&bars));
                for driver in [&small, &finite] {
                    let error = (force(driver) - force(&bars)).abs() / largest;
                    // rounding, times the steps in which it may grow
                    assert!(error < 1e-9, "{law:?} {dim} {basis:?} {step}: {error:e}");
                }
            }
            assert!(largest > 0.1, "they struck");
        }
    }
}

/// The blocks with wavy faces towards each other, a little apart, the upper one thrown along the lower one as well.
fn wavy(dim: usize, scheme: Scheme, friction: f64) -> Model {
    let velocity = Law::Velocity(Velocity {
        capture: Capture::Now,
        reading: Reading::Closed,
    });
    let mut model = blocks(dim, [3, 2], scheme, velocity);
    for x in &mut model.mesh.nodes {
        let gap = if x[dim - 1] > 1.0 { 0.02 } else { 0.0 };
        x[dim - 1] += gap + 0.1 * (2.0 * x[0]).sin();
    }
    model.bodies[0].velocity[0] = 0.3;
    model.contacts[0].sliding = Sliding::Finite;
    model.contacts[0].friction = friction.into();
    model.contacts[0].integration = Integration::Mortar {
        basis: Basis::Standard,
    };
    model
}

#[test]
fn contacts_report_the_force_that_bodies_get_where_normals_differ_over_a_face() {
    let theta = Scheme::Theta(scheme::Theta { theta: 0.5 });
    let keeping = Scheme::EnergyMomentum(scheme::EnergyMomentum {});
    for (dim, scheme, friction) in [(2, theta, 0.3), (3, theta, 0.0), (2, keeping, 0.0)] {
        let system = System::new(wavy(dim, scheme, friction)).unwrap();
        let mut run = Driver::new(system).unwrap();
        for _ in 0..24 {
            run.step().unwrap();
        }
        let impulse = run.state().records.contacts[0].impulse();
        assert!(impulse > 0.1, "they struck: {impulse}");
        // the iterations end at 1e-10 of the forces
        let left = run.state().exchange.relative().unwrap();
        assert!(left < 1e-9, "{dim}, {scheme:?}: {left:e}");
    }
}
