//! Supports that move: what they give to the momentum and to the energy.

use std::sync::Arc;

use carom_bodies::{BodySpec, Kinematics, MassKind};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelBody, Order, Prescribed, Scheme, System, scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke};
use carom_mesh::generate;

const SOFT: Elastic = Elastic {
    density: 2.0,
    young: 8.0,
    poisson: 0.3,
};

const SPEED: f64 = 0.3;

/// A unit square, 0.5 thick, whose nodes in `held` go with [`SPEED`] to the right from a start at rest or at the speed
/// given, and from t = 2 on stand still.
fn carried(scheme: Scheme, material: Material, mass: MassKind, held: &str, speed: f64) -> Driver {
    let mesh = generate::rectangle("a", [0.0, 0.3], [1.0; 2], [3, 3], false);
    let cells = mesh.groups["a"].elements.clone();
    let nodes = match held {
        "a" => (0..mesh.nodes.len() as u32).collect(),
        side => mesh.group_nodes(&mesh.groups[side]),
    };
    let course = vec![[0.0, 0.0], [2.0, 2.0 * SPEED], [9.0, 2.0 * SPEED]];
    let mut model = Model::new(
        vec![ModelBody {
            velocity: [speed, 0.0, 0.0],
            mass,
            ..ModelBody::new(BodySpec::new(
                "a",
                cells,
                Kinematics::PlaneStrain { thickness: 0.5 },
                material,
            ))
        }],
        mesh,
        scheme,
        0.05,
    );
    let across = Amplitude::constant(0.0);
    let along = Amplitude::new(course).unwrap();
    model.nonlinear.motions = vec![Prescribed {
        nodes,
        displacement: [Some(along), Some(across), None],
    }];
    Driver::new(System::new(model).unwrap()).unwrap()
}

fn schemes() -> Vec<Scheme> {
    let mut all = Scheme::registered();
    all.push(Scheme::EnergyMomentum(scheme::EnergyMomentum {}));
    all
}

/// Every scheme, with lumped and with consistent mass.
fn each(check: &dyn Fn(&str, Scheme, MassKind)) {
    let mut seen = 0;
    for scheme in schemes() {
        let map = scheme.get().step_map(0.05);
        let staged = scheme.get().stages().len() > 1;
        let taken = (staged || !map.has_memory())
            && !map.uses_contact_acceleration()
            && !scheme.get().projects_predictor()
            && !scheme.get().restores_contact_work();
        if !taken {
            continue;
        }
        for mass in [MassKind::Lumped, MassKind::Consistent] {
            if mass == MassKind::Consistent && scheme.get().needs_lumped_mass() {
                continue;
            }
            seen += 1;
            let name = format!("{}, {mass:?}", scheme.get().name());
            check(&name, scheme, mass);
        }
    }
    assert!(seen >= 12, "{seen}");
}

#[test]
fn the_momentum_of_a_body_whose_support_starts_and_stops_with_a_jump_is_the_impulse_of_the_support()
{
    each(&|name, scheme, mass| {
        let mut newton = carried(scheme, SOFT.into(), mass, "a.left", 0.0);
        for step in 1..=60 {
            newton.step().unwrap();
            let ledger = &newton.state().ledger;
            let now = &ledger.balance;
            // a linear body: rounding of sixty steps, and nothing else acts
            let bound = 1e-12 * ledger.largest_momentum;
            for i in 0..2 {
                let missing = now.momentum.linear[i] - now.impulse_supports.linear[i];
                assert!(missing.abs() < bound, "{name}, step {step}: {missing:e}");
            }
        }
        let ledger = &newton.state().ledger;
        assert!(ledger.largest_momentum > 0.1 * SPEED, "{name}: it moves");
    });
}

#[test]
fn a_body_held_as_a_whole_gets_its_momentum_and_its_energy_in_the_first_step() {
    each(&|name, scheme, mass| {
        let mut newton = carried(scheme, SOFT.into(), mass, "a", 0.0);
        newton.step().unwrap();
        let m = SOFT.density * 0.5;
        let now = newton.state().ledger.balance;
        // closed forms: m V, -y m V about the lower left corner with the centre at y = 0.5 from there, ½ m V²; rounding
        let close = |found: f64, exact: f64| {
            assert!((found - exact).abs() < 1e-13, "{name}: {found} for {exact}");
        };
        close(now.impulse_supports.linear[0], m * SPEED);
        close(now.impulse_supports.angular[2], -0.5 * m * SPEED);
        close(now.work_supports, 0.5 * m * SPEED * SPEED);
        close(now.dissipation_scheme, 0.0);
        for _ in 1..60 {
            newton.step().unwrap();
        }
        // it stands still again, and the support has taken all back
        let now = newton.state().ledger.balance;
        close(now.momentum.linear[0], 0.0);
        close(now.impulse_supports.linear[0], 0.0);
        close(now.work_supports, 0.0);
    });
}

