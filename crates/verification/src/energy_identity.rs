//! The balances of energy and momentum of every scheme with every law.
//!
//! Problem: two bars of the set "slow", n = 50, CFL 0.5, lumped and consistent mass, to 1.5 times the exact contact; each
//! registered scheme, and the paper's parameters, with each law. Closed solution: the exact energy identity of the
//! scheme, and the momentum that the two bars exchange. Reference: the ledger's own terms, each from its formula; for
//! theta ½ besides the work Σ F (g₊ - g) summed here from the history. Tolerance: 1e-11 of the largest energy and of the
//! largest momentum of the run (the displacement law under the trapezoid at this step multiplies the energy).

use carom_bodies::MassKind;
use carom_dynamics::Scheme;
use carom_dynamics::scheme::{
    GeneralisedAlpha, Hht, Kane, Krenk, NonsmoothAlpha, PaoliSchatzman, TchamwaWielgosz,
};

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::battery::{is_senseless, laws};
use crate::build::{PAPER_SETS, newmark, theta};
use crate::check::{Check, Row};
use crate::figures::drive;

const ELEMENTS: usize = 50;
const TOLERANCE: f64 = 1e-11;

/// Σ F (g₊ - g) of theta ½ against the energy that is gone.
fn work_of_history() -> Result<Row, Error> {
    let (driver, history) = drive(&Run::slow(ELEMENTS))?;
    let mut gap = 0.0;
    let mut work = 0.0;
    for (force, next) in history.force.iter().zip(&history.gap) {
        work += force * (next - gap);
        gap = *next;
    }
    let ledger = &driver.state().ledger;
    let change = ledger.balance.energy() - ledger.initial.energy();
    let difference = (change - work) / ledger.initial.energy();
    Ok(Row::near(
        "theta 0.5: (energy change - sum F dg) / E0",
        difference,
        0.0,
        TOLERANCE,
    ))
}

/// Other parameters of schemes whose terms depend on them.
fn more() -> Vec<Scheme> {
    let alpha = |rho_inf| Scheme::GeneralisedAlpha(GeneralisedAlpha { rho_inf });
    vec![
        alpha(0.0),
        alpha(0.5),
        alpha(1.0),
        Scheme::Hht(Hht { alpha: -1.0 / 3.0 }),
        Scheme::TchamwaWielgosz(TchamwaWielgosz { phi: 1.3 }),
        Scheme::Krenk(Krenk { rho_inf: 0.0 }),
        Scheme::Krenk(Krenk { rho_inf: 1.0 }),
        Scheme::NonsmoothAlpha(NonsmoothAlpha { rho_inf: 0.0 }),
        Scheme::NonsmoothAlpha(NonsmoothAlpha { rho_inf: 1.0 }),
        Scheme::PaoliSchatzman(PaoliSchatzman { restitution: 1.0 }),
        Scheme::Kane(Kane {
            beta: 0.49,
            gamma: 0.9,
        }),
        Scheme::Kane(Kane {
            beta: 0.5,
            gamma: 0.5,
        }),
    ]
}

pub(crate) const CHECK: Check = Check {
    name: "energy-identity",
    fact: "every scheme with every law keeps its energy identity and the momentum",
    run: |_| {
        let mut schemes = Scheme::registered();
        schemes.extend(PAPER_SETS.map(|[beta, gamma]| newmark(beta, gamma)));
        schemes.push(theta(1.0));
        schemes.extend(more());
        let mut rows = vec![work_of_history()?];
        for scheme in schemes {
            for (law_name, law) in laws(&SLOW.material(), SLOW.length / ELEMENTS as f64, SLOW.area)?
            {
                for mass in [MassKind::Lumped, MassKind::Consistent] {
                    let consistent = mass == MassKind::Consistent;
                    if is_senseless(scheme, law) || consistent && scheme.get().needs_lumped_mass() {
                        continue; // refused; see the battery of resumed runs
                    }
                    let case = Run {
                        scheme,
                        law,
                        mass,
                        ..Run::slow(ELEMENTS)
                    };
                    let (driver, _) = drive(&case)?;
                    let ledger = &driver.state().ledger;
                    let energy = ledger.largest_energy_residual / ledger.largest_energy;
                    let momentum = ledger.largest_momentum_residual / ledger.largest_momentum;
                    let name = format!("{scheme:?}, {law_name}, {mass:?}");
                    rows.push(Row::at_most(format!("{name}: energy"), energy, TOLERANCE));
                    rows.push(Row::at_most(
                        format!("{name}: momentum"),
                        momentum,
                        TOLERANCE,
                    ));
                }
            }
        }
        Ok(rows)
    },
};
