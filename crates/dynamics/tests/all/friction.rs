//! Friction: stick, objectivity, symmetry.

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Capture, Displacement, Reading, Velocity};
use carom_contact::{Basis, Integration, Law, Motion, Obstacle, Plane, Sliding, Translation, Turn};
use carom_dynamics::{
    Amplitude, Driver, Model, ModelBody, ModelContact, ModelTarget, Nonlinear, Preload, Prescribed,
    Scheme, System, scheme,
};
use carom_materials::{Elastic, Law as Material, NeoHooke, StVenantKirchhoff};
use carom_mesh::{Mesh, Surface, generate};

const DISPLACEMENT: Law = Law::Displacement(Displacement { projection: false });
const VELOCITY: Law = Law::Velocity(Velocity {
    capture: Capture::Now,
    reading: Reading::Closed,
});
const SOFT: Elastic = Elastic {
    density: 1.0,
    young: 100.0,
    poisson: 0.3,
};

fn body(mesh: &Mesh, name: &str, kinematics: Kinematics, material: Material) -> ModelBody {
    ModelBody::new(BodySpec::new(
        name,
        mesh.groups[name].elements.clone(),
        kinematics,
        material,
    ))
}

fn rubbing(mesh: &Mesh, group: &str, of: &ModelBody, primary: ModelTarget) -> ModelContact {
    ModelContact {
        sliding: Sliding::Finite,
        friction: 0.5.into(),
        ..ModelContact::new(
            "rubbing",
            Surface::new(mesh, &mesh.groups[group], &of.spec.cells).unwrap(),
            primary,
            DISPLACEMENT,
        )
    }
}

/// Steps of the pressing and of the turning.
const PRESSED: u64 = 2;
const TURNED: u64 = 9;

/// Two blocks pressed together by a tenth and then turned as one by a right angle, one second to a step.
fn turned(integration: Integration, young: [f64; 2]) -> Driver {
    let mut mesh = generate::rectangle("a", [0.25, 1.0], [1.0, 0.5], [3, 2], false);
    let low = generate::rectangle("b", [0.0; 2], [1.5, 1.0], [4, 2], false);
    mesh.merge("b", low).unwrap();
    let plane = Kinematics::PlaneStrain { thickness: 1.0 };
    let bodies = ["a", "b"].iter().zip(young).map(|(name, young)| {
        let initial = Elastic { young, ..SOFT };
        body(&mesh, name, plane, Material::NeoHooke(NeoHooke { initial }))
    });
    let bodies: Vec<ModelBody> = bodies.collect();
    let top = Surface::new(&mesh, &mesh.groups["b.top"], &bodies[1].spec.cells).unwrap();
    let mut contact = rubbing(&mesh, "a.bottom", &bodies[0], ModelTarget::Surface(top));
    contact.integration = integration;
    let steps = PRESSED + TURNED;
    let mut motions = Vec::new();
    for (group, down) in [("a.top", -0.1), ("b.bottom", 0.0)] {
        for node in mesh.group_nodes(&mesh.groups[group]) {
            let x = mesh.nodes[node as usize];
            let table = |i: usize| {
                let at = |step: u64| {
                    let press = (step as f64 / PRESSED as f64).min(1.0);
                    let turn = step.saturating_sub(PRESSED) as f64 / TURNED as f64;
                    let (sin, cos) = (0.5 * std::f64::consts::PI * turn).sin_cos();
                    let to = [x[0], x[1] + press * down];
                    let to = [cos * to[0] - sin * to[1], sin * to[0] + cos * to[1]];
                    [step as f64, to[i] - x[i]]
                };
                Amplitude::new((0..=steps).map(at).collect()).unwrap()
            };
            motions.push(Prescribed {
                nodes: vec![node],
                displacement: [Some(table(0)), Some(table(1)), None],
            });
        }
    }
    let model = Model {
        contacts: vec![contact],
        nonlinear: Nonlinear {
            motions,
            preload: Some(Preload {
                end: steps as f64,
                steps,
            }),
            ..Nonlinear::default()
        },
        ..Model::new(
            bodies,
            mesh,
            Scheme::Newmark(scheme::Newmark {
                beta: 0.25,
                gamma: 0.5,
            }),
            1.0,
        )
    };
    Driver::new(System::new(model).unwrap()).unwrap()
}

#[test]
fn bodies_that_stick_do_not_slip_where_they_turn_as_one() {
    let mortar = Integration::Mortar { basis: Basis::Dual };
    for integration in [Integration::Node, mortar] {
        let mut newton = turned(integration, [100.0, 300.0]);
        for _ in 0..PRESSED {
            newton.step().unwrap();
        }
        let before = newton.report().contacts[0].clone();
        let balance = newton.state().ledger.balance;
        assert!(before.friction < before.force && before.force > 1.0);
        let points = newton.state().interface.friction.clone();
        assert!(points.iter().any(|t| t[0] != 0.0), "something would slip");
        for _ in 0..TURNED {
            newton.step().unwrap();
            let now = &newton.report().contacts[0];
            // iterations end at 1e-10 of the forces
            assert!((now.force - before.force).abs() < 1e-8 * before.force);
            assert!((now.friction - before.friction).abs() < 1e-8 * before.force);
            assert_eq!(now.slipping, 0);
        }
        let after = newton.state().ledger.balance;
        let rubbed = after.dissipation_friction - balance.dissipation_friction;
        assert!(rubbed.abs() < 1e-10 * balance.strain, "{rubbed:e}");
        assert!((after.strain - balance.strain).abs() < 1e-8 * balance.strain);
        for (old, new) in points.iter().zip(&newton.state().interface.friction) {
            assert!((old[0] - new[0]).abs() < 1e-8 * before.force);
        }
    }
}

