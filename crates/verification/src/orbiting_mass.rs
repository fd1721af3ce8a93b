//! A mass that orbits inside a bore without friction.
//!
//! Problem: m = 1.5 kg, a section of radius 40 mm in a bore of radius 50 mm with a stop of K = 1e7 N/m, in steady motion at
//! V = 3 m/s on the circle of radius ρ on which K δ = m V²/ρ, δ = ρ less the clearance of 10 mm. Closed solution: force m V²/ρ, energy,
//! angular momentum and radius at rest, a turn in 2πρ/V. The bore is a cylinder, a profile through points at equal radii with the
//! spline, and a profile through points about another centre. Reference: these formulas; the spline through an off-centre circle has
//! an error of order four in the distance of its points.
//!
//! Tolerance: the schemes are of second order: with x = ω dt, ω = V/ρ, they miss the angle by at most x² times it, 2π in one turn,
//! and the start by a radial speed of V x², which swings on the stop at ω_r = √(K/m): x² V/ω_r in the radius, and that
//! times K in the force, ω_r/ω x² of it; three times these, since the swing is resolved by 46 steps in the quick tier. The
//! angular momentum changes by what the normal of a step is off, x² per radian at most. The off-centre profile adds its unevenness: with
//! 48 points at an eccentricity of 30 % below 1e-6 of its radius, times K over the force.

use std::f64::consts::TAU;

use carom_contact::{Cylinder, Obstacle, Profile, Side};
use carom_dynamics::{Driver, Scheme};

use crate::Error;
use crate::build::{CENTRAL, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances, spring_stop};

const MASS: f64 = 1.5;
const BORE: f64 = 0.05;
const ROD: f64 = 0.04;
const STIFFNESS: f64 = 1e7;
const SPEED: f64 = 3.0;

fn orbit(
    (name, obstacle): (&str, Obstacle),
    scheme: Scheme,
    steps: f64,
    uneven: f64,
) -> Result<Vec<Row>, Error> {
    let clearance = BORE - ROD;
    // ρ (ρ - c) = m V²/K
    let part = MASS * SPEED * SPEED / STIFFNESS;
    let radius = 0.5 * (clearance + (clearance * clearance + 4.0 * part).sqrt());
    let turn = TAU * radius / SPEED;
    let dt = turn / steps;
    let mut points = Points::new(2);
    let mass = points.mass(MASS, [radius, 0.0, 0.0], [[0.0; 3], [0.0, SPEED, 0.0]]);
    points.in_front_of(mass, (obstacle, ROD), spring_stop(STIFFNESS, 0.0)?);
    let mut driver = Driver::new(crate::witness::system(points.model(scheme, dt))?)?;
    let force = MASS * SPEED * SPEED / radius;
    let (mut off, mut away, mut spun) = (0.0_f64, 0.0_f64, 0.0_f64);
    let place = |u: &[f64]| [radius + u[0], u[1]];
    while driver.state().time < turn - 0.5 * dt {
        driver.step()?;
        let motion = &driver.state().motion;
        let [x, y] = place(&motion.u);
        off = off.max((driver.report().contacts[0].force / force - 1.0).abs());
        away = away.max((x.hypot(y) / radius - 1.0).abs());
        let spin = x * motion.v[1] - y * motion.v[0];
        spun = spun.max((spin / (radius * SPEED) - 1.0).abs());
    }
    let state = driver.state();
    let [x, y] = place(&state.motion.u);
    let behind = y.atan2(x).abs();
    let second = (TAU / steps).powi(2);
    let swing = (STIFFNESS / MASS).sqrt() * radius / SPEED;
    let name = format!("{name}, {}", scheme.get().name());
    let row = |what: &str, value, bound| Row::at_most(format!("{name}: {what}"), value, bound);
    let mut rows = vec![
        row(
            "error of the force",
            off,
            swing * 3.0 * second + uneven * STIFFNESS / force,
        ),
        row(
            "error of the radius",
            away,
            3.0 * second / swing + uneven / radius,
        ),
        row(
            "error of the angular momentum",
            spun,
            TAU * second + uneven / radius,
        ),
        row(
            "angle behind after one turn, rad",
            behind,
            TAU * second + uneven / radius,
        ),
    ];
    rows.extend(balances(&name, state, MASS * SPEED));
    Ok(rows)
}

/// The bore as a profile, its points seen from a place that is off its centre by a part of its radius.
fn profile(points: usize, off: f64) -> Obstacle {
    let e = off * BORE;
    let point = |k: usize| {
        let angle = TAU * k as f64 / points as f64;
        let root = (BORE * BORE - (e * angle.sin()).powi(2)).sqrt();
        [angle, root - e * angle.cos()]
    };
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let points = (0..points).map(point).collect();
    Profile::new([e, 0.0, 0.0], axes, points, (true, Side::Inside)).into()
}

pub(crate) const CHECK: Check = Check {
    name: "orbiting-mass",
    fact: "a mass orbits in a bore without friction: force m v²/r, in a cylinder and in profiles through points",
    run: |size| {
        let steps = match size {
            Size::Quick => 400.0,
            Size::Full => 4000.0,
        };
        let cylinder = || -> Obstacle {
            Cylinder {
                point: [0.0; 3],
                axis: [0.0, 0.0, 1.0],
                radius: BORE,
                side: Side::Inside,
            }
            .into()
        };
        let mut all = Vec::new();
        for scheme in [newmark(0.25, 0.5), theta(0.5), CENTRAL] {
            all.extend(orbit(("cylinder", cylinder()), scheme, steps, 0.0)?);
            let even = profile(12, 0.0);
            all.extend(orbit(("even profile", even), scheme, steps, 0.0)?);
            let uneven = profile(48, 0.3);
            let error = 1e-6 * BORE;
            all.extend(orbit(("off-centre profile", uneven), scheme, steps, error)?);
        }
        Ok(all)
    },
};
