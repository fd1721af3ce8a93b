//! A case as it is written: TOML values, each with its place, the overrides put in.

use std::collections::BTreeMap;
use std::ops::Range;

use serde_json::json;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::{Place, Problem};
use crate::input::Input;

/// A value, where it stands, and where its key stands.
#[derive(Clone, Debug)]
pub(crate) struct Item {
    pub key: Option<Place>,
    pub value: Place,
    pub node: Node,
}

/// What a value is.
#[derive(Clone, Debug)]
pub(crate) enum Node {
    Text(String),
    Integer(i64),
    /// Any float, also one that is not finite.
    Float(f64),
    Boolean(bool),
    Date,
    Array(Vec<Item>),
    Table(BTreeMap<String, Item>),
}

impl Item {
    /// Where to point for what concerns the item as a whole: a table at its name, anything else at its value.
    pub fn place(&self) -> Place {
        match (&self.node, self.key) {
            (Node::Table(_), Some(key)) => key,
            _ => self.value,
        }
    }

    /// The value for serde. Dates and numbers that are not finite have been refused before.
    pub fn to_json(&self) -> serde_json::Value {
        match &self.node {
            Node::Text(text) => json!(text),
            Node::Integer(value) => json!(value),
            Node::Float(value) => json!(value),
            Node::Boolean(value) => json!(value),
            Node::Date => serde_json::Value::Null,
            Node::Array(items) => items.iter().map(Item::to_json).collect(),
            Node::Table(entries) => entries
                .iter()
                .map(|(key, item)| (key.clone(), item.to_json()))
                .collect(),
        }
    }
}

/// The key path of `key` in the table at `path`: keys that are not bare are quoted.
pub(crate) fn join(path: &str, key: &str) -> String {
    let bare = !key.is_empty()
        && key
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    let key = if bare {
        key.to_owned()
    } else {
        format!("{key:?}")
    };
    if path.is_empty() {
        key
    } else {
        format!("{path}.{key}")
    }
}

/// Parses the file and every override, and puts the overrides in.
///
/// # Errors
/// Every syntax error of every source.
pub(crate) fn read(input: &Input) -> Result<Item, Vec<Problem>> {
    let mut problems = Vec::new();
    let mut root = None;
    for (source, text) in input.sources.iter().enumerate() {
        let text = text.text.as_str();
        if source == 0 {
            root = Some(parse(source, text, 0, &mut problems));
        } else if let (Some(change), Some(root)) =
            (parse_override(source, text, &mut problems), root.as_mut())
        {
            replace(root, change);
        }
    }
    match root {
        Some(root) if problems.is_empty() => Ok(root),
        _ => Err(problems),
    }
}

fn parse(source: usize, text: &str, offset: usize, problems: &mut Vec<Problem>) -> Item {
    let (table, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        let span = error.span().unwrap_or(0..0);
        problems.push(Problem::new("", syntax_message(&error)).at(place(source, &span, offset)));
    }
    let value = place(source, &table.span(), offset);
    Item {
        key: None,
        value,
        node: table_node(source, table.get_ref(), offset),
    }
}

/// What the TOML reader says, except where it takes nothing at all for a text without quotes.
fn syntax_message(error: &toml::de::Error) -> String {
    let nothing = error.span().is_none_or(|span| span.is_empty());
    match error.message() {
        message if nothing && message.starts_with("string values must be quoted") => {
            "not TOML: a value is missing".to_owned()
        }
        message => format!("not TOML: {message}"),
    }
}

fn place(source: usize, span: &Range<usize>, offset: usize) -> Place {
    Place {
        source,
        start: span.start + offset,
        end: span.end + offset,
    }
}

fn table_node(source: usize, table: &DeTable<'_>, offset: usize) -> Node {
    Node::Table(
        table
            .iter()
            .map(|(key, value)| {
                let key_place = place(source, &key.span(), offset);
                (
                    key.get_ref().to_string(),
                    item(source, Some(key_place), value, offset),
                )
            })
            .collect(),
    )
}

