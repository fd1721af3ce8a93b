//! Levels: contacts that are judged together.

use carom_dynamics::System;
use carom_output::{Allowable, LevelSettings, takes_energy};

use super::context::Context;
use super::problems::Problems;
use crate::error::Problem;

/// The levels of the case, their contacts by their places in the system.
pub(super) fn lower(
    context: &Context,
    system: &System,
    problems: &mut Problems,
) -> Vec<LevelSettings> {
    let mut levels = Vec::new();
    for (name, level) in context.case.level.iter() {
        let mut contacts = Vec::new();
        for (k, wanted) in level.contacts.iter().enumerate() {
            let matches = |found: &str| match wanted.strip_suffix('*') {
                Some(start) => found.starts_with(start),
                None => found == wanted,
            };
            let all = system.contacts.iter().enumerate();
            let found = all.filter(|(_, contact)| matches(&contact.name));
            let before = contacts.len();
            contacts.extend(found.map(|(place, _)| place));
            if contacts.len() == before {
                let path = format!("level.{name}.contacts[{k}]");
                let problem = Problem::new(path, "no contact and no stop of this name");
                let names = system.contacts.iter().map(|c| c.name.as_str());
                problems.push(problem.unknown(wanted, names));
            }
        }
        contacts.sort_unstable();
        contacts.dedup();
        let allowable = level
            .allowable
            .map_or(Allowable::default(), |allowable| Allowable {
                force: allowable.force.map(|force| force.0),
                energy: allowable.energy.map(|energy| energy.0),
                stroke: allowable.stroke.map(|stroke| stroke.0),
                crush: allowable.crush.map(|crush| crush.0),
            });
        if allowable.energy.is_some() {
            check_energy(context, system, name, &contacts, problems);
        }
        levels.push(LevelSettings {
            name: name.to_owned(),
            contacts,
            allowable,
        });
    }
    levels
}

/// Refuses an allowable energy of contacts that take up none. A stop that has an exact law in the place of its spring, for a comparison, is told
/// to have no margin.
fn check_energy(
    context: &Context,
    system: &System,
    level: &str,
    contacts: &[usize],
    problems: &mut Problems,
) {
    let without = contacts.iter().filter(|k| !takes_energy(system, **k));
    let without = without.map(|k| &system.contacts[*k]);
    let (stops, others): (Vec<_>, Vec<_>) =
        without.partition(|contact| context.case.stop.get(&contact.name).is_some());
    if let Some(stop) = stops.first() {
        problems.warn(format!(
            "level `{level}`: stop `{}` takes up no energy with the {} law: it has no margin to the allowable one",
            stop.name,
            stop.law.get().name()
        ));
    }
    if let Some(contact) = others.first() {
        let message = format!(
            "contact `{}` takes up no energy with the {} law: what bodies lose there is the error of mesh and step",
            contact.name,
            contact.law.get().name()
        );
        let problem = Problem::new(format!("level.{level}.allowable.energy"), message);
        problems.push(problem.accepted([
            "contacts with a law that takes energy up: stop, penalty, damped, compliance, restitution below 1",
            "an allowable force alone",
        ]));
    }
}
