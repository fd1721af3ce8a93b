//! The figures of a comparison: each quantity against time, all variants over the exact solution.

use carom_output::results::exact::{Polyline, force_curve, motion_curves};
use carom_output::results::trace::Trace;
use carom_pages::page::Data;
use carom_pages::page::block::Block;
use carom_pages::page::draft::{self, Line, draft, line, of_runs, zipped};
use carom_pages::page::schema::{Page, Quantity, SCHEMA};
use carom_pages::plot::{Axis, Curve, Figure, Panel, Role};

use crate::compare::{Comparison, Done};

/// Names of the variants with their curves.
type Curves<'a> = Vec<(&'a str, Polyline)>;

/// Title, curves, exact curve.
type Part<'a> = (String, Curves<'a>, Option<Polyline>);

/// Variants whose names fit over half a page.
const FEW: usize = 4;

const fn axis(quantity: &'static str, unit: &'static str) -> Axis {
    Axis { quantity, unit }
}

/// The variants that ran. What chatters is drawn first, under the others, which it would hide.
fn drawn(comparison: &Comparison) -> Vec<(&str, &Done)> {
    let done = comparison.variants.iter();
    let mut done: Vec<(&str, &Done)> = done
        .filter_map(|v| Some((v.name.as_str(), v.done()?)))
        .collect();
    let changes = |done: &Done| done.contact().map(|contact| contact.status_changes);
    done.sort_by_key(|(_, done)| std::cmp::Reverse(changes(done)));
    done
}

/// File names and figures as SVG; a quantity that no variant has is left out.
pub(crate) fn figures(
    comparison: &Comparison,
) -> Vec<(&'static str, Result<String, carom_pages::Error>)> {
    let done = drawn(comparison);
    let end = done.iter().map(|(_, d)| d.summary.time.end);
    let end = end.fold(0.0, f64::max);
    let force = axis("contact force", "N");
    let displacement = axis("displacement", "m");
    let velocity = axis("velocity", "m/s");
    let all = [
        ("plots/force.svg", force, forces(comparison, &done, end)),
        (
            "plots/displacement.svg",
            displacement,
            motions(comparison, &done, end, 0),
        ),
        (
            "plots/velocity.svg",
            velocity,
            motions(comparison, &done, end, 1),
        ),
        ("plots/energy.svg", axis("energy", "J"), energies(&done)),
    ];
    let draw = |(file, axis, parts): (&'static str, Axis, Vec<Part>)| {
        // a scheme that chatters must not hide the others
        let clip = file == "plots/force.svg";
        let panels = parts.iter().filter(|(_, curves, _)| !curves.is_empty());
        let panels: Vec<Panel> = panels.map(|part| panel(part, axis, clip)).collect();
        let figure = Figure {
            title: comparison.title.clone(),
            abscissa: Axis {
                quantity: "time",
                unit: "s",
            },
            columns: if done.len() > FEW {
                1
            } else {
                panels.len().min(2)
            },
            panels,
        };
        (!figure.panels.is_empty()).then(|| (file, figure.svg()))
    };
    all.into_iter().filter_map(draw).collect()
}

/// The plots of the page: what the figures show, without their clipping.
pub(crate) fn page(comparison: &Comparison) -> Data {
    let done = drawn(comparison);
    let end = done.iter().map(|(_, d)| d.summary.time.end);
    let end = end.fold(0.0, f64::max);
    let all = [
        ("contact force", "N", forces(comparison, &done, end)),
        ("displacement", "m", motions(comparison, &done, end, 0)),
        ("velocity", "m/s", motions(comparison, &done, end, 1)),
        ("energy", "J", energies(&done)),
    ];
    let mut drafts = Vec::new();
    for (quantity, unit, parts) in all {
        for (title, curves, exact) in parts.iter().filter(|(_, curves, _)| !curves.is_empty()) {
            let exact = exact.iter();
            let mut lines: Vec<Line> = exact.map(|c| line("exact", "exact", zipped(c))).collect();
            let computed = curves.iter().map(|(name, curve)| {
                let run = done.iter().find(|(other, _)| other == name);
                let is_bad = run.is_some_and(|(_, done)| done.is_bad());
                (line(*name, "computed", zipped(curve)), is_bad)
            });
            lines.extend(of_runs(computed.collect()));
            drafts.push(draft("plot-comparison", title, (quantity, unit), lines));
        }
    }
    let mut block = Block::default();
    let page = Page {
        schema: SCHEMA,
        abscissa: Quantity {
            name: "time".to_owned(),
            unit: "s",
        },
        begin: 0.0,
        end,
        events: Vec::new(),
        plots: draft::plots(drafts, &mut block),
        raster: None,
        model: None,
    };
    Data { page, block }
}

/// The curves of the variants that have one.
fn curves<'a>(
    done: &[(&'a str, &Done)],
    trace: impl for<'d> Fn(&'d Done) -> Option<&'d Trace>,
) -> Curves<'a> {
    let all = done.iter();
    let traces = all.filter_map(|(name, done)| Some((*name, trace(done)?)));
    let drawn = traces.filter(|(_, trace)| !trace.is_empty());
    drawn.map(|(name, trace)| (name, trace.columns())).collect()
}

fn forces<'a>(comparison: &Comparison, done: &[(&'a str, &Done)], end: f64) -> Vec<Part<'a>> {
    let exact = comparison.exact.as_ref();
    vec![(
        "Contact force".to_owned(),
        curves(done, |d| {
            d.history.contact.as_ref().map(|_| &d.history.force_curve)
        }),
        exact.map(|exact| force_curve(&exact.solution, end)),
    )]
}

/// Displacement (0) or velocity (1) of the contact points, one part for each side.
fn motions<'a>(
    comparison: &Comparison,
    done: &[(&'a str, &Done)],
    end: f64,
    derivative: usize,
) -> Vec<Part<'a>> {
    let sides = done.first().map_or(&[][..], |(_, d)| &d.history.sides);
    let part = |(side, (name, _)): (usize, &(String, [Trace; 2]))| {
        let exact = comparison.exact.as_ref().map(|exact| &exact.solution);
        let exact = exact.filter(|solution| side < solution.motions().len());
        (
            format!("Contact point of {name}"),
            curves(done, |d| Some(&d.history.sides.get(side)?.1[derivative])),
            exact.map(|solution| motion_curves(solution, side, end)[derivative].clone()),
        )
    };
    sides.iter().enumerate().map(part).collect()
}

fn energies<'a>(done: &[(&'a str, &Done)]) -> Vec<Part<'a>> {
    let part = |title: &str, curves| (title.to_owned(), curves, None);
    vec![
        part(
            "Kinetic and strain energy",
            curves(done, |d| Some(&d.history.energy)),
        ),
        part(
            "Lost by the scheme",
            curves(done, |d| Some(&d.history.dissipation)),
        ),
        part(
            "Work of the contact",
            curves(done, |d| Some(&d.history.work_of_contact)),
        ),
    ]
}

fn panel<'a>((title, curves, exact): &'a Part, ordinate: Axis, clip: bool) -> Panel<'a> {
    let exact = exact.iter().map(|(x, y)| Curve {
        name: "exact",
        x,
        y,
        role: Role::Exact,
    });
    let computed = curves.iter().map(|(name, (x, y))| Curve {
        name,
        x,
        y,
        role: Role::Computed,
    });
    Panel {
        title: title.clone(),
        ordinate,
        curves: exact.chain(computed).collect(),
        clip,
    }
}
