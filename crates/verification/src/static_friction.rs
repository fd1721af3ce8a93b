//! Friction that is larger at rest than in motion.
//!
//! Problems, of a mass m = 1 kg under g = 10 m/s² with μ_s = 0.5 and μ_k = 0.3, N = m g: (a) on a belt that moves at V = 0.1 m/s, held
//! by a spring of k = 100 N/m, whose force grows while the mass sticks; (b) it slides at 2 m/s and stops; (c) on inclines whose slopes
//! are between the coefficients, and above both; (d) as (b), where μ falls over v_c = 0.5 m/s.
//!
//! Closed solution: (a) with A = (μ_s - μ_k) N/k, ω² = k/m and R² = A² + (V/ω)² it lets go at the force μ_s N, slides for
//! 2 (π - atan(A ω/V))/ω with forces of the spring from μ_k N + k R down to μ_k N - k R, and is caught with the speed of the belt at
//! (2 μ_k - μ_s) N; it sticks for 2 A/V. (b) v²/(2 μ_k g), and rest. (c) rest, and the acceleration g (sin α - μ_k cos α).
//! (d) `t = v_c/(μ_k g) ln((μ_k e^(v/v_c) + μ_s - μ_k)/μ_s)` from dv/dt = -μ(v) g. Reference: these formulas.
//!
//! Tolerance: statuses hold for a whole step. (a) The mass goes up to V Δt too far before it lets go, which adds to the amplitude; the
//! scheme and the steps about an extreme leave A (ω Δt)²; of the force k times both. Of the time between two largest forces a step at
//! each, and as long as the belt takes for twice the way that the amplitude is off: 4 Δt. (b) The last step stops the mass with
//! a force of at most μ_s N, from a speed of at most μ_s g Δt: the way is off by less than μ_s g Δt². Friction takes all of its energy, to
//! rounding; central differences begin with half a step, and their speeds are those of its middle: v Δt/2, and its work. (c) Rest to
//! 1e-12 m, with central differences where half a step without friction has brought the mass, g sin α Δt²/2; of the speed one step of the acceleration may be missing. (d) μ lags by a step, of which the last has μ_s: two
//! steps. Balances: round-off.

use std::f64::consts::PI;

use carom_bodies::Curve;
use carom_contact::law::{Friction, StaticKinetic};
use carom_contact::{Law, Motion, Obstacle, Plane, Translation};
use carom_dynamics::{Driver, Model, ModelTarget, Scheme};

use crate::Error;
use crate::build::{CENTRAL, NOW, plane, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances};

const GRAVITY: f64 = 10.0;
const STIFFNESS: f64 = 100.0;
const BELT: f64 = 0.1;
const SPEED: f64 = 2.0;
const STATIC: f64 = 0.5;
const KINETIC: f64 = 0.3;
const DECAY: f64 = 0.5;

fn friction(decay: Option<f64>) -> Friction {
    Friction::StaticKinetic(StaticKinetic {
        at_rest: STATIC,
        kinetic: KINETIC,
        decay,
    })
}

/// The mass on a plane, with the pull of gravity along it and onto it, m/s².
struct Rough {
    scheme: Scheme,
    law: Law,
    dt: f64,
    friction: Friction,
    /// Speed at the start.
    speed: f64,
    gravity: [f64; 2],
}

impl Rough {
    fn start(&self, floor: ModelTarget, spring: bool) -> Result<Driver, Error> {
        let mut points = Points::new(2);
        let mass = points.mass(1.0, [0.0; 3], [[0.0; 3], [self.speed, 0.0, 0.0]]);
        if spring {
            points.spring(mass, [1.0, 0.0, 0.0], Curve::line(STIFFNESS));
        }
        points.contact(mass, floor, self.law, self.friction);
        let system = crate::witness::system(Model {
            gravity: [self.gravity[0], -self.gravity[1], 0.0],
            ..points.model(self.scheme, self.dt)
        })?;
        Ok(Driver::new(system)?)
    }
}

/// The means of a run: scheme, law and step.
#[derive(Clone, Copy)]
struct Means {
    scheme: Scheme,
    law: Law,
    dt: f64,
}

impl Means {
    fn name(self, what: &str) -> String {
        format!("{what}, {}", self.scheme.get().name())
    }

    fn rough(self, decay: Option<f64>, speed: f64, gravity: [f64; 2]) -> Rough {
        Rough {
            scheme: self.scheme,
            law: self.law,
            dt: self.dt,
            friction: friction(decay),
            speed,
            gravity,
        }
    }
}

