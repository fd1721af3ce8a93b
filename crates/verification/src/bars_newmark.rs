//! Two equal bars: Newmark's scheme with the displacement law.
//!
//! Problem: set "slow", all ends free, exact multiplier; the paper's three pairs (β, γ). Closed solution: F = Z v0 / 2
//! for 2 L / c. Reference: the project's table of bars in impact, from an independent implementation: n = 100 with
//! lumped mass at CFL 1, 2 and 4, and the paper's dt = 1e-5 s on n = 400 with consistent mass (CFL 2.08). Tolerance:
//! a unit of the last digit printed. Counts of changes hold
//! exactly. Below CFL 1 the law amplifies round-off: the table has orders of size only (force error above
//! 3, overshoot above 15, more than its energy gained), and what Carom finds is shown.

use carom_bodies::MassKind;

use crate::bars::{Run, SLOW};
use crate::build::{DISPLACEMENT, PAPER_SETS, newmark};
use crate::check::{Check, Row};
use crate::figures::run;

/// Force error, overshoot, energy change and changes at CFL 1, 2, 4 for each of the paper's sets.
const TABLE: [[[&str; 4]; 3]; 3] = [
    [
        ["1.77", "3.77", "10.9", "101"],
        ["1.42", "3.95", "1.27", "67"],
        ["0.758", "1.13", "0.0016", "15"],
    ],
    [
        ["0.709", "1.02", "0.0018", "59"],
        ["0.368", "0.516", "-0.0017", "3"],
        ["0.221", "0.436", "-0.0045", "1"],
    ],
    [
        ["0.175", "0.756", "-0.056", "1"],
        ["0.192", "0.517", "-0.079", "1"],
        ["0.228", "0.451", "-0.112", "1"],
    ],
];

/// Force error and overshoot at dt = 1e-5 s on 400 elements with consistent mass.
const PAPER: [[&str; 2]; 3] = [["0.656", "1.17"], ["0.204", "0.441"], ["0.126", "0.457"]];

pub(crate) const CHECK: Check = Check {
    name: "bars-newmark",
    fact: "two equal bars under Newmark's scheme and the displacement law agree with the table",
    run: |_| {
        let mut rows = Vec::new();
        for (k, [beta, gamma]) in PAPER_SETS.into_iter().enumerate() {
            let case = |courant| Run {
                scheme: newmark(beta, gamma),
                law: DISPLACEMENT,
                courant,
                ..Run::slow(100)
            };
            for (courant, [error, over, energy, changes]) in [1.0, 2.0, 4.0].iter().zip(TABLE[k]) {
                let name = format!("({beta}, {gamma}), CFL {courant}");
                let (_, figures) = run(&case(*courant))?;
                let printed = [error, over, energy, changes, "", "0.000", ""];
                rows.extend(figures.against(&name, printed));
                rows.extend(figures.balances(&name));
            }
            let paper = Run {
                elements: 400,
                mass: MassKind::Consistent,
                courant: 1e-5 * SLOW.wave_speed() / (SLOW.length / 400.0),
                ..case(1.0)
            };
            let name = format!("({beta}, {gamma}), dt 1e-5 s, consistent mass");
            let (_, figures) = run(&paper)?;
            let [error, over] = PAPER[k];
            rows.extend(figures.against(&name, [error, over, "", "", "", "", ""]));
            rows.extend(figures.balances(&name));
        }
        let below = Run {
            scheme: newmark(0.25, 0.5),
            law: DISPLACEMENT,
            ..Run::slow(100)
        };
        let (_, figures) = run(&below)?;
        let name = |column: &str| format!("(0.25, 0.5), CFL 0.5: {column}");
        rows.push(Row::shown(name("force error"), figures.force_error));
        rows.push(Row::shown(name("overshoot"), figures.overshoot));
        rows.push(Row::shown(name("energy change"), figures.energy_change));
        Ok(rows)
    },
};
