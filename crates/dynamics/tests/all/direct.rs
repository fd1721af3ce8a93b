//! Explicit steps with lumped mass, taken in one pass, are the steps that the iterations take; they allocate nothing.

use std::sync::Arc;

use carom_algebra::unknowns::Kind;
use carom_bodies::{BodySpec, BulkViscosity, Formulation, Kinematics, MassScaling};
use carom_contact::law::{Capture, Reading, Velocity};
use carom_contact::{Integration, Law, Plane, Sliding};
use carom_dynamics::scheme::CentralDifference;
use carom_dynamics::{
    Amplitude, Balance, Damping, Driver, Model, ModelBody, ModelConstraint, ModelContact,
    ModelTarget, Scheme, Support, System,
};
use carom_materials::{Elastic, J2Plasticity, Law as Material, StVenantKirchhoff};
use carom_mesh::{Surface, generate};
use carom_testing::{allocations, held};

const SOFT: Elastic = Elastic {
    density: 1000.0,
    young: 1e7,
    poisson: 0.3,
};

const STEPS: usize = 60;

/// What a block is made of, and what acts on it.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    material: Material,
    formulation: Formulation,
    /// Whether it has bulk viscosity, and four times its mass.
    viscous: bool,
    /// Whether a plane is in the way, with which friction.
    friction: Option<f64>,
    gravity: f64,
    /// Whether the ground shakes.
    shakes: bool,
    /// Factors of mass, 1/s, and stiffness, s, in its damping.
    damping: [f64; 2],
    /// Whether the top is held.
    held: bool,
    /// Whether all nodes of the top move alike, as far as they are not held.
    linked: bool,
    /// Cells along an edge.
    cells: usize,
}

fn cases() -> Vec<Case> {
    let svk = Material::StVenantKirchhoff(StVenantKirchhoff { initial: SOFT });
    let plastic = Material::J2Plasticity(J2Plasticity {
        initial: SOFT,
        yield_stress: 1e5,
        hardening: 1e6,
    });
    let free = Case {
        name: "free",
        material: Material::Elastic(SOFT),
        formulation: Formulation::Full,
        viscous: false,
        friction: None,
        gravity: 0.0,
        shakes: false,
        damping: [0.0; 2],
        held: false,
        linked: false,
        cells: 3,
    };
    let impact = Case {
        name: "impact",
        friction: Some(0.0),
        gravity: -100.0,
        ..free
    };
    vec![
        free,
        Case {
            name: "hanging",
            gravity: -100.0,
            held: true,
            ..free
        },
        impact,
        Case {
            name: "small, rubbing",
            friction: Some(0.3),
            ..impact
        },
        Case {
            name: "linked, free",
            linked: true,
            ..free
        },
        Case {
            name: "linked, hanging",
            gravity: -100.0,
            held: true,
            linked: true,
            ..free
        },
        Case {
            name: "linked, impact",
            linked: true,
            ..impact
        },
        Case {
            name: "finite, linked, damped, shaken, rubbing",
            material: svk,
            friction: Some(0.3),
            damping: [20.0, 0.0],
            shakes: true,
            linked: true,
            ..impact
        },
        Case {
            name: "damped, free",
            damping: [20.0, 0.0],
            ..free
        },
        Case {
            name: "damped, hanging",
            gravity: -100.0,
            damping: [20.0, 1e-5],
            held: true,
            ..free
        },
        Case {
            name: "damped, rubbing",
            friction: Some(0.3),
            damping: [20.0, 1e-5],
            ..impact
        },
        Case {
            name: "finite, damped, hanging, shaken",
            material: svk,
            gravity: -100.0,
            shakes: true,
            damping: [20.0, 0.0],
            held: true,
            ..free
        },
        Case {
            name: "finite, hanging, shaken",
            material: svk,
            gravity: -100.0,
            shakes: true,
            held: true,
            ..free
        },
        Case {
            name: "finite, rubbing",
            material: svk,
            friction: Some(0.3),
            ..impact
        },
        Case {
            name: "plastic, one point",
            material: plastic,
            formulation: Formulation::Reduced { hourglass: 0.1 },
            friction: Some(0.3),
            ..impact
        },
        Case {
            name: "plastic, viscous, one point",
            material: plastic,
            formulation: Formulation::Reduced { hourglass: 0.1 },
            viscous: true,
            friction: Some(0.3),
            ..impact
        },
    ]
}

