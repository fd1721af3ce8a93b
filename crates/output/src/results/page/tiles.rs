//! The numbers on top of the report.

use std::collections::BTreeMap;

use carom_dynamics::System;
use serde::Serialize;

use crate::form::percent;
use crate::plot::quantity;
use crate::results::Results;
use crate::results::outlines::size;
use crate::results::page::model;
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
}

fn tile(label: &'static str, value: String, note: String, section: &'static str) -> Tile {
    Tile {
        label,
        value,
        note,
        section,
        grade: "",
    }
}

/// All tiles in their order.
pub(crate) fn tiles(results: &Results, summary: &Summary) -> Vec<Tile> {
    let mut tiles = vec![verdict(summary)];
    tiles.extend(of_contacts(results, summary));
    tiles.push(energy(&summary.energy));
    tiles.extend(of_fields(results));
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

/// Of the contact with the largest force.
fn of_contacts(results: &Results, summary: &Summary) -> Vec<Tile> {
    let contacts = summary.contacts.iter();
    let largest = contacts.max_by(|a, b| a.1.peak_force.total_cmp(&b.1.peak_force));
    let Some((name, contact)) = largest else {
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
        format!("at {}, ", quantity(r.peak_time, "s"))
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
    let steps = format!("{at}of a single step{}", mean.unwrap_or_default());
    let peak = quantity(contact.peak_force, "N");
    let mut tiles = vec![tile(
        "Peak force",
        peak,
        format!("{of}{steps}"),
        "plot-force",
    )];
    if let Some(impulse) = contact.impulse {
        let note = format!("{of}{}", closed(contact));
        tiles.push(tile(
            "Impulse",
            quantity(impulse, "N s"),
            note,
            "plot-impulse",
        ));
        tiles.push(restitution(summary, name, contact));
    }
    tiles
}

fn closed(contact: &Contact) -> String {
    let impacts = match contact.impacts {
        1 => "1 impact".to_owned(),
        count => format!("{count} impacts"),
    };
    let from = contact
        .first_closing
        .map_or(String::new(), |t| format!(" from {}", quantity(t, "s")));
    match contact.last_release {
        Some(release) => format!("{impacts}{from} to {}", quantity(release, "s")),
        None => format!("{impacts}{from}, closed at the end"),
    }
}

fn restitution(summary: &Summary, name: &str, contact: &Contact) -> Tile {
    let exact = summary.exact.as_ref().filter(|exact| exact.contact == name);
    let value = contact
        .restitution
        .or(exact.and_then(|exact| exact.restitution));
    let (text, note) = match (value, contact.last_release) {
        (Some(value), _) => {
            let exact = exact.and_then(|exact| exact.exact_restitution);
            let exact = exact.map(|e| format!("; exact {}", quantity(e, "")));
            let note = format!("of the last impact of {name}{}", exact.unwrap_or_default());
            (quantity(value, ""), note)
        }
        (None, None) => (
            "–".to_owned(),
            "the contact is closed at the end".to_owned(),
        ),
        (None, Some(_)) => {
            let note = "none: loads, supports or further contacts change the momenta too, or the impact has not ended";
            ("–".to_owned(), note.to_owned())
        }
    };
    let section = if contact.impacts > 0 {
        "impacts"
    } else {
        "plot-force"
    };
    tile("Restitution", text, note, section)
}

/// What was lost and where; the largest two places first.
fn energy(energy: &Energy) -> Tile {
    let mut places: BTreeMap<String, f64> = energy.dissipations.clone();
    let contact = energy.works.get("contact").copied().unwrap_or(0.0);
    places.insert("contact".to_owned(), -contact);
    let lost: f64 = places.values().sum();
    let supplied = supplied(energy);
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
    let note = match told.is_empty() {
        true => format!("less than 0.005 % of {} put in", quantity(supplied, "J")),
        false => {
            let [lost, supplied] = [lost, supplied].map(|energy| quantity(energy, "J"));
            format!("{lost} of {supplied} put in: {}", told.join(", "))
        }
    };
    tile("Energy lost", part(lost), note, "balances")
}

/// Energy at the start, and what loads, supports and obstacles gave in sum if that is positive, J.
fn supplied(energy: &Energy) -> f64 {
    let outside = ["loads", "supports", "obstacles"];
    let works = outside.iter().filter_map(|name| energy.works.get(*name));
    let given = works.filter(|work| **work > 0.0).sum::<f64>();
    energy.kinetic_initial + energy.strain_initial + given
}

/// Largest values of the fields at the kept instants.
fn of_fields(results: &Results) -> Vec<Tile> {
    let (system, seen) = (&results.system, &results.stills.seen);
    let instants = model::instants(results);
    let kept = format!("largest of {} kept instants", instants.len());
    let mut tiles = Vec::new();
    let labels = [
        ("Largest von Mises stress", "Pa"),
        ("Largest plastic strain", ""),
    ];
    for (k, (label, unit)) in labels.into_iter().enumerate() {
        let values = instants
            .iter()
            .filter_map(|(still, _)| Some((still.largest[k]?, still.time)));
        let best = values.reduce(|best, other| if other.0.0 > best.0.0 { other } else { best });
        let Some(((value, cell), time)) = best.filter(|best| best.0.0 > 0.0) else {
            continue;
        };
        let body = &system.bodies[seen.body_of_cell[cell as usize] as usize];
        let mut elements = system.bodies.iter().flat_map(|body| body.cells());
        let place = elements
            .nth(cell as usize)
            .map_or(String::new(), |element| {
                let nodes = system.mesh.element_nodes(*element);
                let n = nodes.len() as f64;
                let middle = nodes.iter().fold([0.0; 3], |sum, node| {
                    let x = system.mesh.nodes[*node as usize];
                    [0, 1, 2].map(|i| sum[i] + x[i] / n)
                });
                format!(" at {}", coordinates(system, &middle))
            });
        let at = quantity(time, "s");
        let note = format!("mean of a cell of {}{place}, t = {at}; {kept}", body.name());
        tiles.push(tile(label, quantity(value, unit), note, "model"));
    }
    let moved = instants.iter().flat_map(|(still, _)| {
        let nodes = still.moved.iter().zip(&seen.nodes);
        nodes.map(|(u, node)| {
            let length = u.iter().map(|u| f64::from(*u).powi(2)).sum::<f64>().sqrt();
            (length, *node, still.time)
        })
    });
    let best = moved.reduce(|best, other| if other.0 > best.0 { other } else { best });
    if let Some((length, node, time)) = best {
        let place = coordinates(system, &system.x[node as usize]);
        let note = format!(
            "of the node at {place}, t = {}; {kept}",
            quantity(time, "s")
        );
        tiles.push(tile(
            "Largest displacement",
            quantity(length, "m"),
            note,
            "model",
        ));
    }
    tiles
}

/// A place in the reference configuration.
fn coordinates(system: &System, x: &[f64; 3]) -> String {
    // what rounding leaves of a zero
    let least = 1e-9 * size(system);
    let own = x[..system.dim].iter();
    let all: Vec<String> = own
        .map(|x| quantity(if x.abs() < least { 0.0 } else { *x }, "m"))
        .collect();
    format!("({})", all.join(", "))
}
