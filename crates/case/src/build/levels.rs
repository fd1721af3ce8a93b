//! Levels: contacts that are judged together.

use carom_dynamics::System;
use carom_output::{Allowable, LevelSettings};

use super::Builder;
use crate::error::Problem;

impl Builder<'_> {
    /// The levels of the case, their contacts by their places in the system.
    pub(super) fn levels(&mut self, system: &System) -> Vec<LevelSettings> {
        let mut levels = Vec::new();
        for (name, level) in self.case.level.iter() {
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
                    self.problems.push(problem.unknown(wanted, names));
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
            levels.push(LevelSettings {
                name: name.to_owned(),
                contacts,
                allowable,
            });
        }
        levels
    }
}
