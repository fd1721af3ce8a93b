//! What is looked at before a run: estimate, picture, quality of the mesh, other formats; and what the command says of itself.

use std::fs;
use std::path::Path;

use crate::commands::{carom, project, text};

/// A plate with a flat triangle, a part of it that is not merged, and walls of one cell.
const PLATE: &str = r#"
carom = 1
[mesh]
file = "plate.inp"
[material.m]
density = 1000.0
elastic = { young = 1e9, poisson = 0.3 }
[body.a]
region = "all"
material = "m"
section.plane-strain.thickness = 1.0
initial.velocity = [0.0, -1.0]
[contact.floor]
secondary = "under"
obstacle.plane = { point = [0.0, -1e-3], normal = [0.0, 1.0] }
law.velocity = {}
[time]
end = 0.1
step = 1e-4
scheme.theta = {}
"#;

/// Two squares beside each other whose common nodes are there twice, and a triangle of a hundredth of their height.
const MESH: &str = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n5, 1, 0\n6, 2, 0\n7, 2, 1\n8, 1, 1\n9, 0.5, 1.01\n\
*ELEMENT, TYPE=CPE4, ELSET=all\n1, 1, 2, 3, 4\n2, 5, 6, 7, 8\n*ELEMENT, TYPE=CPE3, ELSET=all\n3, 4, 3, 9\n\
*SURFACE, NAME=under\n1, S1\n2, S1\n";

fn plate(work: &Path) {
    fs::write(work.join("case.toml"), PLATE).unwrap();
    fs::write(work.join("plate.inp"), MESH).unwrap();
}

#[test]
fn a_check_tells_poor_cells_thin_walls_and_nodes_that_are_not_merged() {
    let work = tempfile::tempdir().unwrap();
    plate(work.path());
    let output = carom(work.path(), &["check", "case.toml", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let fact = |name: &str| -> String {
        let facts = told["facts"].as_array().unwrap().iter();
        let mut own = facts.filter(|fact| fact[0] == name);
        own.next()
            .map_or(String::new(), |fact| fact[1].as_str().unwrap().to_owned())
    };
    // the sine of the least angle, atan(1/50), over that of 60 degrees
    assert!(
        fact("cells of a").starts_with("scaled Jacobian 0.023 at least (tri3"),
        "{}",
        fact("cells of a")
    );
    assert!(
        fact("poor cells").starts_with("1 cells"),
        "{}",
        fact("poor cells")
    );
    assert!(
        fact("walls of a").starts_with("2 of 3 cells"),
        "{}",
        fact("walls of a")
    );
    assert!(
        fact("nodes of a").starts_with("2 nodes"),
        "{}",
        fact("nodes of a")
    );
    // nothing is written but where it is asked for
    assert_eq!(fs::read_dir(work.path()).unwrap().count(), 2);
    let output = carom(work.path(), &["check", "case.toml", "--cells"]);
    assert!(text(&output).contains("case.check/poor-cells.vtu"));
    let written = work.path().join("case.check/poor-cells.vtu");
    assert!(fs::read(written).unwrap().starts_with(b"<?xml"));
}

#[test]
fn json_with_letters_that_turn_the_writing_is_json() {
    let work = tempfile::tempdir().unwrap();
    plate(work.path());
    let file = work.path().join("case.toml");
    let case = fs::read_to_string(&file).unwrap();
    fs::write(
        &file,
        case.replace("carom = 1", "carom = 1\ntitle = \"a\\u202e b\\u009bc\""),
    )
    .unwrap();
    let output = carom(work.path(), &["run", "case.toml", "--json"]);
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["title"], "a\u{202e} b\u{9b}c");
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(!printed.contains(['\u{202e}', '\u{9b}']));
}

#[test]
fn a_check_estimates_the_run_and_draws_the_model() {
    let work = tempfile::tempdir().unwrap();
    plate(work.path());
    let output = carom(
        work.path(),
        &["check", "case.toml", "--estimate", "--picture", "model.svg"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    let line = text(&output);
    let line = line
        .lines()
        .find(|line| line.starts_with("the run takes"))
        .unwrap()
        .to_owned();
    let told = line.ends_with("of 1000 steps; equations by a factor");
    assert!(told, "{line}");
    let picture = fs::read_to_string(work.path().join("model.svg")).unwrap();
    assert!(
        picture.starts_with("<svg") && picture.contains("<path"),
        "{picture:.300}"
    );
    // nothing was run
    assert!(!work.path().join("case.carom").exists());
    let bars = project().join("cases/two-bars/case.toml");
    let output = carom(
        work.path(),
        &["check", bars.to_str().unwrap(), "--picture", "bars.svg"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    // a line for each bar
    let picture = fs::read_to_string(work.path().join("bars.svg")).unwrap();
    for body in ["striker", "target"] {
        assert!(picture.contains(body), "{picture:.300}");
    }
}

#[test]
fn a_mesh_is_converted_with_its_groups() {
    let work = tempfile::tempdir().unwrap();
    plate(work.path());
    let output = carom(work.path(), &["convert", "plate.inp", "plate.vtu"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert!(
        text(&output).contains("9 nodes, 5 elements, 2 groups"),
        "{}",
        text(&output)
    );
    let grid = fs::read(work.path().join("plate.vtu")).unwrap();
    let head = String::from_utf8_lossy(&grid);
    for text in [
        "NumberOfPoints=\"9\"",
        "NumberOfCells=\"5\"",
        "Name=\"all\"",
        "Name=\"under\"",
    ] {
        assert!(head.contains(text), "{text}");
    }
    // read back and written again it is the same
    let output = carom(work.path(), &["convert", "plate.vtu", "again.vtu"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_eq!(fs::read(work.path().join("again.vtu")).unwrap(), grid);
    let output = carom(work.path(), &["convert", "plate.inp", "plate.obj"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
}

#[test]
fn the_command_has_a_manual_page_completions_and_an_introduction() {
    let work = tempfile::tempdir().unwrap();
    let out = |arguments: &[&str]| {
        let output = carom(work.path(), arguments);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{arguments:?} {}",
            text(&output)
        );
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let page = out(&["man"]);
    assert!(
        page.contains(".TH carom 1") && page.contains("checkpoint"),
        "{page:.200}"
    );
    for (shell, text) in [
        ("bash", "complete -F _carom"),
        ("zsh", "#compdef carom"),
        ("fish", "complete -c carom"),
    ] {
        assert!(out(&["completion", shell]).contains(text), "{shell}");
    }
    let help = out(&["--help"]);
    assert!(help.contains("carom new two-bars"), "{help}");
}

#[test]
fn a_run_prints_its_summary_as_json_and_takes_a_number_of_threads() {
    let work = tempfile::tempdir().unwrap();
    plate(work.path());
    let mut tables = Vec::new();
    for threads in ["1", "2"] {
        let arguments = ["run", "case.toml", "--json", "--threads", threads];
        let output = carom(work.path(), &arguments);
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(summary["model"]["nodes"], 9);
        tables.push(fs::read(work.path().join("case.carom/histories.csv")).unwrap());
    }
    assert_eq!(tables[0], tables[1]);
    let output = carom(work.path(), &["run", "case.toml", "--threads", "0"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output));
}
