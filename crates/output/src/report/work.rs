//! Zones, quality of the mesh, and the model with the work done on it.

use carom_pages::html::{bytes, cells, each, exact, line, quantity, row, text, when, wide};

use crate::results::BodyQuality;
use crate::summary::{Counts, Link, Model, Newton, Summary, Time, Zone, Zones};

/// Bodies that are named; of more their number is told.
const NAMED: usize = 8;

/// Zones and links of a run in zones.
pub(super) fn zones(summary: &Summary) -> String {
    let Some(zones) = &summary.zones else {
        return String::new();
    };
    let names = [
        "Zone",
        "Scheme",
        "Step",
        "Steps per outer step",
        "Bodies",
        "Elements",
        "Unknowns",
        "Courant",
        "Work of links, J",
        "Largest residual, J",
        "Factorisations",
        "Element updates",
        "Solves",
    ];
    let table = wide(false, &names, &each(&zones.zones, zone));
    let links = when(!zones.links.is_empty(), || links(zones));
    format!("\n<h2>Zones and links</h2>\n{table}{links}")
}

fn zone(zone: &Zone) -> String {
    let costs = zone.costs.as_ref();
    let count = |count: Option<u64>| count.map_or(String::new(), |count| count.to_string());
    let shown = [
        text(&zone.scheme),
        quantity(zone.step, "s"),
        zone.substeps.to_string(),
        text(&zone.bodies.join(", ")),
        zone.elements.to_string(),
        zone.unknowns.to_string(),
        quantity(zone.courant, ""),
        exact(zone.work_of_links),
        exact(costs.map(|costs| costs.largest_residual)),
        count(costs.map(|costs| costs.factorisations)),
        count(costs.map(|costs| costs.element_updates)),
        count(costs.map(|costs| costs.solves)),
    ];
    line(&zone.name, &cells(&shown))
}

fn links(zones: &Zones) -> String {
    let link = |link: &Link| {
        let [inner, outer] = &link.zones;
        let shown = [
            text(inner),
            text(outer),
            link.rows.to_string(),
            exact(link.work),
        ];
        line(&link.name, &cells(&shown))
    };
    let names = ["Link", "Inner zone", "Outer zone", "Constraints", "Work, J"];
    let table = wide(false, &names, &each(&zones.links, link));
    format!(
        "{table}<p class=\"faint\">Energy that all links together gave to the zones: {} J, {} of the initial energy. Mean number of passes over an outer step: {}.</p>\n",
        exact(zones.work_of_links),
        exact(zones.relative_work_of_links),
        exact(zones.passes_per_step)
    )
}

/// Quality of the cells.
pub(super) fn quality(summary: &Summary, bodies: &[BodyQuality]) -> String {
    let rows = each(bodies, |body| {
        let place = &body.place[..summary.model.dimension];
        let place: Vec<String> = place.iter().map(|x| quantity(*x, "m")).collect();
        let shown = [
            body.cells.to_string(),
            quantity(body.least, ""),
            quantity(body.mean, ""),
            text(&body.worst),
            place.join(", "),
            quantity(body.edges, ""),
        ];
        line(&body.body, &cells(&shown))
    });
    let names = [
        "Body",
        "Cells",
        "Least scaled Jacobian",
        "Mean",
        "Worst cell",
        "Its middle",
        "Longest over shortest edge",
    ];
    when(!bodies.is_empty(), || {
        let table = wide(false, &names, &rows);
        format!(
            "\n<h2 id=\"quality\">Quality of the mesh</h2>\n{table}<p class=\"faint\">Scaled Jacobian: determinant of the unit vectors along the edges in a corner over that of the regular element, least over the corners. 1 is regular, 0 or less is flat or inverted. The model above can be coloured by it.</p>\n"
        )
    })
}

/// The model and the work done on it.
pub(super) fn work(summary: &Summary) -> String {
    let table = |rows: &[String]| {
        let rows = each(rows.iter().filter(|row| !row.is_empty()), |row| {
            format!("{row}\n")
        });
        format!("<table><tbody>\n{rows}</tbody></table>\n")
    };
    let work = [
        time(&summary.time),
        counts(&summary.counts),
        iterations(summary),
    ]
    .concat();
    let (model, work, timings) = (
        table(&model(&summary.model)),
        table(&work),
        timings(summary),
    );
    format!(
        "\n<h2 id=\"work\">Model and work done</h2>\n<div class=\"columns\">\n{model}{work}{timings}</div>\n\n"
    )
}

