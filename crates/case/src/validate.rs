//! Checks a case, as written, against the schema: every problem in one pass, each with its key path and place.
//!
//! Only the keywords that the schema uses are understood, among them `x-dimension` (a quantity), `x-any-dimension` and `x-length-unit`; a test holds the
//! two together. Nothing is resolved here: names of groups, bodies and materials are stage two's.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::describe::{
    accepted, allows, alternatives, below, entries, keyed, listed, range, resolve,
};
use crate::error::{Place, Problem};
use crate::input::Input;
use crate::keys::{Keys, meant, of};
use crate::schema::is_name;
use crate::tree::{Item, Node, join};
use carom_quantities::units::{Dimension, UnitError, length_of_unit, parse_quantity};

/// Keys as other programs call them, and where that stands here.
const ELSEWHERE: [(&str, &str); 3] = [
    ("gravity", "`load.<name>.acceleration`"),
    ("angular-velocity", "`body.<name>.initial.spin`"),
    ("dt", "`time.step`"),
];

/// Longest value that a message shows whole.
const SHOWN: usize = 60;

/// Most places that a message names for a key that stands in the wrong table.
const MOST_PLACES: usize = 3;

/// Every problem of the case `root` against `schema`.
pub(crate) fn validate(schema: &Value, root: &Item, input: &Input) -> Vec<Problem> {
    let mut walker = Walker {
        schema,
        input,
        problems: Vec::new(),
    };
    walker.visit(schema, root, "");
    walker.problems
}

struct Walker<'a> {
    schema: &'a Value,
    input: &'a Input,
    problems: Vec<Problem>,
}

impl<'a> Walker<'a> {
    fn visit(&mut self, schema: &'a Value, item: &Item, path: &str) {
        let schema = resolve(self.schema, schema);
        let branches = alternatives(self.schema, schema);
        if !branches.is_empty() {
            return self.visit_choice(schema, &branches, item, path);
        }
        match &item.node {
            Node::Table(entries) if allows(schema, "object") => {
                self.visit_table(schema, entries, item, path)
            }
            Node::Array(items) if allows(schema, "array") => {
                self.visit_array(schema, items, item, path)
            }
            Node::Text(text) if allows(schema, "string") => {
                self.visit_text(schema, text, item, path)
            }
            Node::Integer(value) if allows(schema, "integer") || allows(schema, "number") => {
                self.visit_number(schema, *value as f64, item, path);
            }
            Node::Float(value) if allows(schema, "number") => {
                self.visit_number(schema, *value, item, path)
            }
            Node::Boolean(_) if allows(schema, "boolean") => {}
            _ => self.wrong_type(schema, item, path),
        }
    }

