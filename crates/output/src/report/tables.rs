//! Expectations, impacts, springs, bolts, loads, and the distance from an exact solution.

use carom_pages::form::near;
use carom_pages::html::{cells, code, each, line, percent, quantity, text, when, wide};

use crate::ImpactRow;
use crate::expectations::{Expectations, MISSED};
use crate::report::contacts::joules;
use crate::summary::Summary;

/// What the case must give, with what the run gave.
pub(super) fn expectations(summary: &Summary) -> String {
    let Some(expectations) = &summary.expectations else {
        return String::new();
    };
    let rows = each(Expectations::told(expectations), |row| {
        let met = match row.met {
            MISSED => "<b class=\"bad\">missed</b>".to_owned(),
            met => met.to_owned(),
        };
        let reason = when(!row.reason.is_empty(), || {
            format!(" Tolerance: {}", text(&row.reason))
        });
        let shown = [
            format!("<code>{}</code>", text(&row.quantity)),
            text(&row.expected),
            text(&row.tolerance),
            text(&row.found),
            text(&row.difference),
            met,
            text(row.kind),
        ];
        let source = format!("<td class=\"text\">{}{reason}</td>", text(&row.source));
        line(&row.name, &(cells(&shown) + &source))
    });
    let names = [
        "",
        "Quantity",
        "Expected",
        "Tolerance",
        "Found",
        "Difference",
        "",
        "Kind",
        "Source",
    ];
    let unjudged = each(&expectations.unjudged, |why| {
        format!("The rows are not judged: {}. ", code(why))
    });
    let table = wide(true, &names, &rows);
    format!(
        "\n<h2 id=\"expectations\">Expectations</h2>\n{table}<p class=\"faint\">What the case file says that a run of it gives. {unjudged}Closed form: an exact solution, an identity or a conservation law. Second formulation: another scheme, law or mesh of Carom. Regression: a figure that Carom itself gave; it shows that nothing has changed, not that it is right.</p>\n"
    )
}

/// The impacts, in their order.
pub(super) fn impacts(summary: &Summary, impacts: &[ImpactRow]) -> String {
    let joules = |energy: f64| joules(summary, energy);
    let Some(first) = impacts.first() else {
        return String::new();
    };
    let rows = each(impacts, |impact| {
        let given = impact
            .energy_given
            .map(|energy| summary.energy.shown(energy));
        let shown = [
            quantity(impact.start, "s"),
            quantity(impact.duration, "s"),
            quantity(impact.peak_force, "N"),
            impact.peak_steps.to_string(),
            quantity(impact.peak_mean_force, "N"),
            quantity(impact.impulse, "N s"),
            quantity(impact.approach_speed, "m/s"),
            quantity(impact.rebound_speed, "m/s"),
            quantity(impact.restitution, ""),
            quantity(given, "J"),
            joules(impact.energy_taken),
            joules(impact.energy_lost),
            joules(impact.energy_crushed),
            joules(impact.friction_loss),
            quantity(impact.impulsive, "N s"),
            impact.intervals.to_string(),
        ];
        line(&impact.pair, &cells(&shown))
    });
    let names = [
        "Contact",
        "Start",
        "Duration",
        "Peak force",
        "Its steps",
        "Peak mean",
        "Impulse",
        "Approach",
        "Rebound",
        "Restitution",
        "Given",
        "Taken up",
        "Lost",
        "In crush",
        "In friction",
        "Separate impulses",
        "Intervals",
    ];
    let all: usize = summary
        .contacts
        .values()
        .map(|contact| contact.impacts)
        .sum();
    let hidden = match all.saturating_sub(impacts.len()) {
        0 => String::new(),
        hidden => format!("{hidden} further impacts are in impacts.csv. "),
    };
    let table = wide(true, &names, &rows);
    let window = quantity(first.window, "s");
    format!(
        "\n<h2 id=\"impacts\">Impacts</h2>\n{table}<p class=\"faint\">{hidden}Its steps: steps of the closed interval that holds the peak; peaks of fewer than ten are those of the step. Peak mean: largest mean of the force over {window}. Given: kinetic energy of the approach, ½ m w² with the reduced mass. Taken up: the most energy that the contact has taken at one time. Lost: minus the work of the contact forces; in crush: the part of it that stops do not give back. Separate impulses: the part of the impulse that a projection or another stage after a step applies; no force contains it. Intervals: number of closed intervals of the contact within the impact, which ends with a flight longer than the time in which a wave crosses the body. Restitution is empty if something other than the contact also changes the momenta of the bodies.</p>\n"
    )
}