/// A block that stands away from the axis of a plane that spins about its normal.
fn spun(scheme: Scheme, law: Law, dt: f64) -> Driver {
    let mesh = generate::box_("a", [1.0, 0.0, 0.0], [0.4, 0.4, 0.1], [1; 3], false);
    // at finite strain: it must turn without stress
    let initial = Elastic { young: 1e4, ..SOFT };
    let stiff = Material::StVenantKirchhoff(StVenantKirchhoff { initial });
    let block = body(&mesh, "a", Kinematics::Solid, stiff);
    let plane = Plane {
        point: [0.0; 3],
        normal: [0.0, 0.0, 1.0],
    };
    let platform = Obstacle {
        motion: Motion {
            translation: None::<Translation>,
            turn: Some(Turn {
                point: [0.0; 3],
                axis: [0.0, 0.0, 1.0],
                rate: 1.0,
            }),
        },
        ..plane.into()
    };
    let mut contact = rubbing(&mesh, "a.bottom", &block, ModelTarget::Rigid(platform));
    contact.law = law;
    let model = Model {
        gravity: [0.0, 0.0, -10.0],
        contacts: vec![contact],
        ..Model::new(vec![block], mesh, scheme, dt)
    };
    let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
    let system = newton.system();
    let mut v = vec![0.0; system.unknowns()];
    for (node, x) in system.x.iter().enumerate() {
        (v[3 * node], v[3 * node + 1]) = (-x[1], x[0]);
    }
    let u = vec![0.0; system.unknowns()];
    newton.restart(&u, &v).unwrap();
    newton
}

#[test]
fn a_block_on_a_spinning_platform_stays_where_it_stands() {
    let dt = 0.05;
    let newmark = Scheme::Newmark(scheme::Newmark {
        beta: 0.49,
        gamma: 0.9,
    });
    let theta = |theta| Scheme::Theta(scheme::Theta { theta });
    // the trapezoid turns by (ω Δt)²/12 too little, over 2 π; twice that for the vibration of the start, at which
    // nothing pulls the block inwards. The others: rounding, 1e-13 in each of 126 steps
    let late = 2.0 * dt * dt / 12.0 * 2.0 * std::f64::consts::PI * 1.46;
    let sets = [
        (theta(0.5), VELOCITY, late),
        (theta(1.0), DISPLACEMENT, 1e-10),
        (newmark, DISPLACEMENT, 1e-10),
    ];
    for (scheme, law, bound) in sets {
        let mut newton = spun(scheme, law, dt);
        let mut worst = 0.0_f64;
        for _ in 0..126 {
            newton.step().unwrap();
            let (system, state) = (newton.system(), newton.state());
            let (sin, cos) = state.time.sin_cos();
            for (node, x) in system.x.iter().enumerate().filter(|(_, x)| x[2] == 0.0) {
                let u = &state.motion.u[3 * node..];
                let exact = [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]];
                worst = worst.max((x[0] + u[0] - exact[0]).hypot(x[1] + u[1] - exact[1]));
            }
            let report = &newton.report().contacts[0];
            // the vibration of the start, which the trapezoid keeps, is felt by single nodes
            assert!(law == VELOCITY || report.slipping == 0);
        }
        assert!(worst < bound, "{}: {worst:e}", scheme.get().name());
        // m ω² r keeps it on its circle; a chord in place of an arc is (ω Δt)²/12 off, and vibration is left
        let pull = 0.016 * 1.2_f64.hypot(0.2);
        let friction = newton.report().contacts[0].friction;
        let part = if law == VELOCITY { 0.05 } else { 1e-3 };
        assert!((friction / pull - 1.0).abs() < part, "{friction} {pull}");
    }
}

