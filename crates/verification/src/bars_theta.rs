//! Two equal bars: the theta scheme with the velocity law.
//!
//! Problem: set "slow", the striker at v0 in touch with an equal bar at rest, all ends free, lumped mass. Closed
//! solution: F = Z v0 / 2 for 2 L / c, then the striker rests and the other flies on. Reference: the project's table
//! of bars in impact, from an independent implementation, n = 200 in each bar. Tolerance: a unit of the last digit
//! printed there, since the scheme has one answer to round-off; what is zero in theory is held to a multiple of
//! round-off (energy identity 1e-11 of the initial energy, persistency 1e-12 of F0 v0); the
//! release within 1 % of the duration, 4 elements of 400 on the way of the front, over which it spreads.

use crate::bars::Run;
use crate::build::{HALF, NOW, theta};
use crate::check::{Check, Row};
use crate::figures::run;

pub(crate) const CHECK: Check = Check {
    name: "bars-theta",
    fact: "two equal bars under the theta scheme and the velocity law agree with the table",
    run: |_| {
        let half = |courant| Run {
            courant,
            law: HALF,
            ..Run::slow(200)
        };
        let now = |value| Run {
            scheme: theta(value),
            law: NOW,
            ..Run::slow(200)
        };
        let table = [
            (
                "theta 0.5, CFL 0.5",
                half(0.5),
                ["0.0470", "0.118", "-0.001398", "1", "0.9904", "0.500", ""],
            ),
            (
                "theta 0.5, CFL 1",
                half(1.0),
                ["0.0496", "0.0607", "-0.001768", "1", "0.9879", "0.500", ""],
            ),
            (
                "theta 0.75, CFL 0.5",
                now(0.75),
                ["0.107", "0.25", "-0.0315", "1", "0.960", "0.250", ""],
            ),
            (
                "theta 1, CFL 0.5",
                now(1.0),
                ["0.130", "0.414", "-0.0445", "1", "0.944", "0.000", ""],
            ),
        ];
        let mut rows = Vec::new();
        for (name, case, printed) in table {
            let (_, figures) = run(&case)?;
            rows.extend(figures.against(name, printed));
            rows.extend(figures.balances(name));
            let defect = format!("{name}: largest |F rate| / (F0 v0)");
            rows.push(Row::at_most(defect, figures.defect, 1e-12));
            let release = format!("{name}: release / exact duration");
            rows.push(Row::near(release, figures.release, 1.0, 0.01));
        }
        Ok(rows)
    },
};