/// Springs and dashpots.
pub(super) fn discrete(summary: &Summary) -> String {
    let rows = each(&summary.discrete, |(name, element)| {
        let unit = if element.kind == "spring" { "m" } else { "m/s" };
        let shown = [
            text(&element.kind),
            quantity(element.peak_force, "N"),
            quantity(element.time, "s"),
            quantity(element.extent, unit),
        ];
        line(name, &cells(&shown))
    });
    when(!summary.discrete.is_empty(), || {
        let names = ["", "", "Largest force", "at", "Largest elongation, or rate"];
        let table = wide(false, &names, &rows);
        format!("\n<h2>Springs and dashpots</h2>\n{table}")
    })
}

/// Bolts that the static stage tightens.
pub(super) fn bolts(summary: &Summary) -> String {
    let rows = each(&summary.pretensions, |(name, bolt)| {
        let pair = |pair: Option<[f64; 2]>| {
            [
                quantity(pair.map(|pair| pair[0]), "N"),
                quantity(pair.map(|pair| pair[1]), "s"),
            ]
        };
        let [largest, smallest] = [pair(bolt.largest), pair(bolt.smallest)];
        let shown = [
            &[quantity(bolt.end_of_stage, "N")][..],
            &largest,
            &smallest,
            &[quantity(bolt.last, "N"), percent(bolt.loss)],
        ];
        line(name, &cells(&shown.concat()))
    });
    when(!summary.pretensions.is_empty(), || {
        let names = [
            "",
            "Preload",
            "Largest force",
            "at",
            "Smallest force",
            "at",
            "At the end",
            "Preload lost",
        ];
        let table = wide(false, &names, &rows);
        format!(
            "\n<h2>Bolts</h2>\n{table}<p class=\"faint\">Preload: at the end of the static stage, which tightens the bolts. The other forces are of the dynamics, at the ends of the steps.</p>\n"
        )
    })
}

/// Loads on surfaces and at nodes.
pub(super) fn loads(summary: &Summary) -> String {
    let rows = each(&summary.loads, |(name, load)| {
        let size = load
            .impulse
            .iter()
            .fold(0.0, |most: f64, part| most.max(part.abs()));
        let parts = &load.impulse[..summary.model.dimension];
        let parts = parts.iter().map(|part| quantity(near(*part, size), "N s"));
        let shown = [
            quantity(load.peak_force, "N"),
            quantity(load.time, "s"),
            parts.collect::<Vec<_>>().join(", "),
        ];
        line(name, &cells(&shown))
    });
    when(!summary.loads.is_empty(), || {
        let table = wide(false, &["", "Largest force", "at", "Impulse"], &rows);
        format!(
            "\n<h2>Loads</h2>\n{table}<p class=\"faint\">Total force on the bodies at the ends of the steps; impulse over the dynamics by the trapezoidal rule, along the axes. Gravity and accelerations of the ground are not in the table.</p>\n"
        )
    })
}

/// The distance from the exact solution.
pub(super) fn exact(summary: &Summary) -> String {
    let Some(exact) = &summary.exact else {
        return String::new();
    };
    let force = quantity(exact.peak_force, "N");
    let rows = [
        (
            "Contact force, relative L² error",
            percent(exact.force_error),
            String::new(),
        ),
        (
            "Displacement of the contact points, relative L² error",
            percent(exact.displacement_error),
            String::new(),
        ),
        (
            "Peak force of a single step, overshoot",
            percent(exact.overshoot),
            force.clone(),
        ),
        (
            "Peak of the mean force, overshoot",
            percent(exact.mean_overshoot),
            force,
        ),
        (
            "Impulse, error",
            percent(exact.impulse_error),
            quantity(exact.impulse, "N s"),
        ),
        (
            "Restitution",
            quantity(exact.restitution, ""),
            quantity(exact.exact_restitution, ""),
        ),
    ];
    let rows = each(rows, |(label, found, exact)| {
        line(label, &cells(&[found, exact]))
    });
    let between = format!("{} against {}", text(&exact.contact), text(&exact.name));
    let table = wide(false, &[between.as_str(), "", "exact"], &rows);
    format!("\n<h2 id=\"exact\">Against the exact solution</h2>\n{table}")
}
