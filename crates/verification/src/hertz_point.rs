//! A mass meets a Hertz point, and one that loses energy after Hunt and Crossley.
//!
//! Problem: m = 2 kg with v = 3 m/s against k = 10⁷ N/m^1.5, which it touches at the start, under each of three schemes. Closed
//! solution of the Hertz point: it goes `δ_m = (5 m v²/(4 k))^(2/5)` deep, with the force `k δ_m^1.5`, and leaves with v after
//! `T = 2 δ_m/v ∫₀¹ (1 - s^2.5)^(-1/2) ds = 2.943275 δ_m/v`. Of Hunt and Crossley, with x = c v: the first integral of
//! `m δ̈ = -k δⁿ (1 + c δ̇)` gives `δ_m = ((n + 1) m (x - ln(1 + x))/(k c²))^(1/(n + 1))`, and the mass leaves with e v where
//! `x - ln(1 + x) = -x e - ln(1 - x e)`. Reference: these formulas; the second is solved for e here by bisection, the law solves it
//! for c where a rebound is given.
//!
//! Tolerance: with ω² = 1.5 k √δ_m/m, the largest stiffness, and y = ω Δt, schemes of second order have errors of y²/12 in phase and
//! amplitude; the force begins and ends with zero and without a kink. All within y², and the error of the duration falls by four with
//! half the step: order 2 within 0.2. Where the rate is not that of the middle of the step, as with central differences, the damping
//! has an error of first order, x y/2 of the loss. Balances: round-off.

use carom_contact::Law;
use carom_contact::law::{Hertz, HuntCrossley};
use carom_dynamics::{Driver, Scheme};

use crate::Error;
use crate::build::{CENTRAL, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances, crossing, vertex};

const MASS: f64 = 2.0;
const SPEED: f64 = 3.0;
const SPRING: Hertz = Hertz {
    stiffness: 1e7,
    exponent: 1.5,
};

/// 4/5 √π Γ(2/5)/Γ(9/10).
const DURATION: f64 = 2.943_275_184_324_704_7;

/// What was seen of an impact.
struct Impact {
    /// m.
    depth: f64,
    /// N.
    peak: f64,
    /// s.
    duration: f64,
    /// m/s, outwards.
    leaves: f64,
    balances: [Row; 2],
}

fn impact(name: &str, scheme: Scheme, law: Law, dt: f64) -> Result<Impact, Error> {
    let x = [1.0, 0.0, 0.0];
    let mut points = Points::new(1);
    let mass = points.mass(MASS, [0.0; 3], [[0.0; 3], [SPEED, 0.0, 0.0]]);
    points.stop((mass, None), x, 0.0, [1.0, 0.0])?;
    points.law_of_stop(law);
    let mut run = Driver::new(crate::witness::system(points.model(scheme, dt))?)?;
    let (mut places, mut forces) = (vec![[0.0, 0.0]], vec![0.0]);
    while places.len() < 3 || run.state().motion.u[0] > 0.0 {
        run.step()?;
        places.push([run.state().time, run.state().motion.u[0]]);
        forces.push(run.report().contacts[0].force);
    }
    let end = places.len() - 1;
    let most = |values: &dyn Fn(usize) -> f64| {
        let at = (1..end).fold(1, |best, k| match values(k) > values(best) {
            true => k,
            false => best,
        });
        let around = [at - 1, at, at + 1].map(values);
        vertex(places[at][0], dt, around)[1]
    };
    let (depth, peak) = (most(&|k| places[k][1]), most(&|k| forces[k]));
    // two steps further no step lies on the end of the contact
    run.step()?;
    run.step()?;
    Ok(Impact {
        depth,
        peak,
        duration: crossing(places[end - 1], places[end]),
        leaves: -run.state().motion.v[0],
        balances: balances(name, run.state(), 0.0),
    })
}

fn hertz(scheme: Scheme, steps: f64) -> Result<Vec<Row>, Error> {
    let name = format!("hertz, {}", scheme.get().name());
    let depth = (1.25 * MASS * SPEED * SPEED / SPRING.stiffness).powf(0.4);
    let duration = DURATION * depth / SPEED;
    let omega = (1.5 * SPRING.stiffness * depth.sqrt() / MASS).sqrt();
    let of = |steps: f64| impact(&name, scheme, Law::Hertz(SPRING), duration / steps);
    let (found, finer) = (of(steps)?, of(2.0 * steps)?);
    let tolerance = (omega * duration / steps).powi(2);
    let row = |what: &str, found: f64, exact: f64| {
        Row::relative(format!("{name}: {what}"), found, exact, tolerance)
    };
    let [coarse, fine] = [&found, &finer].map(|found| (found.duration - duration).abs());
    let mut rows = vec![
        row("depth, m", found.depth, depth),
        row(
            "largest force, N",
            found.peak,
            SPRING.stiffness * depth.powf(1.5),
        ),
        row("duration, s", found.duration, duration),
        row("speed of the rebound, m/s", found.leaves, SPEED),
        Row::near(
            format!("{name}: order of the duration"),
            (coarse / fine).log2(),
            2.0,
            0.2,
        ),
    ];
    rows.extend(found.balances);
    Ok(rows)
}

/// e of x = c v.
fn rebound(x: f64) -> f64 {
    let came = x - x.ln_1p();
    let (mut low, mut high) = (0.0, f64::min(1.0, 1.0 / x));
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match -x * middle - (-x * middle).ln_1p() < came {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

fn hunt_crossley(scheme: Scheme, x: f64, steps: f64) -> Result<Vec<Row>, Error> {
    let name = format!("hunt-crossley, c v = {x}, {}", scheme.get().name());
    let damping = x / SPEED;
    let law = HuntCrossley {
        spring: SPRING,
        damping,
    };
    let depth = (2.5 * MASS * (x - x.ln_1p()) / (SPRING.stiffness * damping * damping)).powf(0.4);
    let omega = (1.5 * SPRING.stiffness * depth.sqrt() / MASS).sqrt();
    let dt = DURATION * depth / SPEED / steps;
    let found = impact(&name, scheme, Law::HuntCrossley(law), dt)?;
    let y = omega * dt;
    let tolerance = match scheme == CENTRAL {
        true => y * y + 0.5 * x * y,
        false => y * y,
    };
    let row = |what: &str, found: f64, exact: f64| {
        Row::relative(format!("{name}: {what}"), found, exact, tolerance)
    };
    let mut rows = vec![
        row("depth, m", found.depth, depth),
        row(
            "speed of the rebound, m/s",
            found.leaves,
            rebound(x) * SPEED,
        ),
    ];
    rows.extend(found.balances);
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "hertz-point",
    fact: "a mass leaves a Hertz point with its speed, and one of Hunt and Crossley with the restitution of the first integral",
    run: |size| {
        let steps = match size {
            Size::Quick => 200.0,
            Size::Full => 4000.0,
        };
        let mut rows = Vec::new();
        for scheme in [newmark(0.25, 0.5), theta(0.5), CENTRAL] {
            rows.extend(hertz(scheme, steps)?);
            for x in [0.1, 1.0, 10.0] {
                rows.extend(hunt_crossley(scheme, x, steps)?);
            }
        }
        Ok(rows)
    },
};
