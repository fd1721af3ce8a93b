//! Point masses, springs and dashpots in whole steps.

use carom_bodies::{
    BeamSection, BeamTheory, BodySpec, Curve, DiscreteKind, DiscreteSpec, FluidGap, Kinematics,
    Link, MassKind, SectionShape,
};
use carom_dynamics::scheme::{CentralDifference, EnergyMomentum, GeneralisedAlpha, Newmark, Theta};
use carom_dynamics::{
    Driver, Error, Model, ModelBody, ModelDiscrete, ModelScheme, Preload, Scheme, State, Support,
    System,
};
use carom_elements::Kind;
use carom_materials::Elastic;
use carom_mesh::{Mesh, generate};
use carom_testing::allocations;

const TRAPEZOID: Scheme = Scheme::Newmark(Newmark {
    beta: 0.25,
    gamma: 0.5,
});
const CONSERVING: Scheme = Scheme::EnergyMomentum(EnergyMomentum {});
const CENTRAL: Scheme = Scheme::CentralDifference(CentralDifference {});

/// Adds a mass (kg) at a place with a velocity and returns its node.
fn mass(model: &mut Model, m: f64, at: [f64; 3], velocity: [f64; 3]) -> u32 {
    let node = model.mesh.nodes.len() as u32;
    model.mesh.nodes.push(at);
    let cell = model.mesh.push(Kind::Point1, &[node]);
    model.discrete.push(ModelDiscrete {
        velocity: Some(velocity),
        displacement: Some([0.0; 3]),
        ..made(format!("m{node}"), cell, DiscreteKind::Mass(m.into()))
    });
    node
}

fn made(name: String, cell: carom_mesh::ElementId, kind: DiscreteKind) -> ModelDiscrete {
    ModelDiscrete::new(DiscreteSpec {
        name,
        cells: vec![cell],
        kind,
    })
}

/// Adds a spring or a dashpot between nodes, or a node and the ground.
pub(crate) fn link(
    model: &mut Model,
    nodes: &[u32],
    kind: fn(Link) -> DiscreteKind,
    (curve, axis): (Curve, Option<[f64; 3]>),
) {
    let element = match nodes.len() {
        1 => Kind::Point1,
        _ => Kind::Bar2,
    };
    let cell = model.mesh.push(element, nodes);
    let name = format!("e{}", model.discrete.len());
    let made = made(name, cell, kind(Link { curve, axis }));
    model.discrete.push(made);
}

fn empty(dim: usize, scheme: Scheme, dt: f64) -> Model {
    Model::new(Vec::new(), Mesh::new(dim), scheme, dt)
}

fn run(model: Model, steps: usize) -> Driver {
    let mut run = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..steps {
        run.step().unwrap();
    }
    run
}

/// The balances of energy and momentum, over their largest terms, of the momentum at least `scale` (N s); nonlinear steps to the
/// tolerance of their iterations.
fn assert_balanced(run: &Driver, scale: f64) {
    let ledger = &run.state().ledger;
    let name = run.system().scheme.get().name();
    let bound = match run.system().is_nonlinear() {
        true => 1e-9,
        false => 1e-12,
    };
    let energy = ledger.largest_energy_residual / ledger.largest_energy;
    assert!(energy < bound, "{name}: energy {energy:e}");
    let momentum = ledger.largest_momentum_residual / ledger.largest_momentum.max(scale);
    assert!(momentum < bound, "{name}: momentum {momentum:e}");
}

