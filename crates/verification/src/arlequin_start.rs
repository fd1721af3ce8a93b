//! The start of glued zones.
//!
//! Problem: a free bar in two zones. (1) Its nodes start with random velocities, which satisfy no row: they must become the
//! closest ones, in the norm of the mass, that do. Facts: the rows hold; no row acts on a rigid motion, so the momentum
//! stays; the closest ones are those whose change is orthogonal to them, so that the kinetic energy lost is that of the change.
//! (2) It flies at one speed, over 1000 outer steps.
//! Closed solution of (2): no force anywhere, L = 0, f = 0.
//!
//! Tolerance: rounding. The displacement grows to 500 h in up to 10 000 inner steps, each of which rounds it by 6e-14 h; a
//! random walk of that leaves differences of 6e-12 h, and the fine elements make forces of 8 times as much: 1e-10.

use carom_arlequin::Row as Coupled;
use carom_zones::{LinkKind, Zones};

use crate::Error;
use crate::check::{Check, Row};
use crate::glued_bar::{GluedBar, motion};

pub(crate) const CHECK: Check = Check {
    name: "arlequin-start",
    fact: "velocities that disagree are projected at the start, and a glued bar flies without force",
    run: |_| {
        let mut rows = projected()?;
        for kind in [LinkKind::GravouilCombescure, LinkKind::PrakashHjelmstad] {
            for m in [1, 4, 10] {
                let (multiplier, force) = flight(kind, m)?;
                let name = format!("{kind:?}, m = {m}");
                rows.push(Row::at_most(
                    format!("{name}: L h / (Z v)"),
                    multiplier,
                    1e-10,
                ));
                rows.push(Row::at_most(format!("{name}: f / (Z v)"), force, 1e-10));
            }
        }
        Ok(rows)
    },
};

fn projected() -> Result<Vec<Row>, Error> {
    let zoned = GluedBar::usual(60).zoned()?;
    let mut zones = crate::witness::zones(&zoned)?;
    // no two alike, no pattern
    let noise = |x: f64| (1e4 * x + 0.3).sin() + 0.5;
    let start = motion(&zones, |x| [0.0, noise(x)]);
    let momentum = |zones: &Zones, v: &dyn Fn(usize) -> Vec<f64>, square: bool| -> f64 {
        let of = |(k, driver): (usize, &carom_dynamics::Driver)| {
            let masses = driver.system().mass.lumped.iter().zip(v(k));
            masses
                .map(|(m, v)| m * if square { v * v } else { v })
                .sum::<f64>()
        };
        zones.drivers().iter().enumerate().map(of).sum()
    };
    let before = |k: usize| start[k][1].clone();
    let [mass_before, energy_before] = [false, true].map(|s| momentum(&zones, &before, s));
    zones.restart(&start)?;
    let drivers = zones.drivers();
    let after = |k: usize| drivers[k].state().motion.v.clone();
    let [mass_after, energy_after] = [false, true].map(|s| momentum(&zones, &after, s));
    let change = |k: usize| {
        let pairs = before(k).into_iter().zip(after(k));
        pairs.map(|(before, after)| after - before).collect()
    };
    let energy_change = momentum(&zones, &change, true);
    let mut worst = [0.0_f64; 2];
    let fields: [&dyn Fn(usize) -> Vec<f64>; 2] = [&before, &after];
    for (worst, v) in worst.iter_mut().zip(fields) {
        for row in &zoned.links[0].rows {
            let side = |k: usize, terms| {
                let (v, number) = (v(k), &drivers[k].system().number);
                Coupled::apply(terms, |node, _| v[number[node as usize] as usize])
            };
            *worst = worst.max((side(0, &row.inner) - side(1, &row.outer)).abs());
        }
    }
    Ok(vec![
        Row::at_least(
            "random velocities: largest defect of a row before",
            worst[0],
            0.1,
        ),
        Row::at_most("largest defect of a row after", worst[1], 1e-13),
        Row::relative(
            "momentum after / before",
            mass_after / mass_before,
            1.0,
            1e-13,
        ),
        Row::near(
            "kinetic energy lost / that of the change of velocity",
            (energy_before - energy_after) / energy_change,
            1.0,
            1e-10,
        ),
    ])
}

/// Largest multiplier and internal force of a bar that flies at speed one over 1000 steps.
fn flight(kind: LinkKind, substeps: u32) -> Result<(f64, f64), Error> {
    let bar = GluedBar {
        kind,
        substeps,
        ..GluedBar::usual(60)
    };
    let mut zones = crate::witness::zones(&bar.zoned()?)?;
    let start = motion(&zones, |_| [0.0, 1.0]);
    zones.restart(&start)?;
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let (mut multiplier, mut force) = (0.0_f64, 0.0_f64);
    for _ in 0..1000 {
        zones.step()?;
        multiplier = multiplier.max(largest(zones.multipliers()));
        for driver in zones.drivers() {
            force = force.max(largest(&driver.state().motion.internal_force));
        }
    }
    Ok((multiplier, force))
}