fn driver(case: &Case) -> Driver {
    Driver::new(System::new(model(case)).unwrap()).unwrap()
}

/// A cube of 1 m, 5 mm above the plane, that falls, glides and shears.
fn model(case: &Case) -> Model {
    let mesh = generate::box_("cube", [0.0, 0.0, 0.005], [1.0; 3], [case.cells; 3], false);
    let cells = mesh.groups["cube"].elements.clone();
    let bottom = Surface::new(&mesh, &mesh.groups["cube.bottom"], &cells).unwrap();
    let top = mesh.group_nodes(&mesh.groups["cube.top"]);
    let mut spec = BodySpec::new("cube", cells, Kinematics::Solid, case.material);
    spec.formulation = case.formulation;
    if case.viscous {
        spec.viscosity = Some(BulkViscosity {
            linear: 0.06,
            quadratic: 1.2,
        });
        spec.scaling = Some(MassScaling::Factor(4.0));
    }
    let body = ModelBody {
        velocity: [1.0, 0.5, -3.0],
        ..ModelBody::new(spec)
    };
    let ground = |friction: f64| ModelContact {
        sliding: Sliding::Finite,
        integration: Integration::Node,
        friction: friction.into(),
        ..ModelContact::new(
            "ground",
            bottom.clone(),
            ModelTarget::rigid(Plane {
                point: [0.0; 3],
                normal: [0.0, 0.0, 1.0],
            }),
            Law::Velocity(Velocity {
                capture: Capture::Now,
                reading: Reading::Closed,
            }),
        )
    };
    let scheme = Scheme::CentralDifference(CentralDifference {});
    let dt = 0.2 / case.cells as f64 / 120.0;
    let mut model = Model {
        gravity: [0.0, 0.0, case.gravity],
        contacts: case.friction.into_iter().map(ground).collect(),
        ..Model::new(vec![body], mesh, scheme, dt)
    };
    if case.held {
        model.supports = vec![Support {
            nodes: top.clone(),
            fix: [true, false, true],
            fix_rotations: [false; 3],
        }];
    }
    if case.linked {
        let axes = if case.held { 1..2 } else { 0..3 };
        let alike = |pair: &[u32]| {
            let (one, other) = (pair[0], pair[1]);
            let rows = axes.clone().map(move |axis| {
                let kind = Kind::Translation(axis);
                vec![(one, kind, 1.0), (other, kind, -1.0)]
            });
            rows.collect::<Vec<_>>()
        };
        model.constraints = vec![ModelConstraint {
            name: "top".to_string(),
            rows: top.windows(2).flat_map(alike).collect(),
        }];
    }
    let [mass, stiffness] = case.damping;
    model.nonlinear.damping = vec![Damping { mass, stiffness }];
    if case.shakes {
        let course = vec![[0.0, 50.0], [10.0 * dt, -80.0], [40.0 * dt, 30.0]];
        model.nonlinear.base[1] = Some(Amplitude::new(course).unwrap());
    }
    model
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let largest = |values: &[f64]| values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b).max(f64::MIN_POSITIVE)
}

