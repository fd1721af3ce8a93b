//! What reaches the terminal: a stream that fails, letters that a terminal would obey, messages without an end.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use crate::commands::{carom, project, text};

/// A bar that meets a wall, in a few steps.
pub const BAR: &str = r#"carom = 1
title = "TITLE"
[mesh]
generate.bar.line = { from = [0.0], to = [1.0], elements = 8 }
[material.steel]
density = 7800.0
elastic = { young = "200 GPa", poisson = 0.0 }
[body.bar]
region = "bar"
material = "steel"
section.bar = { area = "1 cm^2" }
initial = { velocity = [1.0] }
[contact.wall]
secondary = "bar.right"
obstacle.plane = { point = [1.0], normal = [-1.0] }
law.velocity = {}
[time]
end = "0.2 ms"
step = { courant = 1.0 }
scheme.theta = {}
"#;

const COMMANDS: [&[&str]; 8] = [
    &["--help"],
    &["schema"],
    &["schema", "--reference"],
    &["new"],
    &["check", "case.toml"],
    &["run", "case.toml"],
    &["study", "case.toml", "--vary", "time.step.courant=1,0.5"],
    &[
        "compare",
        "case.toml",
        "--with",
        "newmark",
        "--reference",
        "none",
    ],
];

/// The program with standard output to `to`.
fn with_output(work: &Path, arguments: &[&str], to: Stdio) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(arguments)
        .current_dir(work)
        .stdout(to)
        .stderr(Stdio::piped())
        .spawn();
    program.unwrap().wait_with_output().unwrap()
}

/// A pipe that nobody reads any more.
fn without_a_reader() -> Stdio {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    writer.into()
}

#[test]
fn a_reader_that_goes_away_changes_no_exit_code() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), BAR).unwrap();
    for arguments in COMMANDS {
        let output = with_output(work.path(), arguments, without_a_reader());
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert_eq!(text(&output), "", "{arguments:?}");
    }
    assert!(work.path().join("case.carom/summary.json").is_file());
    // a line of the verdict is bad: the end of contact was not reached, and a bound of the ledger is no number
    let wrong = ["check", "case.toml", "--set", "time.end=-1"];
    let output = with_output(work.path(), &wrong, without_a_reader());
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_under_standard_output_is_named_and_exits_3() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), BAR).unwrap();
    let full = || File::options().write(true).open("/dev/full").unwrap();
    for arguments in COMMANDS {
        let output = with_output(work.path(), arguments, full().into());
        let message = text(&output);
        assert_eq!(output.status.code(), Some(3), "{arguments:?}: {message}");
        assert!(
            message.starts_with("error: cannot write to standard output: "),
            "{arguments:?}: {message}"
        );
        assert!(message.contains("space"), "{arguments:?}: {message}");
    }
    // nowhere to say it: the exit code says it
    let status = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(["check", "nothing.toml"])
        .current_dir(work.path())
        .stderr(full())
        .status();
    assert_eq!(status.unwrap().code(), Some(2));
}

/// Whether a terminal would obey something of it.
fn obeyed(message: &str) -> bool {
    let directs = |c| matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let mut letters = message.chars();
    letters.any(|c| c != '\n' && c.is_control() || directs(c))
}

