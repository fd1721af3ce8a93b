//! Bulk viscosity and mass scaling of explicit steps.

use std::sync::Arc;

use carom_bodies::{BodySpec, BulkViscosity, Kinematics, MARGIN, MassScaling};
use carom_dynamics::scheme::CentralDifference;
use carom_dynamics::{Driver, Error, Model, ModelBody, Scheme, Support, System};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::{Mesh, generate};

const INITIAL: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};
const CENTRAL: Scheme = Scheme::CentralDifference(CentralDifference {});
const NEO_HOOKE: Material = Material::NeoHooke(NeoHooke { initial: INITIAL });

/// A bar of cubes along x of edge 0.1 m, and its body.
fn bar(cells: usize) -> (Mesh, BodySpec) {
    let size = [0.1 * cells as f64, 0.1, 0.1];
    let mesh = generate::box_("bar", [0.0; 3], size, [cells, 1, 1], false);
    let group = mesh.groups["bar"].elements.clone();
    let spec = BodySpec::new("bar", group, Kinematics::Solid, NEO_HOOKE);
    (mesh, spec)
}

/// Held across x.
fn confined(mesh: &Mesh) -> Vec<Support> {
    let nodes = mesh.group_nodes(&mesh.groups["bar"]);
    vec![Support {
        nodes,
        fix: [false, true, true],
        fix_rotations: [false; 3],
    }]
}

/// The added mass takes part in the motion: weight over mass is g, whatever is added, and momentum grows by the weight of all the
/// mass; a number of 1e-13 is the rounding of some hundred sums.
#[test]
fn momentum_of_scaled_mass_grows_by_its_weight() {
    let (mesh, mut spec) = bar(3);
    spec.scaling = Some(MassScaling::Factor(3.0));
    let dt = 1e-5;
    let model = Model {
        gravity: [0.0, 0.0, -10.0],
        ..Model::new(vec![ModelBody::new(spec)], mesh, CENTRAL, dt)
    };
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    let own = 1000.0 * 0.3 * 0.01;
    let added = driver.system().bodies[0].added_mass();
    assert!((added - 2.0 * own).abs() < 1e-13 * own, "{added}");
    assert!((driver.system().body_mass(0) - 3.0 * own).abs() < 1e-13 * own);
    for _ in 0..100 {
        driver.step().unwrap();
    }
    let balance = &driver.state().ledger.balance;
    let right = -3.0 * own * 10.0 * 100.0 * dt;
    assert!((balance.momentum.linear[2] - right).abs() < 1e-12 * right.abs());
    assert!((balance.kinetic - 0.5 * right * right / (3.0 * own)).abs() < 1e-12 * balance.kinetic);
}

/// Mass is added to the small elements alone, until their critical step is the wanted one over the margin; the run goes at that step and
/// its scheme conserves what it balances.
#[test]
fn mass_scaling_reaches_the_wanted_step_and_leaves_large_elements_as_they_are() {
    let mut mesh = generate::box_("bar", [0.0; 3], [1.0, 0.1, 0.1], [10, 1, 1], false);
    // the first slice is a tenth as thick
    for x in &mut mesh.nodes {
        if (x[0] - 0.1).abs() < 1e-9 {
            x[0] = 0.01;
        }
    }
    let cells = mesh.groups["bar"].elements.clone();
    let spec = BodySpec::new("bar", cells, Kinematics::Solid, NEO_HOOKE);
    let system = |scaling, dt| {
        let spec = BodySpec {
            scaling,
            ..spec.clone()
        };
        let body = ModelBody {
            velocity: [1.0, 0.0, 0.0],
            ..ModelBody::new(spec)
        };
        System::new(Model::new(vec![body], mesh.clone(), CENTRAL, dt)).unwrap()
    };
    let plain = system(None, 1e-6);
    let wanted = 4.0 * plain.critical_step();
    let scaled = system(Some(MassScaling::Step(wanted)), wanted);
    let ratio = scaled.critical_step() / (wanted / MARGIN);
    // the bound of the eigenvalue is within a thousandth
    assert!((ratio - 1.0).abs() < 2e-3, "{ratio}");
    let lumped = |system: &System, x: f64| {
        let at = |k: &usize| (system.x[*k][0] - x).abs() < 1e-9;
        let node = (0..system.x.len()).find(at).unwrap();
        system.mass.lumped[3 * node]
    };
    let kept = lumped(&scaled, 0.5) / lumped(&plain, 0.5);
    assert!((kept - 1.0).abs() < 1e-14, "{kept}");
    assert!(lumped(&scaled, 0.0) > 10.0 * lumped(&plain, 0.0));
    let added = scaled.bodies[0].added_mass();
    let total = scaled.body_mass(0) - plain.body_mass(0);
    assert!((added - total).abs() < 1e-12 * total);
    let mut driver = Driver::new(scaled).unwrap();
    let attempts: u32 = (0..200)
        .map(|_| {
            driver.step().unwrap();
            driver.report().attempts
        })
        .sum();
    assert_eq!(attempts, 200);
    let ledger = &driver.state().ledger;
    assert!(ledger.largest_energy_residual < 1e-12 * ledger.largest_energy);
}