#[test]
fn a_support_that_goes_with_the_body_from_the_start_does_nothing() {
    each(&|name, scheme, mass| {
        let mut newton = carried(scheme, SOFT.into(), mass, "a.left", SPEED);
        for _ in 0..30 {
            newton.step().unwrap();
        }
        let now = newton.state().ledger.balance;
        // rigid motion at one speed: rounding of thirty steps, of forces up to E u = 5 N
        let size = now.impulse_supports.largest();
        assert!(size < 1e-13, "{name}: {size:e}");
        assert!(now.work_supports.abs() < 1e-13, "{name}");
        assert!(now.strain < 1e-20, "{name}: {:e}", now.strain);
    });
}

#[test]
fn the_angular_momentum_of_a_large_motion_is_the_impulse_of_a_support_that_jumps() {
    let soft = NeoHooke { initial: SOFT };
    for mass in [MassKind::Lumped, MassKind::Consistent] {
        let schemes = [
            Scheme::Theta(scheme::Theta { theta: 0.5 }),
            Scheme::EnergyMomentum(scheme::EnergyMomentum {}),
        ];
        for scheme in schemes {
            let name = scheme.get().name();
            let mut newton = carried(scheme, Material::NeoHooke(soft), mass, "a.left", 0.0);
            for _ in 0..60 {
                newton.step().unwrap();
            }
            let ledger = &newton.state().ledger;
            // both rules conserve it; sixty steps, each to the default tolerance, 1e-10 of the largest force
            let linear = ledger.largest_momentum_residual / ledger.largest_momentum;
            let angular = ledger.largest_angular_residual / ledger.largest_angular_momentum;
            for residual in [linear, angular] {
                assert!(residual < 6e-9, "{name}, {mass:?}: {residual:e}");
            }
        }
    }
}

/// As [`carried`], held on the left, with the displacement ½ a t² of its support in knots far finer than the steps.
fn accelerated(scheme: Scheme, mass: MassKind, acceleration: f64) -> (Arc<System>, u32) {
    let mesh = generate::rectangle("a", [0.0, 0.3], [1.0; 2], [3, 3], false);
    let cells = mesh.groups["a"].elements.clone();
    let nodes = mesh.group_nodes(&mesh.groups["a.left"]);
    let node = nodes[0];
    let section = Kinematics::PlaneStrain { thickness: 0.5 };
    let body = ModelBody {
        mass,
        ..ModelBody::new(BodySpec::new("a", cells, section, SOFT))
    };
    let mut model = Model::new(vec![body], mesh, scheme, 0.05);
    let knots = (0..=1000).map(|k| f64::from(k) * 0.05 / 32.0);
    let course = knots.map(|t| [t, 0.5 * acceleration * t * t]).collect();
    model.nonlinear.motions = vec![Prescribed {
        nodes,
        displacement: [Some(Amplitude::new(course).unwrap()), None, None],
    }];
    let system = System::new(model).unwrap();
    let number = system.number[node as usize];
    (system, number)
}

#[test]
fn a_support_shows_the_acceleration_of_its_motion_and_steps_do_not_depend_on_that() {
    each(&|name, scheme, mass| {
        let (system, node) = accelerated(scheme, mass, 3.0);
        let mut newton = Driver::new(Arc::clone(&system)).unwrap();
        for step in 0..30 {
            let motion = &newton.state().motion;
            let [along, ..] = system.of_node(node, motion, Order::Acceleration);
            if step > 0 || scheme.get().keeps_acceleration() {
                // knots 1/16 of the shortest difference apart: ½ a t² lies between them by 1/512 of it at most
                assert!((along - 3.0).abs() < 6e-3, "{name}, step {step}: {along}");
            }
            // a run that goes on from a state is the same
            if step == 15 {
                let state = newton.state().clone();
                newton = Driver::resume(Arc::clone(&system), state).unwrap();
            }
            newton.step().unwrap();
        }
        let mut whole = Driver::new(system).unwrap();
        (0..30).for_each(|_| whole.step().unwrap());
        assert_eq!(whole.state().motion.u, newton.state().motion.u, "{name}");
        assert_eq!(whole.state().motion.a, newton.state().motion.a, "{name}");
    });
}
