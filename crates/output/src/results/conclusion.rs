//! After the run: figures, report, summary with its verdict.

use std::collections::BTreeMap;

use carom_dynamics::{ContactRecord, Ledger, System};
use carom_pages::plot::{Logarithmic, model_figure, unless_empty};

use crate::results::columns::files;
use crate::results::costs::{counts, courant, newton, timings};
use crate::results::film::film;
use crate::results::lines::{Evidence, judge};
use crate::results::page::quality::qualities;
use crate::results::page::tiles::tiles;
use crate::results::page::{self, Sources};
use crate::results::totals::Last;
use crate::results::{Comparison, Ending, Results, allowables, contacts, exact, largest, reduced};
use crate::summary::{
    Angular, Energy, Exact, Model, Momentum, Rejected, Summary, Time, Zones, hash,
};
use crate::{Error, Report, atomic, checkpoint};

impl Results {
    /// Writes figures, report and summary, after the run has told its end to the observers
    /// ([`carom_dynamics::march`] does, after a failed run too).
    ///
    /// # Errors
    /// The first file that could not be written; the others are written nevertheless.
    pub fn conclude(self, ending: &Ending) -> Result<Summary, Error> {
        conclude(self, ending)
    }
}

/// Writes figures, report and summary. Everything is tried; the first error is returned.
fn conclude(mut results: Results, ending: &Ending) -> Result<Summary, Error> {
    let mut errors = Vec::new();
    let (figures, spectra) = draw(&mut results, &mut errors);
    let filtered = keep(results.filtered.write(&mut results.folder), &mut errors);
    let report = keep(results.folder.file("report.html"), &mut errors);
    let path = keep(results.folder.file("summary.json"), &mut errors);
    let cause = ending.unfinished.clone();
    let mut summary = summary(&results, ending, cause.or_else(|| first(&errors)));
    keep(expect(&results, &mut summary), &mut errors);
    if let Some(path) = report {
        let (of_cells, quality) = qualities(&results.system);
        let sources = Sources {
            results: &results,
            filtered: filtered.as_deref().unwrap_or_default(),
            spectra: spectra.as_ref(),
            momentum: summary.momentum.size,
        };
        let data = page::data(&sources, &of_cells);
        let report = Report {
            tiles: &tiles(&results, &summary),
            quality: &quality,
            data: Some(&data),
            summary: &summary,
            impacts: &results.impacts.told.rows,
            figures: &figures,
            case: &results.settings.case_text,
        };
        if let Err(error) = report.write(&path) {
            summary.verdict.incomplete(error.to_string());
            errors.push(error);
        }
    }
    if let Some(path) = path {
        keep(summary.write(&path), &mut errors);
    }
    match errors.into_iter().next() {
        Some(error) => Err(error),
        None => Ok(summary),
    }
}

/// Judges the rows of what the case must give, if there are some: the verdict has a line on them.
fn expect(results: &Results, summary: &mut Summary) -> Result<(), Error> {
    let expected = &results.settings.expected;
    if expected.rows.is_empty() {
        return Ok(());
    }
    let unfinished = summary.verdict.unfinished.is_some();
    let [histories, _] = files(&results.settings);
    let histories = results.folder.path().join(histories);
    let values = serde_json::to_value(&*summary)?;
    let found = expected.judge(&values, &histories, unfinished)?;
    match (&found.unjudged, found.line()) {
        (_, Some(line)) => summary.verdict.add(line),
        (Some(why), None) => {
            let unchecked = format!("the rows of `[expect]`: {why}");
            summary.verdict.unchecked.push(unchecked);
        }
        (None, None) => {}
    }
    summary.expectations = Some(found);
    Ok(())
}

fn first(errors: &[Error]) -> Option<String> {
    errors.first().map(Error::to_string)
}

fn keep<T>(outcome: Result<T, Error>, errors: &mut Vec<Error>) -> Option<T> {
    outcome.map_err(|error| errors.push(error)).ok()
}