#[test]
fn a_block_pressed_on_a_rough_plane_sticks_inside_and_slips_at_its_edges_alike() {
    let mesh = generate::rectangle("a", [-1.0, 0.0], [2.0, 1.0], [8, 4], false);
    let block = body(
        &mesh,
        "a",
        Kinematics::PlaneStrain { thickness: 1.0 },
        Material::NeoHooke(NeoHooke { initial: SOFT }),
    );
    let plane = Plane {
        point: [0.0; 3],
        normal: [0.0, 1.0, 0.0],
    };
    let mut contact = rubbing(&mesh, "a.bottom", &block, ModelTarget::rigid(plane));
    contact.friction = 0.2.into();
    let down = Amplitude::new(vec![[0.0, 0.0], [4.0, -0.2]]).unwrap();
    let top = Prescribed {
        nodes: mesh.group_nodes(&mesh.groups["a.top"]),
        displacement: [Some(Amplitude::constant(0.0)), Some(down), None],
    };
    let model = Model {
        contacts: vec![contact],
        nonlinear: Nonlinear {
            motions: vec![top],
            preload: Some(Preload { end: 4.0, steps: 4 }),
            ..Nonlinear::default()
        },
        ..Model::new(
            vec![block],
            mesh,
            Scheme::Theta(scheme::Theta { theta: 0.5 }),
            1.0,
        )
    };
    let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..3 {
        newton.step().unwrap();
    }
    let before = newton.state().motion.u.clone();
    newton.step().unwrap();
    let (system, state) = (newton.system(), newton.state());
    let points = &system.contacts[0].points;
    let (mut sticks, mut slips) = (0, 0);
    let total = newton.report().contacts[0].force;
    for (k, point) in points.iter().enumerate() {
        let node = point.node() as usize;
        let (x, p, t) = (
            system.x[node][0],
            state.interface.force[k],
            state.interface.friction[k][0],
        );
        let slid = state.motion.u[2 * node] - before[2 * node];
        let mirror = points.iter().position(|other| {
            let other = system.x[other.node() as usize][0];
            (other + x).abs() < 1e-12
        });
        let mirror = mirror.unwrap();
        // to the tolerance of the iterations
        assert!((p - state.interface.force[mirror]).abs() < 1e-8 * total);
        assert!((t + state.interface.friction[mirror][0]).abs() < 1e-8 * total);
        assert!(t.abs() <= 0.2 * p * (1.0 + 1e-10));
        if slid.abs() < 1e-9 {
            sticks += 1;
        } else {
            slips += 1;
            // it slides outwards, against the friction, which is all that it can be
            assert!(slid * x > 0.0 && (t.abs() - 0.2 * p).abs() < 1e-10 * total);
        }
    }
    assert!(sticks >= 3 && slips >= 2, "{sticks} stick, {slips} slip");
    assert_eq!(newton.report().contacts[0].slipping, slips);
    let ledger = &state.ledger;
    assert!(ledger.balance.dissipation_friction > 0.0);
    assert!(ledger.largest_energy_residual < 1e-8 * ledger.largest_energy);
    // what the sides pull cancels
    assert!(newton.report().contacts[0].friction < 1e-8 * total);
}

#[test]
fn the_time_of_the_problems_with_friction_is_counted() {
    let mut newton = turned(Integration::Node, [100.0, 300.0]);
    newton.step().unwrap();
    let phases = newton.costs().phases;
    assert!(phases.friction > std::time::Duration::ZERO);
}

/// A block on a plane, its top pressed down and drawn sideways from nothing, in equal static steps; small strain, so that
/// everything grows with the stage in proportion.
fn drawn(steps: u64) -> Driver {
    let mesh = generate::rectangle("a", [0.0; 2], [1.0, 0.5], [4, 2], false);
    let kinematics = Kinematics::PlaneStrain { thickness: 1.0 };
    let block = body(&mesh, "a", kinematics, Material::Elastic(SOFT));
    let plane = Plane {
        point: [0.0; 3],
        normal: [0.0, 1.0, 0.0],
    };
    let contact = rubbing(&mesh, "a.bottom", &block, ModelTarget::rigid(plane));
    let to = |value: f64| Amplitude::new(vec![[0.0, 0.0], [1.0, value]]).unwrap();
    let model = Model {
        contacts: vec![contact],
        nonlinear: Nonlinear {
            motions: vec![Prescribed {
                nodes: mesh.group_nodes(&mesh.groups["a.top"]),
                displacement: [Some(to(0.2)), Some(to(-0.02)), None],
            }],
            preload: Some(Preload { end: 1.0, steps }),
            ..Nonlinear::default()
        },
        ..Model::new(
            vec![block],
            mesh,
            Scheme::Theta(scheme::Theta { theta: 0.5 }),
            1.0,
        )
    };
    let mut newton = Driver::new(System::new(model).unwrap()).unwrap();
    for _ in 0..steps {
        newton.step().unwrap();
    }
    newton
}

#[test]
fn the_static_work_of_friction_does_not_depend_on_the_number_of_steps() {
    let whole = drawn(1);
    let motion = &whole.state().motion;
    // force and way grow together: half of the product of their ends
    let expected = 0.5
        * (0..4 + 1)
            .map(|point| {
                let t = whole.state().interface.friction[point][0];
                let contact = &whole.system().contacts[0];
                let node = contact.points[point].node() as usize;
                (t * motion.u[2 * node]).abs()
            })
            .sum::<f64>();
    assert!(whole.report().contacts[0].slipping == 5 && expected > 0.0);
    for steps in [1, 5, 50] {
        let balance = drawn(steps).state().ledger.balance;
        let work = balance.dissipation_friction.abs();
        // the tolerance of the iterations, 1e-10 of forces, over few steps
        assert!(
            (work / expected - 1.0).abs() < 1e-8,
            "{steps}: {work} {expected}"
        );
    }
}
