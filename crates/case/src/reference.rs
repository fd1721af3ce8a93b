//! The reference page of the case file, written from the schema: every key, what it accepts, its default.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde_json::Value;

use crate::describe::{accepted, alternatives, entries, keyed, listed, resolve, texts};
use crate::schema::json_schema;

/// Top of the page.
const PREFACE: &str = "\
# Reference of the case file

<!-- Written by `carom schema --reference` from the types that read the file: change those. -->

A case is one TOML file, in UTF-8. Names are physical groups of the mesh or names given in the file, never numbers. A choice is a key \
with its own table: `law.velocity = { capture = \"half\" }`. An unknown key is an error. A bare number is in SI units; a text carries its \
unit and is checked for its dimension: `\"254 mm\"`, `\"210 GPa\"`, `\"7.8 t/m^3\"`. Units are products and quotients, read from left to \
right, of m, g, s, N, Pa, J, W, Hz with the SI prefixes from p to T, of t, bar, gn (standard gravity), min, h, in, ft, rad and deg, with integer exponents. \
Vectors have one to three components; those left out are zero.

`carom run case.toml --set time.step=\"1 us\"` replaces the value at that key path for one run.
";

/// The page, in Markdown.
pub fn reference_page() -> String {
    let root = json_schema();
    let mut page = Page {
        root: &root,
        text: PREFACE.to_owned(),
        told: BTreeSet::new(),
    };
    page.keys("The file", &description(&root), &root, 2);
    for key in ORDER {
        if let Some(schema) = root.pointer(&format!("/properties/{key}")) {
            page.table(key, schema, 2);
        }
    }
    page.text
}

/// Tables in the order in which one writes a case.
const ORDER: &[&str] = &[
    "mesh",
    "material",
    "body",
    "mass",
    "spring",
    "pretension",
    "dashpot",
    "stop",
    "rigid-link",
    "transition",
    "constraint",
    "fluid",
    "signal",
    "support",
    "load",
    "contact",
    "general-contact",
    "time",
    "zone",
    "arlequin",
    "interface",
    "probe",
    "level",
    "output",
    "reference",
    "expect",
];

struct Page<'a> {
    root: &'a Value,
    text: String,
    /// Types whose tables are on the page: each is told once, where it comes first.
    told: BTreeSet<String>,
}

impl<'a> Page<'a> {
    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// A table at `path`: its keys, then the tables in it.
    fn table(&mut self, path: &str, schema: &'a Value, level: usize) {
        if let Some(name) = schema.get("$ref").and_then(Value::as_str)
            && !self.told.insert(name.to_owned())
        {
            return;
        }
        let target = resolve(self.root, schema);
        if let Some(inner) = target
            .get("additionalProperties")
            .filter(|inner| inner.is_object())
        {
            return self.table(&format!("{path}.<name>"), inner, level);
        }
        let choices = self.choices(target);
        if choices.is_empty() {
            self.keys(&format!("`[{path}]`"), &description(target), target, level);
        }
        for (key, branch, inner) in choices {
            let inner = resolve(self.root, inner);
            let lead = description(branch);
            if inner.get("properties").is_some() {
                self.keys(&format!("`{path}.{key}`"), &lead, inner, level);
                self.inner_tables(&format!("{path}.{key}"), inner, level);
            } else {
                let value = if inner.get("type") == Some(&"object".into()) {
                    "`{}`".to_owned()
                } else {
                    accepted(self.root, inner)
                };
                self.heading(&format!("`{path}.{key}`"), level);
                let _ = writeln!(self.text, "\nValue: {value}. {lead}");
                self.rows(&format!("{path}.{key}"), inner, level);
            }
        }
        if target.get("properties").is_some() {
            self.inner_tables(path, target, level);
        }
    }

    fn inner_tables(&mut self, path: &str, schema: &'a Value, level: usize) {
        for (key, inner) in entries(schema, "properties") {
            let target = resolve(self.root, inner);
            let is_table = target.get("properties").is_some()
                || target
                    .get("additionalProperties")
                    .is_some_and(Value::is_object);
            let branches = alternatives(self.root, target).into_iter();
            for branch in branches.filter(|branch| keyed(branch).is_none()) {
                if branch.get("properties").is_some() {
                    let path = format!("{path}.{key}");
                    self.keys(
                        &format!("`{path}`"),
                        &description(branch),
                        branch,
                        (level + 1).min(3),
                    );
                    self.inner_tables(&path, branch, level);
                }
            }
            if is_table || !self.choices(target).is_empty() {
                self.table(&format!("{path}.{key}"), inner, (level + 1).min(3));
            } else {
                let path = format!("{path}.{key}");
                for schema in std::iter::once(target).chain(alternatives(self.root, target)) {
                    self.rows(&path, schema, level);
                }
            }
        }
    }

    /// The keys of the tables in an array at `path`.
    fn rows(&mut self, path: &str, array: &'a Value, level: usize) {
        let item = array.get("items").map(|item| resolve(self.root, item));
        if let Some(item) = item.filter(|item| item.get("properties").is_some()) {
            let title = format!("Each table of `{path}`");
            self.keys(&title, &description(item), item, (level + 1).min(3));
        }
    }

    fn choices(&self, schema: &'a Value) -> Vec<(&'a str, &'a Value, &'a Value)> {
        let branches = alternatives(self.root, schema);
        branches
            .into_iter()
            .filter_map(|branch| keyed(branch).map(|(key, inner)| (key, branch, inner)))
            .collect()
    }

    fn heading(&mut self, title: &str, level: usize) {
        let _ = write!(self.text, "\n{} {title}\n", "#".repeat(level));
    }

    /// A heading, what the table is, and one row for each of its keys, the required ones first.
    fn keys(&mut self, title: &str, lead: &str, schema: &'a Value, level: usize) {
        self.heading(title, level);
        let _ = write!(self.text, "\n{lead}\n\n");
        self.line("| key | value | default | |");
        self.line("|---|---|---|---|");
        let required = texts(schema, "required");
        let properties: BTreeMap<&str, &Value> = entries(schema, "properties").collect();
        let others = properties
            .keys()
            .copied()
            .filter(|key| !required.contains(key));
        for key in required.iter().copied().chain(others) {
            let Some(inner) = properties.get(key) else {
                continue;
            };
            let default = match inner.get("default") {
                _ if required.contains(&key) => "required".to_owned(),
                Some(Value::Object(_)) | None => String::new(),
                Some(value) => format!("`{value}`"),
            };
            let value = accepted(self.root, inner).replace('|', "\\|");
            let _ = writeln!(
                self.text,
                "| `{key}` | {value} | {default} | {} |",
                self.meaning(inner)
            );
        }
    }

    /// What a key is for, and what each of the names it accepts stands for.
    fn meaning(&self, schema: &Value) -> String {
        let mut text = description(schema);
        let target = resolve(self.root, schema);
        for branch in alternatives(self.root, target)
            .into_iter()
            .filter(|branch| keyed(branch).is_none())
        {
            for name in listed(self.root, branch) {
                let _ = write!(text, " `{name}`: {}", description(branch));
            }
        }
        text
    }
}

/// The description of a schema on one line.
fn description(schema: &Value) -> String {
    schema
        .get("description")
        .and_then(Value::as_str)
        .unwrap_or_default()
        .replace('\n', " ")
}
