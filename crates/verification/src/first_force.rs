//! The force of the first contact step, and the energy lost in it.
//!
//! Problem: a bar of the set "classic", in touch with an equal bar at rest or with a rigid wall, for one step. Closed
//! solutions: F1 / F0 = √(μ + β CFL²) / (β CFL) for Newmark with the displacement law, √(μ + θ² CFL²) / CFL for the
//! theta scheme with the velocity law, μ = 1/4 with lumped and 1/12 with consistent mass; energy lost by the theta
//! scheme in the impact step √(μ + θ² CFL²) / (2 n) between bars, twice that on a wall. Reference:
//! carom_exact::closed_forms. Tolerance: 1e-9. The forms hold for bars without end; what comes back from the far end
//! within a step falls by a factor per element that is at most 0.66 here (θ CFL = 2 or β CFL² = 8), less than 1e-18 in
//! 100 elements.

use carom_bodies::MassKind;
use carom_exact::closed_forms::{
    Mass, newmark_first_force, theta_first_force, theta_impact_loss, theta_impact_loss_on_wall,
};

use crate::Error;
use crate::bars::{Against, CLASSIC, Run};
use crate::build::{DISPLACEMENT, HALF, PAPER_SETS, newmark, theta};
use crate::check::{Check, Row};
use crate::figures::drive;

const TOLERANCE: f64 = 1e-9;

/// The first step of these bars: force / F0, and energy lost / E0.
fn first_step(run: Run) -> Result<[f64; 2], Error> {
    let (driver, history) = drive(&Run {
        end: run.dt() / run.set.duration(),
        ..run
    })?;
    let initial = driver.state().ledger.initial.energy();
    let lost = initial - history.energy[0];
    Ok([history.force[0] / run.force(), lost / initial])
}

pub(crate) const CHECK: Check = Check {
    name: "first-force",
    fact: "force and loss of the first contact step have their closed forms",
    run: |_| {
        let mut rows = Vec::new();
        for against in [Against::Bar, Against::Wall] {
            for (mass, kind) in [
                (Mass::Lumped, MassKind::Lumped),
                (Mass::Consistent, MassKind::Consistent),
            ] {
                for courant in [0.5, 1.0, 4.0] {
                    let base = Run {
                        set: CLASSIC,
                        against,
                        mass: kind,
                        courant,
                        ..Run::slow(100)
                    };
                    let name = format!("{against:?}, {mass:?}, CFL {courant}");
                    rows.extend(newmark_rows(&name, mass, base)?);
                    rows.extend(theta_rows(&name, mass, base)?);
                }
            }
        }
        Ok(rows)
    },
};

fn newmark_rows(name: &str, mass: Mass, base: Run) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for [beta, gamma] in PAPER_SETS {
        let [force, _] = first_step(Run {
            scheme: newmark(beta, gamma),
            law: DISPLACEMENT,
            ..base
        })?;
        let expected = newmark_first_force(mass, beta, base.courant);
        let name = format!("{name}, Newmark ({beta}, {gamma}): F1/F0");
        rows.push(Row::relative(name, force, expected, TOLERANCE));
    }
    Ok(rows)
}

fn theta_rows(name: &str, mass: Mass, base: Run) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    for value in [0.5, 0.75, 1.0] {
        let [force, loss] = first_step(Run {
            scheme: theta(value),
            law: HALF,
            ..base
        })?;
        let name = format!("{name}, theta {value}");
        let expected = theta_first_force(mass, value, base.courant);
        rows.push(Row::relative(
            format!("{name}: F1/F0"),
            force,
            expected,
            TOLERANCE,
        ));
        let closed = match base.against {
            Against::Bar => theta_impact_loss,
            Against::Wall => theta_impact_loss_on_wall,
        };
        let expected = closed(mass, value, base.courant, base.elements);
        rows.push(Row::relative(
            format!("{name}: energy lost / E0"),
            loss,
            expected,
            TOLERANCE,
        ));
    }
    Ok(rows)
}
