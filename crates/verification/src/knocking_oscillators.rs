//! Two mirrored oscillators that knock against each other, and one on a wall.
//!
//! Problem: two masses on springs to the ground, 1 m apart along an oblique line, swing towards each other with opposite
//! velocities; a stop of stiffness K, damping C and gap j lies between them. One mass of the pair against a stop on the ground
//! with 2 K, 2 C and j/2 is the same problem. Fact: displacement of the one equals that of the first of the two, times -1
//! that of the second, at all steps over several knocks, with linear steps and, with dashpots, nonlinear ones. Tolerance:
//! the equations are the same up to the order of sums: 1e-10 of the amplitude. Momentum of the pair along the line: zero to
//! rounding of its largest part.

use carom_bodies::Curve;
use carom_dynamics::{Driver, Model, Scheme};

use crate::Error;
use crate::build::{newmark, theta};
use crate::check::{Check, Row, Size};
use crate::points::{Points, balances};

const MASS: f64 = 2.0;
const SPRING: f64 = 200.0;
const STOP: f64 = 5e4;
const DAMPING: f64 = 20.0;
const GAP: f64 = 0.02;
const SPEED: f64 = 1.0;
/// Along which all happens.
const AXIS: [f64; 3] = [0.6, 0.8, 0.0];

/// `pair`: whether there are two; `dashpot`: of each mass to the ground, N s/m.
fn model(pair: bool, dashpot: f64, (scheme, dt): (Scheme, f64)) -> Result<Model, Error> {
    let mut points = Points::new(2);
    let moving = |sign: f64| [[0.0; 3], AXIS.map(|n| sign * SPEED * n)];
    let mut all = vec![points.mass(MASS, [0.0; 3], moving(1.0))];
    if pair {
        all.push(points.mass(MASS, AXIS, moving(-1.0)));
    }
    for &mass in &all {
        for axis in [AXIS, [-AXIS[1], AXIS[0], 0.0]] {
            points.spring(mass, axis, Curve::line(SPRING));
        }
        if dashpot > 0.0 {
            points.dashpot(mass, dashpot);
        }
    }
    match all[..] {
        [one, other] => points.stop((one, Some(other)), AXIS, GAP, [STOP, DAMPING])?,
        _ => points.stop((all[0], None), AXIS, 0.5 * GAP, [2.0 * STOP, 2.0 * DAMPING])?,
    }
    Ok(points.model(scheme, dt))
}

fn rows(name: &str, dashpot: f64, time: (Scheme, f64), steps: usize) -> Result<Vec<Row>, Error> {
    let mut two = Driver::new(crate::witness::system(model(true, dashpot, time)?)?)?;
    let mut one = Driver::new(crate::witness::system(model(false, dashpot, time)?)?)?;
    let (mut apart, mut largest, mut drift) = (0.0_f64, 0.0_f64, 0.0_f64);
    for _ in 0..steps {
        two.step()?;
        one.step()?;
        let [pair, single] = [&two, &one].map(|run| &run.state().motion.u);
        for i in 0..2 {
            largest = largest.max(single[i].abs());
            apart = apart.max((pair[i] - single[i]).abs());
            apart = apart.max((pair[2 + i] + single[i]).abs());
        }
        let momentum = &two.state().ledger.balance.momentum;
        drift = drift.max(momentum.largest() / (MASS * SPEED));
    }
    let knocks = one.state().records.contacts[0].closings;
    let mut rows = vec![
        Row::at_most(
            format!("{name}: pair against one on a wall / amplitude"),
            apart / largest,
            1e-10,
        ),
        Row::at_least(format!("{name}: knocks"), knocks as f64, 3.0),
        Row::at_most(
            format!("{name}: momentum of the pair / largest"),
            drift,
            1e-10,
        ),
    ];
    rows.extend(balances(
        &format!("{name}, the pair"),
        two.state(),
        MASS * SPEED,
    ));
    rows.extend(balances(
        &format!("{name}, the one"),
        one.state(),
        MASS * SPEED,
    ));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "knocking-oscillators",
    fact: "two mirrored oscillators knock each other like one on a wall with half the gap and twice the stop",
    run: |size| {
        let (dt, steps) = match size {
            Size::Quick => (2e-4, 8000),
            Size::Full => (2e-5, 80_000),
        };
        let mut all = rows("linear", 0.0, (newmark(0.25, 0.5), dt), steps)?;
        all.extend(rows("with dashpots", 0.5, (newmark(0.25, 0.5), dt), steps)?);
        all.extend(rows("theta, with dashpots", 0.5, (theta(0.5), dt), steps)?);
        Ok(all)
    },
};
