//! Contacts with a compliance: what an elastic stop gives back, under every scheme.

use std::f64::consts::PI;

use carom_bodies::{BodySpec, Kinematics};
use carom_contact::law::{Adhesion, Crush, Curve, Damped, Penalty, Stop};
use carom_contact::{Law, Plane};
use carom_dynamics::{
    Driver, Model, ModelBody, ModelContact, ModelTarget, Scheme, Stepper, Support, System, scheme,
};
use carom_materials::{Elastic, Law as Material};
use carom_mesh::{Surface, generate};

/// Stiffness of the stop, N/m, and the mass on it: the end of a bar of 2 kg.
const STIFFNESS: f64 = 4.0;
const MASS: f64 = 1.0;
const CLEARANCE: f64 = 0.37;

fn laws() -> [Law; 2] {
    let curve = Curve::new(&[[1.0, STIFFNESS]]).unwrap();
    [
        Law::Stop(Stop {
            clearance: CLEARANCE,
            curve,
            crush: Crush::Recovered,
            damping: 0.0,
            adhesion: Adhesion::Clip,
        }),
        Law::Penalty(Penalty(Damped {
            stiffness: STIFFNESS,
            damping: 0.0,
            adhesion: Adhesion::Clip,
        })),
    ]
}

/// A mass that meets a stop at the speed 1; all else is softer by 10⁻¹². `part`: ω dt, ω² = k/m.
fn model(scheme: Scheme, law: Law, part: f64) -> Model {
    let mesh = generate::line("bar", [0.0; 3], [1.0, 0.0, 0.0], 1, 1);
    let cells = mesh.groups["bar"].elements.clone();
    let material = Elastic {
        density: 2.0 * MASS,
        young: 1e-12 * STIFFNESS,
        poisson: 0.0,
    };
    let spec = BodySpec::new(
        "bar",
        cells.clone(),
        Kinematics::Bar { area: 1.0 },
        Material::Elastic(material),
    );
    let plane = Plane {
        point: [
            if matches!(law, Law::Stop(_)) {
                0.0
            } else {
                -CLEARANCE
            },
            0.0,
            0.0,
        ],
        normal: [1.0, 0.0, 0.0],
    };
    let end = Surface::new(&mesh, &mesh.groups["bar.left"], &cells).unwrap();
    Model {
        contacts: vec![ModelContact::new(
            "stop",
            end,
            ModelTarget::rigid(plane),
            law,
        )],
        supports: vec![Support {
            nodes: mesh.group_nodes(&mesh.groups["bar.right"]),
            fix: [true; 3],
            fix_rotations: [false; 3],
        }],
        ..Model::new(
            vec![ModelBody {
                velocity: [-1.0, 0.0, 0.0],
                ..ModelBody::new(spec)
            }],
            mesh,
            scheme,
            part * (MASS / STIFFNESS).sqrt(),
        )
    }
}

/// Speed of the mass after the stop.
fn rebound(scheme: Scheme, law: Law, part: f64) -> f64 {
    let system = System::new(model(scheme, law, part)).unwrap();
    let mut run: Box<dyn Stepper> = match scheme.get().is_between() {
        true => Box::new(Driver::new(system).unwrap()),
        false => Box::new(Driver::new(system).unwrap()),
    };
    let end = CLEARANCE + 1.5 * PI * (MASS / STIFFNESS).sqrt();
    while run.state().time < end {
        run.step().unwrap();
    }
    let (system, state) = (run.system(), run.state());
    let node = (0..system.x.len()).find(|&node| system.x[node][0] == 0.0);
    state.motion.v[node.unwrap()]
}

#[test]
fn an_elastic_stop_gives_back_all_but_a_term_of_second_order() {
    let conserving = [
        Scheme::Newmark(scheme::Newmark {
            beta: 0.25,
            gamma: 0.5,
        }),
        Scheme::Theta(scheme::Theta { theta: 0.5 }),
        Scheme::GeneralisedAlpha(scheme::GeneralisedAlpha { rho_inf: 1.0 }),
        Scheme::Hht(scheme::Hht { alpha: 0.0 }),
        Scheme::LaursenChawla(scheme::LaursenChawla {}),
        Scheme::Krenk(scheme::Krenk { rho_inf: 1.0 }),
        Scheme::EnergyMomentum(scheme::EnergyMomentum {}),
    ];
    for scheme in conserving {
        for law in laws() {
            for part in [0.2, 0.1, 0.05] {
                // within a step the spring begins and ends: each time at most k (v dt/2)²/2 of the energy m v²/2, (ω dt)²/4
                // of it, half of that in the speed
                let lost = 1.0 - rebound(scheme, law, part);
                assert!(
                    lost.abs() < 0.25 * part * part,
                    "{scheme:?} {part}: {lost:e}"
                );
            }
        }
    }
}

