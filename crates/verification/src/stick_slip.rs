//! A block on a spring over a rough floor and over a moving belt: stick and slip.
//!
//! Problem: the block of `sliding_block`, hung on a wall by a spring of 100 N/m at its foot. (a) Pulled by 0.1 m and let go
//! on a floor of μ = 0.15, it swings three half-periods and sticks. (b) At rest with the spring free, put on a belt that
//! moves at 0.1 m/s with μ = 0.2, it slips, is caught, carried and lost. Closed solution and reference: mass points,
//! carom_exact::friction::RoughFloor and Belt.
//!
//! Tolerance: the scheme lengthens the period by (ω Δt)²/12, a phase of that times ω t. In the step of a turn friction has
//! one direction, so that the velocity is off by at most 2 μ g Δt, the place a quarter of a period later by 2 δ ω Δt; the
//! work of that friction moves the turning point only by δ (ω Δt)², and 1e-3 of the pull is left to the vibration of the
//! elastic block. Caught and lost, taken as the velocity of the belt within 2 %, are found to two steps: slowly the block
//! leaves that velocity, so lost is later than the exact instant by arccos(0.98)/ω. The dissipation is μ N times the way
//! over the floor or the belt to 1e-3, again vibration; balances 1e-9.

use std::f64::consts::PI;

use carom_contact::Law;
use carom_dynamics::Driver;
use carom_exact::friction::{Belt, RoughFloor};

use crate::Error;
use crate::build::{DISPLACEMENT, NOW, theta};
use crate::check::{Check, Row, Size};
use crate::sliding_block::{GRAVITY, Rough, balances, place};

const STIFFNESS: f64 = 100.0;
const PULLED: f64 = 0.1;
const BELT: f64 = 0.1;
/// Part of the belt's velocity from which on the block goes with it.
const NEAR: f64 = 0.98;

fn rough(mu: f64, belt: f64, law: Law, dt: f64) -> Rough {
    Rough {
        dim: 2,
        gravity: [0.0, -GRAVITY, 0.0],
        mu,
        velocity: [0.0; 3],
        spring: Some(STIFFNESS),
        belt,
        scheme: theta(0.5),
        law,
        dt,
    }
}

/// What was seen of a run.
#[derive(Default)]
struct Seen {
    /// Largest difference of the place from the exact one, m.
    error: f64,
    /// Way over the floor or the belt, m.
    slid: f64,
    /// Ends of the steps in which the block goes with the floor or the belt, s: within 2 % of `speed`.
    with: Vec<f64>,
    /// Place at the end, m.
    end: f64,
}

/// Runs until a time in s. `speed`: that against which sliding and sticking are measured, m/s.
fn watch(
    newton: &mut Driver,
    until: f64,
    (floor, speed): (f64, f64),
    exact: impl Fn(f64) -> f64,
) -> Result<Seen, Error> {
    let mut seen = Seen::default();
    let mut last = place(newton, newton.state())[0][0];
    let dt = newton.system().dt;
    while newton.state().time < until - 0.5 * dt {
        newton.step()?;
        let time = newton.state().time;
        let [[x, ..], _] = place(newton, newton.state());
        seen.error = seen.error.max((x - exact(time)).abs());
        seen.slid += (x - last - floor * dt).abs();
        if ((x - last) / dt - floor).abs() < (1.0 - NEAR) * speed {
            seen.with.push(time);
        }
        last = x;
    }
    seen.end = last;
    Ok(seen)
}

