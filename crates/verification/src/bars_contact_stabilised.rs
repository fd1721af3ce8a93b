//! Two equal bars, a bar on a wall, and two blocks under the contact-stabilised Newmark scheme.
//!
//! Problem: set "slow", all ends free, lumped and consistent mass, CFL 0.25 to 4; two blocks with meshes that do not
//! match, paired once. Closed solution: F = Z v0 / 2 (Z v0 on the wall) for 2 L / c; the energy never grows, which is
//! proved from the two complementarities of the step; no penetration. Reference: the exact solution; no other
//! implementation was at hand. With lumped mass, n = 200 and CFL 0.5 the force errs by 0.054 and overshoots by 0.095, the
//! energy changes by -0.0014 between bars and the restitution is 0.988; the worst over all runs is the overshoot of 0.557
//! with consistent mass at CFL 0.25. Tolerance: bounds of that size over all runs; 1e-11 of the energy for the balances,
//! 1e-13 for what a step may gain by rounding.

use carom_bodies::MassKind;
use carom_contact::Sliding;
use carom_dynamics::scheme::ContactStabilised;
use carom_dynamics::{Driver, Scheme, System};

use crate::Error;
use crate::bars::{Against, Run};
use crate::blocks::SMALLEST;
use crate::build::DISPLACEMENT;
use crate::check::{Check, Row};
use crate::figures::run;

const SCHEME: Scheme = Scheme::ContactStabilised(ContactStabilised);

const GROWTH: &str = "growth of the energy in a step / E0";

/// Largest growth of the energy in a step, over its start.
fn growth(energy: &[f64], start: f64) -> f64 {
    let before = std::iter::once(&start).chain(energy);
    let steps = before.zip(energy).map(|(one, other)| other - one);
    steps.fold(0.0, f64::max) / start
}

fn blocks() -> Result<[Row; 2], Error> {
    let system = System::new(SMALLEST.model(SCHEME, DISPLACEMENT, Sliding::Small)?)?;
    let mut driver = Driver::new(system)?;
    let start = driver.state().ledger.balance.energy();
    let mut energy = Vec::new();
    while driver.state().step < 60 {
        driver.step()?;
        energy.push(driver.state().ledger.balance.energy());
    }
    let residual = driver.state().ledger.largest_energy_residual / start;
    Ok([
        Row::at_most(format!("blocks: {GROWTH}"), growth(&energy, start), 1e-13),
        Row::at_most("blocks: energy residual / E0", residual, 1e-11),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "bars-contact-stabilised",
    fact: "the contact-stabilised Newmark scheme never gains energy and does not penetrate",
    run: |_| {
        let mut rows = Vec::new();
        for against in [Against::Bar, Against::Wall] {
            for mass in [MassKind::Lumped, MassKind::Consistent] {
                for courant in [0.25, 0.5, 1.0, 2.0, 4.0] {
                    let case = Run {
                        scheme: SCHEME,
                        law: DISPLACEMENT,
                        against,
                        mass,
                        courant,
                        ..Run::slow(200)
                    };
                    let (history, figures) = run(&case)?;
                    let name = format!("{against:?}, {mass:?}, CFL {courant}");
                    let row = |what: &str| format!("{name}: {what}");
                    let at_most = |what, value, bound| Row::at_most(row(what), value, bound);
                    let set = case.set;
                    let start = 0.5 * set.density * set.area * set.length * set.speed.powi(2);
                    rows.extend([
                        at_most(GROWTH, growth(&history.energy, start), 1e-13),
                        at_most("force error", figures.force_error, 0.12),
                        at_most("overshoot", figures.overshoot, 0.56),
                        Row::near(row("energy change"), figures.energy_change, -0.0025, 0.0025),
                        at_most("changes after the closing", figures.switches as f64, 1.0),
                        Row::near(row("restitution"), figures.restitution, 0.985, 0.015),
                        at_most("penetration / (v0 dt)", figures.penetration, 1e-12),
                    ]);
                    rows.extend(figures.balances(&name));
                }
            }
        }
        rows.extend(blocks()?);
        Ok(rows)
    },
};