/// Writes the figures; returns those that could be drawn, and the response spectra.
fn draw(results: &mut Results, errors: &mut Vec<Error>) -> (Vec<String>, Option<Logarithmic>) {
    let reference = results.settings.reference.as_ref();
    let system = &results.system;
    let model = results.settings.zoning.as_ref().map(|zoning| {
        let shapes = zoning.shapes(system);
        let svg = model_figure(system.dim, &zoning.zones, &shapes);
        ("plots/model.svg", svg)
    });
    let drawn = results
        .curves
        .draw(reference, (results.last.time, results.is_static()));
    let film = film(system, &results.stills).map(|figure| ("plots/film.svg", figure));
    let instants = results.instants.draw(system);
    let instants = instants.map(|figure| ("plots/largest-forces.svg", figure));
    let spectra = keep(results.spectra.write(&mut results.folder), errors).flatten();
    let drawn_spectra = spectra
        .as_ref()
        .map(|figure| ("plots/spectra.svg", figure.svg()));
    let drawn = model.into_iter().chain(drawn).chain(film);
    let drawn = drawn.chain(instants).chain(drawn_spectra);
    let mut figures = Vec::new();
    for (name, figure) in drawn {
        let Some(svg) = keep(unless_empty(figure).map_err(Error::from), errors).flatten() else {
            continue;
        };
        let path = results.folder.file(name);
        keep(
            path.and_then(|path| atomic::write_text(&path, &svg)),
            errors,
        );
        figures.push(svg);
    }
    (figures, spectra)
}

fn summary(results: &Results, ending: &Ending, unfinished: Option<String>) -> Summary {
    let Results {
        system,
        settings,
        last,
        totals,
        ..
    } = results;
    let zones = ending.zones.as_ref();
    let energy = energy(system, last, zones);
    let momentum = momentum(system, last, zones.is_some());
    let comparison = results.comparison.as_ref();
    let exact = comparison.map(|comparison| against_exact(results, comparison));
    let pretensions = results.bolts.all(system);
    let evidence = Evidence {
        system,
        last,
        totals,
        zones,
        energy: &energy,
        momentum: &momentum,
        exact: exact.as_ref(),
        bolts: &pretensions,
        doubts: &settings.doubts,
        iterated: ending.costs.work.products > 0,
        study: settings.study.as_deref(),
    };
    let verdict = judge(&evidence, unfinished);
    let names = results.folder.names().map(str::to_owned);
    let own = ["report.html", "summary.json"];
    // the collection names the field files, which may be thousands; which earlier checkpoints there are depends on the clock
    let left_out = |name: &str| name.starts_with("fields/") || checkpoint::is_earlier(name);
    let names = names.filter(|name| !left_out(name));
    let there =
        |name: &String| own.contains(&&**name) || results.folder.path().join(name).is_file();
    Summary {
        version: settings.version.clone(),
        title: settings.title.clone(),
        case_hash: hash(&settings.case_text),
        verdict,
        model: model(system),
        scheme: settings.scheme.clone(),
        time: time(system, last, zones),
        zones: ending.zones.clone(),
        contacts: contacts::contacts(results),
        levels: contacts::levels(results),
        discrete: results.discrete.all(),
        pretensions,
        loads: results.loads.all(system),
        maxima: largest::maxima(results),
        expectations: None,
        allowables: allowables::checks(results, &largest::stills(results)),
        energy,
        momentum,
        exact,
        counts: counts(ending.costs, totals.passes),
        newton: (system.is_nonlinear() && zones.is_none()).then(|| newton(results, ending)),
        timings: timings(results, ending),
        warnings: settings.warnings.clone(),
        notices: totals.notices(),
        outputs: names.filter(there).collect(),
    }
}

fn model(system: &System) -> Model {
    let mut elements = BTreeMap::new();
    for cell in system.bodies.iter().flat_map(|body| body.cells()) {
        let name = system.mesh.kind(*cell).table().name;
        *elements.entry(name.to_owned()).or_insert(0) += 1;
    }
    let lumped = |node: &(u32, f64)| system.mass.lumped[system.unknowns.first(node.0)] > 0.0;
    let mass = system.bodies.iter().zip(&system.body_masses);
    let mass = mass.map(|(body, nodes)| {
        let kind = if nodes.iter().all(lumped) {
            "lumped"
        } else {
            "consistent"
        };
        (body.name().to_owned(), kind.to_owned())
    });
    let added = system.bodies.iter().filter(|body| body.added_mass() != 0.0);
    let added = added.map(|body| (body.name().to_owned(), body.added_mass()));
    Model {
        dimension: system.dim,
        bodies: system
            .bodies
            .iter()
            .map(|body| body.name().to_owned())
            .collect(),
        nodes: system.x.len(),
        elements,
        unknowns: system.fixed.iter().filter(|fixed| !**fixed).count(),
        contact_points: system.points(),
        mass: mass.collect(),
        added_mass: added.collect(),
        reduced: reduced::reduced(system),
        damped_modes: reduced::damped_modes(system),
    }
}