/// (a): the mass begins with the belt.
fn belt(means: Means) -> Result<Vec<Row>, Error> {
    let name = means.name("on a belt");
    let floor = Obstacle {
        motion: Motion {
            translation: Some(Translation::Velocity([BELT, 0.0, 0.0])),
            turn: None,
        },
        ..Plane {
            point: [0.0; 3],
            normal: [0.0, 1.0, 0.0],
        }
        .into()
    };
    let rough = means.rough(None, BELT, [0.0, GRAVITY]);
    let mut run = rough.start(ModelTarget::Rigid(floor), true)?;
    let (omega, amplitude) = (STIFFNESS.sqrt(), (STATIC - KINETIC) * GRAVITY / STIFFNESS);
    let slides = 2.0 * (PI - (amplitude * omega / BELT).atan()) / omega;
    let period = slides + 2.0 * amplitude / BELT;
    let mut forces = vec![[0.0, 0.0]];
    let end = STATIC * GRAVITY / STIFFNESS / BELT + 3.25 * period;
    while run.state().time < end {
        run.step()?;
        forces.push([run.state().time, STIFFNESS * run.state().motion.u[0]]);
    }
    // turns of the force of the spring: largest and smallest by turns
    let turns: Vec<[f64; 2]> = forces
        .windows(3)
        .filter(|of| (of[1][1] - of[0][1]) * (of[2][1] - of[1][1]) < 0.0)
        .map(|of| of[1])
        .collect();
    let dt = means.dt;
    let off = STIFFNESS * (BELT * dt + amplitude * (omega * dt).powi(2));
    let mut rows = vec![Row::count(format!("{name}: turns"), turns.len(), 7)];
    for pair in turns.chunks_exact(2) {
        let [most, least] = [pair[0], pair[1]];
        rows.push(Row::near(
            format!("{name}: largest force of the spring, N"),
            most[1],
            KINETIC * GRAVITY + STIFFNESS * amplitude.hypot(BELT / omega),
            off,
        ));
        rows.push(Row::near(
            format!("{name}: least force of the spring, N"),
            least[1],
            KINETIC * GRAVITY - STIFFNESS * amplitude.hypot(BELT / omega),
            off,
        ));
    }
    for pair in turns.windows(3).step_by(2) {
        rows.push(Row::near(
            format!("{name}: period, s"),
            pair[2][0] - pair[0][0],
            period,
            4.0 * dt,
        ));
    }
    rows.extend(balances(&name, run.state(), 0.0));
    Ok(rows)
}

/// (b) and (d): place and time at which the mass rests.
fn braking(means: Means, decay: Option<f64>) -> Result<Vec<Row>, Error> {
    let name = means.name(match decay {
        Some(_) => "braking with decay",
        None => "braking",
    });
    let mut run = means
        .rough(decay, SPEED, [0.0, GRAVITY])
        .start(plane(1, 1.0), false)?;
    let mut rests = None;
    while run.state().time < 2.0 * SPEED / (KINETIC * GRAVITY) {
        run.step()?;
        if run.state().motion.v[0].abs() < 1e-9 * SPEED {
            rests.get_or_insert(run.state().time);
        }
    }
    let (place, dt) = (run.state().motion.u[0], means.dt);
    let late = match means.scheme == CENTRAL {
        true => 0.5 * dt,
        false => 0.0,
    };
    let found = rests.unwrap_or(f64::INFINITY);
    let mut rows = match decay {
        None => vec![
            Row::near(
                format!("{name}: way, m"),
                place,
                SPEED * SPEED / (2.0 * KINETIC * GRAVITY),
                STATIC * GRAVITY * dt * dt + SPEED * late,
            ),
            Row::near(
                format!("{name}: dissipated, J"),
                run.state().ledger.balance.dissipation_friction,
                0.5 * SPEED * SPEED,
                1e-12 + SPEED * STATIC * GRAVITY * late,
            ),
        ],
        Some(speed) => {
            let grown = (SPEED / speed).exp();
            let left = (KINETIC * grown + STATIC - KINETIC) / STATIC;
            let exact = speed / (KINETIC * GRAVITY) * left.ln();
            vec![Row::near(
                format!("{name}: rests at, s"),
                found,
                exact,
                2.0 * dt,
            )]
        }
    };
    rows.extend(balances(&name, run.state(), 0.0));
    Ok(rows)
}

/// (c): from rest.
fn incline(means: Means, slope: f64) -> Result<Vec<Row>, Error> {
    let name = means.name(&format!("slope {slope}"));
    let (sin, cos) = slope.atan().sin_cos();
    let gravity = [GRAVITY * sin, GRAVITY * cos];
    let mut run = means
        .rough(None, 0.0, gravity)
        .start(plane(1, 1.0), false)?;
    let end = 0.5;
    while run.state().time < end {
        run.step()?;
    }
    let motion = &run.state().motion;
    if slope <= STATIC {
        let first = match means.scheme == CENTRAL {
            true => 0.5 * gravity[0] * means.dt * means.dt,
            false => 0.0,
        };
        return Ok(vec![Row::near(
            format!("{name}: moves, m"),
            motion.u[0],
            first,
            1e-12,
        )]);
    }
    let acceleration = gravity[0] - KINETIC * gravity[1];
    let mut rows = vec![Row::near(
        format!("{name}: speed, m/s"),
        motion.v[0],
        acceleration * run.state().time,
        acceleration * means.dt,
    )];
    rows.extend(balances(&name, run.state(), 0.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "static-friction",
    fact: "with more friction at rest than in motion a mass sticks and slips on a belt, stops, and rests on inclines as the closed forms say",
    run: |size| {
        let dt = match size {
            Size::Quick => 1e-3,
            Size::Full => 1e-4,
        };
        let mut rows = Vec::new();
        for scheme in [theta(0.5), CENTRAL] {
            let law = NOW;
            let means = Means { scheme, law, dt };
            rows.extend(belt(means)?);
            rows.extend(braking(means, None)?);
            rows.extend(braking(means, Some(DECAY))?);
            for slope in [0.4, 0.499, 0.501, 0.8] {
                rows.extend(incline(means, slope)?);
            }
        }
        Ok(rows)
    },
};
