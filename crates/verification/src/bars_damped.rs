//! Two equal bars: the trapezoid with the damped law.
//!
//! Problem: set "slow", all ends free, lumped mass, n = 200, CFL 0.5, k_p = E / h, C_n a multiple of ρ c. Closed
//! solution: F = Z v0 / 2 for 2 L / c. Reference: the project's table of bars in impact, from an independent
//! implementation; the law with tension cut off ("clip"), and as the equation is printed. Tolerance: a unit of
//! the last digit printed.

use carom_contact::law::Adhesion;

use crate::bars::Run;
use crate::build::{damped, newmark};
use crate::check::{Check, Row};
use crate::figures::run;

/// C_n / (ρ c), whether tension is cut off, and the line of the table.
const TABLE: [(f64, Adhesion, [&str; 7]); 7] = [
    (
        0.5,
        Adhesion::Clip,
        ["0.0427", "0.197", "-0.00083", "", "0.9924", "1.06", "0.23"],
    ),
    (
        0.0,
        Adhesion::AsPrinted,
        ["0.309", "0.447", "", "", "0.993", "", ""],
    ),
    (
        0.1,
        Adhesion::AsPrinted,
        ["0.047", "0.248", "", "", "0.993", "", ""],
    ),
    (
        5.0,
        Adhesion::AsPrinted,
        ["0.084", "0.931", "", "", "0.982", "", ""],
    ),
    (
        50.0,
        Adhesion::AsPrinted,
        ["0.252", "1.77", "", "", "0.827", "", ""],
    ),
    (
        5.0,
        Adhesion::Clip,
        ["0.065", "0.931", "", "", "0.990", "", ""],
    ),
    (
        50.0,
        Adhesion::Clip,
        ["0.124", "1.20", "", "", "0.9885", "", ""],
    ),
];

pub(crate) const CHECK: Check = Check {
    name: "bars-damped",
    fact: "two equal bars under the trapezoid and the damped law agree with the table",
    run: |_| {
        let mut rows: Vec<Row> = Vec::new();
        for (part, adhesion, printed) in TABLE {
            let base = Run::slow(200);
            let size = base.set.length / base.elements as f64;
            let case = Run {
                scheme: newmark(0.25, 0.5),
                law: damped(&base.set.material(), size, part, adhesion),
                ..base
            };
            let how = match adhesion {
                Adhesion::Clip => "clip",
                Adhesion::AsPrinted => "as printed",
            };
            let name = format!("C_n = {part} rho c, {how}");
            let (_, figures) = run(&case)?;
            rows.extend(figures.against(&name, printed));
            rows.extend(figures.balances(&name));
        }
        Ok(rows)
    },
};