fn time(system: &System, last: &Last, zones: Option<&Zones>) -> Time {
    let courant = match zones {
        Some(zones) => zones
            .zones
            .iter()
            .filter_map(|zone| zone.courant)
            .reduce(f64::max),
        None => courant(system, last.control.range[1]),
    };
    Time {
        end: last.time,
        steps: last.step,
        rejected: Rejected {
            closing: last.control.cut,
            passage: last.control.passed,
            energy_growth: last.control.grown,
            failure: last.control.failed,
        },
        smallest_step: last.control.range[0],
        largest_step: last.control.range[1],
        courant,
    }
}

fn energy(system: &System, last: &Last, zones: Option<&Zones>) -> Energy {
    let identity = match zones {
        Some(zones) => zones.zones.iter().all(|zone| zone.has_identity),
        None => system.closes_energy(),
    };
    let ledger = &last.ledger;
    let (start, end) = (&ledger.initial, &ledger.balance);
    // what only some runs have is named only where there is some
    let there = |terms: &[(&str, f64)]| -> BTreeMap<String, f64> {
        let terms = terms.iter().filter(|(_, term)| *term != 0.0);
        terms
            .map(|(name, term)| ((*name).to_owned(), *term))
            .collect()
    };
    let mut works = there(&[
        ("supports", end.work_supports),
        ("obstacles", end.work_obstacles),
    ]);
    works.insert("loads".to_owned(), end.work_loads);
    works.insert("contact".to_owned(), end.work_contact);
    if zones.is_some() {
        works.insert("links".to_owned(), end.work_links);
    }
    let mut dissipations = there(&[
        ("materials", end.dissipation_material),
        ("damping", end.dissipation_damping),
        ("friction", end.dissipation_friction),
        ("viscosity", end.dissipation_viscosity),
        ("deletion", end.dissipation_deletion),
    ]);
    dissipations.insert("scheme".to_owned(), end.dissipation_scheme);
    let stored = there(&[
        ("hardening", end.hardening - start.hardening),
        ("scheme", end.scheme_energy - start.scheme_energy),
    ]);
    // a residual that is not a number must not be hidden by `max`
    let largest = match end.energy_residual.is_nan() {
        true => f64::NAN,
        false => ledger.largest_energy_residual,
    };
    Energy {
        kinetic_initial: start.kinetic,
        strain_initial: start.strain,
        kinetic_final: end.kinetic,
        strain_final: end.strain,
        works,
        dissipations,
        stored,
        residual: end.energy_residual,
        largest_residual: largest,
        largest: last.largest_energy(),
        largest_hourglass: (ledger.largest_hourglass > 0.0).then_some(ledger.largest_hourglass),
        relative_residual: relative(largest, last.balanced_energy()),
        identity,
    }
}

/// Residuals are compared with the largest momentum or impulse of the run, or, if that is larger, with the momentum
/// that its energy could hold, sqrt(2 m E) >= Σ |m v|: bodies that run at each other have none in sum.
fn momentum(system: &System, last: &Last, linked: bool) -> Momentum {
    let ledger = &last.ledger;
    let (start, end) = (&ledger.initial, &ledger.balance);
    let mass: f64 = (0..system.bodies.len())
        .map(|body| system.body_mass(body))
        .sum();
    let size = (2.0 * mass * ledger.largest_energy).sqrt();
    let size = size.max(ledger.largest_momentum);
    let impulses = [
        ("loads", end.impulse_loads.linear),
        ("supports", end.impulse_supports.linear),
        ("obstacles", end.impulse_contact.linear),
    ];
    let links = linked.then_some(("links", end.impulse_links.linear));
    let impulses = impulses.into_iter().chain(links);
    let angular = (system.is_nonlinear() && !system.axisymmetric)
        .then(|| angular(system, ledger, linked, size));
    Momentum {
        angular,
        initial: start.momentum.linear,
        r#final: end.momentum.linear,
        impulses: impulses
            .map(|(name, impulse)| (name.to_owned(), impulse))
            .collect(),
        residual: end.momentum_residual.linear,
        size,
        relative_residual: relative(ledger.largest_momentum_residual, size),
    }
}

