//! The picture of the step in the developer book against the driver: its owners, and the files that it is made of.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const PAGE: &str = "docs/src/developer/architecture.md";
const DRIVER: &str = "crates/dynamics/src/driver";

/// The folder of what all owners see.
const SHARED: &str = "attempt";

/// Owners and files of which picture, tables and program do not say the same.
pub fn check(root: &Path) -> Vec<String> {
    let page = fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    let read = |name: &str| fs::read_to_string(root.join(DRIVER).join(name)).unwrap_or_default();
    let fields = fields(&read("mod.rs"));
    let Ok(entries) = fs::read_dir(root.join(DRIVER)) else {
        return vec![format!("{DRIVER}: cannot be read")];
    };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let (files, folders): (BTreeSet<String>, BTreeSet<String>) =
        names.partition(|name| name.ends_with(".rs"));
    let structs: BTreeSet<String> = folders
        .iter()
        .flat_map(|folder| structs(&read(&format!("{folder}/mod.rs"))))
        .collect();
    let owners: BTreeSet<String> = fields.intersection(&structs).cloned().collect();
    let mut problems = differ("the picture of owners", &drawn(&page, &structs), &owners);
    problems.extend(differ(
        "the table of owners",
        &rows(&page, &structs),
        &owners,
    ));
    problems.extend(differ(
        "the table of files of the driver",
        &listed(&page),
        &files,
    ));
    problems.extend(differ(
        "the table of owners, by folder,",
        &told_folders(&page),
        &folders,
    ));
    for folder in folders.iter().filter(|folder| *folder != SHARED) {
        let module = read(&format!("{folder}/mod.rs"));
        let open = owners.iter().flat_map(|owner| open_fields(&module, owner));
        problems.extend(open.map(|line| {
            format!("{DRIVER}/{folder}/mod.rs: fields of an owner are private: `{line}`")
        }));
    }
    problems
}

fn differ(what: &str, told: &BTreeSet<String>, found: &BTreeSet<String>) -> Vec<String> {
    let missing = found
        .difference(told)
        .map(|name| format!("{PAGE}: {what} lacks `{name}`"));
    let more = told
        .difference(found)
        .map(|name| format!("{PAGE}: {what} has `{name}`, which is not there"));
    missing.chain(more).collect()
}

/// Fields of a struct that others see.
fn open_fields<'a>(module: &'a str, owner: &str) -> Vec<&'a str> {
    let body = module.split(&format!("struct {owner} {{")).nth(1);
    let lines = body.unwrap_or_default().lines();
    let fields = lines.take_while(|line| !line.starts_with('}'));
    fields
        .map(str::trim)
        .filter(|line| line.starts_with("pub"))
        .collect()
}

/// Folders in the table of owners.
fn told_folders(page: &str) -> BTreeSet<String> {
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let cells = rows.flat_map(|row| row.split('`').skip(1).step_by(2));
    let folders = cells.filter_map(|cell| cell.strip_suffix('/'));
    folders
        .filter(|name| !name.contains('/'))
        .map(str::to_owned)
        .collect()
}

/// Types of the fields of the driver.
fn fields(module: &str) -> BTreeSet<String> {
    let body = module
        .split("pub struct Driver {")
        .nth(1)
        .unwrap_or_default();
    let lines = body.lines().take_while(|line| !line.starts_with('}'));
    let types = lines.filter_map(|line| Some(line.split_once(": ")?.1.trim_end_matches(',')));
    let last = types.filter_map(|name| name.rsplit("::").next());
    last.map(str::to_owned).collect()
}

/// Names of the structs of a file.
fn structs(text: &str) -> BTreeSet<String> {
    let lines = text.lines().filter_map(|line| line.split_once("struct "));
    let names = lines.filter(|(before, _)| before.starts_with("pub"));
    names.map(|(_, after)| word(after)).collect()
}

fn word(text: &str) -> String {
    text.chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect()
}

/// Owners in the picture.
fn drawn(page: &str, structs: &BTreeSet<String>) -> BTreeSet<String> {
    let blocks = page
        .split("```")
        .filter(|block| block.contains("Driver: order of the stages"));
    let words = blocks.flat_map(|block| block.split(|c: char| !c.is_alphanumeric()));
    words
        .filter(|word| structs.contains(*word))
        .map(str::to_owned)
        .collect()
}

/// Owners in the table: the first column of its rows.
fn rows(page: &str, structs: &BTreeSet<String>) -> BTreeSet<String> {
    let first = page.lines().filter_map(|line| line.strip_prefix("| `"));
    first
        .map(word)
        .filter(|name| structs.contains(name))
        .collect()
}

/// Files in the table of the files of the driver.
fn listed(page: &str) -> BTreeSet<String> {
    let table = page
        .split("| file | what it holds |")
        .nth(1)
        .unwrap_or_default();
    let rows = table
        .lines()
        .skip(2)
        .take_while(|line| line.starts_with('|'));
    let cells = rows.filter_map(|row| row.split('|').nth(1));
    let names = cells.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    names.map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::{drawn, fields, listed, open_fields, rows, structs, told_folders};

    #[test]
    fn picture_tables_and_program_are_read_alike() {
        let module = "pub struct Driver {\n    attempt: Attempt,\n    links: owners::Links,\n    ahead: f64,\n}\n";
        let owners =
            structs("pub(super) struct Attempt {\npub(super) struct Links {\n// struct No {\n");
        let both: Vec<String> = fields(module).intersection(&owners).cloned().collect();
        assert_eq!(both, ["Attempt", "Links"]);
        let page = "```\nDriver: order of the stages\n  Links\n Attempt: state\n```\n| `Links` | rows |\n| file | what it holds |\n|---|---|\n| `a.rs`, `b.rs` | both |\n";
        assert_eq!(drawn(page, &owners), owners);
        assert_eq!(
            rows(page, &owners).into_iter().collect::<Vec<_>>(),
            ["Links"]
        );
        assert_eq!(
            listed(page).into_iter().collect::<Vec<_>>(),
            ["a.rs", "b.rs"]
        );
    }

    #[test]
    fn fields_that_others_see_and_folders_of_the_table_are_found() {
        let module = "pub(crate) struct Links {\n    force: f64,\n    pub(crate) rows: f64,\n}\npub(crate) struct Other {\n    pub(crate) a: f64,\n}\n";
        assert_eq!(open_fields(module, "Links"), ["pub(crate) rows: f64,"]);
        let folders =
            told_folders("| `Links` | `links/` | rows |\n| `a.rs` | `b/c/` |\ntext `d/`\n");
        assert_eq!(folders.into_iter().collect::<Vec<_>>(), ["links"]);
    }
}