/// Energies and works, momenta and impulses.
fn terms(balance: &Balance) -> [Vec<f64>; 2] {
    let resultants = [
        balance.momentum,
        balance.impulse_loads,
        balance.impulse_contact,
        balance.impulse_supports,
    ];
    let energies = vec![
        balance.kinetic,
        balance.strain,
        balance.hardening,
        balance.scheme_energy,
        balance.work_loads,
        balance.work_contact,
        balance.work_supports,
        balance.work_links,
        balance.dissipation_scheme,
        balance.dissipation_material,
        balance.dissipation_damping,
        balance.dissipation_friction,
        balance.dissipation_viscosity,
        balance.hourglass,
        balance.energy_residual,
    ];
    let momenta = resultants
        .iter()
        .flat_map(|r| r.linear.into_iter().chain(r.angular));
    [energies, momenta.collect()]
}

/// Both do the same operations in another order: 1e-10 is rounding that some hundred steps amplify.
#[test]
fn steps_in_one_pass_are_those_of_the_iterations() {
    for case in cases() {
        let mut direct = driver(&case);
        let mut iterated = Driver::of_zone(System::new(model(&case)).unwrap()).unwrap();
        let mut touched = false;
        for step in 0..STEPS {
            direct.step().unwrap();
            iterated.complete().unwrap();
            iterated.take();
            let at = format!("{}, step {step}", case.name);
            let [a, b] = [&direct, &iterated].map(|driver| &driver.state().motion);
            for (a, b) in [(&a.u, &b.u), (&a.v, &b.v), (&a.a, &b.a)] {
                assert!(distance(a, b) < 1e-10, "{at}: {}", distance(a, b));
            }
            let [a, b] = [&direct, &iterated].map(|driver| driver.state());
            assert!(
                distance(&a.interface.force, &b.interface.force) < 1e-9,
                "{at}"
            );
            // multipliers round as the forces that they hold, their works as the kinetic energy
            let norm = |forces: &[f64]| forces.iter().fold(0.0_f64, |most, f| most.max(f.abs()));
            let forces = [&b.motion.internal_force, &b.links.multipliers];
            let forces = forces.into_iter().chain(b.forces.each());
            let force = forces.map(|forces| norm(forces)).fold(0.0, f64::max);
            let both = a.links.multipliers.iter().zip(&b.links.multipliers);
            for (a, b) in both {
                assert!((a - b).abs() <= 1e-10 * force, "{at}: {a} {b}");
            }
            let energy = b.ledger.balance.kinetic;
            for (a, b) in a.links.works.iter().zip(&b.links.works) {
                let apart = (0..2).map(|k| (a[k] - b[k]).abs());
                assert!(
                    apart.fold(0.0, f64::max) < 1e-10 * energy,
                    "{at}: {a:?} {b:?}"
                );
            }
            touched |= a.interface.force.iter().any(|force| *force != 0.0);
            let [a, b] = [&a.ledger, &b.ledger].map(|ledger| terms(&ledger.balance));
            for (a, b) in a.iter().zip(&b) {
                assert!(distance(a, b) < 1e-10, "{at}: {a:?} {b:?}");
            }
            let [a, b] = [&direct, &iterated].map(|driver| &driver.state().ledger);
            let (a, b) = (a.tolerated, b.tolerated);
            assert!((a.energy - b.energy).abs() <= 1e-9 * b.energy, "{at}");
            assert!((a.momentum - b.momentum).abs() <= 1e-9 * b.momentum, "{at}");
        }
        assert_eq!(touched, case.friction.is_some(), "{}", case.name);
        let state = direct.state();
        let residual = state.ledger.largest_energy_residual / state.ledger.largest_energy;
        assert!(residual < 1e-12, "{}: {residual}", case.name);
        let exchange = state.exchange.relative().unwrap();
        assert!(exchange < 1e-12, "{}: {exchange}", case.name);
    }
}