fn floor(name: &str, law: Law, dt: f64) -> Result<Vec<Row>, Error> {
    let rough = rough(0.15, 0.0, law, dt);
    let exact = RoughFloor {
        mass: rough.mass(),
        stiffness: STIFFNESS,
        friction: rough.mu * rough.mass() * GRAVITY,
        start: PULLED,
    };
    let mut newton = rough.start()?;
    let system = newton.system();
    let mut pulled = vec![0.0; system.unknowns()];
    for (node, _) in system.x.iter().enumerate().filter(|(_, x)| x[0] >= 0.0) {
        pulled[system.unknowns.first(node as u32)] = PULLED;
    }
    let still = vec![0.0; system.unknowns()];
    newton.restart(&pulled, &still)?;
    let omega = exact.frequency();
    let stop = exact
        .half_periods()
        .map_or(f64::INFINITY, |n| n as f64 * PI / omega);
    let speed = PULLED * omega;
    let seen = watch(&mut newton, 1.5 * stop, (0.0, speed), |t| exact.at(t).0)?;
    let sticks = last_rest(&seen.with, dt);
    let way = (0..3).fold(0.0, |sum, n| {
        sum + (exact.turning_point(n) - exact.turning_point(n + 1)).abs()
    });
    let phase = omega * dt;
    let rest = 3.0 * exact.shift() * phase.powi(2) + 1e-3 * PULLED;
    let bound = phase.powi(2) * PULLED * omega * stop / 12.0 + 2.0 * 2.0 * exact.shift() * phase;
    let dissipated = newton.state().ledger.balance.dissipation_friction;
    let mut rows = vec![
        Row::at_most(format!("{name}: error of the place, m"), seen.error, bound),
        Row::near(
            format!("{name}: place of rest, m"),
            seen.end,
            exact.turning_point(3),
            rest,
        ),
        Row::near(format!("{name}: sticks from, s"), sticks, stop, 2.0 * dt),
        Row::near(
            format!("{name}: dissipated, J"),
            dissipated,
            exact.friction * way,
            exact.friction * 2.0 * 3.0 * rest,
        ),
        Row::relative(
            format!("{name}: dissipated / (μ N way slid)"),
            dissipated / (exact.friction * seen.slid),
            1.0,
            1e-3,
        ),
    ];
    rows.extend(balances(name, &newton));
    Ok(rows)
}

/// The instant from which every step is among `with`, s.
fn last_rest(with: &[f64], dt: f64) -> f64 {
    let pairs = with.windows(2).rev();
    let together = pairs
        .take_while(|pair| pair[1] - pair[0] < 1.5 * dt)
        .count();
    match with.len().checked_sub(1 + together) {
        Some(first) => with[first],
        None => f64::NAN,
    }
}

fn belt(name: &str, law: Law, dt: f64) -> Result<Vec<Row>, Error> {
    let rough = rough(0.2, BELT, law, dt);
    let exact = Belt {
        mass: rough.mass(),
        stiffness: STIFFNESS,
        friction: rough.mu * rough.mass() * GRAVITY,
        velocity: BELT,
    };
    let mut newton = rough.start()?;
    let until = 3.0;
    let seen = watch(&mut newton, until, (BELT, BELT), |t| exact.at(t).0)?;
    let [caught, lost] = exact.sticks();
    let first: Vec<f64> = seen
        .with
        .iter()
        .copied()
        .filter(|t| *t < 1.5 * lost)
        .collect();
    let omega = exact.frequency();
    let bound = (omega * dt).powi(2) * (BELT * until / 12.0 + exact.shift());
    let ledger = &newton.state().ledger.balance;
    // the belt gives V μ N while it slips under the block, and V k x while it carries it
    let carried = 0.5 * STIFFNESS * (exact.at(lost).0.powi(2) - exact.at(caught).0.powi(2));
    let given = BELT * exact.friction * (until - lost + caught) + carried;
    let mut rows = vec![
        Row::at_most(format!("{name}: error of the place, m"), seen.error, bound),
        Row::near(
            format!("{name}: caught at, s"),
            first.first().copied().unwrap_or(f64::NAN),
            caught,
            2.0 * dt,
        ),
        Row::near(
            format!("{name}: lost at, s"),
            first.last().copied().unwrap_or(f64::NAN),
            lost + NEAR.acos() / omega,
            2.0 * dt,
        ),
        Row::relative(
            format!("{name}: dissipated / (μ N way slid)"),
            ledger.dissipation_friction / (exact.friction * seen.slid),
            1.0,
            1e-3,
        ),
        Row::relative(
            format!("{name}: work of the belt, J"),
            ledger.work_obstacles,
            given,
            0.01,
        ),
    ];
    rows.extend(balances(name, &newton));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "stick-slip",
    fact: "a block on a spring sticks and slips on a rough floor and on a belt as a mass point does",
    run: |size| {
        let dts: &[f64] = match size {
            Size::Quick => &[0.01],
            Size::Full => &[0.01, 0.005, 0.0025],
        };
        let mut rows = Vec::new();
        for &dt in dts {
            for (name, law) in [("velocity law", NOW), ("displacement law", DISPLACEMENT)] {
                rows.extend(floor(&format!("floor, {name}, Δt {dt}"), law, dt)?);
                rows.extend(belt(&format!("belt, {name}, Δt {dt}"), law, dt)?);
            }
        }
        Ok(rows)
    },
};