    /// A value of one of several kinds: a listed text, a number, or a table with one of several keys.
    fn visit_choice(&mut self, schema: &'a Value, branches: &[&'a Value], item: &Item, path: &str) {
        let choices: BTreeMap<&str, &Value> =
            branches.iter().filter_map(|branch| keyed(branch)).collect();
        let names = listed(self.schema, schema);
        match &item.node {
            Node::Text(text) if names.contains(&text.as_str()) => {}
            Node::Table(entries) if !choices.is_empty() => {
                self.visit_keyed(&choices, entries, item, path)
            }
            node => {
                let kind = json_type(node);
                let whole = matches!(node, Node::Integer(_));
                let plain = branches.iter().find(|branch| {
                    (allows(branch, kind) || whole && allows(branch, "integer"))
                        && listed(self.schema, branch).is_empty()
                });
                match (plain, node) {
                    (Some(branch), _) if keyed(branch).is_none() => self.visit(branch, item, path),
                    (_, Node::Text(text)) if !names.is_empty() => {
                        self.problems.push(
                            Problem::new(path, format!("unknown name `{text}`"))
                                .unknown(text, names)
                                .at(item.value),
                        );
                    }
                    _ => self.wrong_type(schema, item, path),
                }
            }
        }
    }

    /// A table that is a choice: exactly one of its keys.
    fn visit_keyed(
        &mut self,
        choices: &BTreeMap<&str, &'a Value>,
        entries: &BTreeMap<String, Item>,
        item: &Item,
        path: &str,
    ) {
        let mut chosen: Vec<(&str, &Item)> = Vec::new();
        for (key, inner) in entries {
            match choices.get(key.as_str()) {
                Some(schema) => {
                    chosen.push((key, inner));
                    self.visit(schema, inner, &join(path, key));
                }
                None => self.unknown_key(key, inner, path, choices),
            }
        }
        chosen.sort_by_key(|(_, inner)| inner.place());
        if let [(first, _), (second, inner), ..] = chosen.as_slice() {
            let message = format!("`{second}` beside `{first}`: only one of them is allowed");
            self.problems.push(
                Problem::new(join(path, second), message)
                    .accepted(choices.keys().copied())
                    .at(key_place(inner)),
            );
        } else if entries.is_empty() {
            self.problems.push(
                Problem::new(path, "empty: one key is needed")
                    .accepted(choices.keys().copied())
                    .at(item.place()),
            );
        }
    }

    fn visit_table(
        &mut self,
        schema: &'a Value,
        found: &BTreeMap<String, Item>,
        item: &Item,
        path: &str,
    ) {
        let properties: BTreeMap<&str, &Value> = entries(schema, "properties").collect();
        let others = schema
            .get("additionalProperties")
            .filter(|others| others.is_object());
        for (key, inner) in found {
            let inner_path = join(path, key);
            match (properties.get(key.as_str()), others) {
                (Some(schema), _) => self.visit(schema, inner, &inner_path),
                (None, Some(schema)) => {
                    if !is_name(key) {
                        let problem =
                            Problem::new(&inner_path, "not a name").found(format!("{key:?}"));
                        self.problems.push(
                            problem
                                .accepted(["letters from a to z, digits, `_` and `-`"])
                                .at(key_place(inner)),
                        );
                    }
                    self.visit(schema, inner, &inner_path);
                }
                (None, None) => self.unknown_key(key, inner, path, &properties),
            }
        }
        if others.is_some() && found.is_empty() {
            self.problems
                .push(Problem::new(path, "empty: one is needed at least").at(item.place()));
        }
        self.problems
            .extend(Keys::new(self.schema, schema, found).problems(item.place(), path));
    }

    fn visit_array(&mut self, schema: &'a Value, items: &[Item], item: &Item, path: &str) {
        let bound = |keyword: &str, default: usize| {
            schema
                .get(keyword)
                .and_then(Value::as_u64)
                .map_or(default, |value| usize::try_from(value).unwrap_or(default))
        };
        if items.len() < bound("minItems", 0) || items.len() > bound("maxItems", usize::MAX) {
            let message = if items.is_empty() {
                "an empty array".to_owned()
            } else {
                format!("an array of {} values", items.len())
            };
            self.problems.push(
                Problem::new(path, message)
                    .accepted([accepted(self.schema, schema)])
                    .at(item.value),
            );
        }
        if let Some(schema) = schema.get("items") {
            for (at, inner) in items.iter().enumerate() {
                self.visit(schema, inner, &format!("{path}[{at}]"));
            }
        }
        if schema.get("uniqueItems") == Some(&Value::Bool(true)) {
            let values: Vec<Value> = items.iter().map(Item::to_json).collect();
            for at in (1..values.len()).filter(|&at| values[..at].contains(&values[at])) {
                let message = format!("{} stands here twice", values[at]);
                self.problems
                    .push(Problem::new(format!("{path}[{at}]"), message).at(items[at].value));
            }
        }
    }

    fn visit_text(&mut self, schema: &'a Value, text: &str, item: &Item, path: &str) {
        let names = listed(self.schema, schema);
        if !names.is_empty() {
            if !names.contains(&text) {
                self.problems.push(
                    Problem::new(path, format!("unknown name `{text}`"))
                        .unknown(text, names)
                        .at(item.value),
                );
            }
        } else if schema.get("x-length-unit").is_some() {
            if let Err(error) = length_of_unit(text) {
                self.unit_error(schema, error, item, path);
            }
        } else if let Some(name) = schema.get("x-dimension").and_then(Value::as_str) {
            let Some(dimension) = Dimension::named(name) else {
                return;
            };
            match parse_quantity(text, dimension) {
                Ok(value) => self.check_range(schema, value, item, path),
                Err(error) => self.unit_error(schema, error, item, path),
            }
        } else if text.trim().is_empty() {
            self.problems
                .push(Problem::new(path, "an empty text").at(item.value));
        }
    }

    fn unit_error(&mut self, schema: &Value, error: UnitError, item: &Item, path: &str) {
        let problem = Problem::new(path, error.to_string())
            .found(self.written(item.value))
            .accepted([accepted(self.schema, schema)]);
        self.problems.push(
            Problem {
                nearest: error.meant(),
                ..problem
            }
            .at(item.value),
        );
    }

    fn visit_number(&mut self, schema: &'a Value, value: f64, item: &Item, path: &str) {
        if !value.is_finite() {
            let problem = Problem::new(path, "not a finite number").found(self.written(item.value));
            self.problems.push(
                problem
                    .accepted([accepted(self.schema, schema)])
                    .at(item.value),
            );
            return;
        }
        match schema.get("const").and_then(Value::as_f64) {
            Some(only) if only != value => {
                let problem =
                    Problem::new(path, "this value is not known").found(self.written(item.value));
                self.problems
                    .push(problem.accepted([only.to_string()]).at(item.value));
            }
            _ => self.check_range(schema, value, item, path),
        }
    }

    fn check_range(&mut self, schema: &Value, value: f64, item: &Item, path: &str) {
        let bound = |keyword: &str| schema.get(keyword).and_then(Value::as_f64);
        let inside = bound("minimum").is_none_or(|low| value >= low)
            && bound("exclusiveMinimum").is_none_or(|low| value > low)
            && bound("maximum").is_none_or(|high| value <= high)
            && bound("exclusiveMaximum").is_none_or(|high| value < high);
        let problem = match largest_integer(schema) {
            _ if !inside => {
                let message = format!("out of range: it must be{}", range(schema));
                Problem::new(path, message).accepted([accepted(self.schema, schema)])
            }
            Some(largest) if value > largest => {
                let message = format!("out of range: it must be at most {largest}");
                Problem::new(path, message).accepted([format!("an integer up to {largest}")])
            }
            _ => return,
        };
        let problem = problem.found(self.written(item.value));
        self.problems.push(problem.at(item.value));
    }

    fn unknown_key(
        &mut self,
        key: &str,
        item: &Item,
        path: &str,
        known: &BTreeMap<&str, &'a Value>,
    ) {
        let message = format!("unknown key `{key}`{}", of(path));
        let mut problem = Problem {
            found: None,
            ..Problem::new(join(path, key), message).unknown(key, known.keys().copied())
        };
        problem.nearest = meant(key, known.keys().copied()).map(str::to_owned);
        if let Some((_, here)) = ELSEWHERE.iter().find(|(there, _)| *there == key) {
            problem = problem.note(format!("it is {here}"));
        } else if problem.nearest.is_none() {
            let places = below(self.schema, known, key);
            if (1..=MOST_PLACES).contains(&places.len()) {
                let above = if path.is_empty() { "" } else { "." };
                let named = |keys: &String| format!("`{path}{above}{keys}`");
                let places: Vec<String> = places.iter().map(named).collect();
                problem = problem.note(format!("it is a key of {}", places.join(", ")));
            }
        }
        self.problems.push(problem.at(key_place(item)));
    }

    fn wrong_type(&mut self, schema: &Value, item: &Item, path: &str) {
        let found = match &item.node {
            Node::Table(_) => "a table".to_owned(),
            Node::Array(_) => "an array".to_owned(),
            Node::Date => "a date".to_owned(),
            _ => self.written(item.value),
        };
        let problem = Problem::new(path, "a value of the wrong kind").found(found);
        self.problems.push(
            problem
                .accepted([accepted(self.schema, schema)])
                .at(item.place()),
        );
    }

    /// The value as it is written, shortened where it is long.
    fn written(&self, place: Place) -> String {
        let text = self
            .input
            .sources
            .get(place.source)
            .and_then(|source| source.text.get(place.start..place.end))
            .unwrap_or_default();
        let line = text.lines().next().unwrap_or_default();
        match line.char_indices().nth(SHOWN) {
            Some((end, _)) => format!("{} ...", &line[..end]),
            None => line.to_owned(),
        }
    }
}

/// The largest integer that the reader can hold, where the schema says how many bits it has.
fn largest_integer(schema: &Value) -> Option<f64> {
    match schema.get("format").and_then(Value::as_str) {
        Some("uint32") => Some(f64::from(u32::MAX)),
        _ => None,
    }
}

fn key_place(item: &Item) -> Place {
    item.key.unwrap_or(item.value)
}

fn json_type(node: &Node) -> &'static str {
    match node {
        Node::Text(_) => "string",
        Node::Integer(_) | Node::Float(_) => "number",
        Node::Boolean(_) => "boolean",
        Node::Date => "date",
        Node::Array(_) => "array",
        Node::Table(_) => "object",
    }
}
