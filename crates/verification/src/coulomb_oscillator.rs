//! A point mass on a spring that slides on a rough floor until it sticks.
//!
//! Problem: m = 1 kg on a spring k = 1e4 N/m, pulled by 0.85 mm and let go on a floor of μ = 0.1 under g = 10 m/s². Closed
//! solution: friction shifts the centre of each half swing by δ = μ m g/k = 0.1 mm against the motion, so that the turns are
//! at -0.65, 0.45, -0.25 and 0.05 mm, where the spring is weaker than friction: it sticks. Reference: these numbers.
//!
//! Tolerance: with x = ω Δt the largest place of a swing is between two steps, x²/8 of the swing off at most; in the step of a
//! turn friction has one direction, which moves the turn by δ x² at most; four swings: 4 (0.85/8 + 0.1) x² mm, below x² mm.
//! Stuck is a place that does not change to 1e-12 of the pull. Friction dissipates μ m g times the way, 3.6 mm of the way in
//! all, to x² of it. The trapezoidal rule with the law in the displacement holds the place at the ends of steps and turns the
//! velocity with which it was caught from step to step: it has the turns, but does not rest. Balances: round-off.

use std::f64::consts::PI;

use carom_bodies::Curve;
use carom_contact::Law;
use carom_dynamics::{Driver, Model, Scheme};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, newmark, plane, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances};

const STIFFNESS: f64 = 1e4;
const GRAVITY: f64 = 10.0;
const FRICTION: f64 = 0.1;
const PULLED: f64 = 0.85e-3;
const TURNS: [f64; 4] = [-0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3];

/// `rests`: whether the scheme comes to rest.
fn rows((scheme, law): (Scheme, Law), steps: f64, rests: bool) -> Result<Vec<Row>, Error> {
    let omega = STIFFNESS.sqrt();
    let mut points = Points::new(2);
    let mass = points.mass(1.0, [0.0; 3], [[PULLED, 0.0, 0.0], [0.0; 3]]);
    points.spring(mass, [1.0, 0.0, 0.0], Curve::line(STIFFNESS));
    points.contact(mass, plane(1, 1.0), law, FRICTION);
    let dt = 2.0 * PI / omega / steps;
    let mut newton = Driver::new(crate::witness::system(Model {
        gravity: [0.0, -GRAVITY, 0.0],
        ..points.model(scheme, dt)
    })?)?;
    let half = PI / omega;
    let mut found = Vec::new();
    for (k, turn) in TURNS.iter().enumerate() {
        // the furthest place about the end of the half swing
        let mut furthest = 0.0_f64;
        while newton.state().time < (k as f64 + 1.4) * half {
            newton.step()?;
            let x = newton.state().motion.u[0];
            if newton.state().time > (k as f64 + 0.6) * half {
                furthest = match turn.signum() * (x - furthest) > 0.0 || furthest == 0.0 {
                    true => x,
                    false => furthest,
                };
            }
        }
        found.push(furthest);
    }
    let name = format!("{}, {}", scheme.get().name(), law.get().name());
    let part = (omega * dt).powi(2);
    let mut rows: Vec<Row> = found
        .iter()
        .zip(TURNS)
        .enumerate()
        .map(|(k, (found, exact))| {
            Row::near(
                format!("{name}: turn {}, m", k + 1),
                *found,
                exact,
                part * 1e-3,
            )
        })
        .collect();
    let stuck = newton.state().motion.u[0];
    while newton.state().time < 8.0 * half {
        newton.step()?;
    }
    let state = newton.state();
    rows.extend(balances(&name, state, 0.0));
    if !rests {
        return Ok(rows);
    }
    let moved = (state.motion.u[0] - stuck).abs() / PULLED;
    rows.push(Row::at_most(
        format!("{name}: moves while stuck / pull"),
        moved,
        1e-12,
    ));
    let way = PULLED + TURNS[3].abs() + 2.0 * TURNS[..3].iter().map(|x| x.abs()).sum::<f64>();
    rows.push(Row::relative(
        format!("{name}: friction work, J"),
        state.ledger.balance.dissipation_friction,
        FRICTION * GRAVITY * way,
        part,
    ));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "coulomb-oscillator",
    fact: "a mass on a spring slides on a rough floor, turns where the closed form says, and sticks",
    run: |size| {
        let steps = match size {
            Size::Quick => 200.0,
            Size::Full => 2000.0,
        };
        let mut all = rows((theta(0.5), NOW), steps, true)?;
        all.extend(rows((newmark(0.25, 0.5), DISPLACEMENT), steps, false)?);
        Ok(all)
    },
};
