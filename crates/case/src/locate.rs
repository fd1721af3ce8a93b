//! Where each value of a case stands, for what is found out after reading.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{Place, Problem};
use crate::tree::{Item, Node, join};

/// From key paths to places in the sources.
#[derive(Clone, Debug)]
pub struct Locator {
    entries: BTreeMap<String, Entry>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    key: Option<Place>,
    place: Place,
}

impl Locator {
    pub(crate) fn new(root: &Item) -> Locator {
        let mut locator = Locator {
            entries: BTreeMap::new(),
        };
        locator.enter("", root);
        locator
    }

    fn enter(&mut self, path: &str, item: &Item) {
        self.entries.insert(
            path.to_owned(),
            Entry {
                key: item.key,
                place: item.place(),
            },
        );
        match &item.node {
            Node::Table(entries) => entries
                .iter()
                .for_each(|(key, item)| self.enter(&join(path, key), item)),
            Node::Array(items) => items
                .iter()
                .enumerate()
                .for_each(|(at, item)| self.enter(&format!("{path}[{at}]"), item)),
            _ => {}
        }
    }

    /// Whether the file or an override holds a value at `path`.
    pub fn contains(&self, path: &str) -> bool {
        self.entries.contains_key(path)
    }

    /// Place of the value at `path` (of a table: of its name); where the case leaves it out, of the table it would stand in.
    pub fn value(&self, path: &str) -> Option<Place> {
        self.nearest(path).map(|entry| entry.place)
    }

    /// Place of the key at `path`, otherwise as [`Locator::value`].
    pub fn key(&self, path: &str) -> Option<Place> {
        self.nearest(path)
            .map(|entry| entry.key.unwrap_or(entry.place))
    }

    /// The problem with its place, unless it has one.
    #[must_use]
    pub fn locate(&self, mut problem: Problem) -> Problem {
        problem.place = problem.place.or_else(|| self.value(&problem.path));
        problem
    }

    /// All problems with their places, in the order of the sources; those of tables that are made of one, once.
    #[must_use]
    pub fn locate_all(&self, problems: Vec<Problem>) -> Vec<Problem> {
        let mut problems: Vec<Problem> = problems
            .into_iter()
            .map(|problem| self.locate(problem))
            .collect();
        problems.sort_by_key(|problem| problem.place);
        self.once(problems)
    }

    /// Problems of tables with one key in the sources, which `[repeat]` has made of one, that differ by the name of the table alone: the first
    /// one, which tells the number of the others.
    fn once(&self, problems: Vec<Problem>) -> Vec<Problem> {
        let mut all: Vec<Problem> = Vec::new();
        let mut groups = BTreeMap::new();
        for problem in problems {
            let Some((table, name, path)) = parts(&problem.path) else {
                all.push(problem);
                continue;
            };
            let Some(key) = self.entries.get(table).and_then(|entry| entry.key) else {
                all.push(problem);
                continue;
            };
            let (name, message) = (name.to_owned(), problem.message.replace(name, ""));
            let group = (problem.place, key, path, message);
            let (_, names) = groups.entry(group).or_insert_with(|| {
                all.push(problem);
                (all.len() - 1, BTreeSet::new())
            });
            names.insert(name);
        }
        for (at, names) in groups.into_values().filter(|(_, names)| names.len() > 1) {
            let others = names.len() - 1;
            let note = format!("the same in {others} more tables that are made of this one");
            all[at].notes.push(note);
        }
        all
    }

    fn nearest(&self, path: &str) -> Option<Entry> {
        let mut path = path;
        loop {
            if let Some(entry) = self.entries.get(path) {
                return Some(*entry);
            }
            if path.is_empty() {
                return None;
            }
            path = &path[..path.rfind(['.', '[']).unwrap_or(0)];
        }
    }
}

/// Of a path, `stop.left.gap`: the table `stop.left`, its name, and the path without it.
fn parts(path: &str) -> Option<(&str, &str, String)> {
    let (kind, rest) = path.split_once('.')?;
    let end = rest.find(['.', '[']).unwrap_or(rest.len());
    let table = &path[..kind.len() + 1 + end];
    Some((table, &rest[..end], format!("{kind}.{}", &rest[end..])))
}
