//! Tables that stand for many: `[repeat]` names indices, and a table with one of them in its name is written once for each of its values.
//!
//! Repetition comes after the overrides and before the schema, so that overrides see the tables as they are written, and each
//! error names the table that was made and the place where it was written.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::{Place, Problem};
use crate::schema::is_name;
use crate::tree::{Item, Node, join};

/// The key of the indices.
const REPEAT: &str = "repeat";

/// Most tables made of one.
const MOST: i64 = 10_000;

/// First and last value of each index.
type Indices = BTreeMap<String, [i64; 2]>;

/// Values of the indices in the names around.
type Values<'a> = BTreeMap<&'a str, i64>;

/// Replaces tables with indices in their names by one for each value. Where two make the same table, the keys of the one that has
/// fewer indices count, and those of a table that is written out before all.
///
/// # Errors
/// Indices that are none, names in braces that are no index or have no value where they stand, names made twice.
pub(crate) fn expand(root: &mut Item) -> Result<(), Vec<Problem>> {
    let Node::Table(entries) = &mut root.node else {
        return Ok(());
    };
    let Some(given) = entries.remove(REPEAT) else {
        return Ok(());
    };
    let mut problems = Vec::new();
    let indices = indices(&given, &mut problems);
    if problems.is_empty() {
        let mut maker = Maker {
            indices: &indices,
            problems,
        };
        maker.table("", entries, &Values::new());
        problems = maker.problems;
    }
    entries.insert(REPEAT.to_owned(), given);
    // one for all tables that are made
    let mut told = BTreeSet::new();
    problems.retain(|problem| told.insert((problem.place, problem.message.clone())));
    match problems.is_empty() {
        true => Ok(()),
        false => Err(problems),
    }
}

fn indices(given: &Item, problems: &mut Vec<Problem>) -> Indices {
    let mut indices = Indices::new();
    let Node::Table(entries) = &given.node else {
        let problem = Problem::new(REPEAT, "indices are a table").at(given.place());
        problems.push(problem.accepted(["[repeat] with lines such as n = [1, 15]"]));
        return indices;
    };
    for (name, item) in entries {
        let range = match &item.node {
            Node::Array(ends) => match &ends[..] {
                [a, b] => match (&a.node, &b.node) {
                    (Node::Integer(a), Node::Integer(b)) => Some([*a, *b]),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        };
        let fits = |[first, last]: &[i64; 2]| {
            first <= last && last.checked_sub(*first).is_some_and(|more| more < MOST)
        };
        match range.filter(fits).filter(|_| is_name(name)) {
            Some(range) => {
                indices.insert(name.clone(), range);
            }
            None => {
                let message =
                    "an index has a name of letters, digits, `_` and `-`, a first and a last value";
                let problem = Problem::new(join(REPEAT, name), message).at(item.place());
                let accepted = format!("two integers, at most {MOST} values, as in n = [1, 15]");
                problems.push(problem.accepted([accepted]));
            }
        }
    }
    indices
}

struct Maker<'a> {
    indices: &'a Indices,
    problems: Vec<Problem>,
}

impl<'a> Maker<'a> {
    fn table(&mut self, path: &str, entries: &mut BTreeMap<String, Item>, values: &Values<'a>) {
        let (repeated, own): (Vec<_>, Vec<_>) = std::mem::take(entries)
            .into_iter()
            .partition(|(key, _)| key.contains('{'));
        let mut templates = Vec::new();
        for (key, item) in repeated {
            let at = (join(path, &key), item.key.unwrap_or(item.value));
            if let Some(pieces) = self.pieces(&key, &at) {
                let free = self.free(&pieces, values);
                templates.push((free, pieces, item, at));
            }
        }
        // what stands for fewer tables comes later
        templates.sort_by_key(|(free, ..)| std::cmp::Reverse(free.len()));
        let mut made: BTreeMap<String, usize> = BTreeMap::new();
        for (free, pieces, item, at) in templates {
            for values in self.each(&free, values, &at) {
                let name = self.written(&pieces, &values, &at);
                let mut one = item.clone();
                self.item(&join(path, &name), &mut one, &values);
                if made.insert(name.clone(), free.len()) == Some(free.len()) {
                    let problem = Problem::new(join(path, &name), "a name is made twice");
                    self.problems.push(problem.at(at.1));
                }
                put(entries, name, one);
            }
        }
        for (key, mut item) in own {
            self.item(&join(path, &key), &mut item, values);
            put(entries, key, item);
        }
    }

    /// Indices in a name that have no value yet.
    fn free(&self, pieces: &[Piece], values: &Values) -> Vec<&'a str> {
        let mut free = Vec::new();
        for index in pieces.iter().filter_map(Piece::index) {
            if let Some((index, _)) = self.indices.get_key_value(index)
                && !values.contains_key(index.as_str())
                && !free.contains(&index.as_str())
            {
                free.push(index.as_str());
            }
        }
        free
    }

    /// All values of some indices beside those around; none after a problem.
    fn each(
        &mut self,
        free: &[&'a str],
        around: &Values<'a>,
        (path, place): &(String, Place),
    ) -> Vec<Values<'a>> {
        let mut all = vec![around.clone()];
        for &index in free {
            let [first, last] = self.indices[index];
            if (last - first + 1) * all.len() as i64 > MOST {
                let message = format!("one table stands for more than {MOST}");
                let problem = Problem::new(path.clone(), message);
                self.problems.push(problem.at(*place));
                return Vec::new();
            }
            let with = |values: Values<'a>| {
                (first..=last).map(move |value| {
                    let mut values = values.clone();
                    values.insert(index, value);
                    values
                })
            };
            all = all.into_iter().flat_map(with).collect();
        }
        all
    }

    fn item(&mut self, path: &str, item: &mut Item, values: &Values<'a>) {
        let place = item.value;
        match &mut item.node {
            Node::Text(text) if text.contains('{') => {
                let at = (path.to_owned(), place);
                if let Some(pieces) = self.pieces(text, &at) {
                    *text = self.written(&pieces, values, &at);
                }
            }
            Node::Array(items) => {
                for (k, item) in items.iter_mut().enumerate() {
                    self.item(&format!("{path}[{k}]"), item, values);
                }
            }
            Node::Table(entries) => self.table(path, entries, values),
            _ => {}
        }
    }

    /// A text in pieces; none after a problem.
    fn pieces(&mut self, text: &str, (path, place): &(String, Place)) -> Option<Vec<Piece>> {
        let pieces = pieces(text);
        let is_known = |piece: &Piece| {
            piece
                .index()
                .is_none_or(|name| self.indices.contains_key(name))
        };
        if let Some(pieces) = pieces.filter(|pieces| pieces.iter().all(is_known)) {
            return Some(pieces);
        }
        let names = self.indices.keys().map(|name| format!("{{{name}}}"));
        let problem = Problem::new(
            path.clone(),
            "what stands in braces is no index of `[repeat]`",
        );
        let problem = problem.found(format!("{text:?}")).at(*place);
        let more =
            "an index times a number, plus or minus a number, as in {n+1} and {n*0.25}".to_owned();
        self.problems.push(problem.accepted(names.chain([more])));
        None
    }

    /// The text with the values of its indices.
    fn written(
        &mut self,
        pieces: &[Piece],
        values: &Values,
        (path, place): &(String, Place),
    ) -> String {
        let mut text = String::new();
        for piece in pieces {
            match piece {
                Piece::Plain(plain) => text += plain,
                Piece::Index {
                    name,
                    factor,
                    shift,
                } => match values.get(name.as_str()) {
                    Some(value) => text += &(*value as f64 * factor + shift).to_string(),
                    None => {
                        let message = format!("`{name}` has no value here: no name around has it");
                        let problem = Problem::new(path.clone(), message).at(*place);
                        self.problems.push(problem);
                    }
                },
            }
        }
        text
    }
}

