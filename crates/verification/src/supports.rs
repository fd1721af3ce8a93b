//! Forces of the supports under every scheme.
//!
//! Problem: a bar of the set "slow" strikes an equal one, n = 20, lumped mass, CFL 0.5, under gravity along the bars; the
//! target is held at its far end, or at the end that is struck. Closed solution: the momentum that bars and obstacles
//! exchange, and the exact energy identity of the scheme. Reference: the ledger's own terms, each from its formula.
//! Tolerance: 1e-11 of the largest energy and of the largest momentum, round-off.

use carom_contact::law::Level;
use carom_dynamics::{Driver, Scheme, march};

use crate::Error;
use crate::bars::{Run, SLOW};
use crate::build::{DISPLACEMENT, NOW, support};
use crate::check::{Check, Row};

fn rows(scheme: Scheme, end: &str) -> Result<[Row; 3], Error> {
    let law = match scheme.get().takes(Level::Gap) {
        true => DISPLACEMENT,
        false => NOW,
    };
    let case = Run {
        scheme,
        law,
        ..Run::slow(20)
    };
    let mut model = case.model()?;
    let held = support(&model.mesh, end, [true, false, false])?;
    model.supports.push(held);
    model.gravity = [1e3, 0.0, 0.0];
    let mut driver = Driver::new(crate::witness::system(model)?)?;
    march(&mut driver, SLOW.duration(), &mut [], &|| false)?;
    let ledger = &driver.state().ledger;
    let row = |what: &str| format!("{scheme:?}, {end}: {what}");
    Ok([
        Row::at_most(
            row("energy residual / largest"),
            ledger.largest_energy_residual / ledger.largest_energy,
            1e-11,
        ),
        Row::at_most(
            row("momentum residual / largest"),
            ledger.largest_momentum_residual / ledger.largest_momentum,
            1e-11,
        ),
        Row::at_least(
            row("impulse of the supports / largest"),
            ledger.balance.impulse_supports.largest() / ledger.largest_momentum,
            0.1,
        ),
    ])
}

pub(crate) const CHECK: Check = Check {
    name: "supports",
    fact: "under every scheme the forces of the supports close the balance of momentum",
    run: |_| {
        let mut all = Vec::new();
        for scheme in Scheme::registered() {
            for end in ["target.right", "target.left"] {
                all.extend(rows(scheme, end)?);
            }
        }
        Ok(all)
    },
};
