//! Two equal bars: central differences with the velocity law (CD-Lagrange).
//!
//! Problem: set "slow", all ends free, lumped mass, n = 200, CFL 0.9. Closed solution: F = Z v0 / 2 for 2 L / c; the
//! impact takes from the two end masses, ρ A h / 2 each at v0 and 0, the kinetic energy of their relative motion,
//! which is 1/(4 n) of the striker's. Reference: the project's table of bars in impact, and Fekak, Brun, Gravouil,
//! Depale (2017) for the scheme. Tolerance: a unit of the last digit printed; the loss, which is exact in the
//! energy that the scheme balances (kinetic + strain - dt²/8 |a|²_M), and the penetration v0 dt to round-off, 1e-11.

use crate::bars::Run;
use crate::build::{CENTRAL, NOW};
use crate::check::{Check, Row};
use crate::figures::run;

pub(crate) const CHECK: Check = Check {
    name: "bars-central-difference",
    fact: "two equal bars under central differences and the velocity law lose 1/(4 n) of their energy",
    run: |_| {
        let case = Run {
            scheme: CENTRAL,
            law: NOW,
            courant: 0.9,
            ..Run::slow(200)
        };
        let (_, figures) = run(&case)?;
        let name = "CFL 0.9";
        let mut rows = figures.against(name, ["0.0293", "0.071", "", "1", "", "1.00", ""]);
        rows.extend(figures.balances(name));
        let loss = 1.0 / (4.0 * case.elements as f64);
        rows.push(Row::near(
            "CFL 0.9: change of the energy that the scheme balances",
            figures.balanced_change,
            -loss,
            1e-11,
        ));
        rows.push(Row::near(
            "CFL 0.9: penetration / (v0 dt), exactly",
            figures.penetration,
            1.0,
            1e-11,
        ));
        rows.push(Row::at_most(
            "CFL 0.9: largest |F rate| / (F0 v0)",
            figures.defect,
            1e-12,
        ));
        Ok(rows)
    },
};
