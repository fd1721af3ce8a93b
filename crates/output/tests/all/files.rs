//! Whole files and the results folder.

use std::fs;
use std::io;
use std::path::Path;

use carom_output::folder::LIST;
use carom_output::{Error, Folder, atomic, checkpoint};

use crate::models;

fn entries(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_write_that_fails_half_way_leaves_the_old_file_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("summary.json");
    atomic::write_text(&path, "old").unwrap();
    let error = atomic::write(&path, |to| {
        to.write_all(&[b'x'; 100_000])?;
        Err(io::Error::other("the disk is full"))
    })
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        format!("cannot write '{}': the disk is full", path.display())
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(entries(folder.path()), ["summary.json"]);
    atomic::write(&path, |to| to.write_all(b"new")).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
}

#[test]
fn a_folder_in_the_way_of_a_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.html");
    fs::create_dir(&path).unwrap();
    let error = atomic::write_text(&path, "page").unwrap_err().to_string();
    assert!(
        error.starts_with(&format!("cannot write '{}': ", path.display())),
        "{error}"
    );
    assert_eq!(entries(folder.path()), ["report.html"]);
    let missing = folder.path().join("no/such/folder.txt");
    let error = atomic::write_text(&missing, "text")
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with(&format!("cannot write '{}': ", missing.display())),
        "{error}"
    );
}

#[cfg(unix)]
#[test]
fn files_are_as_readable_as_any_other() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let mode = |name: &str| {
        fs::metadata(folder.path().join(name))
            .unwrap()
            .permissions()
            .mode()
    };
    fs::write(folder.path().join("plain"), "").unwrap();
    atomic::write_text(&folder.path().join("ours"), "").unwrap();
    assert_eq!(mode("ours"), mode("plain"));
}

#[test]
fn a_file_where_the_folder_should_be_is_an_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.carom");
    fs::write(&path, "in the way").unwrap();
    let error = Folder::create(&path).unwrap_err();
    assert!(
        matches!(error, Error::NotAFolder { path: ref named } if *named == path),
        "{error}"
    );
    let error = Folder::create(&path.join("below")).unwrap_err();
    assert!(matches!(error, Error::File { .. }), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "in the way");
}

#[test]
fn a_second_run_removes_what_the_first_wrote_and_nothing_else() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("deep/case.carom");
    let mut first = Folder::create(&path).unwrap();
    for name in ["summary.json", "fields/a.vtu", "plots/contact.svg"] {
        fs::write(first.file(name).unwrap(), name).unwrap();
    }
    first.file("announced but never made.csv").unwrap();
    let sorted = [
        "announced but never made.csv",
        "fields/a.vtu",
        "plots/contact.svg",
        "summary.json",
    ];
    assert_eq!(first.names().collect::<Vec<_>>(), sorted);
    drop(first);
    fs::write(path.join("notes.txt"), "mine").unwrap();
    fs::write(path.join("plots/view.pvsm"), "mine").unwrap();
    let second = Folder::create(&path).unwrap();
    assert_eq!(entries(&path), [LIST, "notes.txt", "plots"]);
    assert_eq!(entries(&path.join("plots")), ["view.pvsm"]);
    assert_eq!(second.names().count(), 0);
}

#[test]
fn a_list_cut_in_its_last_line_removes_only_what_it_names_whole() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("case.carom");
    let mut folder = Folder::create(&path).unwrap();
    fs::write(folder.file("fields.pvd").unwrap(), "").unwrap();
    drop(folder);
    fs::write(path.join("field"), "mine").unwrap();
    let list = fs::read_to_string(path.join(LIST)).unwrap();
    fs::write(path.join(LIST), list + "field").unwrap();
    Folder::create(&path).unwrap();
    assert_eq!(entries(&path), ["field", LIST]);
}

#[test]
fn a_folder_of_somebody_else_is_left_alone_and_an_empty_one_is_taken() {
    let parent = tempfile::tempdir().unwrap();
    fs::write(parent.path().join("files.txt"), "apples\npears\n").unwrap();
    fs::write(parent.path().join("apples"), "").unwrap();
    let error = Folder::create(parent.path()).unwrap_err();
    assert!(matches!(error, Error::ForeignFolder { .. }), "{error}");
    assert_eq!(entries(parent.path()), ["apples", "files.txt"]);
    let empty = parent.path().join("empty");
    fs::create_dir(&empty).unwrap();
    Folder::create(&empty).unwrap();
    assert_eq!(entries(&empty), [LIST]);
}

#[test]
fn names_that_leave_the_folder_are_refused_when_written_and_when_read() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("case.carom");
    let mut folder = Folder::create(&path).unwrap();
    for name in [
        "",
        "../escape",
        "/etc/escape",
        "a/../../escape",
        "two\nlines",
        "./.",
    ] {
        assert!(
            matches!(folder.file(name), Err(Error::FileName { .. })),
            "{name:?}"
        );
    }
    fs::write(parent.path().join("precious"), "").unwrap();
    let list = fs::read_to_string(path.join(LIST)).unwrap();
    fs::write(path.join(LIST), list + "../precious\n").unwrap();
    Folder::create(&path).unwrap();
    assert_eq!(entries(parent.path()), ["case.carom", "precious"]);
}

#[test]
fn a_saved_state_comes_back_and_a_damaged_or_foreign_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("last.state");
    let system = models::two_bars(8);
    let mut driver = carom_dynamics::Driver::new(system.clone()).unwrap();
    driver.step().unwrap();
    let bytes = driver.state().to_bytes().unwrap();
    checkpoint::write(&path, "0123", &bytes).unwrap();
    let bytes = checkpoint::read(&path, "0123").unwrap();
    let state = |system| carom_dynamics::State::from_bytes(system, &bytes);
    assert_eq!(&state(&system).unwrap(), driver.state());
    let other = state(&models::two_bars(9)).unwrap_err().to_string();
    assert!(other.contains("another model"));
    let refused = |case: &str| checkpoint::read(&path, case).unwrap_err().to_string();
    assert!(refused("4567").contains("another case"));
    let mut bytes = std::fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    assert!(refused("0123").contains("damaged"));
    std::fs::write(&path, "a text\n").unwrap();
    assert!(refused("0123").contains("no state"));
}