#[test]
fn a_damped_oscillator_converges_with_the_order_of_its_scheme_and_the_dashpot_takes_its_energy() {
    // m = 2, k = 50, c = 4 in all directions: δ = 1, ω² = 24
    let (m, k, c) = (2.0, 50.0, 4.0);
    let (delta, omega) = (c / (2.0 * m), f64::sqrt(k / m - 1.0));
    let way = [0.3, -0.8, 0.5];
    let error = |scheme: Scheme, steps: usize| {
        let dt = 1.0 / steps as f64;
        let mut model = empty(3, scheme, dt);
        let node = mass(&mut model, m, [1.0, 2.0, 3.0], way);
        link(
            &mut model,
            &[node],
            DiscreteKind::Spring,
            (Curve::line(k), None),
        );
        link(
            &mut model,
            &[node],
            DiscreteKind::Dashpot,
            (Curve::line(c), None),
        );
        let run = run(model, steps);
        let state = run.state();
        assert_balanced(&run, 0.0);
        let time = state.time;
        let exact = (-delta * time).exp() * (omega * time).sin() / omega;
        let balance = &state.ledger.balance;
        // all that is gone is heat of the dashpot, to the error of the scheme
        let lost = 0.5 * m * 0.98 - balance.kinetic - balance.strain;
        assert!((balance.dissipation_damping / lost - 1.0).abs() < 0.01);
        let errors = (0..3).map(|i| (state.motion.u[i] - way[i] * exact).abs());
        errors.fold(0.0, f64::max)
    };
    let alpha = Scheme::GeneralisedAlpha(GeneralisedAlpha { rho_inf: 0.8 });
    let theta = Scheme::Theta(Theta { theta: 0.5 });
    // with the velocity that an explicit step knows before the forces dashpots are of first order
    for (scheme, order) in [
        (TRAPEZOID, 2.0),
        (theta, 2.0),
        (CONSERVING, 2.0),
        (alpha, 2.0),
        (CENTRAL, 1.0),
    ] {
        let [coarse, fine] = [200, 400].map(|steps| error(scheme, steps));
        let found = (coarse / fine).log2();
        assert!(
            (found - order).abs() < 0.1,
            "{}: order {found}, errors {coarse:e} {fine:e}",
            scheme.get().name()
        );
    }
}

#[test]
fn springs_on_the_ground_and_across_their_nodes_leave_no_residual_of_momentum() {
    let bent = Curve::new(vec![[-0.1, -40.0], [0.0, 0.0], [0.05, 2.0], [1.0, 100.0]]).unwrap();
    for scheme in [TRAPEZOID, CENTRAL, CONSERVING] {
        for curve in [Curve::line(300.0), bent.clone()] {
            let mut model = empty(3, scheme, 1e-3);
            let one = mass(&mut model, 2.0, [0.0; 3], [1.0, 0.2, 0.0]);
            let other = mass(&mut model, 1.0, [0.5, 0.3, 0.0], [-0.5, 0.3, 0.1]);
            // not along the line between the nodes: a couple
            let axis = Some([0.0, 0.6, 0.8]);
            link(
                &mut model,
                &[one, other],
                DiscreteKind::Spring,
                (curve.clone(), axis),
            );
            let axis = Some([1.0, 0.0, 0.0]);
            link(&mut model, &[other], DiscreteKind::Spring, (curve, axis));
            let run = run(model, 300);
            let name = scheme.get().name();
            assert_balanced(&run, 0.0);
            let ledger = &run.state().ledger;
            let angular = ledger.largest_angular_residual / ledger.largest_angular_momentum;
            // nonlinear steps count moments about places at the mean displacement, exact of the mid-point rule
            if run.system().is_nonlinear() && scheme == CONSERVING {
                assert!(angular < 1e-9, "{name}: {angular:e}");
            }
            assert!(run.state().exchange.relative().unwrap() < 1e-9, "{name}");
            if scheme == CONSERVING {
                let balance = &ledger.balance;
                assert!(balance.dissipation_scheme.abs() < 1e-9 * ledger.largest_energy);
            }
        }
    }
}

#[test]
fn a_mass_hangs_at_rest_on_a_spring_in_a_static_stage() {
    let mut model = empty(2, TRAPEZOID, 1e-3);
    let node = mass(&mut model, 2.0, [0.0; 3], [0.0; 3]);
    let bent = Curve::new(vec![[-1.0, -10.0], [0.0, 0.0], [0.1, 10.0], [0.2, 40.0]]).unwrap();
    let down = [0.0, -1.0, 0.0];
    link(
        &mut model,
        &[node],
        DiscreteKind::Spring,
        (bent, Some([0.0, 1.0, 0.0])),
    );
    model.gravity = [0.0, -10.0, 0.0];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 2 });
    let across = (Curve::line(5.0), Some([1.0, 0.0, 0.0]));
    // nothing holds it across
    let free = Driver::new(System::new(model.clone()).unwrap());
    assert!(
        matches!(free.err(), Some(Error::FreeMotion { motion, .. }) if motion == "move along x")
    );
    link(&mut model, &[node], DiscreteKind::Spring, across);
    let run = run(model, 2);
    // 20 N: 10 N up to 0.1 m and 300 N/m beyond
    let found = run.state().motion.u[1] / down[1];
    assert!((found - (0.1 + 10.0 / 300.0)).abs() < 1e-12, "{found}");
    assert_eq!(run.state().motion.u[0], 0.0);
}

