//! The numbers on top of the report.

use std::collections::BTreeMap;

use carom_bodies::Body;
use carom_dynamics::System;
use carom_pages::form::percent;
use carom_pages::plot::{quantity, scientific};
use serde::Serialize;

use crate::maxima::{Maxima, Maximum};
use crate::results::Results;
use crate::results::outlines::size;
use crate::statistics::Margin;
use crate::summary::{Contact, Energy, Summary};
use crate::verdict::Grade;

/// A number with what it is about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tile {
    /// What it is.
    pub label: &'static str,
    /// The number with its unit.
    pub value: String,
    /// Where and when, and what to read beside it.
    pub note: String,
    /// The section of the page that has more.
    pub section: &'static str,
    /// `good`, `look` or `bad` of the verdict, else empty.
    pub grade: &'static str,
    /// The instant that the model is to show, s.
    pub time: Option<f64>,
    /// The field that the model is to be coloured by, else empty.
    pub field: &'static str,
}

fn tile(label: &'static str, value: String, note: String, section: &'static str) -> Tile {
    Tile {
        label,
        value,
        note,
        section,
        grade: "",
        time: None,
        field: "",
    }
}

/// All tiles in their order.
pub(crate) fn tiles(results: &Results, summary: &Summary) -> Vec<Tile> {
    let mut tiles = vec![verdict(summary)];
    tiles.extend(margin(summary));
    tiles.extend(of_contacts(results, summary));
    tiles.push(energy(&summary.energy));
    tiles.extend(of_fields(results, &summary.maxima));
    tiles
}

fn verdict(summary: &Summary) -> Tile {
    let verdict = &summary.verdict;
    let of = |grade: Grade| {
        verdict
            .lines
            .iter()
            .filter(|line| line.grade == grade)
            .count()
    };
    let note = match &verdict.unfinished {
        Some(_) => "the run did not come to its end".to_owned(),
        None => format!(
            "{} lines good, {} to look at, {} bad, {} not checked",
            of(Grade::Good),
            of(Grade::Look),
            of(Grade::Bad),
            verdict.unchecked.len()
        ),
    };
    Tile {
        grade: verdict.grade.word(),
        ..tile("Verdict", verdict.grade.word().to_owned(), note, "verdict")
    }
}

