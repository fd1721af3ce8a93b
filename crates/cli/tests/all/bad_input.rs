//! Every wrong case of `tests/bad-input` gives its expected message, exits 2 and leaves nothing but, from `carom check --cells`, the
//! files that the message names.
//!
//! A folder there holds `case.toml` (or not, where that is what is wrong), what it refers to, the message in `expected.txt`, and the
//! further arguments of the command in `arguments`, one a line. `CAROM_BLESS=1` writes the messages anew: read them by eye then.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The command that writes cells.
const WRITES: &str = "check --cells";

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/bad-input")
}

/// Copies a folder of the corpus without its expected message.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target);
        } else if entry.file_name() != "expected.txt" {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

fn names(folder: &Path) -> BTreeSet<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    entries.map(|entry| entry.path()).collect()
}

/// What is wrong with the answer of `carom COMMAND case.toml` to one wrong case; the message it gives.
fn answer(command: &str, case: &Path, work: &Path) -> (String, Vec<String>) {
    copy(case, work);
    let arguments = fs::read_to_string(case.join("arguments")).unwrap_or_default();
    let before = names(work);
    let output = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(command.split(' '))
        .arg("case.toml")
        .args(arguments.lines())
        .current_dir(work)
        .output()
        .unwrap();
    let mut wrong = Vec::new();
    if output.status.code() != Some(2) {
        wrong.push(format!("exit {:?} instead of 2", output.status.code()));
    }
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    let pictures = work.join("case.check");
    for left in names(work).difference(&before) {
        if command != WRITES || *left != pictures {
            wrong.push(format!("left {}", left.display()));
        }
    }
    wrong.extend(not_as_named(&message, command, &pictures));
    (message, wrong)
}

/// Files with cells that the message names and `carom check --cells` did not write, or the other way round.
fn not_as_named(message: &str, command: &str, pictures: &Path) -> Vec<String> {
    let written = match command == WRITES && pictures.is_dir() {
        true => names(pictures),
        false => BTreeSet::new(),
    };
    let named = message.split_whitespace().filter_map(|word| {
        let name = word.strip_prefix("case.check/")?;
        Some(pictures.join(name))
    });
    let named: BTreeSet<PathBuf> = named.filter(|_| command == WRITES).collect();
    let differ = written.symmetric_difference(&named);
    differ
        .map(|file| format!("named or written, not both: {}", file.display()))
        .collect()
}

#[test]
fn every_wrong_case_gives_its_message_and_leaves_nothing() {
    let bless = std::env::var_os("CAROM_BLESS").is_some();
    let work = tempfile::tempdir().unwrap();
    let cases: Vec<PathBuf> = names(&corpus()).into_iter().collect();
    let mut wrong = Vec::new();
    for case in &cases {
        let name = case.file_name().unwrap().to_string_lossy();
        let expected = case.join("expected.txt");
        for command in [WRITES, "run"] {
            let folder = work.path().join(command).join(name.as_ref());
            let (message, answers) = answer(command, case, &folder);
            wrong.extend(
                answers
                    .iter()
                    .map(|answer| format!("{command} {name}: {answer}")),
            );
            if bless && command == WRITES && answers.is_empty() {
                fs::write(&expected, &message).unwrap();
            }
            if fs::read_to_string(&expected).ok().as_ref() != Some(&message) {
                wrong.push(format!("{command} {name}: not as expected:\n{message}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(cases.len() >= 40);
}
