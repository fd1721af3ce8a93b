//! Two equal bars: the trapezoid with the displacement law and projection at closure.
//!
//! Problem: set "slow", all ends free, lumped mass at CFL 0.25 to 4, and consistent mass; an exact multiplier with
//! projection of velocity and acceleration where points close. Closed solution: F = Z v0 / 2 for 2 L / c; the impact of
//! the two end nodes loses 1 / (4 n) of the energy and no later step any. Reference: the project's table of bars in
//! impact, n = 200 at CFL 0.5, from an independent implementation; the first force of [`crate::first_force`], which the
//! projection follows and does not change. Tolerance: a unit of the last digit printed; 1e-10 for the persistency defect,
//! which is round-off that the trapezoid does not damp; 1e-6 for the loss, whose formula is exact but for the step of the
//! release.

use carom_bodies::MassKind;

use crate::bars::Run;
use crate::build::{PROJECTION, newmark};
use crate::check::{Check, Row};
use crate::figures::run;
use crate::kind::Kind;

pub(crate) const CHECK: Check = Check {
    name: "bars-projection",
    fact: "with projection at closure the trapezoid keeps contact under the displacement law, at any step",
    run: |_| {
        let case = Run {
            scheme: newmark(0.25, 0.5),
            law: PROJECTION,
            ..Run::slow(200)
        };
        let (history, figures) = run(&case)?;
        let name = "CFL 0.5";
        let mut rows = figures.against(name, ["0.132", "3.47", "", "", "0.990", "0.000", ""]);
        rows.extend(figures.balances(name));
        let later = history.force[2..].iter().fold(0.0_f64, |m, f| m.max(*f));
        rows.push(Row::printed(
            Kind::OtherCode,
            format!("{name}: overshoot after the second step"),
            later / case.force() - 1.0,
            "0.117",
        ));
        rows.push(Row::near(
            format!("{name}: energy change"),
            figures.energy_change,
            -1.0 / (4.0 * case.elements as f64),
            1e-6,
        ));
        for mass in [MassKind::Lumped, MassKind::Consistent] {
            for courant in [0.25, 0.5, 1.0, 2.0, 4.0] {
                let case = Run {
                    courant,
                    mass,
                    elements: 100,
                    ..case
                };
                let (_, figures) = run(&case)?;
                let name = format!("n = 100, {mass:?}, CFL {courant}");
                let at_most = |what: &str, value, bound| {
                    Row::at_most(format!("{name}: {what}"), value, bound)
                };
                rows.push(at_most("largest |F rate| / (F0 v0)", figures.defect, 1e-10));
                rows.push(at_most("energy change", figures.energy_change, 0.0));
                rows.push(Row::count(
                    format!("{name}: changes after the closing"),
                    figures.switches,
                    1,
                ));
                rows.extend(figures.balances(&name));
            }
        }
        Ok(rows)
    },
};
