//! What the repository holds: sizes, and nothing that belongs to one machine.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Longest Rust file, in lines.
const LINES: usize = 600;

/// Largest file, in bytes.
const BYTES: u64 = 2 << 20;

/// Beginnings of paths that exist on one machine only, where a text names one.
const PRIVATE: [&str; 4] = ["/home/", "/root/", "/Users/", "/tmp/"];

/// Extensions of files that people read.
const TEXTS: [&str; 4] = ["md", "toml", "html", "svg"];

/// Files of the repository, relative to its root, sorted: tracked, or new and not ignored.
pub fn list(root: &Path) -> Result<Vec<PathBuf>, String> {
    let output = Command::new("git")
        .args(["ls-files", "--cached", "--others", "--exclude-standard"])
        .current_dir(root)
        .output()
        .map_err(|cause| format!("cannot list the files of the repository: git: {cause}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut files: Vec<PathBuf> = text
        .lines()
        .map(PathBuf::from)
        .filter(|file| root.join(file).is_file())
        .collect();
    files.sort();
    files.dedup();
    match files.is_empty() {
        true => Err("no files: is this a git checkout?".to_owned()),
        false => Ok(files),
    }
}

/// Whether a path ends with this extension.
pub fn is(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found == extension)
}

/// What is too long, too large, or names this machine.
pub fn check(root: &Path) -> Vec<String> {
    let files = match list(root) {
        Ok(files) => files,
        Err(problem) => return vec![problem],
    };
    let here = fs::canonicalize(root).unwrap_or_default();
    files
        .iter()
        .filter_map(|file| problem(root, file, &here.to_string_lossy()))
        .collect()
}

fn problem(root: &Path, file: &Path, here: &str) -> Option<String> {
    let bytes = fs::metadata(root.join(file)).ok()?.len();
    let name = file.display();
    if bytes > BYTES {
        return Some(format!("{name}: {bytes} bytes; at most {BYTES}"));
    }
    // what is no text cannot be read here, and has neither lines nor paths
    let text = fs::read_to_string(root.join(file)).ok()?;
    let lines = text.lines().count();
    if is(file, "rs") && lines > LINES {
        return Some(format!("{name}: {lines} lines; split above {LINES}"));
    }
    let reads = TEXTS.iter().any(|extension| is(file, extension));
    let private = PRIVATE.into_iter().filter(|_| reads);
    let named = private.chain([here]).find(|path| text.contains(path))?;
    Some(format!(
        "{name}: names {named}, which other machines do not have"
    ))
}
