//! `check`, `schema`, `new`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The folder of the project.
pub fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs the program in a folder.
pub fn carom(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_carom"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

/// Standard output and error, for messages.
pub fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

#[test]
fn every_case_of_the_project_passes_the_check_and_leaves_nothing() {
    let cases = project().join("cases");
    let mut count = 0;
    for folder in std::fs::read_dir(&cases)
        .unwrap()
        .map(|entry| entry.unwrap().path())
    {
        let before = std::fs::read_dir(&folder).unwrap().count();
        let output = carom(&folder, &["check", "case.toml"]);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{}: {}",
            folder.display(),
            text(&output)
        );
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), before);
        // users mesh planes and solids with Gmsh, and so do the cases that they copy
        let case = std::fs::read_to_string(folder.join("case.toml")).unwrap();
        let mut generated = case.lines().filter(|line| line.contains("generate"));
        let of_lines = |line: &str| !line.contains("rectangle") && !line.contains("box");
        assert!(generated.all(of_lines), "{case}");
        count += 1;
    }
    assert!(count >= 5);
}

#[test]
fn every_template_passes_the_check_and_no_file_is_overwritten() {
    let listed = text(&carom(&project(), &["new"]));
    let work = tempfile::tempdir().unwrap();
    for name in [
        "two-bars",
        "two-bars-newmark",
        "bar-on-wall",
        "block-drop",
        "drop-test",
        "friction",
        "rigid-hammer",
        "seismic-stops",
        "preload",
        "arlequin",
    ] {
        assert!(listed.contains(name));
        let file = format!("{name}.toml");
        assert_eq!(
            carom(work.path(), &["new", name, &file]).status.code(),
            Some(0)
        );
        let output = carom(work.path(), &["check", &file]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output));
        assert_eq!(
            carom(work.path(), &["new", name, &file]).status.code(),
            Some(2)
        );
    }
    assert_eq!(
        carom(work.path(), &["new", "two-barz"]).status.code(),
        Some(2)
    );
}

/// Runs templates, and asks for the verdict `good`.
fn end_good(names: &[&str]) {
    for name in names {
        let work = tempfile::tempdir().unwrap();
        assert_eq!(carom(work.path(), &["new", name]).status.code(), Some(0));
        let output = carom(work.path(), &["run", "case.toml", "--json"]);
        let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let verdict = &summary["verdict"];
        assert_eq!(verdict["grade"], "good", "{name}: {verdict:#}");
    }
}

/// All but the box of shells, `drop-test`, whose steps are too many for a quick test.
#[test]
fn templates_end_good() {
    end_good(&[
        "two-bars",
        "two-bars-newmark",
        "bar-on-wall",
        "friction",
        "rigid-hammer",
    ]);
    end_good(&["preload", "arlequin"]);
}

#[test]
fn templates_of_a_block_and_of_buildings_end_good() {
    end_good(&["block-drop", "seismic-stops"]);
}

#[test]
fn a_template_with_a_mesh_brings_it_along_and_writes_all_its_files_or_none() {
    let work = tempfile::tempdir().unwrap();
    let names = || {
        let entries = std::fs::read_dir(work.path().join("sub")).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    std::fs::create_dir(work.path().join("sub")).unwrap();
    let mine = work.path().join("sub/block.msh");
    std::fs::write(&mine, "mine").unwrap();
    let output = carom(work.path(), &["new", "block-drop", "sub/drop.toml"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output).contains("block.msh exists"));
    assert_eq!(names(), ["block.msh"]);
    assert_eq!(std::fs::read(&mine).unwrap(), b"mine");

    std::fs::remove_file(&mine).unwrap();
    let output = carom(work.path(), &["new", "block-drop", "sub/drop.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
    assert_eq!(names(), ["block.geo", "block.msh", "drop.toml"]);
    let output = carom(work.path(), &["check", "sub/drop.toml"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output));
}

#[test]
fn schema_is_json_and_names_the_tables() {
    let output = carom(&project(), &["schema"]);
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for table in [
        "mesh",
        "material",
        "body",
        "contact",
        "time",
        "probe",
        "output",
        "reference",
    ] {
        assert!(schema["properties"].get(table).is_some(), "{table}");
    }
}