#[test]
fn what_a_dissipative_scheme_takes_in_an_elastic_stop_falls_with_the_square_of_the_step_at_least() {
    // of second order and dissipative at high frequencies: (ω dt)³ in free vibration
    for scheme in [
        Scheme::GeneralisedAlpha(scheme::GeneralisedAlpha { rho_inf: 0.5 }),
        Scheme::Hht(scheme::Hht { alpha: -0.2 }),
        Scheme::Krenk(scheme::Krenk { rho_inf: 0.5 }),
    ] {
        for law in laws() {
            for part in [0.2, 0.1, 0.05] {
                let lost = 1.0 - rebound(scheme, law, part);
                assert!(
                    lost.abs() < 0.5 * part * part,
                    "{scheme:?} {part}: {lost:e}"
                );
            }
        }
    }
    // theta takes (θ - ½) ω dt of the speed in each radian, half a turn long
    let theta = Scheme::Theta(scheme::Theta { theta: 0.6 });
    for part in [0.1, 0.05] {
        let lost = 1.0 - rebound(theta, laws()[0], part);
        let expected = 0.1 * part * PI;
        assert!(
            (lost - expected).abs() < part * part,
            "{part}: {lost:e} {expected:e}"
        );
    }
}

/// Largest error of the place of a mass, over its amplitude, that a stop pushes from rest through an eighth of a period. `ratio`: of the
/// dashpot.
fn released(scheme: Scheme, ratio: f64, steps: u32) -> f64 {
    const DEPTH: f64 = 0.3;
    let omega = (STIFFNESS / MASS).sqrt();
    let law = Law::Stop(Stop {
        clearance: CLEARANCE,
        curve: Curve::new(&[[1.0, STIFFNESS]]).unwrap(),
        crush: Crush::Recovered,
        damping: 2.0 * ratio * MASS * omega,
        adhesion: Adhesion::Clip,
    });
    let mut model = model(scheme, law, 0.25 * PI / f64::from(steps));
    model.bodies[0].velocity = [0.0; 3];
    model.bodies[0].displacement = [-(CLEARANCE + DEPTH), 0.0, 0.0];
    let mut driver = Driver::new(System::new(model).unwrap()).unwrap();
    let system = driver.system();
    let node = (0..system.x.len()).find(|&node| system.x[node][0] == 0.0);
    let node = node.unwrap();
    let damped = omega * (1.0 - ratio * ratio).sqrt();
    let mut most = 0.0_f64;
    for _ in 0..steps {
        driver.step().unwrap();
        let state = driver.state();
        let decay = (-ratio * omega * state.time).exp();
        let (sine, cosine) = (damped * state.time).sin_cos();
        let exact = -decay * (cosine + ratio * omega / damped * sine);
        let place = (state.motion.u[node] + CLEARANCE) / DEPTH;
        most = most.max((place - exact).abs());
    }
    let balance = &driver.state().ledger.balance;
    let energy = 0.5 * STIFFNESS * DEPTH * DEPTH;
    assert!(balance.energy_residual.abs() < 1e-13 * energy);
    assert!(driver.state().exchange.relative().unwrap() < 1e-13);
    most
}

#[test]
fn a_stop_that_is_compressed_at_the_start_pushes_from_the_start() {
    let schemes = [
        Scheme::Newmark(scheme::Newmark {
            beta: 0.25,
            gamma: 0.5,
        }),
        Scheme::GeneralisedAlpha(scheme::GeneralisedAlpha { rho_inf: 0.8 }),
        Scheme::Hht(scheme::Hht { alpha: -0.1 }),
        Scheme::CentralDifference(scheme::CentralDifference {}),
    ];
    for scheme in schemes {
        // an explicit scheme takes the rate half a step late: first order with a dashpot
        let explicit = matches!(scheme, Scheme::CentralDifference(_));
        let ratios = if explicit { &[0.0][..] } else { &[0.0, 0.2] };
        for &ratio in ratios {
            for steps in [8, 16, 32] {
                // the error of schemes of second order is at most about (ω dt)²/12 in each radian; without the force at the start it
                // would be ω dt/2, ten times as much with 8 steps
                let part = 0.25 * PI / f64::from(steps);
                let error = released(scheme, ratio, steps);
                assert!(
                    error < 0.5 * part * part,
                    "{scheme:?} {ratio} {steps}: {error:e}"
                );
            }
        }
    }
}
