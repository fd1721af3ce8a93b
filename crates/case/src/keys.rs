//! Rules between the keys of one table: those it needs, and those that need, replace or exclude each other.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::describe::{accepted, elements, entries, resolve, texts};
use carom_quantities::nearest;

use crate::error::{Place, Problem};
use crate::tree::{Item, join};

/// Keys of a table as other programs call them.
const ELSEWHERE: [(&str, &str); 2] = [("master", "primary"), ("slave", "secondary")];

/// The valid key that an unknown one was probably meant to be.
pub(crate) fn meant<'a>(
    key: &str,
    valid: impl Iterator<Item = &'a str> + Clone,
) -> Option<&'a str> {
    let here = ELSEWHERE.iter().find(|(there, _)| *there == key);
    let same = here.and_then(|(_, here)| valid.clone().find(|valid| valid == here));
    same.or_else(|| nearest(key, valid))
}

/// The keys of a table as written, beside the schema of the table.
pub(crate) struct Keys<'a> {
    root: &'a Value,
    schema: &'a Value,
    found: &'a BTreeMap<String, Item>,
    /// Valid keys that an unknown key was probably meant to be: they are not told as missing too.
    meant: Vec<&'a str>,
}

impl<'a> Keys<'a> {
    /// `root` is the whole schema.
    pub fn new(root: &'a Value, schema: &'a Value, found: &'a BTreeMap<String, Item>) -> Keys<'a> {
        let valid: Vec<&str> = entries(schema, "properties").map(|(key, _)| key).collect();
        let unknown = found.keys().filter(|key| !valid.contains(&key.as_str()));
        let meant = unknown.filter_map(|key| meant(key, valid.iter().copied()));
        Keys {
            meant: meant.collect(),
            root,
            schema,
            found,
        }
    }

    /// Every rule that the table breaks; `place` is where the table `path` is named.
    pub fn problems(&self, place: Place, path: &str) -> Vec<Problem> {
        let missing = self.missing(path).into_iter();
        missing
            .map(|problem| problem.at(place))
            .chain(self.excluded(path))
            .chain(self.dependent(path))
            .collect()
    }

    fn has(&self, key: &str) -> bool {
        self.found.contains_key(key) || self.meant.contains(&key)
    }

    /// Groups of keys of which one is needed, by keyword: `oneOf` (one only) or `anyOf` (one or more).
    fn group(&self, keyword: &str) -> Vec<&'a str> {
        elements(self.schema, keyword)
            .flat_map(|branch| texts(branch, "required"))
            .collect()
    }

    fn missing(&self, path: &str) -> Vec<Problem> {
        let required = texts(self.schema, "required").into_iter();
        let mut problems: Vec<Problem> = required
            .filter(|key| !self.has(key))
            .map(|key| {
                Problem::new(path, format!("`{key}` is missing{}", of(path)))
                    .accepted([self.wanted(key, path)])
            })
            .collect();
        for keyword in ["oneOf", "anyOf"] {
            let keys = self.group(keyword);
            if !keys.is_empty() && !keys.iter().any(|key| self.has(key)) {
                let message = format!("one of {} is missing{}", quoted(&keys), of(path));
                problems.push(Problem::new(path, message));
            }
        }
        problems
    }

    /// What the key takes: of a table, what it is for.
    fn wanted(&self, key: &str, path: &str) -> String {
        let schema = &self.schema["properties"][key];
        match accepted(self.root, schema).as_str() {
            "a table" => {
                let purpose = schema
                    .get("description")
                    .or(resolve(self.root, schema).get("description"));
                let purpose = purpose.and_then(Value::as_str).unwrap_or_default();
                format!(
                    "the table `{}`: {}",
                    join(path, key),
                    purpose.trim_end_matches('.')
                )
            }
            other => other.to_owned(),
        }
    }

    /// Keys that exclude each other, told at the last of them.
    fn excluded(&self, path: &str) -> Vec<Problem> {
        let both = self.schema.get("not").map(|not| texts(not, "required"));
        let both = both.filter(|keys| keys.iter().all(|key| self.found.contains_key(*key)));
        let groups = [self.group("oneOf"), both.unwrap_or_default()];
        let last = groups.into_iter().filter_map(|mut keys| {
            keys.retain(|key| self.found.contains_key(*key));
            let given = keys.iter().map(|&key| (key, &self.found[key]));
            let last = given.max_by_key(|(_, item)| item.place())?;
            (keys.len() > 1).then_some((keys, last))
        });
        last.map(|(keys, (key, item))| {
            let message = format!("{} exclude each other", quoted(&keys));
            Problem::new(join(path, key), message).at(item.key.unwrap_or(item.value))
        })
        .collect()
    }

    fn dependent(&self, path: &str) -> Vec<Problem> {
        let rules = entries(self.schema, "dependentRequired").filter_map(|(key, needs)| {
            let mut needs = needs.as_array()?.iter().filter_map(Value::as_str);
            Some((
                key,
                self.found.get(key)?,
                needs.find(|need| !self.has(need))?,
            ))
        });
        rules
            .map(|(key, item, need)| {
                let message = format!("`{key}` without `{need}`, which it belongs to");
                Problem::new(join(path, key), message).at(item.key.unwrap_or(item.value))
            })
            .collect()
    }
}

/// ` in `path``, or nothing for the file as a whole.
pub(crate) fn of(path: &str) -> String {
    if path.is_empty() {
        String::new()
    } else {
        format!(" in `{path}`")
    }
}

fn quoted(keys: &[&str]) -> String {
    let quoted: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    match quoted.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => quoted.concat(),
    }
}
