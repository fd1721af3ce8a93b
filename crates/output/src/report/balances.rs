//! Balances of energy and momentum.

use std::collections::BTreeMap;

use carom_pages::form::near;
use carom_pages::html::{each, exact, line, row, text};

use crate::summary::{Angular, Energy, Momentum, Summary};

/// The tables with their head.
pub(super) fn tables(summary: &Summary) -> String {
    let momentum = &summary.momentum;
    format!("\n<h2 id=\"balances\">Balances</h2>
<div class=\"columns\">
{}{}{}</div>
<p class=\"faint\">The residual is end − start − Σ terms. In a linear run every term has its own formula. In a nonlinear run the dissipation of the scheme is a difference (works minus changes of the energies), and the residual is the work of the forces that the iterations leave unbalanced.</p>
",
        energy(&summary.energy),
        linear(momentum),
        each(&momentum.angular, angular),
    )
}

fn energy(energy: &Energy) -> String {
    let joules = |label: &str, value: f64| row(label, exact(energy.shown(value))) + "\n";
    let terms = |sign: &str, terms: &BTreeMap<String, f64>| {
        each(terms, |(name, value)| {
            joules(&format!("{sign}{name}"), *value)
        })
    };
    [
        "<table>\n<thead><tr><th>Energy</th><th>J</th></tr></thead>\n<tbody>\n".to_owned(),
        joules("Kinetic, start", energy.kinetic_initial),
        joules("Strain, start", energy.strain_initial),
        terms("+ work of ", &energy.works),
        terms("− dissipated: ", &energy.dissipations),
        terms("− stored: ", &energy.stored),
        joules("Kinetic, end", energy.kinetic_final),
        joules("Strain, end", energy.strain_final),
        format!(
            "<tr class=\"sum\"><th scope=\"row\">Residual</th><td>{}</td></tr>\n",
            exact(energy.residual)
        ),
        row(
            "Largest residual / largest energy",
            exact(energy.relative_residual),
        ),
        "\n</tbody></table>\n".to_owned(),
    ]
    .concat()
}

/// A row of three components; those that are rounding beside the size are zero.
fn vector(label: &str, value: &[f64; 3], size: f64, class: &str) -> String {
    let cells = each(value, |part| {
        format!("<td>{}</td>", exact(near(*part, size)))
    });
    format!(
        "<tr class=\"{class}\"><th scope=\"row\">{}</th>{cells}</tr>\n",
        text(label)
    )
}

/// The rows from the start over the impulses to the end, and the residual.
fn vectors(
    [initial, last, residual]: [&[f64; 3]; 3],
    impulses: &BTreeMap<String, [f64; 3]>,
    size: f64,
) -> String {
    let impulse = |(name, impulse)| vector(&format!("+ {name}"), impulse, size, "");
    [
        vector("Start", initial, size, ""),
        each(impulses, impulse),
        vector("End", last, size, ""),
        vector("Residual", residual, 0.0, "sum"),
    ]
    .concat()
}

fn linear(momentum: &Momentum) -> String {
    let ends = [&momentum.initial, &momentum.r#final, &momentum.residual];
    let rows = vectors(ends, &momentum.impulses, momentum.size);
    format!(
        "<table>\n<thead><tr><th>Momentum</th><th>x, N s</th><th>y, N s</th><th>z, N s</th></tr></thead>\n<tbody>\n{rows}</tbody></table>\n"
    )
}

fn angular(angular: &Angular) -> String {
    let about = match angular.about == [0.0; 3] {
        true => "the origin".to_owned(),
        false => format!("({}) m", angular.about.map(exact).join(", ")),
    };
    let ends = [&angular.initial, &angular.r#final, &angular.residual];
    let rows = vectors(ends, &angular.impulses, angular.largest());
    let relative = exact(angular.relative_residual);
    let relative = line(
        "Largest residual, relative",
        &format!("<td>{relative}</td><td></td><td></td>"),
    );
    format!(
        "<table>\n<thead><tr><th>Angular momentum about {about}</th><th>x, N m s</th><th>y, N m s</th><th>z, N m s</th></tr></thead>\n<tbody>\n{rows}{relative}\n</tbody></table>\n"
    )
}