/// A spring that gives way beyond 10 N: the fourth part of 12 N has no equilibrium, and the stiffness beyond is negative.
#[test]
fn a_static_stage_tells_that_it_has_come_to_a_limit_point() {
    let mut model = empty(1, TRAPEZOID, 1e-3);
    let node = mass(&mut model, 2.0, [0.0; 3], [0.0; 3]);
    let weak = Curve::new(vec![[0.0, 0.0], [0.1, 10.0], [0.2, 5.0]]).unwrap();
    let along = Some([1.0, 0.0, 0.0]);
    link(&mut model, &[node], DiscreteKind::Spring, (weak, along));
    model.gravity = [-6.0, 0.0, 0.0];
    model.nonlinear.preload = Some(Preload { end: 1.0, steps: 4 });
    let mut run = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..3 {
        run.step().unwrap();
    }
    let error = run.step().unwrap_err();
    assert!(matches!(error, Error::Unstable { .. }), "{error}");
    assert!(error.to_string().contains("limit point"), "{error}");
}

#[test]
fn the_critical_step_is_that_of_the_oscillator() {
    let mut model = empty(1, CENTRAL, 1e-3);
    let nodes = [0.0, 1.0].map(|x| mass(&mut model, 2.0, [x, 0.0, 0.0], [0.0; 3]));
    link(
        &mut model,
        &nodes,
        DiscreteKind::Spring,
        (Curve::line(400.0), None),
    );
    // ω² = 2 k/m
    let critical = System::new(model.clone()).unwrap().critical_step();
    assert!((critical - 2.0 / 20.0).abs() < 1e-15);
    link(
        &mut model,
        &nodes,
        DiscreteKind::Dashpot,
        (Curve::line(30.0), None),
    );
    // c = 2 C/m: ω² dt² + 2 c dt = 4
    let critical = System::new(model.clone()).unwrap().critical_step();
    assert!((400.0 * critical * critical + 60.0 * critical - 4.0).abs() < 1e-13);
    model.dt = 1.01 * critical;
    assert!(matches!(
        System::new(model),
        Err(carom_system::Error::Unstable { .. })
    ));
}

#[test]
fn a_spring_at_a_node_without_mass_is_refused() {
    let mut model = empty(1, TRAPEZOID, 1e-3);
    let node = mass(&mut model, 2.0, [0.0; 3], [0.0; 3]);
    model.mesh.nodes.push([1.0, 0.0, 0.0]);
    link(
        &mut model,
        &[node, 1],
        DiscreteKind::Spring,
        (Curve::line(1.0), None),
    );
    assert!(matches!(
        System::new(model),
        Err(carom_system::Error::NoMass { node: 1, .. })
    ));
}

#[test]
fn a_spring_joins_two_bars_and_a_mass_their_ends() {
    // free-free: the two bars swing against each other as two masses on a soft spring do, 1e-5 of the stiffness of a bar
    let mut mesh = generate::line("a", [0.0; 3], [1.0, 0.0, 0.0], 2, 1);
    mesh.merge(
        "b",
        generate::line("b", [1.5, 0.0, 0.0], [2.5, 0.0, 0.0], 2, 1),
    )
    .unwrap();
    let body = |name: &str, speed: f64| ModelBody {
        velocity: [speed, 0.0, 0.0],
        ..ModelBody::new(BodySpec::new(
            name,
            mesh.groups[name].elements.clone(),
            Kinematics::Bar { area: 1.0 },
            Elastic {
                density: 1.0,
                young: 1e5,
                poisson: 0.0,
            },
        ))
    };
    let bodies = vec![body("a", 1.0), body("b", -1.0)];
    let ends = ["a.right", "b.left"].map(|side| mesh.group_nodes(&mesh.groups[side])[0]);
    let mut model = Model::new(bodies, mesh, TRAPEZOID, 1e-3);
    for end in ends {
        let cell = model.mesh.push(Kind::Point1, &[end]);
        model.discrete.push(made(
            format!("m{end}"),
            cell,
            DiscreteKind::Mass(3.0.into()),
        ));
    }
    link(
        &mut model,
        &ends,
        DiscreteKind::Spring,
        (Curve::line(1.0), None),
    );
    let quarter = 0.5 * std::f64::consts::PI / f64::sqrt(2.0 * 1.0 / 4.0);
    let run = run(model, (quarter / 1e-3).round() as usize);
    let system = run.system();
    assert_eq!((system.parts.len(), system.body_mass(2)), (1, 3.0));
    // at the end of the quarter all is strain of the spring: ½ k (2 v/ω)², to the part that bars take
    let balance = &run.state().ledger.balance;
    assert!(
        (balance.strain / 4.0 - 1.0).abs() < 1e-4,
        "{}",
        balance.strain
    );
    assert_balanced(&run, 4.0);
}

