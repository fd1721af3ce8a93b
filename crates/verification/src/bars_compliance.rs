//! Bars with the compliance in velocity.
//!
//! Problem: set "slow", theta ½, CFL 0.5, lumped mass, n = 200; two equal bars with C_n = 10 ρ c, and one on a rigid wall
//! with C_n = ρ c and 10 ρ c. Closed solution: F = φ F0 for 2 L / c, φ = C_n / (C_n + Z), Z = ρ c / 2 between bars and ρ c on
//! a wall; energy lost 2 φ (1 - φ), on a wall 4 φ (1 - φ), all of it at C_n = Z. Reference: carom_exact, and the
//! project's table of bars in impact, from an independent implementation. Tolerance: a unit of the last digit printed;
//! the impulse 2 %, for the spread front; the loss 1 / (2 n) between bars and twice that on a wall, as much as the scheme
//! takes in a rigid impact. At C_n = 1e9 ρ c the compliance is the velocity law: 1e-6.

use carom_contact::law::Capture;
use carom_exact::closed_forms::{compliance_loss, compliance_loss_on_wall, compliance_ratio};

use crate::Error;
use crate::bars::{Against, Run};
use crate::build::compliance;
use crate::check::{Check, Row};
use crate::figures::run;

const ELEMENTS: usize = 200;

/// Two bars or one on a wall, with C_n = `part` ρ c.
fn case(part: f64, against: Against) -> Run {
    let base = Run::slow(ELEMENTS);
    Run {
        law: compliance(&base.set.material(), part, Capture::Half),
        against,
        ..base
    }
}

/// Rows of one run against the line of the table and the closed forms.
fn rows(part: f64, against: Against, printed: [&str; 7]) -> Result<Vec<Row>, Error> {
    let case = case(part, against);
    let (history, figures) = run(&case)?;
    let (name, impedance, loss_of, scheme): (_, f64, fn(f64) -> f64, _) = match against {
        Against::Bar => ("bars", 0.5, compliance_loss, 0.5),
        Against::Wall => ("wall", 1.0, compliance_loss_on_wall, 1.0),
    };
    let phi = compliance_ratio(part, impedance);
    let name = format!("{name}, C_n = {part} rho c");
    let impulse = case.dt() * history.force.iter().sum::<f64>();
    let expected = phi * case.force() * case.set.duration();
    let mut rows = figures.against(&name, printed);
    rows.push(Row::relative(
        format!("{name}: impulse, N s"),
        impulse,
        expected,
        0.02,
    ));
    rows.push(Row::near(
        format!("{name}: energy lost / E0"),
        -figures.energy_change,
        loss_of(phi),
        scheme / ELEMENTS as f64,
    ));
    rows.extend(figures.balances(&name));
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "bars-compliance",
    fact: "bars with the compliance in velocity agree with the table and with the closed forms of force and loss",
    run: |_| {
        let mut all = rows(
            10.0,
            Against::Bar,
            ["0.068", "", "-0.0912", "", "0.896", "", ""],
        )?;
        for (part, printed) in [
            (1.0, ["", "", "-0.9986", "", "0.012", "", ""]),
            (10.0, ["", "", "-0.330", "", "0.811", "", ""]),
        ] {
            all.extend(rows(part, Against::Wall, printed)?);
        }
        let (_, stiff) = run(&case(1e9, Against::Bar))?;
        let (_, rigid) = run(&Run::slow(ELEMENTS))?;
        for (what, value, reference) in [
            ("force error", stiff.force_error, rigid.force_error),
            ("energy change", stiff.energy_change, rigid.energy_change),
        ] {
            all.push(
                Row::near(
                    format!("bars, C_n = 1e9 rho c: {what} as with the velocity law"),
                    value,
                    reference,
                    1e-6,
                )
                .second_formulation(),
            );
        }
        Ok(all)
    },
};
