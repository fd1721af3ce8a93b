//! Names that were retired: the table of words in `CONTRIBUTING.md` against the sources.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::files;

const PAGE: &str = "CONTRIBUTING.md";

/// Begins the head of the table.
const HEAD: &str = "| word | meaning |";

/// Sources that still have a retired name.
pub fn check(root: &Path) -> Vec<String> {
    let page = fs::read_to_string(root.join(PAGE)).unwrap_or_default();
    let retired = retired(&page);
    if retired.is_empty() {
        return vec![format!("{PAGE}: the table of words retires nothing")];
    }
    let all = match files::list(root) {
        Ok(all) => all,
        Err(problem) => return vec![problem],
    };
    let sources = all.iter().filter(|file| files::is(file, "rs"));
    let found = sources.flat_map(|file| {
        let text = fs::read_to_string(root.join(file)).unwrap_or_default();
        let own = words(&text);
        let left = retired.iter().filter(move |word| own.contains(*word));
        left.map(move |word| {
            format!(
                "{}: `{word}` is retired; {PAGE} has the word for it",
                file.display()
            )
        })
        .collect::<Vec<String>>()
    });
    found.collect()
}

/// The names in code of the last column of the table.
fn retired(page: &str) -> BTreeSet<String> {
    let rows = page.lines().skip_while(|line| !line.starts_with(HEAD));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    // what is before the first bar is a column too
    let last = rows.filter_map(|row| row.split('|').nth(3));
    let names = last.flat_map(|cell| cell.split('`').skip(1).step_by(2));
    names.map(str::to_owned).collect()
}

/// Identifiers of a source.
fn words(text: &str) -> BTreeSet<String> {
    let part = |c: char| !(c.is_alphanumeric() || c == '_');
    text.split(part).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn retired_names_are_those_in_code_of_the_last_column() {
        let page = "text `a`\n\n| word | meaning | in place of |\n|---|---|---|\n| one | `b` | `Old`, `older` |\n| two | c | |\n\n`d`\n";
        let expected = ["Old", "older"].map(str::to_owned);
        assert_eq!(retired(page), BTreeSet::from(expected));
        assert!(words("let older_one = Old::new();").contains("Old"));
        assert!(!words("let older_one = 1;").contains("older"));
    }
}
