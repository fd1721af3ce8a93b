//! A mass that falls on a spring that it does not stick to.
//!
//! Problem: m = 1 kg falls 2 m from a speed of 1 m/s under g = 10 m/s² onto a stop K = 100 N/m. Closed solution: it touches at
//! (√41 - 1)/10 = 0.540312 s with √41 m/s; then u = g/ω² - R cos(ω t + φ), ω² = K/m, R² = (g/ω²)² + (v/ω)²,
//! cos φ = g/(ω² R): crush g/ω² + R = 0.748074 m, and it leaves 2 (π - φ)/ω later, at 0.885456 s. Reference: these formulas.
//!
//! Tolerance: with x = ω Δt phase and amplitude of schemes of second order have errors of x²/12; the steps in which the stop
//! closes and opens miss a part of a step of a force that begins with zero, x²/4 of the velocity change in the unit of v; the
//! zeros of the gap by a line are exact to g Δt²/(8 v). All within x² of the crush and of the duration. Balances: round-off.

use std::f64::consts::PI;

use carom_dynamics::{Driver, Model, Scheme};

use crate::Error;
use crate::build::{CENTRAL, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances, crossing, vertex};

const GRAVITY: f64 = 10.0;
const DROP: f64 = 2.0;
const SPEED: f64 = 1.0;
const STOP: f64 = 100.0;

fn rows(scheme: Scheme, dt: f64) -> Result<Vec<Row>, Error> {
    let down = [0.0, -1.0, 0.0];
    let mut points = Points::new(2);
    let velocity = down.map(|n| SPEED * n);
    let mass = points.mass(1.0, [0.3, 0.0, 0.0], [[0.0; 3], velocity]);
    points.stop((mass, None), down, DROP, [STOP, 0.0])?;
    let mut run = Driver::new(crate::witness::system(Model {
        gravity: down.map(|n| GRAVITY * n),
        ..points.model(scheme, dt)
    })?)?;
    let touch_speed = (SPEED * SPEED + 2.0 * GRAVITY * DROP).sqrt();
    let touch = (touch_speed - SPEED) / GRAVITY;
    let omega = STOP.sqrt();
    let rest = GRAVITY / STOP;
    let reach = rest.hypot(touch_speed / omega);
    let last = 2.0 * (PI - (rest / reach).acos()) / omega;
    let mut gaps = vec![[0.0, DROP]];
    while run.state().time < 1.0 {
        run.step()?;
        gaps.push([run.state().time, DROP + run.state().motion.u[1]]);
    }
    let cross = |down: f64| {
        let pair = gaps
            .windows(2)
            .find(|pair| down * pair[0][1] > 0.0 && down * pair[1][1] <= 0.0);
        pair.map_or(f64::NAN, |pair| crossing(pair[0], pair[1]))
    };
    let lowest = (0..gaps.len())
        .min_by(|a, b| gaps[*a][1].total_cmp(&gaps[*b][1]))
        .unwrap_or(1);
    let around = [lowest - 1, lowest, lowest + 1].map(|k| gaps[k][1]);
    let [_, deepest] = vertex(gaps[lowest][0], dt, around);
    let name = scheme.get().name();
    let part = (omega * dt).powi(2);
    let row = |what: &str, found: f64, exact: f64, unit: f64| {
        Row::near(format!("{name}: {what}"), found, exact, part * unit)
    };
    let mut rows = vec![
        row("touches, s", cross(1.0), touch, last),
        row("leaves, s", cross(-1.0), touch + last, last),
        row("crush, m", -deepest, rest + reach, rest + reach),
    ];
    rows.extend(balances(name, run.state(), 0.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "bouncing-mass",
    fact: "a mass falls on a spring and leaves it again: times and crush of the closed form",
    run: |size| {
        let dt = match size {
            Size::Quick => 1e-3,
            Size::Full => 1e-4,
        };
        let schemes = [newmark(0.25, 0.5), theta(0.5), CENTRAL];
        let all = schemes.map(|scheme| rows(scheme, dt));
        Ok(all.into_iter().collect::<Result<Vec<_>, _>>()?.concat())
    },
};