/// A free bar of one unit speed at its left half; with it, or not, two masses with a fluid between them on a stiff spring.
fn bar_and_wet_masses(schemes: [Scheme; 2], wet: bool) -> Model {
    let line = generate::line("bar", [0.0; 3], [1.0, 0.0, 0.0], 8, 2);
    let mut model = Model {
        mesh: line,
        ..empty(2, schemes[1], 0.05)
    };
    let steel = Elastic {
        density: 1.0,
        young: 1.0,
        poisson: 0.0,
    };
    let cells = model.mesh.groups["bar"].elements.clone();
    let kinematics = Kinematics::Bar { area: 1.0 };
    let spec = BodySpec::new("bar", cells, kinematics, steel);
    model.bodies.push(ModelBody {
        velocity: [1.0, 0.0, 0.0],
        ..ModelBody::new(spec)
    });
    let scheme = schemes[0];
    let bodies = vec![0];
    model.zones.push(ModelScheme { bodies, scheme });
    // the bar deforms
    let stop = mass(&mut model, 1e3, [0.0, 1.0, 0.0], [0.0; 3]);
    link(
        &mut model,
        &[stop],
        DiscreteKind::Spring,
        (Curve::line(1.0), None),
    );
    if wet {
        let nodes = [2.0, 3.0].map(|x| mass(&mut model, 1.0, [x, 0.0, 0.0], [0.3, 0.0, 0.0]));
        let fluid = DiscreteKind::Fluid(FluidGap::new(1.0, [0.5, 0.8], 1.0));
        let cell = model.mesh.push(Kind::Bar2, &nodes);
        model.discrete.push(made("water".to_string(), cell, fluid));
        link(
            &mut model,
            &nodes[..1],
            DiscreteKind::Spring,
            (Curve::line(1e6), None),
        );
    }
    model
}

/// What does not touch an explicit zone neither refuses it, nor bounds its step, nor gives it a factor.
#[test]
fn a_fluid_in_an_implicit_zone_leaves_an_explicit_one_alone() {
    let schemes = [CENTRAL, TRAPEZOID];
    let [alone, both] = [false, true].map(|wet| run(bar_and_wet_masses(schemes, wet), 20));
    let [one, other] = [&alone, &both].map(|run| &run.state().motion.u[..18]);
    assert_eq!(one, other);
    assert_eq!(
        both.costs().factors.len(),
        alone.costs().factors.len() + 1,
        "the masses in the fluid have the only other factor"
    );
    // the impulse of the spring in a step, v √(k m) dt
    assert_balanced(&both, 15.0);
    let refused = System::new(bar_and_wet_masses([TRAPEZOID, CENTRAL], true));
    let error = refused.unwrap_err().to_string();
    assert!(
        error.contains("water") && error.contains("lumped"),
        "{error}"
    );
}

#[test]
fn linear_steps_with_springs_allocate_nothing() {
    let mut model = empty(2, TRAPEZOID, 1e-3);
    let node = mass(&mut model, 2.0, [0.0; 3], [1.0, 0.5, 0.0]);
    link(
        &mut model,
        &[node],
        DiscreteKind::Spring,
        (Curve::line(50.0), None),
    );
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    driver.step().unwrap();
    let before = allocations();
    for _ in 0..20 {
        driver.step().unwrap();
    }
    assert_eq!(allocations() - before, 0);
}

