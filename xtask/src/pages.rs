//! Files that pages show: case files and their pages, decisions, measured tables; and tables of what cases must give ([`expected`]).
//!
//! The text stands in the page itself, between two comments, so that the page reads alike in the book and in the
//! repository:
//!
//! ```text
//! <!-- include ../tables/rings.md -->
//! ...
//! <!-- end -->
//! ```
//!
//! `cargo xtask pages` writes the text anew; the check of the documentation compares.

use std::fs;
use std::path::{Path, PathBuf};

use crate::expected;
use crate::files::{is, list};
use crate::place::beside;

const BEGIN: &str = "<!-- include ";
const CLOSE: &str = " -->";
/// Folder of the cases, whose pages have tables of what they must give.
const CASES: &str = "cases";
const END: &str = "<!-- end -->";

/// Pages whose included text is not that of the file.
pub fn check(root: &Path) -> Vec<String> {
    let stale = |(file, new): (PathBuf, Result<String, String>)| match new {
        Err(problem) => Some(format!("{}: {problem}", file.display())),
        Ok(new) if fs::read_to_string(root.join(&file)).ok()? == new => None,
        Ok(_) => Some(format!(
            "{}: an included file has changed: run `cargo xtask pages`",
            file.display()
        )),
    };
    pages(root).into_iter().filter_map(stale).collect()
}

/// Writes the included texts anew.
pub fn write(root: &Path) -> Result<(), String> {
    for (file, new) in pages(root) {
        let new = new.map_err(|problem| format!("{}: {problem}", file.display()))?;
        fs::write(root.join(&file), new).map_err(|cause| format!("{}: {cause}", file.display()))?;
    }
    Ok(())
}

/// Pages that include something, with the text that they must have.
fn pages(root: &Path) -> Vec<(PathBuf, Result<String, String>)> {
    let files = list(root).unwrap_or_default();
    let files = files.into_iter().filter(|file| is(file, "md"));
    let texts = files.filter_map(|file| {
        let text = fs::read_to_string(root.join(&file)).ok()?;
        let written = |line: &str| included(line).or(expected::named(line)).is_some();
        let holds = text.lines().any(written);
        holds.then_some((file, text))
    });
    texts
        .map(|(file, text)| {
            let new = match file.starts_with(CASES) {
                true => with_rows(root, &file, &text),
                false => expand(&text, |target: &str| {
                    let path = beside(&file, target);
                    let text = read(root, &path)?;
                    // a page of a case as it is to be
                    match is(&path, "md") {
                        true => with_rows(root, &path, &text),
                        false => Ok(text),
                    }
                }),
            };
            (file, new)
        })
        .collect()
}

fn read(root: &Path, path: &Path) -> Result<String, String> {
    let text = fs::read_to_string(root.join(path));
    text.map_err(|cause| format!("includes {}: {cause}", path.display()))
}

/// The page of a case with the tables of what it must give.
fn with_rows(root: &Path, page: &Path, text: &str) -> Result<String, String> {
    expected::expand(text, |case| read(root, &beside(page, case)))
}

/// The target of a line that begins an included text.
pub fn included(line: &str) -> Option<&str> {
    line.strip_prefix(BEGIN)?.strip_suffix(CLOSE)
}

/// `page` with the texts of its included files; Markdown as it is, anything else as a block of code.
fn expand(page: &str, read: impl Fn(&str) -> Result<String, String>) -> Result<String, String> {
    let mut out = String::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        out += line;
        out.push('\n');
        let Some(target) = included(line) else {
            continue;
        };
        if !lines.any(|line| line == END) {
            return Err(format!("`{line}` has no `{END}`"));
        }
        let text = read(target)?;
        let text = text.trim_end();
        let path = Path::new(target);
        let language = path.extension().unwrap_or_default().to_string_lossy();
        out += &match is(path, "md") {
            true => format!("\n{text}\n\n{END}\n"),
            false => format!("\n```{language}\n{text}\n```\n\n{END}\n"),
        };
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::expand;

    #[test]
    fn an_included_text_is_replaced_and_the_rest_stays() {
        let read = |target: &str| Ok(format!("text of {target}\n"));
        let page = "a\n<!-- include b.md -->\nold\n<!-- end -->\nc\n<!-- include d.toml -->\n<!-- end -->\n";
        let new = "a\n<!-- include b.md -->\n\ntext of b.md\n\n<!-- end -->\nc\n<!-- include d.toml -->\n\n```toml\ntext of d.toml\n```\n\n<!-- end -->\n";
        assert_eq!(expand(page, read).as_deref(), Ok(new));
        assert_eq!(expand(new, read).as_deref(), Ok(new));
        assert!(expand("<!-- include b.md -->\n", read).is_err());
    }
}
