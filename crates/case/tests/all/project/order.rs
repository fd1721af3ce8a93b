//! The order of what a case names: that of the alphabet.

use std::collections::BTreeMap;

use toml::Value;

use super::Project;

/// Sections whose things are named anew.
const SECTIONS: [&str; 11] = [
    "body",
    "contact",
    "stop",
    "spring",
    "dashpot",
    "support",
    "load",
    "arlequin",
    "interface",
    "zone",
    "probe",
];

impl Project {
    /// The same with bodies, contacts and all else in the reversed order, and the old name of each new one.
    pub fn reversed(&self) -> (Project, BTreeMap<String, String>) {
        let mut other = self.in_si();
        // levels name contacts by patterns
        other.table.remove("level");
        let mut names = BTreeMap::new();
        let mut bodies = BTreeMap::new();
        let mut zones = BTreeMap::new();
        for section in SECTIONS {
            let Some(Value::Table(things)) = other.table.get_mut(section) else {
                continue;
            };
            let old = std::mem::take(things);
            let count = old.len();
            for (k, (name, thing)) in old.into_iter().enumerate() {
                let new = format!("r{:03}-{name}", count - k);
                names.insert(new.clone(), name.clone());
                match section {
                    "body" => bodies.insert(name, new.clone()),
                    "zone" => zones.insert(name, new.clone()),
                    _ => None,
                };
                things.insert(new, thing);
            }
        }
        for (section, key) in [
            ("zone", "bodies"),
            ("arlequin", "inner"),
            ("arlequin", "outer"),
            ("interface", "inner"),
            ("interface", "outer"),
            ("pretension", "beam"),
        ] {
            other.rename(section, key, &bodies);
        }
        if let Some(Value::Table(all)) = other.table.get_mut("zone") {
            for (_, zone) in all.iter_mut() {
                if let Some(Value::Table(substeps)) = zone.get_mut("substeps") {
                    let old = std::mem::take(substeps);
                    let new = |name: &String| zones[name].clone();
                    substeps.extend(old.into_iter().map(|(name, steps)| (new(&name), steps)));
                }
            }
        }
        (other, names)
    }

    /// The same with the ends of each stop in the other order: what one does to the other is the same as what the other does to the one.
    pub fn with_ends_swapped(&self) -> Option<Project> {
        let mut other = self.in_si();
        let Value::Table(stops) = other.table.get_mut("stop")? else {
            return None;
        };
        // the ground, which has no radius, is the second end then
        let swaps = |stop: &Value| {
            let radii = stop.get("radius").and_then(Value::as_array);
            radii.is_none_or(|radii| radii.len() == 2)
        };
        for (_, stop) in stops.iter_mut().filter(|(_, stop)| swaps(stop)) {
            let Some(Value::Array(axis)) = stop.get_mut("axis") else {
                continue;
            };
            for x in axis {
                *x = Value::Float(-x.as_float().unwrap());
            }
            for key in ["ends", "radius"] {
                if let Some(Value::Array(ends)) = stop.get_mut(key) {
                    ends.reverse();
                }
            }
        }
        Some(other)
    }

    /// The same with the sides of each contact of two bodies in the other order.
    pub fn with_sides_swapped(&self) -> Project {
        let mut other = self.clone();
        if let Some(Value::Table(contacts)) = other.table.get_mut("contact") {
            for (_, contact) in contacts.iter_mut() {
                let contact = contact.as_table_mut().unwrap();
                if let Some(primary) = contact.remove("primary") {
                    let secondary = contact.insert("secondary".to_owned(), primary);
                    contact.insert("primary".to_owned(), secondary.unwrap());
                }
            }
        }
        other
    }

    /// Gives names in a key of the things of a section their new ones.
    fn rename(&mut self, section: &str, key: &str, names: &BTreeMap<String, String>) {
        let Some(Value::Table(things)) = self.table.get_mut(section) else {
            return;
        };
        let new = |name: &mut Value| {
            let known = name.as_str().and_then(|name| names.get(name));
            *name = known.map_or(name.clone(), |new| Value::String(new.clone()));
        };
        for (_, thing) in things.iter_mut() {
            match thing.get_mut(key) {
                Some(Value::Array(list)) => list.iter_mut().for_each(new),
                Some(name) => new(name),
                None => {}
            }
        }
    }
}