fn item(source: usize, key: Option<Place>, value: &Spanned<DeValue<'_>>, offset: usize) -> Item {
    let node = match value.get_ref() {
        DeValue::String(text) => Node::Text(text.to_string()),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Node::Integer(number),
            Err(_) => Node::Float(number.as_str().parse().unwrap_or(f64::INFINITY)),
        },
        DeValue::Float(number) => Node::Float(number.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(value) => Node::Boolean(*value),
        DeValue::Datetime(_) => Node::Date,
        DeValue::Array(values) => Node::Array(
            values
                .iter()
                .map(|value| item(source, None, value, offset))
                .collect(),
        ),
        DeValue::Table(table) => table_node(source, table, offset),
    };
    Item {
        key,
        value: place(source, &value.span(), offset),
        node,
    }
}

/// An override: the keys that lead to the value, each with its place, and the value.
struct Override {
    keys: Vec<(String, Place)>,
    value: Item,
}

/// Reads `key.path=value`. A value that is no TOML and does not look like some is a text, since a shell takes the quotes away.
fn parse_override(source: usize, text: &str, problems: &mut Vec<Problem>) -> Option<Override> {
    let all = Place {
        source,
        start: 0,
        end: text.len(),
    };
    let Some(at) = text.find('=') else {
        let message = "an override has no `=`";
        problems.push(
            Problem::new("", message)
                .at(all)
                .accepted(["key.path=value, for example time.end=1e-3"]),
        );
        return None;
    };
    let keys = parse_keys(source, &text[..at]);
    if keys.is_none() {
        let message = "the left side of an override is not a key path";
        problems.push(
            Problem::new("", message)
                .at(Place { end: at, ..all })
                .accepted(["keys joined by points, as in time.end=1e-3"]),
        );
    }
    let mut value = match DeValue::parse(&text[at + 1..]) {
        Ok(value) => item(source, None, &value, at + 1),
        Err(error)
            if text[at + 1..]
                .trim_start()
                .starts_with(['[', '{', '"', '\'']) =>
        {
            let span = error.span().unwrap_or(0..0);
            problems.push(Problem::new("", syntax_message(&error)).at(place(
                source,
                &span,
                at + 1,
            )));
            return None;
        }
        Err(_) => {
            let text = text[at + 1..].trim().to_owned();
            Item {
                key: None,
                value: Place {
                    start: at + 1,
                    ..all
                },
                node: Node::Text(text),
            }
        }
    };
    let keys = keys?;
    value.key = keys.last().map(|key| key.1);
    Some(Override { keys, value })
}

/// The keys of a key path with their places, read as TOML reads `a.b = 0`; none if that is not what it is.
fn parse_keys(source: usize, text: &str) -> Option<Vec<(String, Place)>> {
    let mut problems = Vec::new();
    let mut next = parse(source, &format!("{text}= 0"), 0, &mut problems).node;
    let mut keys = Vec::new();
    while let Node::Table(entries) = next {
        let (key, inner) = entries.into_iter().next()?;
        keys.push((key, inner.key?));
        next = inner.node;
    }
    (problems.is_empty() && !text.contains('\n') && matches!(next, Node::Integer(0)))
        .then_some(keys)
}

/// Puts the value of an override in the place of whatever stands at its key path.
fn replace(root: &mut Item, change: Override) {
    let mut table = root;
    let last = change.keys.len() - 1;
    for (depth, (key, key_place)) in change.keys.into_iter().enumerate() {
        if !matches!(table.node, Node::Table(_)) {
            *table = Item {
                key: Some(key_place),
                value: key_place,
                node: Node::Table(BTreeMap::new()),
            };
        }
        let Node::Table(entries) = &mut table.node else {
            return;
        };
        if depth == last {
            entries.insert(key, change.value);
            return;
        }
        table = entries.entry(key).or_insert(Item {
            key: Some(key_place),
            value: key_place,
            node: Node::Table(BTreeMap::new()),
        });
    }
}
