//! Two equal bars: how the figures fall with the mesh.
//!
//! Problem: set "slow", theta ½, velocity law, CFL 0.5, n elements in each bar. Closed solution: the exact force jumps,
//! and the front that travels through a bar of elements spreads over a width that grows as the cube root of the
//! distance in elements; so the force errs by n^-1/3 or so in the mean square, impulse and restitution by n^-2/3.
//! Reference: the project's table: force error like n^-0.36, 1 - restitution = 0.0251, 0.0155, 0.0096, 0.0060 for n = 50
//! to 400, like n^-0.69; impulse like n^-0.69, energy like 1/n. Tolerance: a unit of the last digit; 0.03 for the exponents,
//! fitted to the two ends of the range, whose local value drifts by that much over it. The overshoot does not converge: 0.118
//! for every n, and 0.091 after two steps.
//! Sizes: quick n = 50 and 100, full to 400.

use crate::Error;
use crate::bars::Run;
use crate::check::{Check, Row, Size};
use crate::figures::run;
use crate::kind::Kind;

pub(crate) const CHECK: Check = Check {
    name: "bars-convergence",
    fact: "the force error of two bars falls like n^-0.36, the restitution's like n^-0.69",
    run: |size| match size {
        Size::Quick => rows(&[(50, "0.0251"), (100, "0.0155")]),
        Size::Full => rows(&[
            (50, "0.0251"),
            (100, "0.0155"),
            (200, "0.0096"),
            (400, "0.0060"),
        ]),
    },
};

fn rows(table: &[(usize, &str)]) -> Result<Vec<Row>, Error> {
    let mut rows = Vec::new();
    let [mut errors, mut losses, mut energies, mut impulses] = [const { Vec::new() }; 4];
    for &(elements, printed) in table {
        let case = Run::slow(elements);
        let (history, figures) = run(&case)?;
        let name = |quantity: &str| format!("n = {elements}: {quantity}");
        let loss = 1.0 - figures.restitution;
        rows.push(Row::printed(
            Kind::OtherCode,
            name("1 - restitution"),
            loss,
            printed,
        ));
        rows.push(Row::printed(
            Kind::OtherCode,
            name("overshoot"),
            figures.overshoot,
            "0.118",
        ));
        let later = history.force[2..].iter().fold(0.0_f64, |m, f| m.max(*f)) / case.force() - 1.0;
        rows.push(Row::printed(
            Kind::OtherCode,
            name("overshoot after two steps"),
            later,
            "0.091",
        ));
        let impulse = history.force.iter().sum::<f64>() * case.dt();
        impulses.push(1.0 - impulse / (case.force() * case.set.duration()));
        energies.push(-figures.energy_change);
        errors.push(figures.force_error);
        losses.push(loss);
    }
    let last = table.len() - 1;
    let doublings = (table[last].0 as f64 / table[0].0 as f64).ln();
    let exponent = |values: &[f64]| (values[last] / values[0]).ln() / doublings;
    for (name, values, expected) in [
        ("the force error", &errors, -0.36),
        ("1 - restitution", &losses, -0.69),
        ("the impulse error", &impulses, -0.69),
        ("the energy lost", &energies, -1.0),
    ] {
        let row = Row::near(
            format!("exponent of {name}"),
            exponent(values),
            expected,
            0.03,
        );
        // that of the energy is in closed form
        rows.push(if expected == -1.0 {
            row
        } else {
            row.other_code()
        });
    }
    Ok(rows)
}
