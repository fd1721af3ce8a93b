//! The cases with thin bodies and solids run: a few steps of each, with balances that close.

use std::fs;
use std::path::Path;

use crate::commands::{carom, project, text};

/// Runs a case of the project up to a time, with other keys set too; the summary.
fn run_until(name: &str, end: &str, set: &[&str]) -> serde_json::Value {
    let work = tempfile::tempdir().unwrap();
    let folder = project().join("cases").join(name);
    for entry in fs::read_dir(&folder).unwrap().map(Result::unwrap) {
        if entry.path().is_file() {
            fs::copy(entry.path(), work.path().join(entry.file_name())).unwrap();
        }
    }
    let end = format!("time.end={end}");
    let set = set.iter().copied().chain([&end[..]]);
    let set = set.flat_map(|set| ["--set", set]);
    let arguments: Vec<&str> = ["run", "case.toml"].into_iter().chain(set).collect();
    let output = carom(work.path(), &arguments);
    assert_eq!(output.status.code(), Some(0), "{name}: {}", text(&output));
    summary(work.path())
}

fn summary(work: &Path) -> serde_json::Value {
    serde_json::from_slice(&fs::read(work.join("case.carom/summary.json")).unwrap()).unwrap()
}

/// Energy, relative, to the tolerance of the iterations; momentum likewise.
fn assert_balanced(summary: &serde_json::Value, name: &str) {
    for quantity in ["energy", "momentum"] {
        let residual = summary[quantity]["relative_residual"].as_f64().unwrap();
        assert!(residual < 1e-8, "{name}: {quantity}: {residual}");
    }
}

#[test]
fn a_rod_between_solid_leaves_runs() {
    assert_balanced(&run_until("rod-arlequin", "250 us", &[]), "rod-arlequin");
}

#[test]
fn a_tube_in_the_hole_of_its_plate_runs() {
    // a spectrum needs a period of its lowest frequency
    let fast =
        r#"random.spectrum=[{frequency="10 kHz",density=30.0},{frequency="20 kHz",density=30.0}]"#;
    let [x, y] = ["x", "y"].map(|axis| format!("load.turbulence-{axis}.{fast}"));
    let summary = run_until("tube-on-support", "250 us", &[&x, &y]);
    assert_balanced(&summary, "tube-on-support");
}

#[test]
fn a_box_of_shells_falls() {
    assert_balanced(&run_until("dropped-box", "20 us", &[]), "dropped-box");
}

#[test]
fn a_bar_of_solid_and_beam_is_struck() {
    let summary = run_until("beam-and-solid", "100 us", &[]);
    assert_balanced(&summary, "beam-and-solid");
    // a spring of 5 MN/m after 0.1 ms at 2 m/s: below k v t, above half of it
    let force = summary["contacts"]["head"]["peak_force"].as_f64().unwrap();
    assert!((500.0..1000.0).contains(&force), "{force}");
}