/// The least margin of all that the case allows.
fn margin(summary: &Summary) -> Option<Tile> {
    let of_levels = summary.levels.iter().flat_map(|(name, level)| {
        let all = [
            ("force", "N", &level.force_margin),
            ("energy", "J", &level.energy_margin),
            ("stroke", "m", &level.stroke_margin),
            ("crush", "m", &level.crush_margin),
        ];
        all.into_iter().filter_map(move |(what, unit, margin)| {
            let margin = margin.clone()?;
            Some((format!("{what} of level {name}"), unit, margin, "levels"))
        })
    });
    let of_parts = summary.allowables.iter().map(|check| {
        let of = format!("{} of {} {}", check.quantity, check.kind, check.name);
        (of, check.unit.as_str(), check.margin.clone(), "allowables")
    });
    let all: Vec<(String, &str, Margin, &'static str)> = of_levels.chain(of_parts).collect();
    let known = all.iter().filter_map(|one| Some((one, one.2.margin?)));
    let exceeded = known.clone().filter(|(_, left)| *left < 0.0).count();
    let ((of, unit, margin, section), left) = known.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let [found, allowable] = [margin.found, margin.allowable].map(|value| quantity(value, unit));
    let others = match all.len() {
        1 => String::new(),
        count => format!("; least of {count} margins, {exceeded} allowables exceeded"),
    };
    Some(Tile {
        grade: if left < 0.0 { "bad" } else { "good" },
        ..tile(
            "Margin",
            percent(left),
            format!("{of}: {found} of {allowable}{others}"),
            section,
        )
    })
}

/// Of the contact with the largest force.
fn of_contacts(results: &Results, summary: &Summary) -> Vec<Tile> {
    let Some((name, contact, _)) = largest(&summary.contacts, |c| Some(c.peak_force)) else {
        return Vec::new();
    };
    if contact.first_closing.is_none() {
        let note = "nothing touched".to_owned();
        return vec![tile("Peak force", "0".to_owned(), note, "plot-force")];
    }
    let system = &results.system;
    let number = system.contacts.iter().position(|c| c.name == *name);
    let record = number.and_then(|k| results.last.records.contacts.get(k));
    let at = record.map_or(String::new(), |r| {
        format!("at {}, ", clock(results, r.peak_time))
    });
    let of = match summary.contacts.len() {
        1 => String::new(),
        count => format!("{name}, largest of {count} contacts; "),
    };
    let mean = contact.peak_mean_force.filter(|_| contact.window > 0.0);
    let mean = mean.map(|mean| {
        let window = quantity(contact.window, "s");
        format!("; mean over {window}: {}", quantity(mean, "N"))
    });
    let loaded = preload(contact).map(|[preload, shock]| {
        let [preload, shock] = [preload, shock].map(|force| quantity(force, "N"));
        format!("; of it preload {preload}, shock {shock}")
    });
    let steps = format!(
        "{at}of a single step{}{}",
        loaded.unwrap_or_default(),
        mean.unwrap_or_default()
    );
    let peak = quantity(contact.peak_force, "N");
    let mut tiles = vec![Tile {
        time: record.map(|record| record.peak_time),
        ..tile("Peak force", peak, format!("{of}{steps}"), "plot-force")
    }];
    tiles.extend(shock(&summary.contacts));
    tiles.extend(impulse(results, summary));
    if contact.impulse.is_some() {
        tiles.push(restitution(summary, name, contact));
    }
    tiles
}

/// The force at the end of a static stage, and what the largest force has over it, N; none of a contact that carries nothing there.
fn preload(contact: &Contact) -> Option<[f64; 2]> {
    let preload = contact.preload.filter(|preload| *preload > 0.0)?;
    Some([preload, (contact.peak_force - preload).max(0.0)])
}

/// Of the contact whose force grows most over its preload: a large preload hides the shock, and the shock of another contact.
fn shock(contacts: &BTreeMap<String, Contact>) -> Option<Tile> {
    let is_loaded = |contact: &Contact| preload(contact).is_some();
    if !contacts.values().any(is_loaded) {
        return None;
    }
    let over = |contact: &Contact| preload(contact).map_or(contact.peak_force, |[_, over]| over);
    let (name, contact, most) = largest(contacts, |contact| Some(over(contact)))?;
    let of = match contacts.len() {
        1 => String::new(),
        count => format!("{name}, largest of {count} contacts; "),
    };
    let [peak, before] = [contact.peak_force, contact.peak_force - most];
    let [peak, before] = [peak, before].map(|force| quantity(force, "N"));
    let note = format!("{of}largest force {peak} less the preload {before}");
    Some(tile("Shock", quantity(most, "N"), note, "plot-force"))
}

/// The contact with the largest number of those that have one, and that number; the last of equals.
fn largest(
    contacts: &BTreeMap<String, Contact>,
    number: impl Fn(&Contact) -> Option<f64>,
) -> Option<(&String, &Contact, f64)> {
    let all = contacts.iter();
    let all = all.filter_map(|(name, contact)| Some((name, contact, number(contact)?)));
    all.max_by(|a, b| a.2.total_cmp(&b.2))
}

/// Of the contact with the largest impulse, which need not be that with the largest force.
fn impulse(results: &Results, summary: &Summary) -> Option<Tile> {
    let all = summary.contacts.values().filter_map(|c| c.impulse);
    let (name, contact, largest) = largest(&summary.contacts, |contact| contact.impulse)?;
    let (of, sum) = match summary.contacts.len() {
        1 => Default::default(),
        count => {
            let sum = quantity(all.sum(), "N s");
            let of = format!("{name}, largest of {count} contacts; ");
            (of, format!("; all contacts together {sum}"))
        }
    };
    let note = format!("{of}{}{sum}", closed(results, contact));
    let value = quantity(largest, "N s");
    Some(tile("Impulse", value, note, "plot-impulse"))
}

fn closed(results: &Results, contact: &Contact) -> String {
    let impacts = match contact.impacts {
        1 => "1 impact".to_owned(),
        count => format!("{count} impacts"),
    };
    let from = contact
        .first_closing
        .map_or(String::new(), |t| format!(" from {}", clock(results, t)));
    match contact.last_release {
        Some(release) => format!("{impacts}{from} to {}", clock(results, release)),
        None => format!("{impacts}{from}, closed at the end"),
    }
}

fn restitution(summary: &Summary, name: &str, contact: &Contact) -> Tile {
    let exact = summary.exact.as_ref().filter(|exact| exact.contact == name);
    let value = contact
        .restitution
        .or(exact.and_then(|exact| exact.restitution));
    let (text, note) = match value {
        Some(value) => {
            let exact = exact.and_then(|exact| exact.exact_restitution);
            let exact = exact.map(|e| format!("; exact {}", quantity(e, "")));
            let note = format!("of the last impact of {name}{}", exact.unwrap_or_default());
            (quantity(value, ""), note)
        }
        None if summary.contacts.len() > 1 => {
            let why = no_restitution(contact);
            ("–".to_owned(), format!("none of {name}: {why}"))
        }
        None => ("–".to_owned(), format!("none: {}", no_restitution(contact))),
    };
    let section = if contact.impacts > 0 {
        "impacts"
    } else {
        "plot-force"
    };
    tile("Restitution", text, note, section)
}

fn no_restitution(contact: &Contact) -> String {
    let why = contact.no_restitution.clone();
    why.unwrap_or_else(|| "links join further bodies to one of the two".to_owned())
}

/// What was lost and where; the largest two places first.
fn energy(energy: &Energy) -> Tile {
    let mut places: BTreeMap<String, f64> = energy.dissipations.clone();
    let contact = energy.works.get("contact").copied().unwrap_or(0.0);
    places.insert("contact".to_owned(), -contact);
    let lost: f64 = places.values().sum();
    let supplied = energy.supplied();
    // what rounding and the shown digits leave
    let is_none = |value: f64| value.abs() < 5e-5 * supplied;
    let part = |value: f64| match supplied > 0.0 && !is_none(value) {
        true => percent(value / supplied),
        false => percent(0.0),
    };
    let mut sorted: Vec<(&String, f64)> =
        places.iter().map(|(name, value)| (name, *value)).collect();
    sorted.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    let told = sorted.iter().filter(|(_, value)| !is_none(*value)).take(3);
    let told: Vec<String> = told
        .map(|(name, value)| format!("{name} {}", part(*value)))
        .collect();
    let told = match told.is_empty() {
        true => format!("less than 0.005 % of {} put in", quantity(supplied, "J")),
        false => {
            let [lost, supplied] = [lost, supplied].map(|energy| quantity(energy, "J"));
            format!("{lost} of {supplied} put in: {}", told.join(", "))
        }
    };
    let residual = match energy.relative_residual {
        0.0 => "0".to_owned(),
        residual => scientific(residual, 1),
    };
    let note = format!("{told}; the balance closes to {residual} of the largest energy");
    tile("Energy lost", part(lost), note, "balances")
}

/// Largest values of the fields: of stresses over the steps, of others at the kept instants.
fn of_fields(results: &Results, maxima: &Maxima) -> Vec<Tile> {
    let kept = format!("largest of {} kept instants", maxima.instants);
    let steps = results.stressed.schedule();
    let cells = "mean of a cell";
    let sections = maxima.von_mises.as_ref();
    let sections = sections.map_or(cells, |maximum| place_in_section(&results.system, maximum));
    let all = [
        (
            ("Largest von Mises stress", "Pa"),
            (&maxima.von_mises, "von_mises"),
            (sections, &steps),
        ),
        (
            ("Largest principal strain", ""),
            (&maxima.strain, ""),
            ("a cell", &kept),
        ),
        (
            ("Largest plastic strain", ""),
            (&maxima.plastic_strain, "plastic"),
            (cells, &kept),
        ),
        (
            ("Largest displacement", "m"),
            (&maxima.displacement, "displacement"),
            ("a node", &kept),
        ),
    ];
    let one = |((label, unit), (maximum, field), (of, over)): (_, (&Option<Maximum>, _), _)| {
        let maximum = maximum.as_ref()?;
        let body = match maximum.body.as_str() {
            "" => String::new(),
            name => format!(" of {name}"),
        };
        let place = coordinates(&results.system, &maximum.place);
        let time = clock(results, maximum.time);
        let note = format!("{of}{body} at {place}, t = {time}; {over}");
        Some(Tile {
            time: Some(maximum.time),
            field,
            ..tile(label, quantity(maximum.value, unit), note, "model")
        })
    };
    all.into_iter().filter_map(one).collect()
}

/// Where in a cell of its body a largest stress is.
fn place_in_section(system: &System, maximum: &Maximum) -> &'static str {
    let mut bodies = system.bodies.iter();
    let body = bodies.find(|body| body.name() == maximum.body);
    match body {
        Some(Body::Shell(_)) => "the largest through the thickness",
        Some(Body::Beam(_) | Body::LargeBeam(_)) => "the largest in a section",
        Some(Body::Reduced(reduced)) if reduced.has_sections() => "the largest in a section",
        _ => "mean of a cell",
    }
}