#[test]
fn control_characters_of_a_case_are_shown_and_not_obeyed() {
    let work = tempfile::tempdir().unwrap();
    let title = r"\u001b[31mred\u001b[0m \u001b]0;window\u0007 \u009b2J \u202e\nverdict: good";
    fs::write(work.path().join("case.toml"), BAR.replace("TITLE", title)).unwrap();
    for arguments in &COMMANDS[4..] {
        let output = carom(work.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        assert!(!obeyed(&text(&output)), "{}", text(&output));
    }
    let shown = r"\u{1b}[31mred\u{1b}[0m \u{1b}]0;window\u{7} \u{9b}2J \u{202e}\nverdict: good";
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(text(&output).lines().next(), Some(shown));
    // in what was found, in a path, in a line of the case
    let odd = "a\u{1b}[2J\u{9b}b";
    for (arguments, code) in [
        (["check", "case.toml", "--set", &format!("{odd}=1")], 2),
        (
            [
                "check",
                "case.toml",
                "--set",
                &format!("body.bar.region=\"{odd}\""),
            ],
            2,
        ),
        (["check", odd, "--set", "time.end=1"], 2),
        (["run", "case.toml", "--results", &format!("{odd}/r")], 0),
    ] {
        let output = carom(work.path(), &arguments);
        assert_eq!(output.status.code(), Some(code), "{}", text(&output));
        assert!(!obeyed(&text(&output)), "{}", text(&output));
    }
}

#[test]
fn a_message_is_cut_with_the_count_of_what_is_left_out() {
    let work = tempfile::tempdir().unwrap();
    let long = "x".repeat(200_000);
    for (case, counted) in [
        (
            BAR.replace("\"bar\"\nmat", &format!("\"{long}\"\nmat")),
            "more letters)",
        ),
        (BAR.replace("steel]", &format!("{long}]")), "more letters)"),
        (BAR.replace("TITLE", &long), "more letters)"),
        (
            BAR.replace("[0.0]", &format!("[{}0.0]", "0.0,\n".repeat(50_000))),
            "array",
        ),
        (
            BAR.replace("[0.0]", &format!("[{}0.0]", "'a', ".repeat(3000))),
            "The first 50 of them are shown.",
        ),
    ] {
        fs::write(work.path().join("case.toml"), case).unwrap();
        let output = carom(work.path(), &["run", "case.toml"]);
        let message = text(&output);
        assert!(message.contains(counted), "{}", message.len());
        assert!(message.len() < 40_000, "{}", message.len());
    }
}

#[test]
fn an_override_of_several_lines_stands_in_the_copy_of_the_case_as_a_comment() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), BAR).unwrap();
    let title = "title=\"\"\"a\nb\u{7f}\"\"\"";
    let set = ["run", "case.toml", "--set", title];
    // TOML has no delete in a text: two overrides, and the second is refused alone
    assert_eq!(carom(work.path(), &set).status.code(), Some(2));
    let set = ["run", "case.toml", "--set", &title.replace('\u{7f}', "")];
    let output = carom(work.path(), &set);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let copy = work.path().join("case.carom/case.toml");
    let copied = fs::read_to_string(&copy).unwrap();
    assert!(
        copied.starts_with("# --set title=\"\"\"a\\nb\"\"\"\ncarom = 1"),
        "{copied}"
    );
    let again = carom(work.path(), &["check", "case.carom/case.toml"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again));
}

#[test]
fn help_begins_with_what_the_program_is() {
    let help = text(&carom(&project(), &["--help"]));
    assert!(
        help.starts_with("Computes the impact of deformable bodies"),
        "{help}"
    );
}

#[test]
fn forces_next_to_the_smallest_number_leave_a_report() {
    let work = tempfile::tempdir().unwrap();
    let case = BAR.replace("initial = { velocity = [1.0] }\n", "")
        + "[load.push]\non = \"bar.left\"\npressure = 1e-306\n[probe.p]\non = \"bar.right\"\nrecord = [\"displacement\", \"velocity\", \"acceleration\"]\n";
    fs::write(work.path().join("case.toml"), case).unwrap();
    let output = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert!(work.path().join("case.carom/report.html").is_file());
}

#[test]
fn a_key_that_varies_twice_is_refused_before_any_run() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), BAR).unwrap();
    let study = ["study", "case.toml", "--vary", "time.step.courant=1,0.5"];
    let twice = [&study[..], &["--vary", "time.step.courant=0.2,0.1"]].concat();
    let output = carom(work.path(), &twice);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
    assert!(text(&output).contains("`--vary` has the key `time.step.courant` twice"));
    assert!(!work.path().join("case.study").exists());
}
