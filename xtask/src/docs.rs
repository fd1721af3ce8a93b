//! The documentation: links that lead somewhere, included files that exist, pages that the book lists, paths and
//! commands that are true.
//!
//! Markdown is read as far as this needs: fenced blocks, code spans, inline links, headings, included files (`pages`).

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::commands::{RUN, TEST};
use crate::files::{is, list};
use crate::pages;
use crate::place::beside;

/// Folder of the book's pages.
const BOOK: &str = "docs/src";

/// Pages that show the first case, and the case: each line that they show is one of its lines.
const SHOWN: [&str; 2] = ["README.md", "docs/src/start.md"];
const CASE: &str = "cases/two-bars/case.toml";

/// Files that must give the README's two commands word for word.
const COMMANDS: [&str; 2] = ["README.md", ".ci/run"];

/// A Markdown file, taken apart.
#[derive(Default)]
struct Page {
    /// Targets of links.
    links: Vec<String>,
    /// Files that it includes.
    includes: Vec<String>,
    /// Code spans.
    codes: Vec<String>,
    /// Anchors of headings.
    anchors: BTreeSet<String>,
}

/// What is wrong with the documentation.
pub fn check(root: &Path) -> Vec<String> {
    let files = match list(root) {
        Ok(files) => files,
        Err(problem) => return vec![problem],
    };
    let pages: Vec<(&PathBuf, Page)> = files
        .iter()
        .filter(|file| is(file, "md"))
        .map(|file| (file, read(root, file)))
        .collect();
    let included: BTreeSet<PathBuf> = pages
        .iter()
        .flat_map(|(file, page)| page.includes.iter().map(|target| beside(file, target)))
        .collect();
    let mut problems = pages::check(root);
    for (file, page) in &pages {
        let wrong = page
            .links
            .iter()
            .filter(|link| !link.contains("://"))
            .filter_map(|link| link_problem(root, file, link, included.contains(*file)))
            .chain(
                page.codes
                    .iter()
                    .filter_map(|code| code_problem(root, code)),
            );
        problems.extend(wrong.map(|wrong| format!("{}: {wrong}", file.display())));
    }
    problems.extend(unlisted(&pages));
    problems.extend(missing_commands(root));
    problems.extend(SHOWN.iter().flat_map(|file| not_in_the_case(root, file)));
    problems
}

fn read(root: &Path, file: &Path) -> Page {
    fs::read_to_string(root.join(file)).map_or_else(|_| Page::default(), |text| parse(&text))
}

fn parse(text: &str) -> Page {
    let mut page = Page::default();
    let mut fenced = false;
    for line in text.lines() {
        if let Some(target) = pages::included(line) {
            page.includes.push(target.to_owned());
        }
        if line.trim_start().starts_with("```") {
            fenced = !fenced;
            continue;
        }
        if fenced {
            continue;
        }
        if let Some(title) = heading(line) {
            page.anchors.insert(anchor(title));
        }
        // every second piece between backticks is code
        let mut prose = String::new();
        for (piece, text) in line.split('`').enumerate() {
            match piece % 2 {
                0 => prose.push_str(text),
                _ => page.codes.push(text.to_owned()),
            }
        }
        for rest in prose.split("](").skip(1) {
            page.links
                .extend(rest.split([')', ' ']).next().map(str::to_owned));
        }
    }
    page
}

fn heading(line: &str) -> Option<&str> {
    let title = line.trim_start_matches('#');
    (title.len() < line.len()).then(|| title.strip_prefix(' '))?
}

/// The anchor that mdBook and code hosts give a heading.
fn anchor(title: &str) -> String {
    let letters = title.trim().chars().filter_map(|letter| match letter {
        ' ' => Some('-'),
        '-' | '_' => Some(letter),
        _ => letter.is_alphanumeric().then_some(letter),
    });
    letters.flat_map(char::to_lowercase).collect()
}

