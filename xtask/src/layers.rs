//! Who uses whom: the table of the developer book against the manifests of the crates.

use std::fs;
use std::path::Path;

const PAGE: &str = "docs/src/developer/architecture.md";

/// Crates whose row is missing or says something else than their manifest.
pub fn check(root: &Path) -> Vec<String> {
    let page = fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    let Ok(folders) = fs::read_dir(root.join("crates")) else {
        return vec!["crates: cannot be read".to_owned()];
    };
    let names = folders.filter_map(|folder| folder.ok()?.file_name().into_string().ok());
    let mut problems: Vec<String> = names
        .filter_map(|name| problem(root, &page, &name))
        .collect();
    problems.sort();
    problems
}

fn problem(root: &Path, page: &str, name: &str) -> Option<String> {
    let manifest = fs::read_to_string(root.join("crates").join(name).join("Cargo.toml")).ok()?;
    let mut found = used(&manifest);
    let Some(mut told) = told(page, name) else {
        return Some(format!("{PAGE}: the table has no row for `{name}`"));
    };
    found.sort();
    told.sort();
    (found != told).then(|| {
        format!(
            "{PAGE}: `{name}` uses {}; its row says {}",
            found.join(", "),
            told.join(", ")
        )
    })
}

/// Crates of ours among the dependencies, those of tests left out.
fn used(manifest: &str) -> Vec<String> {
    let section = manifest
        .split("\n[dependencies]\n")
        .nth(1)
        .unwrap_or_default();
    let lines = section.lines().take_while(|line| !line.starts_with('['));
    let names = lines.filter_map(|line| line.strip_prefix("carom-")?.split('.').next());
    names.map(str::to_owned).collect()
}

/// The last column of the row of a crate.
fn told(page: &str, name: &str) -> Option<Vec<String>> {
    let row = page
        .lines()
        .find(|line| line.starts_with(&format!("| `{name}` |")))?;
    let last = row.trim_end_matches([' ', '|']).rsplit('|').next()?.trim();
    let names = last.split(", ").filter(|name| *name != "none");
    Some(names.map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::{told, used};

    #[test]
    fn rows_and_manifests_are_read_alike() {
        let manifest = "[package]\n\n[dependencies]\ncarom-mesh.workspace = true\nserde.workspace = true\n\n[dev-dependencies]\ncarom-exact.workspace = true\n";
        assert_eq!(used(manifest), ["mesh"]);
        assert_eq!(
            told("| `a` | what | mesh |\n", "a"),
            Some(vec!["mesh".to_owned()])
        );
        assert_eq!(told("| `a` | what | none |\n", "a"), Some(vec![]));
    }
}
