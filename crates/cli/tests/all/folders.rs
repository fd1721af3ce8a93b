//! The results folder under two runs, a killed run, and links.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use crate::commands::{carom, text};
use crate::streams::BAR;

/// Starts a run of very many steps and waits until it has written its first rows.
fn long_run(work: &Path) -> Child {
    let mut run = Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(["run", "case.toml", "--set", "time.end=1000.0"])
        .current_dir(work)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begin = Instant::now();
    let running = || {
        let rows = fs::metadata(work.join("case.carom/histories.csv"));
        rows.is_ok_and(|rows| rows.len() > 0)
    };
    while !running() {
        assert!(begin.elapsed() < Duration::from_secs(60), "no row");
        assert_eq!(run.try_wait().unwrap(), None, "it ended");
        std::thread::sleep(Duration::from_millis(2));
    }
    run
}

#[test]
fn a_second_run_into_a_folder_is_refused_until_the_first_is_dead() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), BAR).unwrap();
    let mut first = long_run(work.path());
    let second = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(second.status.code(), Some(3), "{}", text(&second));
    let said = text(&second);
    assert!(
        said.contains("another run of carom writes into 'case.carom'"),
        "{said}"
    );
    let copy = fs::read_to_string(work.path().join("case.carom/case.toml")).unwrap();
    assert!(copy.contains("time.end=1000.0"), "the first run's");
    first.kill().unwrap();
    first.wait().unwrap();
    let third = carom(work.path(), &["run", "case.toml"]);
    assert_eq!(third.status.code(), Some(0), "{}", text(&third));
    let copy = fs::read_to_string(work.path().join("case.carom/case.toml")).unwrap();
    assert!(!copy.contains("time.end=1000.0"), "the third run's");
}

#[test]
#[cfg(unix)]
fn a_run_overwrites_no_file_that_a_link_in_its_folder_leads_to() {
    let work = tempfile::tempdir().unwrap();
    fs::write(work.path().join("case.toml"), BAR).unwrap();
    assert_eq!(
        carom(work.path(), &["run", "case.toml"]).status.code(),
        Some(0)
    );
    let results = work.path().join("case.carom");
    let precious = work.path().join("precious");
    for name in [
        "histories.csv",
        "impacts.csv",
        "summary.json",
        "checkpoints/last.state",
    ] {
        fs::write(&precious, "precious").unwrap();
        let _ = fs::remove_file(results.join(name));
        std::os::unix::fs::symlink(&precious, results.join(name)).unwrap();
        let output = carom(work.path(), &["run", "case.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        assert_eq!(fs::read(&precious).unwrap(), b"precious", "{name}");
        assert!(results.join(name).symlink_metadata().unwrap().is_file());
    }
}