fn model(model: &Model) -> Vec<String> {
    let bodies = match model.bodies.len() {
        count if count > NAMED => count.to_string(),
        _ => text(&model.bodies.join(", ")),
    };
    let mut rows = vec![
        row("Bodies", bodies),
        row("Dimension", model.dimension),
        row("Nodes", model.nodes),
    ];
    let kinds = model.elements.iter();
    rows.extend(kinds.map(|(kind, count)| row(&format!("Elements, {kind}"), count)));
    rows.push(row("Unknowns", model.unknowns));
    rows.push(row("Contact points", model.contact_points));
    let masses = model.mass.iter();
    rows.extend(masses.map(|(body, mass)| row(&format!("Mass of {body}"), text(mass))));
    rows
}

/// The row of a count; empty where there was nothing to count.
fn some(label: &str, count: u64) -> String {
    when(count > 0, || row(label, count))
}

fn time(time: &Time) -> Vec<String> {
    let step = match time.smallest_step == time.largest_step {
        true => vec![row("Step", quantity(time.largest_step, "s"))],
        false => vec![
            row("Smallest step", quantity(time.smallest_step, "s")),
            row("Largest step", quantity(time.largest_step, "s")),
        ],
    };
    let rejected = &time.rejected;
    let before = vec![
        row("Time reached", quantity(time.end, "s")),
        row("Steps", time.steps),
        some("Attempts rejected, a contact closed", rejected.closing),
        some(
            "Attempts rejected, a point passed what it faces",
            rejected.passage,
        ),
        some("Attempts rejected, energy grew", rejected.energy_growth),
        some("Attempts rejected, no solution", rejected.failure),
    ];
    let courant = vec![row("Courant number", quantity(time.courant, ""))];
    [before, step, courant].concat()
}

fn counts(counts: &Counts) -> Vec<String> {
    let mut rows = Vec::new();
    if counts.factorisations > 0 {
        rows.push(row("Factorisations", counts.factorisations));
        rows.push(row("Triangular sweeps", counts.sweeps));
        rows.push(row("Entries of the factor", counts.factor_entries));
        rows.push(row("Memory of the factor", bytes(counts.factor_bytes)));
    }
    rows.push(some("Columns for contact points", counts.contact_columns));
    rows.push(row(
        "Memory of columns and compliance",
        bytes(counts.compliance_bytes),
    ));
    rows.push(some("Solutions with a factor", counts.solves));
    rows.push(some(
        "Products with the matrix, of the iterative solver",
        counts.matrix_products,
    ));
    rows.push(row("Internal-force evaluations", counts.force_sweeps));
    rows.push(row("Element updates", counts.element_updates));
    rows
}

fn iterations(summary: &Summary) -> Vec<String> {
    let factored = summary.counts.factorisations > 0;
    let iterates = |newton: &&Newton| factored || newton.most_iterations > 1;
    match summary.newton.as_ref().filter(iterates) {
        Some(newton) => {
            let mean = quantity(newton.iterations_per_step, "");
            let most = newton.most_iterations;
            vec![
                row("Newton iterations", newton.iterations),
                row(
                    "Newton iterations per step, mean and largest",
                    format!("{mean}, {most}"),
                ),
                row(
                    "Factorisations per step",
                    quantity(newton.factorisations_per_step, ""),
                ),
                some("Halvings of steps", newton.halvings),
            ]
        }
        None if summary.zones.is_none() => {
            vec![some("Status iterations", summary.counts.status_iterations)]
        }
        None => Vec::new(),
    }
}

/// Seconds spent, the largest first.
fn timings(summary: &Summary) -> String {
    let mut timings: Vec<(&String, f64)> =
        summary.timings.iter().map(|(part, s)| (part, *s)).collect();
    timings.sort_by(|a, b| b.1.total_cmp(&a.1));
    let rows = each(&timings, |(part, seconds)| {
        row(part, quantity(*seconds, "s")) + "\n"
    });
    when(!timings.is_empty(), || {
        format!(
            "<table>\n<thead><tr><th>Time spent</th><th></th></tr></thead>\n<tbody>\n{rows}</tbody></table>\n"
        )
    })
}
