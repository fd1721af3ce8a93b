//! What a part of the schema accepts, in words: for messages and for the reference page.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use carom_quantities::units::with_article;

/// Keys above a key that stands in the wrong table, at most, where it is looked for.
const DEEPEST: usize = 4;

/// The schema with its `$ref`, if it is one, replaced by what it refers to.
pub(crate) fn resolve<'a>(root: &'a Value, schema: &'a Value) -> &'a Value {
    let target = schema
        .get("$ref")
        .and_then(Value::as_str)
        .and_then(|name| root.pointer(name.trim_start_matches('#')));
    target.unwrap_or(schema)
}

/// Entries of an object inside a schema; none where there is no such object.
pub(crate) fn entries<'a>(
    schema: &'a Value,
    keyword: &str,
) -> impl Iterator<Item = (&'a str, &'a Value)> + use<'a> {
    schema
        .get(keyword)
        .and_then(Value::as_object)
        .into_iter()
        .flat_map(Map::iter)
        .map(|(key, value)| (key.as_str(), value))
}

/// Elements of an array inside a schema; none where there is no such array.
pub(crate) fn elements<'a>(
    schema: &'a Value,
    keyword: &str,
) -> impl Iterator<Item = &'a Value> + use<'a> {
    schema
        .get(keyword)
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
}

/// Texts of an array inside a schema.
pub(crate) fn texts<'a>(schema: &'a Value, keyword: &str) -> Vec<&'a str> {
    elements(schema, keyword)
        .filter_map(Value::as_str)
        .collect()
}

/// The alternatives of a schema that is a choice, nested ones spread out; none if it is no choice.
pub(crate) fn alternatives<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a Value> {
    let mut found = Vec::new();
    if schema.get("properties").is_none() {
        for branch in elements(schema, "oneOf").chain(elements(schema, "anyOf")) {
            let branch = resolve(root, branch);
            let inner = alternatives(root, branch);
            if inner.is_empty() {
                found.push(branch);
            } else {
                found.extend(inner);
            }
        }
    }
    found
}

/// The one key of an alternative that is a keyed choice: key, and schema of its value.
pub(crate) fn keyed(branch: &Value) -> Option<(&str, &Value)> {
    let key = match texts(branch, "required").as_slice() {
        [key] => *key,
        _ => return None,
    };
    let mut properties = entries(branch, "properties");
    match (properties.next(), properties.next()) {
        (Some((name, value)), None) if name == key => Some((name, value)),
        _ => None,
    }
}

/// Tables below some keys that know another one, as paths of keys: all that are nearest to the top, within [`DEEPEST`] keys.
pub(crate) fn below(root: &Value, known: &BTreeMap<&str, &Value>, key: &str) -> Vec<String> {
    let mut level: Vec<(String, &Value)> = Vec::new();
    level.extend(
        known
            .iter()
            .map(|(name, schema)| ((*name).to_owned(), *schema)),
    );
    for _ in 0..DEEPEST {
        let knows = |at: &&(String, &Value)| keys(root, at.1).iter().any(|(name, _)| *name == key);
        let found: Vec<String> = level
            .iter()
            .filter(knows)
            .map(|(path, _)| path.clone())
            .collect();
        if !found.is_empty() {
            return found;
        }
        let deeper = level.iter().flat_map(|(path, schema)| {
            let inner = keys(root, schema);
            inner
                .into_iter()
                .map(move |(name, schema)| (format!("{path}.{name}"), schema))
        });
        level = deeper.collect();
    }
    Vec::new()
}

/// The keys of a table, or of the tables that a choice offers.
fn keys<'a>(root: &'a Value, schema: &'a Value) -> Vec<(&'a str, &'a Value)> {
    let schema = resolve(root, schema);
    let branches = alternatives(root, schema);
    let of_branches = branches
        .into_iter()
        .flat_map(|branch| entries(branch, "properties"));
    entries(schema, "properties").chain(of_branches).collect()
}

/// The texts that a schema lists, of all its alternatives.
pub(crate) fn listed<'a>(root: &'a Value, schema: &'a Value) -> Vec<&'a str> {
    let own = texts(schema, "enum")
        .into_iter()
        .chain(schema.get("const").and_then(Value::as_str));
    own.chain(
        alternatives(root, schema)
            .into_iter()
            .flat_map(|branch| listed(root, branch)),
    )
    .collect()
}

/// Whether the schema allows the JSON type `name`.
pub(crate) fn allows(schema: &Value, name: &str) -> bool {
    match schema.get("type") {
        Some(Value::String(only)) => only == name,
        Some(Value::Array(names)) => names.iter().any(|one| one == name),
        _ => false,
    }
}