fn link_problem(root: &Path, file: &Path, link: &str, included: bool) -> Option<String> {
    let (target, fragment) = link.split_once('#').unwrap_or((link, ""));
    if included && !target.is_empty() {
        return Some(format!(
            "links to {link}: another page includes this file, and the link leads elsewhere there"
        ));
    }
    let path = match target {
        "" => file.to_owned(),
        target => beside(file, target),
    };
    if !root.join(&path).exists() {
        return Some(format!("links to {link}, which is not there"));
    }
    if file.starts_with(BOOK) && !path.starts_with(BOOK) {
        return Some(format!("links to {link}, which is not in the book"));
    }
    if fragment.is_empty() {
        return None;
    }
    (!read(root, &path).anchors.contains(fragment)).then(|| {
        format!(
            "links to {link}, but {} has no such heading",
            path.display()
        )
    })
}

/// A code span that starts with a folder of the repository is a path; patterns (`<name>`, `*`) are left alone.
fn code_problem(root: &Path, code: &str) -> Option<String> {
    let top = code.split_once('/').map(|(top, _)| root.join(top))?;
    let pattern =
        code.contains(|letter: char| letter.is_whitespace() || "<>*{}$…".contains(letter));
    let made_by_a_run = code.contains(".carom") || code.starts_with("target/");
    if pattern || made_by_a_run || !top.is_dir() || root.join(code).exists() {
        return None;
    }
    Some(format!("names `{code}`, which is not there"))
}

/// Pages of the book that its summary does not list.
fn unlisted(pages: &[(&PathBuf, Page)]) -> Vec<String> {
    let summary = Path::new(BOOK).join("SUMMARY.md");
    let listed: BTreeSet<PathBuf> = pages
        .iter()
        .filter(|(file, _)| **file == summary)
        .flat_map(|(file, page)| page.links.iter().map(|link| beside(file, link)))
        .collect();
    pages
        .iter()
        .filter(|(file, _)| file.starts_with(BOOK) && **file != summary && !listed.contains(*file))
        .map(|(file, _)| format!("{}: {} does not list it", file.display(), summary.display()))
        .collect()
}

fn missing_commands(root: &Path) -> Vec<String> {
    let files = COMMANDS.map(|file| {
        (
            file,
            fs::read_to_string(root.join(file)).unwrap_or_default(),
        )
    });
    let lacking = files.iter().flat_map(|(file, text)| {
        [RUN, TEST]
            .into_iter()
            .filter(|line| !text.contains(line))
            .map(move |line| format!("{file}: does not give the command `{line}`"))
    });
    lacking.collect()
}

/// Lines of TOML that a page shows and the first case does not have.
fn not_in_the_case(root: &Path, file: &str) -> Vec<String> {
    let read = |file: &str| fs::read_to_string(root.join(file)).unwrap_or_default();
    let case = read(CASE);
    let known: BTreeSet<&str> = case.lines().collect();
    let page = read(file);
    let blocks = page
        .split("```toml\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next());
    let strange = blocks
        .flat_map(str::lines)
        .filter(|line| !known.contains(line));
    strange
        .map(|line| format!("{file}: shows `{line}`, which {CASE} does not have"))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{anchor, beside, parse};

    #[test]
    fn links_includes_and_code_are_told_apart() {
        let page = parse(
            "# A `b` c\n[x](a.md#b) and `[y](no.md)`\n<!-- include ../c.toml -->\n```\n[z](no.md)\n```\n<!-- end -->\n",
        );
        assert_eq!(page.links, ["a.md#b"]);
        assert_eq!(page.includes, ["../c.toml"]);
        assert_eq!(page.codes, ["b", "[y](no.md)"]);
        assert!(page.anchors.contains("a-b-c"));
    }

    #[test]
    fn anchors_and_paths_are_those_of_a_browser() {
        assert_eq!(anchor("Newmark: β and γ, (5)"), "newmark-β-and-γ-5");
        assert_eq!(
            beside(Path::new("docs/src/a.md"), "../b/./c.md"),
            Path::new("docs/b/c.md")
        );
    }
}