#[test]
fn a_resumed_run_takes_the_same_steps() {
    let mut model = empty(2, TRAPEZOID, 1e-2);
    let node = mass(&mut model, 2.0, [0.0; 3], [1.0, 0.5, 0.0]);
    let bent = Curve::new(vec![[-0.1, -40.0], [0.0, 0.0], [0.05, 2.0], [1.0, 100.0]]).unwrap();
    link(
        &mut model,
        &[node],
        DiscreteKind::Spring,
        (bent, Some([0.6, 0.8, 0.0])),
    );
    link(
        &mut model,
        &[node],
        DiscreteKind::Dashpot,
        (Curve::line(0.5), None),
    );
    let system = System::new(model).unwrap();
    let mut whole = Driver::new(system.clone()).unwrap();
    let mut saved = None;
    for step in 0..60 {
        if step == 25 {
            saved = Some(whole.state().to_bytes().unwrap());
        }
        whole.step().unwrap();
    }
    let state = State::from_bytes(&system, &saved.unwrap()).unwrap();
    let mut second = Driver::resume(system, state).unwrap();
    for _ in 25..60 {
        second.step().unwrap();
    }
    assert_eq!(
        second.state().to_bytes().unwrap(),
        whole.state().to_bytes().unwrap()
    );
}

/// The fluid in a channel that moves with the base loads a beam as the fluid between it and a second one that is held: with the buoyancy.
#[test]
fn a_beam_in_a_channel_feels_an_acceleration_of_the_base_as_one_in_a_held_tube() {
    const DENSITY: f64 = 1000.0;
    let radii = [0.01, 0.015];
    let [added, displaced] = FluidGap::around(DENSITY, radii);
    let rod = BeamSection {
        orientation: Some([0.0, 1.0, 0.0]),
        ..BeamSection::new(
            BeamTheory::Timoshenko,
            SectionShape::Circle { diameter: 0.02 }.properties(0.3),
        )
    };
    let beam = |mesh: &Mesh, name: &str, section, mass| ModelBody {
        mass,
        ..ModelBody::new(BodySpec::new(
            name,
            mesh.groups[name].elements.clone(),
            Kinematics::Beam(section),
            Elastic {
                density: 2500.0,
                young: 7e10,
                poisson: 0.3,
            },
        ))
    };
    let line = |name| generate::line(name, [0.0; 3], [0.8, 0.0, 0.0], 4, 3);
    let pulled = [0.7, -9.0, 4.0];
    // the force on the nodes of the first beam
    let force = |model: Model| -> [f64; 3] {
        let system = System::new(Model {
            gravity: pulled,
            ..model
        })
        .unwrap();
        let nodes = (0..5).map(|node| system.unknowns.vector(system.number[node], &system.load));
        nodes.fold([0.0; 3], |sum, f| [0, 1, 2].map(|i| sum[i] + f[i]))
    };
    for mass in [MassKind::Lumped, MassKind::Consistent] {
        let mesh = line("one");
        let wet = BeamSection {
            added_mass: added,
            displaced_mass: displaced,
            ..rod
        };
        let channel = Model::new(vec![beam(&mesh, "one", wet, mass)], mesh, TRAPEZOID, 1e-5);
        let mut mesh = line("one");
        mesh.merge("two", line("two")).unwrap();
        let bodies = vec![beam(&mesh, "one", rod, mass), beam(&mesh, "two", rod, mass)];
        let gaps = [0.1, 0.2, 0.2, 0.2, 0.1].into_iter().zip(0..);
        let gaps = gaps.map(|(length, node)| {
            let cell = mesh.push(Kind::Bar2, &[node, node + 5]);
            let fluid = FluidGap {
                axis: Some([1.0, 0.0, 0.0]),
                ..FluidGap::new(DENSITY, radii, length)
            };
            made(format!("gap{node}"), cell, DiscreteKind::Fluid(fluid))
        });
        let tube = Model {
            discrete: gaps.collect(),
            supports: vec![Support {
                nodes: (5..10).collect(),
                fix: [true; 3],
                fix_rotations: [true; 3],
            }],
            ..Model::new(bodies, mesh, TRAPEZOID, 1e-5)
        };
        let (own, other) = (force(channel), force(tube));
        let mass = 2500.0 * rod.properties.area * 0.8;
        let exact = [mass, mass - 0.8 * displaced, mass - 0.8 * displaced];
        for i in 0..3 {
            // sums of five nodes
            assert!(
                (own[i] / (exact[i] * pulled[i]) - 1.0).abs() < 1e-12,
                "{own:?}"
            );
            assert!((other[i] / own[i] - 1.0).abs() < 1e-12, "{own:?} {other:?}");
        }
    }
}