/// A piece of a text.
#[derive(Debug, PartialEq)]
enum Piece {
    Plain(String),
    /// `factor` times the value of an index, plus `shift`.
    Index {
        name: String,
        factor: f64,
        shift: f64,
    },
}

impl Piece {
    fn index(&self) -> Option<&str> {
        match self {
            Piece::Plain(_) => None,
            Piece::Index { name, .. } => Some(name),
        }
    }
}

/// A text in its pieces; none where braces do not close or hold something else than an index.
fn pieces(text: &str) -> Option<Vec<Piece>> {
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(open) = rest.find('{') {
        let close = open + rest[open..].find('}')?;
        pieces.push(Piece::Plain(rest[..open].to_owned()));
        pieces.push(index(&rest[open + 1..close])?);
        rest = &rest[close + 1..];
    }
    pieces.push(Piece::Plain(rest.to_owned()));
    Some(pieces)
}

/// `n`, `n*2`, `n+1`, `n*2-1`.
fn index(text: &str) -> Option<Piece> {
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
    let (term, shift) = match text.rfind(['+', '-']) {
        // a name may have a hyphen: a number follows the sign
        Some(at) => match number(&text[at + 1..]) {
            Some(shift) if text[at..].starts_with('-') => (&text[..at], -shift),
            Some(shift) => (&text[..at], shift),
            None => (text, 0.0),
        },
        None => (text, 0.0),
    };
    let (name, factor) = match term.split_once('*') {
        Some((name, factor)) => (name, number(factor)?),
        None => (term, 1.0),
    };
    let name = name.trim();
    is_name(name).then(|| Piece::Index {
        name: name.to_owned(),
        factor,
        shift,
    })
}

/// Puts an item in a table; of two tables the keys of the later one count.
fn put(entries: &mut BTreeMap<String, Item>, key: String, item: Item) {
    let item = match entries.remove(&key) {
        Some(before) => merged(before, item),
        None => item,
    };
    entries.insert(key, item);
}

fn merged(made: Item, own: Item) -> Item {
    match (made.node, own.node) {
        (Node::Table(mut entries), Node::Table(keys)) => {
            for (key, item) in keys {
                put(&mut entries, key, item);
            }
            Item {
                node: Node::Table(entries),
                ..own
            }
        }
        (_, node) => Item { node, ..own },
    }
}
