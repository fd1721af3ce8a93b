//! The plots of a page, from what the run gathered.

use carom_dynamics::ContactPair;
use carom_pages::page::block::Block;
use carom_pages::page::draft::{self, Draft, Line, draft, line, zipped};
use carom_pages::page::schema::Plot;
use carom_pages::plot::{Logarithmic, quantity};

use crate::results::Results;
use crate::results::columns::moments;
use crate::results::exact::{Polyline, force_curve, motion_curves};
use crate::results::filtered::FilteredCurve;
use crate::results::page::series::ContactSeries;
use crate::results::sensor::COMPONENTS;
use crate::results::stills::Still;
use crate::results::trace::Trace;

/// Contacts with plots of their own; more share them, eight in each.
const OWN: usize = 4;

const SHARED: usize = 8;

/// Part of the largest energy or momentum below which a residual is rounding: the bound of the verdict.
const ROUNDING: f64 = 1e-9;

/// Motion of a contact point or a probe: what, unit, section of its curves.
const MOTIONS: [(&str, &str); 3] = [
    ("displacement", "m"),
    ("velocity", "m/s"),
    ("acceleration", "m/s²"),
];

/// What plots are made of beside the results.
pub(crate) struct Sources<'a> {
    pub(crate) results: &'a Results,
    pub(crate) filtered: &'a [FilteredCurve],
    pub(crate) spectra: Option<&'a Logarithmic>,
    /// What residuals of momentum are relative to, N s.
    pub(crate) momentum: f64,
}

fn computed(name: impl Into<String>, trace: &Trace) -> Line {
    line(name, "computed", trace.points().to_vec())
}

/// All plots, their curves in the block.
pub(crate) fn plots(sources: &Sources, block: &mut Block) -> Vec<Plot> {
    let results = sources.results;
    let mut drafts = forces(sources);
    drafts.extend(of_contacts(results));
    drafts.extend(contact_moments(results));
    drafts.extend(motions(results));
    drafts.extend(probes(sources));
    drafts.extend(supports(results));
    drafts.extend(loads(results));
    drafts.extend(energies(results));
    drafts.extend(residuals(sources));
    drafts.extend(sources.spectra.map(spectra));
    draft::plots(drafts, block)
}

/// Contacts in groups that share a plot, those with the largest forces first, and whether the group is folded.
fn groups(results: &Results) -> Vec<(Vec<usize>, bool)> {
    let mut order: Vec<usize> = (0..results.system.contacts.len()).collect();
    let records = &results.last.records.contacts;
    let peak = |k: &usize| records.get(*k).map_or(0.0, |record| record.peak_force);
    if order.len() <= OWN {
        return order.into_iter().map(|k| (vec![k], false)).collect();
    }
    // most pairs of a general contact never meet
    order.retain(|k| !results.system.contacts[*k].near_only || peak(k) > 0.0);
    order.sort_by(|a, b| peak(b).total_cmp(&peak(a)));
    let groups = order.chunks(SHARED).enumerate();
    groups.map(|(k, group)| (group.to_vec(), k > 0)).collect()
}

/// Title of the plot of a group.
fn of_group(results: &Results, what: &str, group: &[usize]) -> String {
    let name = |k: usize| &results.system.contacts[k].name;
    match group {
        [one] => format!("{what} of contact {}", name(*one)),
        _ => format!("{what}s of contacts"),
    }
}

/// Forces: raw, and of a contact by itself behind its filters, the mean over the window and the exact curve.
fn forces(sources: &Sources) -> Vec<Draft> {
    let results = sources.results;
    let (system, series) = (&results.system, &results.series.series);
    let reference = results.settings.reference.as_ref();
    let one = |(group, folded): (Vec<usize>, bool)| {
        let mut lines = Vec::new();
        for &k in &group {
            let exact = reference.filter(|reference| reference.contact == k);
            lines.extend(exact.map(|reference| {
                let curve = force_curve(&reference.solution, results.last.time);
                line(
                    format!("exact ({})", reference.name),
                    "exact",
                    zipped(&curve),
                )
            }));
            let name = match group.len() {
                1 => "raw".to_owned(),
                _ => system.contacts[k].name.clone(),
            };
            lines.push(computed(name, &series.contacts[k].force));
            let window = results.impacts.told.contacts[k].window;
            if group.len() == 1 && window > 0.0 && !results.is_static() {
                let name = format!("mean over {}", quantity(window, "s"));
                lines.push(line(
                    name,
                    "filtered",
                    series.contacts[k].mean.points().to_vec(),
                ));
            }
        }
        let filtered = sources.filtered.iter().filter(|curve| {
            curve.filter.is_some() && group.len() == 1 && curve.contact == Some(group[0])
        });
        lines.extend(filtered.map(|curve| line(&curve.name, curve.role(), curve.points.clone())));
        let title = of_group(results, "Force", &group);
        let mut draft = draft("plot-force", title, ("force", "N"), lines);
        draft.plot.folded = folded;
        draft
    };
    groups(results).into_iter().map(one).collect()
}