/// What the schema accepts, in words: `a length greater than 0: a number in m, or a text such as "254 mm"`.
pub(crate) fn accepted(root: &Value, schema: &Value) -> String {
    let schema = resolve(root, schema);
    let alternatives = alternatives(root, schema);
    if !alternatives.is_empty() {
        return accepted_choice(root, schema, &alternatives);
    }
    let names = listed(root, schema);
    if !names.is_empty() {
        return names
            .iter()
            .map(|name| format!("{name:?}"))
            .collect::<Vec<_>>()
            .join(", ");
    }
    if let Some(value) = schema.get("const") {
        return value.to_string();
    }
    let text = |keyword: &str| {
        schema
            .get(keyword)
            .and_then(Value::as_str)
            .unwrap_or_default()
    };
    let range = range(schema);
    if schema.get("x-dimension").is_some() {
        let (name, unit, example) = (text("x-dimension"), text("x-unit"), text("x-example"));
        return format!(
            "{}{range}: a number in {unit}, or a text such as {example:?}",
            with_article(name)
        );
    }
    if schema.get("x-any-dimension").is_some() {
        let example = text("x-example");
        return format!("a number, or a text with a unit such as {example:?}");
    }
    if schema.get("x-length-unit").is_some() {
        return format!("a unit of length such as {:?}", text("x-example"));
    }
    match text("type") {
        "string" => "a text".to_owned(),
        "boolean" => "true or false".to_owned(),
        "integer" => format!("an integer{range}"),
        "number" => format!("a number{range}"),
        "array" => accepted_array(root, schema),
        _ => "a table".to_owned(),
    }
}

fn accepted_choice(root: &Value, schema: &Value, alternatives: &[&Value]) -> String {
    let keys: Vec<&str> = alternatives
        .iter()
        .filter_map(|branch| keyed(branch))
        .map(|(key, _)| key)
        .collect();
    let names: Vec<String> = listed(root, schema)
        .into_iter()
        .map(|name| format!("{name:?}"))
        .collect();
    let mut parts: Vec<String> = if names.is_empty() {
        Vec::new()
    } else {
        vec![names.join(", ")]
    };
    let plain = alternatives
        .iter()
        .filter(|branch| keyed(branch).is_none() && listed(root, branch).is_empty());
    parts.extend(plain.map(|branch| accepted(root, branch)));
    match keys.as_slice() {
        [] => {}
        [key] => parts.push(format!("a table with the key {key}")),
        keys => parts.push(format!("a table with one of the keys {}", keys.join(", "))),
    }
    parts.join(", or ")
}

fn accepted_array(root: &Value, schema: &Value) -> String {
    let items = schema.get("items").map(|items| {
        let required = texts(resolve(root, items), "required");
        match accepted(root, items).as_str() {
            "a table" if !required.is_empty() => format!("a table of {}", required.join(", ")),
            other => other.to_owned(),
        }
    });
    let items = items.unwrap_or_default();
    let bound = |keyword: &str| schema.get(keyword).and_then(Value::as_u64);
    let count = match (bound("minItems"), bound("maxItems")) {
        (Some(least), Some(most)) if least == most => format!("{least} values"),
        (Some(least), Some(most)) => format!("{least} to {most} values"),
        (Some(least), None) => {
            format!("{least} value{} or more", if least == 1 { "" } else { "s" })
        }
        _ => "values".to_owned(),
    };
    format!("an array of {count}, each of them {items}")
}

/// ` greater than 0`, ` from 0.5 to 1`: the range of a number, with a leading blank, or nothing.
pub(crate) fn range(schema: &Value) -> String {
    let bound = |keyword: &str| schema.get(keyword).and_then(Value::as_f64);
    let low = match (bound("minimum"), bound("exclusiveMinimum")) {
        (Some(low), _) => Some((low, "at least", "from")),
        (_, Some(low)) => Some((low, "greater than", "above")),
        _ => None,
    };
    let high = match (bound("maximum"), bound("exclusiveMaximum")) {
        (Some(high), _) => Some((high, "at most", "to")),
        (_, Some(high)) => Some((high, "less than", "and below")),
        _ => None,
    };
    match (low, high) {
        (Some((low, _, from)), Some((high, _, to))) => format!(" {from} {low} {to} {high}"),
        (Some((value, words, _)), None) | (None, Some((value, words, _))) => {
            format!(" {words} {value}")
        }
        (None, None) => String::new(),
    }
}