/// The cube meets the plane, rubs on it, and does so again with the lists of the contact as long as they became. The two states of a driver take
/// their own memory in the first two steps. What finds the frequencies of elements anew has memory of its own for the chunk.
#[test]
fn such_steps_allocate_nothing() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        for case in cases() {
            let mut driver = driver(&case);
            let unknowns = driver.state().motion.u.len();
            for _ in 0..STEPS {
                driver.step().unwrap();
            }
            let velocity = [1.0, 0.5, -3.0].repeat(unknowns / 3);
            driver.restart(&vec![0.0; unknowns], &velocity).unwrap();
            let (mut touched, mut looks, mut renewals) = (false, 0, 0);
            for step in 0..STEPS {
                let (shapes, stable) =
                    (driver.state().shapes.clone(), driver.state().control.stable);
                let before = allocations();
                driver.step().unwrap();
                let taken = allocations() - before;
                let renewed = !driver.state().shapes.have_frequencies_of(&shapes);
                assert!(taken == 0 || renewed || step < 2, "{}: {step}", case.name);
                touched |= driver.report().contacts.iter().any(|c| c.closed > 0);
                looks += usize::from(driver.state().control.stable != stable);
                renewals += usize::from(renewed);
            }
            // a look at which none of the fastest elements has changed leaves the critical step
            assert!(renewals < STEPS / 5, "{}: {renewals}", case.name);
            assert_eq!(touched, case.friction.is_some(), "{}", case.name);
            assert!(looks < STEPS / 10, "{}: {looks}", case.name);
        }
    });
}

/// A run that goes on from its saved state has the same bits.
#[test]
fn resumed_steps_have_the_same_bits() {
    for case in cases() {
        let mut whole = driver(&case);
        let system = System::new(model(&case)).unwrap();
        let mut parts = Driver::new(Arc::clone(&system)).unwrap();
        for step in 0..STEPS {
            whole.step().unwrap();
            parts.step().unwrap();
            if step % 7 == 3 {
                let state = parts.state().clone();
                parts = Driver::resume(Arc::clone(&system), state).unwrap();
            }
        }
        assert_eq!(whole.state(), parts.state(), "{}", case.name);
    }
}

/// With more than one panel of blocks and of nodes.
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let all = cases();
    let case = Case {
        cells: 17,
        damping: [20.0, 0.0],
        ..*all
            .iter()
            .find(|case| case.name == "finite, rubbing")
            .unwrap()
    };
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let mut driver = driver(&case);
            for _ in 0..STEPS {
                driver.step().unwrap();
            }
            driver.state().clone()
        })
    };
    let one = run(1);
    assert!(one.interface.force.iter().any(|force| *force != 0.0));
    assert_eq!(one, run(3));
}

/// Vectors with a number for each unknown that such a run has, 24 bytes a node each: five of each state, the displacement ahead, mass, loads,
/// the start of the run (2), the unknown: 16, 384 bytes. The rest of a node: its place in the mesh and in the system (48), numbers (28),
/// what forces act on (12), the mass of its body and that of the step (24), what is held (3): 115 bytes. A cell has its nodes twice (64), its
/// names in group and body (16), and 2.4 nodes of the list of its chunk with place, place at the last look, force and numbers (88 each): 291 bytes. So
/// 400 bytes a cell, which the requirement allows beside its nodes, and 520 a node leave a fifth for surfaces, sums and what was not thought of. A start takes the vectors of an
/// iteration and the forces of its ledger besides, 16 at most.
#[test]
fn a_run_holds_the_vectors_of_its_steps_alone() {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        let material = Material::StVenantKirchhoff(StVenantKirchhoff { initial: SOFT });
        let case = Case {
            material,
            formulation: Formulation::Reduced { hourglass: 0.1 },
            cells: 24,
            ..cases()[0]
        };
        let [before, _] = held();
        let system = System::new(model(&case)).unwrap();
        held();
        let mut driver = Driver::new(system).unwrap();
        let [_, most] = held();
        for _ in 0..3 {
            driver.step().unwrap();
        }
        let [held, _] = held();
        let (cells, nodes) = (24_isize.pow(3), 25_isize.pow(3));
        let room = 400 * cells + 520 * nodes;
        assert!(held - before < room, "{} of {room}", held - before);
        let room = room + 16 * 24 * nodes;
        assert!(most - before < room, "{} of {room}", most - before);
    });
}