/// Gaps and impulses.
fn of_contacts(results: &Results) -> Vec<Draft> {
    let (system, series) = (&results.system, &results.series.series);
    let mut drafts = Vec::new();
    for (group, folded) in groups(results) {
        let lines = |trace: fn(&ContactSeries) -> &Trace| {
            let of = |k: &usize| computed(&system.contacts[*k].name, trace(&series.contacts[*k]));
            group.iter().map(of).collect()
        };
        let title = of_group(results, "Least gap", &group);
        let gaps = draft("plot-gap", title, ("gap", "m"), lines(|c| &c.gap));
        let title = of_group(results, "Impulse", &group);
        let impulses = draft(
            "plot-impulse",
            title,
            ("impulse", "N s"),
            lines(|c| &c.impulse),
        );
        for mut draft in [gaps, impulses] {
            draft.plot.folded = folded;
            drafts.push(draft);
        }
    }
    drafts.retain(|draft| draft.plot.id != "plot-impulse" || !results.is_static());
    drafts
}

/// Moments of the contacts that name a point.
fn contact_moments(results: &Results) -> Vec<Draft> {
    let (system, series) = (&results.system, &results.series.series);
    let one = |(contact, series): (&ContactPair, &ContactSeries)| {
        let point = contact.moment.as_ref()?.point;
        let place: Vec<String> = point[..system.dim].iter().map(|x| format!("{x}")).collect();
        let title = format!(
            "Moment of contact {} about ({}) m",
            contact.name,
            place.join(", ")
        );
        let names = COMPONENTS[moments(system)].iter().zip(&series.moment);
        let lines = names.map(|(name, trace)| computed(*name, trace)).collect();
        Some(draft("plot-moment", title, ("moment", "N m"), lines))
    };
    let all = system.contacts.iter().zip(&series.contacts);
    all.filter_map(one).collect()
}

/// Motion of the contact point that the static figures show, with the exact one.
fn motions(results: &Results) -> Vec<Draft> {
    let Some(point) = &results.point else {
        return Vec::new();
    };
    let reference = results.settings.reference.as_ref();
    let traces = results.curves.motions();
    let exact: Vec<[Polyline; 3]> = reference.map_or(Vec::new(), |reference| {
        let bodies = 0..reference.solution.motions().len().min(traces.len());
        let curves = |body| motion_curves(&reference.solution, body, results.last.time);
        bodies.map(curves).collect()
    });
    let contact = &results.system.contacts[point.contact].name;
    let one = |(order, (what, unit)): (usize, (&'static str, &'static str))| {
        let sides = point.sides.iter();
        let mut lines: Vec<Line> = exact
            .iter()
            .zip(sides.clone())
            .map(|(motion, (side, _))| {
                let name = format!("{side}, exact");
                line(name, "exact", zipped(&motion[order]))
            })
            .collect();
        let sides = sides.zip(traces);
        lines.extend(sides.map(|((name, _), motion)| computed(name, &motion[order])));
        let title = format!("Contact {contact}: {what} of its middle points along the normal");
        let mut draft = draft("plot-motion", title, (what, unit), lines);
        if results.system.contacts.len() > 1 {
            draft.plot.note = Some(format!(
                "Of {contact} alone, the contact of the exact solution or the first one; a probe records the motion of any other place."
            ));
        }
        draft
    };
    MOTIONS.into_iter().enumerate().map(one).collect()
}

/// Probes: what the case asks for, by component, and behind their filters.
fn probes(sources: &Sources) -> Vec<Draft> {
    let results = sources.results;
    let mut drafts = Vec::new();
    let probes = results.settings.probes.iter();
    for (probe, components) in probes.zip(&results.series.series.probes) {
        for (order, (what, unit)) in MOTIONS.into_iter().enumerate() {
            if !probe.recorded()[order] {
                continue;
            }
            let names = COMPONENTS.iter().zip(components);
            let lines = names.map(|(name, motion)| computed(*name, &motion[order]));
            let title = format!("Probe {}: {what}", probe.name);
            drafts.push(draft("plot-probe", title, (what, unit), lines.collect()));
        }
    }
    let mut raw: Option<Draft> = None;
    let of_probes = sources
        .filtered
        .iter()
        .filter(|curve| curve.contact.is_none());
    for curve in of_probes {
        let filtered = line(&curve.name, curve.role(), curve.points.clone());
        match &mut raw {
            Some(draft) if curve.filter.is_some() => draft.lines.push(filtered),
            _ => {
                drafts.extend(raw.take());
                let unit = ("acceleration", "m/s²");
                raw = Some(draft("plot-probe", &curve.title, unit, vec![filtered]));
            }
        }
    }
    drafts.extend(raw);
    drafts
}