/// `momentum`: size that linear momenta are compared with, N s. Times the largest distance of a node from the point of
/// the balance it is one for angular momenta: |Σ x × m v| ≤ max |x| Σ |m v|.
fn angular(system: &System, ledger: &Ledger, linked: bool, momentum: f64) -> Angular {
    let (start, end) = (&ledger.initial, &ledger.balance);
    let distance = |x: &[f64; 3]| {
        let arm = x.iter().zip(&system.about).map(|(x, about)| x - about);
        arm.map(|x| x * x).sum::<f64>().sqrt()
    };
    let farthest = system.x.iter().map(distance).fold(0.0, f64::max);
    let size = ledger.largest_angular_momentum.max(farthest * momentum);
    let impulses = [
        ("loads", end.impulse_loads.angular),
        ("supports", end.impulse_supports.angular),
        ("obstacles", end.impulse_contact.angular),
    ];
    let links = linked.then_some(("links", end.impulse_links.angular));
    let impulses = impulses.into_iter().chain(links);
    Angular {
        about: system.about,
        initial: start.momentum.angular,
        r#final: end.momentum.angular,
        impulses: impulses
            .map(|(name, impulse)| (name.to_owned(), impulse))
            .collect(),
        residual: end.momentum_residual.angular,
        relative_residual: relative(ledger.largest_angular_residual, size),
    }
}

/// A part of something; nothing is no part of anything.
fn relative(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

fn against_exact(results: &Results, comparison: &Comparison) -> Exact {
    let reference = &comparison.reference;
    let (solution, k) = (&reference.solution, reference.contact);
    let end = results.last.time.min(solution.end_time());
    let totals = &results.impacts.told.contacts[k];
    let none = ContactRecord::default();
    let record = results.last.records.contacts.get(k).unwrap_or(&none);
    let peak = exact::peak_force(solution, end);
    let over = |value: f64| (peak > 0.0).then(|| value / peak - 1.0);
    let free = exact::parts_freely(solution, end);
    Exact {
        name: reference.name.clone(),
        contact: results.system.contacts[k].name.clone(),
        force_error: comparison.errors.force.relative(),
        displacement_error: comparison.errors.displacement.relative(),
        peak_force: peak,
        overshoot: over(record.peak_force),
        mean_overshoot: over(totals.mean.peak()),
        impulse: solution.impulse(end),
        impulse_error: relative(
            record.impulse() - solution.impulse(end),
            solution.impulse(end),
        ),
        restitution: free
            .then_some([&results.start, &results.last.velocities])
            .and_then(|velocities| parting(velocities.map(|v| opening_speed(results, k, v)))),
        exact_restitution: free
            .then_some([0.0, end])
            .and_then(|times| parting(times.map(|time| exact::opening_speed(solution, time)))),
    }
}

/// Speed of parting over that of approach, from the opening speeds at the start and at the end.
fn parting([start, end]: [f64; 2]) -> Option<f64> {
    (start < 0.0).then(|| -end / start)
}

/// Speed at which the mean motions of the two sides of a contact part along the axis of the exact solution, m/s.
fn opening_speed(results: &Results, contact: usize, velocities: &[[f64; 3]]) -> f64 {
    let axis = results
        .settings
        .reference
        .as_ref()
        .map_or([0.0; 3], |r| r.axis);
    let joined = |body: usize| match &results.settings.zoning {
        Some(zoning) => zoning.joined[body].clone(),
        None => vec![body],
    };
    // bodies joined by links move as one
    let along = |body: usize| {
        let (mut momentum, mut mass) = (0.0, 0.0);
        for body in joined(body) {
            let v = velocities.get(body).copied().unwrap_or_default();
            let m = results.system.body_mass(body);
            mass += m;
            momentum += m * (0..3).map(|i| v[i] * axis[i]).sum::<f64>();
        }
        momentum / mass
    };
    let contact = &results.system.contacts[contact];
    contact.primary_body.map_or(0.0, along) - along(contact.secondary_body)
}
