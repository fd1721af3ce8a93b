//! Stops with friction on sections that turn.
//!
//! Problem 1: a disc, m = 2 kg, J = m R²/2, slides at v0 = 1 m/s without turning over a stop that carries its weight; friction
//! μ = 0.3 acts at the radius R of the section. Closed solution (Coriolis): it slides until t = v0 / (3 μ g) and then rolls at
//! v = 2/3 v0, with the energy m v0²/6 lost in friction; m v R - J ω = m v0 R at all times. Problem 2: two discs with held
//! axles are pressed together by the force N; the first turns at ω0, the second one rests. Closed solution: friction μ N
//! turns them until their surfaces move alike, ω1 = ω0 J1 / (J1 + J2 R1²/R2²), ω2 = -ω1 R1/R2, at t = J1 (ω0 - ω1)/(μ N R1).
//! Reference: these formulas.
//!
//! Tolerance: the force of sliding is constant, which all schemes integrate exactly, until the step in which sliding ends.
//! The law holds there in the way of the step: the rate of sliding that it leaves is at most that before the step, which
//! friction would undo in one step, 3 μ g dt or μ N dt (R1²/J1 + R2²/J2). Of speeds that is the tolerance, of the time one
//! step and a half, of the energy the energy of that rate; of the time of the wheels under Newmark's scheme one step more, since it
//! begins with the normal force of the stop but without friction, of which the first step has half. What both keep together: round-off.
//! A disc that rolls needs no friction: what central differences leave of it is the round-off of the speeds over what μ N changes in a
//! step, 1e-16/(3 μ g dt), less than 1e-12; 1e-9 is left to the speeds of the carrying stop.

use carom_dynamics::{Driver, Scheme, Support};

use crate::Error;
use crate::build::{CENTRAL, newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances};

const MASS: f64 = 2.0;
const RADIUS: f64 = 0.05;
const GRAVITY: f64 = 9.81;
const FRICTION: f64 = 0.3;
const SPEED: f64 = 1.0;
const STIFFNESS: f64 = 1e5;

/// Takes steps to a time in s; when the rate of sliding (m/s), a function of the velocities, is first no more than `left`, s.
fn slide(
    driver: &mut Driver,
    end: f64,
    (rate, left): (impl Fn(&[f64]) -> f64, f64),
) -> Result<f64, Error> {
    let mut stopped = None;
    while driver.state().time < end {
        driver.step()?;
        if rate(&driver.state().motion.v).abs() <= left {
            stopped.get_or_insert(driver.state().time);
        }
    }
    Ok(stopped.unwrap_or(end))
}

fn rolling(scheme: Scheme, steps: f64) -> Result<Vec<Row>, Error> {
    let inertia = 0.5 * MASS * RADIUS * RADIUS;
    let mut points = Points::new(2);
    let disc = points.disc([MASS, inertia], [0.0; 3]);
    points.stop((disc, None), [0.0, -1.0, 0.0], 0.0, [STIFFNESS, 0.0])?;
    points.rub(FRICTION, [RADIUS, 0.0]);
    let roll = SPEED / (3.0 * FRICTION * GRAVITY);
    let dt = roll / steps;
    let mut model = points.model(scheme, dt);
    model.gravity = [0.0, -GRAVITY, 0.0];
    // in equilibrium on the stop
    let (down, along) = (-MASS * GRAVITY / STIFFNESS, [SPEED, 0.0, 0.0]);
    (model.discrete[0].displacement, model.discrete[0].velocity) =
        (Some([0.0, down, 0.0]), Some(along));
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let left = 3.0 * FRICTION * GRAVITY * dt;
    let rate = |v: &[f64]| v[0] + RADIUS * v[2];
    let last = slide(&mut driver, 2.0 * roll, (rate, left))?;
    let (state, name) = (driver.state(), format!("rolling, {}", scheme.get().name()));
    let (v, turned) = (state.motion.v[0], RADIUS * state.motion.v[2]);
    let kept = v - 0.5 * turned;
    let near = |what: &str, found, exact, tolerance| {
        Row::near(format!("{name}: {what}"), found, exact, tolerance)
    };
    let lost = driver.report().balance.dissipation_friction;
    let impacts = state.impacts(driver.system());
    let worn: f64 = impacts.iter().map(|impact| impact.friction_loss).sum();
    let mut rows = vec![
        near("speed / initial speed", v / SPEED, 2.0 / 3.0, left / SPEED),
        near("rate of sliding, m/s", v + turned, 0.0, left),
        near("time of sliding / exact", last / roll, 1.0, 1.5 / steps),
        near(
            "energy lost in friction / that of the start",
            lost / (0.5 * MASS * SPEED * SPEED),
            1.0 / 3.0,
            (left / SPEED).powi(2),
        ),
        near("m v R - J w / that of the start", kept / SPEED, 1.0, 1e-12),
        near(
            "friction loss of the impact / that of the run",
            worn / lost,
            1.0,
            1e-12,
        ),
    ];
    if scheme == CENTRAL {
        let friction = state.interface.friction[0][0] / (FRICTION * MASS * GRAVITY);
        rows.push(near("friction while it rolls / μ N", friction, 0.0, 1e-9));
    }
    rows.extend(balances(&name, state, 0.0));
    Ok(rows)
}