/// Forces of all supports, and of each of the first ones, where they give any.
fn supports(results: &Results) -> Vec<Draft> {
    let series = &results.series.series;
    let of = |title, traces| along_axes(results, ("plot-reaction", title), traces);
    let all = "Force of all supports on the bodies, mean of each step";
    let named = results.system.supports.iter().zip(&series.named);
    let named = named.map(|(support, traces)| {
        let title = format!("Force of the support {} on the bodies", support.name);
        of(title, traces)
    });
    let all = of(all.to_owned(), &series.supports);
    std::iter::once(all).chain(named).flatten().collect()
}

/// Total forces of the first loads.
fn loads(results: &Results) -> Vec<Draft> {
    let names = results.system.nonlinear.load_names.iter();
    let each = names.zip(&results.series.series.loads);
    let one = |(name, traces): (&String, &[Trace; 3])| {
        along_axes(
            results,
            ("plot-load", format!("Force of the load {name}")),
            traces,
        )
    };
    each.filter_map(one).collect()
}

/// A force along the axes; none where it is zero.
fn along_axes(
    results: &Results,
    (id, title): (&'static str, String),
    traces: &[Trace; 3],
) -> Option<Draft> {
    let acts = |trace: &Trace| trace.points().iter().any(|p| p.1 != 0.0);
    let lines = COMPONENTS.iter().zip(traces).take(results.system.dim);
    let lines = lines.map(|(name, trace)| computed(*name, trace));
    let draft = draft(id, title, ("force", "N"), lines.collect());
    traces.iter().any(acts).then_some(draft)
}

/// Energies of the model, and the kinetic energy of each body at the kept instants.
fn energies(results: &Results) -> Vec<Draft> {
    let lines = results.curves.energies();
    let lines = lines
        .into_iter()
        .map(|(name, trace)| computed(name, trace))
        .collect();
    let mut drafts = vec![draft(
        "plot-energy",
        "Energies of the model",
        ("energy", "J"),
        lines,
    )];
    let bodies = &results.system.bodies;
    let is_plain = bodies.iter().all(|body| body.as_reduced().is_none());
    if bodies.len() > 1 && is_plain {
        let kinetic = "Kinetic energy of the bodies at the kept instants, lumped masses";
        drafts.push(by_body(results, kinetic, |still| &still.kinetic));
        let strain = "Strain energy of the bodies at the kept instants";
        drafts.push(by_body(results, strain, |still| &still.strain));
    }
    drafts
}

/// An energy of the bodies at the kept instants, those with the most of it.
fn by_body(results: &Results, title: &str, of: fn(&Still) -> &[f64]) -> Draft {
    let stills = &results.stills.kept.equal;
    let one = |(number, body): (usize, &carom_bodies::Body)| {
        let values = stills.iter().map(|still| (still.time, of(still)[number]));
        let finite = values.filter(|(_, energy)| energy.is_finite());
        line(body.name(), "instants", finite.collect())
    };
    let mut lines: Vec<Line> = results.system.bodies.iter().enumerate().map(one).collect();
    let largest = |line: &Line| line.points.iter().fold(0.0_f64, |m, p| m.max(p.1));
    lines.sort_by(|a, b| largest(b).total_cmp(&largest(a)));
    lines.truncate(SHARED);
    draft("plot-energy", title, ("energy", "J"), lines)
}

/// Residuals over the largest energy and momentum.
fn residuals(sources: &Sources) -> Option<Draft> {
    let results = sources.results;
    let ledger = &results.last.ledger;
    let over = |trace: &Trace, whole: f64| -> Vec<(f64, f64)> {
        let points = trace.points().iter();
        points.map(|(t, r)| (*t, r.abs() / whole)).collect()
    };
    let mut lines = Vec::new();
    if ledger.largest_energy > 0.0 {
        let points = over(results.curves.residual(), ledger.largest_energy);
        lines.push(line("energy / largest energy", "computed", points));
    }
    let size = sources.momentum;
    if size > 0.0 {
        let points = over(&results.series.series.momentum_residual, size);
        lines.push(line("momentum / largest momentum", "computed", points));
    }
    lines.retain(|line| line.points.iter().any(|p| p.1 > 0.0));
    let title = "Residuals of the balances";
    let mut draft = draft("plot-residual", title, ("residual", ""), lines);
    draft.plot.scale = "logarithmic";
    draft.plot.rounding = Some(ROUNDING);
    draft.plot.note = Some(
        "Magnitudes. Below 1e-9 lies what rounding leaves after up to a million steps; the verdict bounds a linear run by it."
            .to_owned(),
    );
    (!draft.lines.is_empty()).then_some(draft)
}

/// Response spectra.
fn spectra(figure: &Logarithmic) -> Draft {
    let lines = figure.series.iter();
    let lines = lines.map(|series| line(&series.name, "computed", series.points.clone()));
    let unit = ("acceleration", "m/s²");
    let mut draft = draft("plot-spectra", &figure.title, unit, lines.collect());
    draft.plot.abscissa = "frequency";
    draft.plot.scale = "double logarithmic";
    draft
}