/// A time; in a run that begins with a static stage, whose time is none, that since its end.
fn clock(results: &Results, time: f64) -> String {
    let begin = results.stills.begin();
    match (begin > 0.0, time - begin) {
        (false, _) => quantity(time, "s"),
        (true, since) if since > 0.0 => {
            format!("{} after the static stage", quantity(since, "s"))
        }
        (true, _) => "the static stage".to_owned(),
    }
}

/// A place in the reference configuration.
fn coordinates(system: &System, x: &[f64]) -> String {
    // what rounding leaves of a zero
    let least = 1e-9 * size(system);
    let all: Vec<String> = x
        .iter()
        .map(|x| quantity(if x.abs() < least { 0.0 } else { *x }, "m"))
        .collect();
    format!("({})", all.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shock_is_told_beside_a_preload_that_is_larger() {
        let contact = |peak_force, preload| Contact {
            peak_force,
            preload,
            ..Contact::default()
        };
        let both = |contacts: [(&str, Contact); 2]| -> BTreeMap<String, Contact> {
            contacts.map(|(name, one)| (name.to_owned(), one)).into()
        };
        let loaded = [
            ("bolt", contact(20e3, Some(19e3))),
            ("rail", contact(3e3, Some(0.0))),
        ];
        let tile = shock(&both(loaded)).unwrap();
        assert_eq!((tile.label, &tile.value[..]), ("Shock", "3.00 kN"));
        assert!(tile.note.starts_with("rail"), "{}", tile.note);
        assert_eq!(preload(&contact(20e3, Some(19e3))), Some([19e3, 1e3]));
        let without = [("bolt", contact(20e3, None)), ("rail", contact(3e3, None))];
        assert_eq!(shock(&both(without)), None);
    }

    #[test]
    fn the_largest_force_and_the_largest_impulse_may_be_of_two_contacts() {
        let contact = |peak_force, impulse| Contact {
            peak_force,
            impulse,
            ..Contact::default()
        };
        let contacts = BTreeMap::from([
            ("hard".to_owned(), contact(15.0, Some(0.7))),
            ("soft".to_owned(), contact(3.0, Some(1.7))),
            ("still".to_owned(), contact(0.0, None)),
        ]);
        let (name, _, force) = largest(&contacts, |c| Some(c.peak_force)).unwrap();
        assert_eq!((name.as_str(), force), ("hard", 15.0));
        let (name, _, impulse) = largest(&contacts, |c| c.impulse).unwrap();
        assert_eq!((name.as_str(), impulse), ("soft", 1.7));
    }
}