/// A single confined element of length h breathes with ω = 2 c/h, damped by γ = 4 b₁ c/h. Displacements of central differences whose
/// damping lags half a step obey u₊ = (2 - ω² dt² - γ dt) u - (1 - γ dt) u₋: an amplitude of 1e-6 h leaves 1e-5 of nonlinearity.
#[test]
fn linear_bulk_viscosity_damps_the_highest_mode_as_its_recurrence_says() {
    let linear = 0.06;
    let (mesh, mut spec) = bar(1);
    spec.viscosity = Some(BulkViscosity {
        linear,
        quadratic: 0.0,
    });
    let (h, c) = (0.1, INITIAL.wave_speed(carom_materials::Plane::Full));
    let (omega, gamma) = (2.0 * c / h, 4.0 * linear * c / h);
    // stable up to ω² dt² + 2 γ dt = 4
    let limit = (-gamma + (gamma * gamma + 4.0 * omega * omega).sqrt()) / (omega * omega);
    let supports = confined(&mesh);
    let model = Model {
        supports,
        ..Model::new(vec![ModelBody::new(spec)], mesh, CENTRAL, 0.3 * limit)
    };
    let ends: Vec<u32> = model.mesh.group_nodes(&model.mesh.groups["bar.right"]);
    let system = System::new(model.clone()).unwrap();
    // the breathing of an unconfined cube is faster, and is what the bound knows
    assert!(system.critical_step() < limit);
    assert!(system.critical_step() > 0.5 * limit);
    let dt = model.dt;
    let mut driver = Driver::new(Arc::clone(&system)).unwrap();
    let mut state = driver.state().clone();
    let unknown = 3 * driver.system().number[ends[0] as usize] as usize;
    for (k, x) in driver.system().x.iter().enumerate() {
        state.motion.v[3 * k] = if x[0] > 0.05 { 1.0 } else { -1.0 } * 1e-6 * c;
    }
    driver = Driver::resume(system, state).unwrap();
    let mut places = vec![0.0];
    for _ in 0..60 {
        driver.step().unwrap();
        places.push(driver.state().motion.u[unknown]);
    }
    let largest = places.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    for of in places.windows(3) {
        let right = (2.0 - (omega * dt).powi(2) - gamma * dt) * of[1] - (1.0 - gamma * dt) * of[0];
        assert!((of[2] - right).abs() < 1e-5 * largest, "{} {right}", of[2]);
    }
    assert!(driver.state().ledger.balance.dissipation_viscosity > 0.0);
}

/// A bar that is pressed together by its ends until no part of a step is stable ends with the element.
#[test]
fn a_collapsed_element_ends_the_run_with_its_name() {
    let (mesh, spec) = bar(2);
    let supports = confined(&mesh);
    let body = ModelBody {
        velocity: [0.0; 3],
        ..ModelBody::new(spec)
    };
    let mut model = Model {
        supports,
        ..Model::new(vec![body], mesh, CENTRAL, 1e-4)
    };
    model.dt = 0.88 * System::new(model.clone()).unwrap().critical_step();
    model.nonlinear.iteration.halvings = 0;
    let system = System::new(model).unwrap();
    let mut driver = Driver::new(Arc::clone(&system)).unwrap();
    let mut state = driver.state().clone();
    let c = INITIAL.wave_speed(carom_materials::Plane::Full);
    for (k, x) in driver.system().x.iter().enumerate() {
        // the right element alone is pressed together
        state.motion.v[3 * k] = if x[0] > 0.15 { -0.9 * c } else { 0.0 };
    }
    driver = Driver::resume(system, state).unwrap();
    let error = (0..200).find_map(|_| driver.step().err()).unwrap();
    let last = driver.state().step;
    assert!(driver.state().motion.u.iter().all(|u| u.is_finite()));
    match &error {
        Error::Shortened { step, place, .. } => {
            assert_eq!(*step, last + 1);
            assert!(place.contains("cell 1 of block 0 in body 'bar'"), "{place}");
        }
        Error::Body(carom_bodies::Error::NoStress { cell, .. }) => assert_eq!(cell.index, 1),
        other => panic!("{other}"),
    }
}

/// A bar flies at 0.4 c against the support of one end. In its first step nothing is known of the compression to come: without bulk
/// viscosity the step is stable; with it its quadratic part has γ dt of about ten, where 2 γ dt + ω² dt² ≤ 4 is stable, so that attempts are
/// dropped and parts of the step taken.
#[test]
fn the_first_step_of_a_hard_impact_is_taken_in_halves() {
    let first_step = |quadratic: f64| {
        let (mesh, mut spec) = bar(10);
        spec.viscosity = Some(BulkViscosity {
            linear: 0.0,
            quadratic,
        });
        let c = INITIAL.wave_speed(carom_materials::Plane::Full);
        let mut supports = confined(&mesh);
        supports.push(Support {
            nodes: mesh.group_nodes(&mesh.groups["bar.left"]),
            fix: [true; 3],
            fix_rotations: [false; 3],
        });
        let body = ModelBody {
            velocity: [-0.4 * c, 0.0, 0.0],
            ..ModelBody::new(spec)
        };
        let mut model = Model {
            supports,
            ..Model::new(vec![body], mesh, CENTRAL, 1e-4)
        };
        model.dt = 0.6 * System::new(model.clone()).unwrap().critical_step();
        let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
        driver.step().unwrap();
        let attempts = driver.report().attempts;
        for _ in 0..20 {
            driver.step().unwrap();
        }
        let state = driver.state();
        (
            attempts,
            state.control.failed,
            state.ledger.largest_made / state.ledger.initial.energy(),
        )
    };
    let (attempts, failed, made) = first_step(0.0);
    assert_eq!((attempts, failed), (1, 0), "{made}");
    let (attempts, failed, made) = first_step(3.0);
    assert!(attempts > 2 && failed > 0, "{attempts} {failed} {made}");
}
