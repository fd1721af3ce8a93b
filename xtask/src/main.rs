//! The project's checks: `cargo xtask check` is what a contributor runs before a commit and what CI runs. `cargo xtask
//! chapter` makes the measured tables of the manual anew, `cargo xtask pages` the texts that pages include.
//!
//! Quick things first: what the repository holds (`files`), the documentation (`docs`), who uses whom (`layers`,
//! `circles`), the owners of the step (`owners`), names that were retired (`words`), the lock file of the Python package (`lock`), format,
//! lints, pages of the API, one build of the dependencies for all commands (`builds`), then the README's test command, and reports in a browser
//! where one is installed (`page`).

// A tool for the terminal: printing is its work.
#![allow(clippy::print_stdout, clippy::print_stderr)]

mod builds;
mod chapter;
mod circles;
mod commands;
mod docs;
mod expected;
mod files;
mod layers;
mod lock;
mod owners;
mod page;
mod pages;
mod place;
mod words;

use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use commands::TEST;

const CLIPPY: &str = "cargo clippy --release --workspace --all-targets -- -D warnings";
const DOC: &str = "cargo doc --release --workspace --no-deps";

/// A named check: what is wrong, one line each, or nothing.
type Check = (&'static str, fn(&Path) -> Vec<String>);

const CHECKS: [Check; 13] = [
    ("files", files::check),
    ("documentation", docs::check),
    ("layers", layers::check),
    ("circles", circles::check),
    ("owners", owners::check),
    ("words", words::check),
    ("lock", lock::check),
    ("format", |root| command(root, "cargo fmt --all -- --check")),
    ("lints", |root| command(root, CLIPPY)),
    ("pages of the API", |root| command(root, DOC)),
    ("one build for all commands", builds::check),
    ("tests", |root| command(root, TEST)),
    ("page", page::check),
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    match arguments.first().map(String::as_str) {
        Some("check") => check(&root, &arguments[1..]),
        Some("chapter") => written(chapter::write(&root)),
        Some("pages") => written(pages::write(&root)),
        _ => {
            let names: Vec<&str> = CHECKS.iter().map(|(name, _)| *name).collect();
            eprintln!(
                "usage: cargo xtask check [NAME]... | chapter | pages\nchecks: {}",
                names.join(", ")
            );
            ExitCode::from(2)
        }
    }
}

fn written(outcome: Result<(), String>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Runs the named checks, all of them if none is named, and stops at the first that fails.
fn check(root: &Path, only: &[String]) -> ExitCode {
    let chosen = |name: &str| only.is_empty() || only.iter().any(|wanted| wanted == name);
    if let Some(unknown) = only
        .iter()
        .find(|wanted| CHECKS.iter().all(|(name, _)| name != wanted))
    {
        eprintln!("no check is called '{unknown}'");
        return ExitCode::from(2);
    }
    for (name, find) in CHECKS.iter().filter(|(name, _)| chosen(name)) {
        println!("== {name}");
        let begin = Instant::now();
        let problems = find(root);
        for problem in &problems {
            println!("{problem}");
        }
        let seconds = begin.elapsed().as_secs_f64();
        if !problems.is_empty() {
            println!("== {name}: {} wrong, {seconds:.1} s", problems.len());
            return ExitCode::FAILURE;
        }
        println!("== {name}: good, {seconds:.1} s");
    }
    ExitCode::SUCCESS
}

/// Runs a command line in the root of the repository; its output goes where ours goes.
fn command(root: &Path, line: &str) -> Vec<String> {
    let mut words = line.split(' ');
    let status = Command::new(words.next().unwrap_or_default())
        .args(words)
        .current_dir(root)
        .env("RUSTDOCFLAGS", "-D warnings")
        .status();
    match status {
        Ok(status) if status.success() => Vec::new(),
        Ok(status) => vec![format!("`{line}` failed: {status}")],
        Err(cause) => vec![format!("`{line}` could not be started: {cause}")],
    }
}
