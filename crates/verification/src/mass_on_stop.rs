//! A mass on a spring that moves against a stop.
//!
//! Problem: m = 100 kg on a spring k = 1e4 N/m to the ground, at rest length against a stop K = 1e6 N/m of gap zero, moves
//! into it at V = 1 m/s. Closed solution while the stop is closed: u = V/ω sin ωt, ω² = (k + K)/m. Peak of the stop's force
//! K V/ω = 9950.4 N at π/(2ω) = 1.5630e-2 s, contact for π/ω = 3.1260e-2 s, impulse 2 K V/ω² = 198.02 N s; then half a
//! swing of the spring alone, back to the stop at V. Reference: these formulas.
//!
//! Tolerance: with x = ω Δt the schemes, of second order, have the phase error x²/24 (central differences) or x²/12
//! (trapezoidal rule) in time; the same, relative, in the amplitude V/ω and in what follows from it; the step in which the
//! stop opens misses at most the force of a part of a step, K V Δt²/2, x²/4 of the impulse. All within x².
//! Balances: round-off.

use std::f64::consts::PI;

use carom_bodies::Curve;
use carom_dynamics::{Driver, Scheme};

use crate::Error;
use crate::build::{CENTRAL, newmark};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances, crossing, vertex};

const MASS: f64 = 100.0;
const SPRING: f64 = 1e4;
const STOP: f64 = 1e6;
const SPEED: f64 = 1.0;

/// `curve`: of the spring, straight where the mass is.
fn rows(name: &str, scheme: Scheme, curve: Curve, steps: f64) -> Result<Vec<Row>, Error> {
    let omega = ((SPRING + STOP) / MASS).sqrt();
    let x = [1.0, 0.0, 0.0];
    let mut points = Points::new(1);
    let mass = points.mass(MASS, [0.0; 3], [[0.0; 3], [SPEED, 0.0, 0.0]]);
    points.spring(mass, x, curve);
    points.stop((mass, None), x, 0.0, [STOP, 0.0])?;
    let dt = PI / omega / steps;
    let system = crate::witness::system(points.model(scheme, dt))?;
    let mut run = Driver::new(system)?;
    let mut places = vec![[0.0, 0.0]];
    let mut forces = vec![0.0];
    while run.state().time < 1.1 * PI / omega {
        run.step()?;
        places.push([run.state().time, run.state().motion.u[0]]);
        forces.push(run.report().contacts[0].force);
    }
    let largest = (0..forces.len())
        .max_by(|a, b| forces[*a].total_cmp(&forces[*b]))
        .unwrap_or(1);
    let around = [largest - 1, largest, largest + 1].map(|k| forces[k]);
    let [time, peak] = vertex(places[largest][0], dt, around);
    let back = places.windows(2).skip(1).find(|pair| pair[1][1] < 0.0);
    let end = back.map_or(f64::NAN, |pair| crossing(pair[0], pair[1]));
    let impulse = run.state().records.contacts[0].impulse();
    let mut rows: Vec<Row> = [
        ("peak force, N", peak, STOP * SPEED / omega),
        ("time of the peak, s", time, 0.5 * PI / omega),
        ("contact, s", end, PI / omega),
        (
            "impulse, N s",
            impulse,
            2.0 * STOP * SPEED / (omega * omega),
        ),
    ]
    .into_iter()
    .map(|(what, found, exact)| {
        let tolerance = (omega * dt).powi(2);
        Row::relative(format!("{name}: {what}"), found, exact, tolerance)
    })
    .collect();
    while run.state().time < 0.5 {
        run.step()?;
    }
    // the spring alone brings it back with the speed that it left with
    let record = &run.state().records.contacts[0];
    let turn = PI / (SPRING / MASS).sqrt();
    let again = record.last_force.unwrap_or(f64::NAN);
    let exact = 2.0 * PI / omega + turn;
    rows.push(Row::near(
        format!("{name}: end of the second contact, s"),
        again,
        exact,
        // the end of the step, and the phase of both oscillations
        dt + exact * (omega * dt).powi(2),
    ));
    rows.extend(balances(name, run.state(), 0.0));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "mass-on-stop",
    fact: "a mass on a spring meets a stop: force, duration and impulse of the closed form, with linear and nonlinear steps",
    run: |size| {
        let steps = match size {
            Size::Quick => 200.0,
            Size::Full => 4000.0,
        };
        // as stiff where the mass is, softer far away
        let [far, force] = [1.0, SPRING];
        let bent = Curve::new(vec![
            [-2.0 * far, -1.5 * force],
            [-far, -force],
            [far, force],
            [2.0 * far, 1.5 * force],
        ])?;
        let mut all = rows(
            "trapezoidal rule",
            newmark(0.25, 0.5),
            Curve::line(SPRING),
            steps,
        )?;
        all.extend(rows(
            "central differences",
            CENTRAL,
            Curve::line(SPRING),
            steps,
        )?);
        all.extend(rows("spring by a curve", newmark(0.25, 0.5), bent, steps)?);
        Ok(all)
    },
};
