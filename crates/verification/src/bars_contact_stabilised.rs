//! Two equal bars, a bar on a wall, and two blocks under the contact-stabilised Newmark scheme.
//!
//! Problem: set "slow", all ends free, lumped and consistent mass, CFL 0.25 to 4; two blocks with meshes that do not
//! match, paired once. Closed solution: F = Z v0 / 2 (Z v0 on the wall) for 2 L / c; the energy never grows, which is
//! proved from the two complementarities of the step; so the restitution is at most one; no penetration. Reference: the exact
//! solution; no other implementation was at hand. The front is spread as in two bars under theta (see `bars-convergence`): the
//! force errs by n^-1/3, 1 - restitution by n^-2/3, and the energy lost, that of the end nodes, is like 1/n. From n = 100 to 200
//! three quarters of each exponent are asked for. The overshoot does not converge and is shown. Tolerance: 1e-11 of the energy
//! for the balances, 1e-13 for what a step may gain by rounding.

use carom_bodies::MassKind;
use carom_contact::Sliding;
use carom_dynamics::scheme::ContactStabilised;
use carom_dynamics::{Driver, Scheme};

use crate::Error;
use crate::bars::{Against, Run};
use crate::blocks::SMALLEST;
use crate::build::DISPLACEMENT;
use crate::check::{Check, Row};
use crate::figures::{converging, run};

const SCHEME: Scheme = Scheme::ContactStabilised(ContactStabilised {});

const GROWTH: &str = "growth of the energy in a step / E0";

/// Largest growth of the energy in a step, over its start.
fn growth(energy: &[f64], start: f64) -> f64 {
    let before = std::iter::once(&start).chain(energy);
    let steps = before.zip(energy).map(|(one, other)| other - one);
    steps.fold(0.0, f64::max) / start
}

fn blocks() -> Result<[Row; 2], Error> {
    let system = crate::witness::system(SMALLEST.model(SCHEME, DISPLACEMENT, Sliding::Small)?)?;
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

/// What one mesh leaves: error of the force, loss of speed, loss of energy.
fn bars(case: &Run, rows: &mut Vec<Row>) -> Result<[f64; 3], Error> {
    let (history, figures) = run(case)?;
    let Run { elements, set, .. } = *case;
    let name = format!("{}, n = {elements}", case.name());
    let row = |what: &str| format!("{name}: {what}");
    let start = 0.5 * set.density * set.area * set.length * set.speed.powi(2);
    rows.extend([
        Row::at_most(row(GROWTH), growth(&history.energy, start), 1e-13),
        Row::shown(row("overshoot"), figures.overshoot),
        Row::count(row("changes after the closing"), figures.switches, 1),
        Row::at_most(row("restitution"), figures.restitution, 1.0),
        Row::at_most(row("penetration / (v0 dt)"), figures.penetration, 1e-12),
    ]);
    rows.extend(figures.balances(&name));
    Ok([
        figures.force_error,
        1.0 - figures.restitution,
        -figures.energy_change,
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
                        ..Run::slow(100)
                    };
                    rows.extend(converging(&case, bars)?);
                }
            }
        }
        rows.extend(blocks()?);
        Ok(rows)
    },
};