fn wheels(scheme: Scheme, steps: f64) -> Result<Vec<Row>, Error> {
    let (inertia, radii) = ([4e-3, 1e-3], [0.05, 0.03]);
    let (force, spin) = (20.0, 30.0);
    let mut points = Points::new(2);
    let one = points.disc([MASS, inertia[0]], [0.0; 3]);
    let other = points.disc([MASS, inertia[1]], [0.0, 0.08, 0.0]);
    let gap = -force / STIFFNESS;
    points.stop((one, Some(other)), [0.0, 1.0, 0.0], gap, [STIFFNESS, 0.0])?;
    points.rub(FRICTION, radii);
    let ratio = radii[0] / radii[1];
    let ends = spin * inertia[0] / (inertia[0] + inertia[1] * ratio * ratio);
    let exact = inertia[0] * (spin - ends) / (FRICTION * force * radii[0]);
    let dt = exact / steps;
    let mut model = points.model(scheme, dt);
    model.supports.push(Support {
        nodes: vec![one.0, other.0],
        fix: [true; 3],
        fix_rotations: [false; 3],
    });
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    let (u, mut v) = (
        driver.state().motion.u.clone(),
        driver.state().motion.v.clone(),
    );
    let turns = [one, other].map(|(node, _)| {
        let system = driver.system();
        system
            .unknowns
            .rotations_of(system.number[node as usize])
            .start
    });
    v[turns[0]] = spin;
    driver.restart(&u, &v)?;
    let slowing = |k: usize| FRICTION * force * radii[k] * radii[k] / inertia[k];
    let left = (slowing(0) + slowing(1)) * dt;
    let rate = |v: &[f64]| v[turns[0]] * radii[0] + v[turns[1]] * radii[1];
    let last = slide(&mut driver, 2.0 * exact, (rate, left))?;
    let (state, name) = (driver.state(), format!("wheels, {}", scheme.get().name()));
    let late = match scheme.get().keeps_acceleration() {
        true => 2.5,
        false => 1.5,
    };
    let [first, second] = turns.map(|unknown| state.motion.v[unknown]);
    let kept = inertia[0] / radii[0] * (spin - first) + inertia[1] / radii[1] * second;
    let near = |what: &str, found, exact, tolerance| {
        Row::near(format!("{name}: {what}"), found, exact, tolerance)
    };
    let mut rows = vec![
        near("speed of the first, rad/s", first, ends, left / radii[0]),
        near(
            "speed of the second, rad/s",
            second,
            -ends * ratio,
            left / radii[1],
        ),
        near(
            "rate of sliding, m/s",
            first * radii[0] + second * radii[1],
            0.0,
            left,
        ),
        near("time of sliding / exact", last / exact, 1.0, late / steps),
        near(
            "impulses of both at their radii / largest",
            kept * radii[0] / (inertia[0] * spin),
            0.0,
            1e-12,
        ),
    ];
    rows.extend(balances(&name, state, inertia[0] * spin));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "rubbing-stops",
    fact: "friction of a stop turns the section: a disc slides and then rolls at 2/3 of its speed, two wheels end with equal surface speeds",
    run: |size| {
        let steps = match size {
            Size::Quick => 200.0,
            Size::Full => 2000.0,
        };
        let mut all = Vec::new();
        for scheme in [newmark(0.25, 0.5), theta(0.5), CENTRAL] {
            all.extend(rolling(scheme, steps)?);
            all.extend(wheels(scheme, steps)?);
        }
        Ok(all)
    },
};
