//! `resume`: after a kill at any instant, after a signal, after a full disk.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::commands::{carom, project, text};

/// Two bars over many times their impact, some 40 000 steps with 25 checkpoints.
const CASE: [&str; 8] = [
    "run",
    "case.toml",
    "--set",
    "time.end=\"5 ms\"",
    "--set",
    "output={ histories.every = \"5 us\", fields = { every = \"0.5 ms\", record = [\"displacement\"] } }",
    "--set",
    "output.checkpoint={ every = \"0.2 ms\" }",
];

fn case(work: &Path) {
    let from = project().join("cases/two-bars/case.toml");
    fs::copy(from, work.join("case.toml")).unwrap();
}

fn start(work: &Path) -> Child {
    Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(CASE)
        .current_dir(work)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// Waits until there is a checkpoint.
fn await_checkpoint(work: &Path) {
    let begin = Instant::now();
    while !work.join("case.carom/checkpoints/last.state").is_file() {
        assert!(begin.elapsed() < Duration::from_secs(60), "no checkpoint");
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Whether two results folders have the same tables, fields, collection, list and copy of the case.
fn assert_same(one: &Path, other: &Path) {
    let list = fs::read_to_string(one.join("files.txt")).unwrap();
    assert_eq!(list, fs::read_to_string(other.join("files.txt")).unwrap());
    let kinds = [".csv", ".vtu", ".pvd", ".toml", ".svg"];
    let names = list
        .lines()
        .filter(|name| kinds.iter().any(|kind| name.ends_with(kind)));
    let mut count = 0;
    for name in names {
        let [a, b] = [one, other].map(|folder| fs::read(folder.join(name)).unwrap());
        assert!(a == b, "{name} differs");
        count += 1;
    }
    assert!(count > 20, "{count} files");
}

#[test]
fn a_run_that_is_killed_at_any_instant_goes_on_with_the_same_bytes() {
    let whole = tempfile::tempdir().unwrap();
    case(whole.path());
    let begin = Instant::now();
    assert_eq!(start(whole.path()).wait().unwrap().code(), Some(0));
    let lasted = begin.elapsed();
    let cut = tempfile::tempdir().unwrap();
    case(cut.path());
    // parts of the time that a run takes, in the proportion of the golden ratio
    for k in 1..=3 {
        let mut child = start(cut.path());
        await_checkpoint(cut.path());
        std::thread::sleep(lasted.mul_f64((0.618 * f64::from(k)).fract() * 0.8));
        child.kill().unwrap();
        child.wait().unwrap();
        let output = carom(cut.path(), &["resume", "case.carom"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        assert_same(
            &whole.path().join("case.carom"),
            &cut.path().join("case.carom"),
        );
    }
}

#[test]
#[cfg(unix)]
fn a_signal_ends_a_run_with_a_checkpoint() {
    for signal in ["-TERM", "-INT"] {
        let work = tempfile::tempdir().unwrap();
        case(work.path());
        let mut child = start(work.path());
        await_checkpoint(work.path());
        let process = child.id().to_string();
        Command::new("kill")
            .args([signal, &process])
            .status()
            .unwrap();
        assert_eq!(child.wait().unwrap().code(), Some(130), "{signal}");
        let results = work.path().join("case.carom");
        let summary = fs::read(results.join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap();
        // nothing is lost: the checkpoint is that of the last step
        let output = carom(work.path(), &["resume", "case.carom", "--until", "1 us"]);
        assert_eq!(output.status.code(), Some(2));
        let output = carom(work.path(), &["resume", "case.carom"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        let step = format!("checkpoint of step {} ", summary["time"]["steps"]);
        assert!(text(&output).contains(&step), "{}", text(&output));
    }
}

#[test]
#[cfg(unix)]
fn a_run_that_met_a_full_disk_goes_on_when_there_is_room() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    // a limit on the size of files stands for a full disk; the shell ignores the signal that comes with it
    let script = format!(
        "trap '' XFSZ; ulimit -f 600; exec '{}' \"$@\"",
        env!("CARGO_BIN_EXE_carom")
    );
    let output = Command::new("bash")
        .args(["-c", &script, "carom", "run", "case.toml"])
        .args(["--set", "time.end=\"500 us\""])
        .args(["--set", "output.checkpoint={ every = \"50 us\" }"])
        .current_dir(work.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", text(&output));
    let output = carom(work.path(), &["resume", "case.carom"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let rows = fs::read_to_string(work.path().join("case.carom/histories.csv")).unwrap();
    let times = rows
        .lines()
        .skip(1)
        .map(|row| row.split(',').next().unwrap().parse().unwrap());
    let times: Vec<f64> = times.collect();
    assert!(times.is_sorted_by(|a, b| a < b), "no row twice");
    let steps = extremes(&times);
    assert!((steps[1] / steps[0] - 1.0).abs() < 1e-6, "no row missing");
}

/// The smallest and the largest difference of two times.
fn extremes(times: &[f64]) -> [f64; 2] {
    let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
    steps.fold([f64::INFINITY, 0.0], |[least, most], step| {
        [least.min(step), most.max(step)]
    })
}

#[test]
fn what_is_no_run_is_refused_with_its_cause() {
    let work = tempfile::tempdir().unwrap();
    case(work.path());
    for (folder, message) in [
        ("missing.carom", "not a results folder"),
        (".", "not a results folder"),
    ] {
        let output = carom(work.path(), &["resume", folder]);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output));
        assert!(text(&output).contains(message), "{}", text(&output));
    }
    assert_eq!(
        carom(work.path(), &["run", "case.toml"]).status.code(),
        Some(0)
    );
    for (set, message) in [
        ("time.step.courant=0.4", "--> --set"),
        (
            "contact.shock.law.velocity.capture=\"now\"",
            "cannot go on with another model",
        ),
        ("output.fields.evry=\"1 us\"", "every"),
    ] {
        let output = carom(work.path(), &["resume", "case.carom", "--set", set]);
        assert_eq!(output.status.code(), Some(2), "{}", text(&output));
        assert!(text(&output).contains(message), "{}", text(&output));
    }
}

#[test]
fn a_run_that_was_killed_has_a_report_and_goes_on_with_the_same_bytes() {
    let whole = tempfile::tempdir().unwrap();
    case(whole.path());
    assert_eq!(start(whole.path()).wait().unwrap().code(), Some(0));
    let cut = tempfile::tempdir().unwrap();
    case(cut.path());
    let mut child = start(cut.path());
    await_checkpoint(cut.path());
    child.kill().unwrap();
    child.wait().unwrap();
    let folder = cut.path().join("case.carom");
    assert!(!folder.join("report.html").exists());
    let rows = fs::read(folder.join("histories.csv")).unwrap();
    let output = carom(cut.path(), &["report", "case.carom"]);
    // the verdict on a run that has not come to its end is bad
    assert_eq!(output.status.code(), Some(4), "{}", text(&output));
    assert!(text(&output).contains("has not come to its end"));
    let report = fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(report.contains("has not come to its end"));
    assert!(fs::read(folder.join("histories.csv")).unwrap() == rows);
    let output = carom(cut.path(), &["resume", "case.carom"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_same(&whole.path().join("case.carom"), &folder);
    // and one that has come to its end has the report that it had
    let before = fs::read(folder.join("report.html")).unwrap();
    let output = carom(cut.path(), &["report", "case.carom", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let after = fs::read(folder.join("report.html")).unwrap();
    assert!(after.len().abs_diff(before.len()) < before.len() / 100);
}

#[test]
fn a_run_with_iterations_goes_on_with_the_same_bytes_on_any_number_of_threads() {
    let work = tempfile::tempdir().unwrap();
    for file in ["case.toml", "block.msh"] {
        let from = project().join("cases/block-drop").join(file);
        fs::copy(from, work.path().join(file)).unwrap();
    }
    let run = |folder: &str, threads: &str, end: &str| {
        let end = format!("time.end=\"{end}\"");
        let solver = "time.solver=\"iterative\"";
        let arguments = ["run", "case.toml", "--set", solver, "--set", &end];
        let others = ["--threads", threads, "--results", folder];
        let output = carom(work.path(), &[&arguments[..], &others].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    };
    run("whole", "1", "2 ms");
    run("cut", "3", "1 ms");
    let output = carom(work.path(), &["resume", "cut", "--until", "2 ms"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let [whole, cut] =
        ["whole", "cut"].map(|folder| fs::read(work.path().join(folder).join("histories.csv")));
    assert_eq!(whole.unwrap(), cut.unwrap());
}
