//! What cases must give: the table of a run, exit codes, and the cases as checks of `carom verify`.

use std::collections::BTreeSet;
use std::fs;

use crate::commands::{carom, project, text};

const CASE: &str = r#"
carom = 1
title = "A mass on a stop"
mass.block = { mass = "100 kg", at = [0.0], initial.velocity = [1.0] }
stop.bumper = { ends = ["block", "ground"], axis = [1.0], gap = 0.0, stiffness = "1 MN/m" }
time = { end = "40 ms", step = "0.05 ms", scheme.newmark = {} }

[expect.impulse]
summary = "contacts.bumper.impulse"
value = "200 N s"
tolerance = 0.001
kind = "closed-form"
source = "2 m v"
"#;

#[test]
fn a_missed_expectation_is_told_and_is_no_success() {
    let work = tempfile::tempdir().unwrap();
    let run = |case: &str, more: &[&str]| {
        fs::write(work.path().join("case.toml"), case).unwrap();
        let output = carom(
            work.path(),
            &[&["run", "case.toml", "--quiet"], more].concat(),
        );
        (output.status.code(), text(&output))
    };
    let (code, told) = run(CASE, &[]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("expectations: all 1 met"), "{told}");
    assert!(told.contains("impulse (contacts.bumper.impulse)"), "{told}");
    let report = fs::read_to_string(work.path().join("case.carom/report.html")).unwrap();
    assert!(report.contains("<h2 id=\"expectations\">"));
    let wrong = CASE.replace("200 N s", "100 N s");
    let (code, told) = run(&wrong, &[]);
    assert_eq!(code, Some(4), "{told}");
    assert!(told.contains("expectations: 1 of 1 MISSED"), "{told}");
    assert!(told.contains("verdict: BAD"), "{told}");
    // another model is another case
    let (code, told) = run(&wrong, &["--set", "mass.block.mass=50"]);
    assert_eq!(code, Some(0), "{told}");
    assert!(told.contains("expectations, not judged"), "{told}");
    assert!(told.contains("--set mass.block.mass=50"), "{told}");
}

#[test]
fn a_case_of_the_project_is_a_check_that_needs_no_source_tree() {
    let work = tempfile::tempdir().unwrap();
    let output = carom(work.path(), &["verify", "cases/mass-on-stop"]);
    let told = text(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("contacts.bumper.peak_force"), "{told}");
    assert!(told.contains("1 checks"), "{told}");
    assert_eq!(fs::read_dir(work.path()).unwrap().count(), 0);
}

#[test]
fn a_template_has_no_rows_since_they_are_stated_for_the_case_that_it_is() {
    let work = tempfile::tempdir().unwrap();
    let output = carom(work.path(), &["new", "two-bars"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let case = fs::read_to_string(work.path().join("case.toml")).unwrap();
    assert!(case.ends_with("[reference.two-bars]\n"), "{case}");
}

/// Cases with rows that `carom verify` does not run: the check in the second place has their model, or they take long.
const LEFT_OUT: [(&str, &str); 15] = [
    ("arlequin-block", "arlequin-block"),
    ("assembly-row", "half a minute"),
    ("beam-and-solid", "beam-solid-impact"),
    ("bird-on-plate", "a minute"),
    ("dropped-box", "more than a minute"),
    ("pile", "a minute"),
    ("reduced-bracket", "half a minute"),
    ("rod-in-grid", "rod-in-grid"),
    ("sdnl111", "sdnl111"),
    ("struck-pipe", "a minute"),
    ("struck-plate", "shell-solid-impact"),
    ("taylor-bar", "taylor-bar"),
    ("tied-bar", "half a minute"),
    ("tori", "tori"),
    ("wrapped-sheet", "half a minute"),
];

#[test]
fn every_case_with_rows_is_a_check_or_left_out_for_a_reason() {
    let work = tempfile::tempdir().unwrap();
    let listed = text(&carom(work.path(), &["verify", "no such check"]));
    let names = listed.split([',', ' ', '\n']);
    let run: BTreeSet<&str> = names
        .filter_map(|name| name.strip_prefix("cases/"))
        .collect();
    let checks: BTreeSet<&str> = listed.split([',', ' ', '\n']).collect();
    let mut with_rows = BTreeSet::new();
    for folder in fs::read_dir(project().join("cases")).unwrap() {
        let folder = folder.unwrap();
        let case = fs::read_to_string(folder.path().join("case.toml")).unwrap();
        let page = fs::read_to_string(folder.path().join("README.md")).unwrap();
        let has_rows = case.contains("\n[expect.");
        let name = folder.file_name().into_string().unwrap();
        assert_eq!(
            page.contains("<!-- expect case.toml -->"),
            has_rows,
            "{name}"
        );
        if has_rows {
            with_rows.insert(name);
        }
    }
    let left_out: BTreeSet<&str> = LEFT_OUT.iter().map(|(name, _)| *name).collect();
    for name in &with_rows {
        assert!(
            run.contains(&**name) != left_out.contains(&**name),
            "{name}"
        );
    }
    assert!(
        run.iter()
            .chain(&left_out)
            .all(|name| with_rows.contains(*name))
    );
    for (name, why) in LEFT_OUT {
        assert!(
            checks.contains(why) || why.contains("minute"),
            "{name}: {why}"
        );
    }
}
