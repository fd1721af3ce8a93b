//! Whole files and the results folder.

use std::fs;
use std::io;
use std::path::Path;

use carom_output::folder::LIST;
use carom_output::rows::{Cell, Rows};
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
    drop(folder);
    fs::write(parent.path().join("precious"), "").unwrap();
    let list = fs::read_to_string(path.join(LIST)).unwrap();
    fs::write(path.join(LIST), list + "../precious\n").unwrap();
    Folder::create(&path).unwrap();
    assert_eq!(entries(parent.path()), ["case.carom", "precious"]);
}

#[test]
fn a_second_run_into_a_folder_is_refused_as_long_as_the_first_is_open() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("case.carom");
    let mut first = Folder::create(&path).unwrap();
    let inner = Folder::create(&first.nested("1-run").unwrap()).unwrap();
    fs::write(first.file("mine.csv").unwrap(), "first").unwrap();
    let error = Folder::create(&path).unwrap_err();
    assert!(
        matches!(error, Error::Busy { path: ref named } if *named == path),
        "{error}"
    );
    assert_eq!(fs::read(path.join("mine.csv")).unwrap(), b"first");
    drop(first);
    // a run that is still going inside the folder
    let error = Folder::create(&path).unwrap_err();
    assert!(
        matches!(error, Error::Busy { path: ref named } if *named == path.join("1-run")),
        "{error}"
    );
    drop(inner);
    Folder::create(&path).unwrap();
    assert_eq!(entries(&path), [LIST]);
}

#[test]
fn what_a_killed_run_left_half_written_is_removed_by_the_next() {
    let parent = tempfile::tempdir().unwrap();
    let path = parent.path().join("case.carom");
    let mut folder = Folder::create(&path).unwrap();
    fs::write(folder.file("plots/a.svg").unwrap(), "").unwrap();
    drop(folder);
    for name in [
        ".carom-1a2b.part",
        "plots/.carom-3c4d.part",
        "plots/.part",
        ".carom-notes",
    ] {
        fs::write(path.join(name), "").unwrap();
    }
    Folder::create(&path).unwrap();
    assert_eq!(entries(&path), [".carom-notes", LIST, "plots"]);
    assert_eq!(entries(&path.join("plots")), [".part"]);
    // killed while it wrote the first line of the list
    let empty = parent.path().join("begun");
    fs::create_dir(&empty).unwrap();
    fs::write(empty.join(LIST), "# results of").unwrap();
    Folder::create(&empty).unwrap();
    fs::write(empty.join(LIST), "").unwrap();
    fs::write(empty.join("mine"), "").unwrap();
    let error = Folder::create(&empty).unwrap_err();
    assert!(matches!(error, Error::ForeignFolder { .. }), "{error}");
}

#[test]
#[cfg(unix)]
fn nothing_in_a_results_folder_is_reached_through_a_link() {
    use std::os::unix::fs::symlink;
    let parent = tempfile::tempdir().unwrap();
    let other = parent.path().join("other");
    fs::create_dir(&other).unwrap();
    for name in ["file", "table.csv", LIST] {
        fs::write(other.join(name), "precious").unwrap();
    }
    let precious = || {
        assert_eq!(entries(&other), ["file", LIST, "table.csv"]);
        for name in entries(&other) {
            assert_eq!(fs::read(other.join(name)).unwrap(), b"precious");
        }
    };
    let path = parent.path().join("case.carom");
    drop(Folder::create(&path).unwrap());
    let list = fs::read_to_string(path.join(LIST)).unwrap();
    // a listed file behind a linked subfolder, with a list of its own; files that are links
    symlink(&other, path.join("sub")).unwrap();
    symlink(other.join("table.csv"), path.join("table.csv")).unwrap();
    symlink(other.join("table.csv"), path.join("whole.txt")).unwrap();
    let listed = format!("{list}sub/file\nsub/{LIST}\nwhole.txt\n");
    fs::write(path.join(LIST), listed).unwrap();
    let mut folder = Folder::create(&path).unwrap();
    assert_eq!(entries(&path), [LIST, "sub", "table.csv"]);
    precious();
    // written anew: not through the link
    let mut table = Rows::create(&folder.file("table.csv").unwrap(), &["x"]).unwrap();
    table.push([Cell::Number(1.0)].into_iter()).unwrap();
    table.finish().unwrap();
    assert_eq!(
        fs::read_to_string(path.join("table.csv")).unwrap(),
        "x\n1.0\n"
    );
    symlink(other.join("file"), path.join("whole.txt")).unwrap();
    atomic::write_text(&folder.file("whole.txt").unwrap(), "ours").unwrap();
    assert_eq!(fs::read(path.join("whole.txt")).unwrap(), b"ours");
    let error = folder.file("sub/file").unwrap_err();
    assert!(
        matches!(error, Error::Link { path: ref named } if *named == path.join("sub")),
        "{error}"
    );
    drop(folder);
    precious();
    // the list itself
    fs::remove_file(path.join(LIST)).unwrap();
    symlink(other.join(LIST), path.join(LIST)).unwrap();
    let error = Folder::create(&path).unwrap_err();
    assert!(matches!(error, Error::Link { .. }), "{error}");
    precious();
}

#[test]
fn a_saved_state_comes_back_and_a_damaged_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(checkpoint::name(0));
    std::fs::create_dir(folder.path().join(checkpoint::FOLDER)).unwrap();
    let system = models::two_bars(8);
    let mut driver = carom_dynamics::Driver::new(system.clone()).unwrap();
    driver.step().unwrap();
    let bytes = driver.state().to_bytes().unwrap();
    let parts: [&[u8]; 4] = [b"a case", &bytes, b"", b""];
    let written = checkpoint::write(folder.path(), 1, (1, 0.5), parts).unwrap();
    assert_eq!(written, std::fs::metadata(&path).unwrap().len());
    let saved = checkpoint::read(&path).unwrap();
    assert_eq!((saved.head.step, saved.head.time), (1, 0.5));
    assert_eq!(saved.origin, "a case");
    let bytes = saved.state;
    let state = |system| carom_dynamics::State::from_bytes(system, &bytes);
    assert_eq!(&state(&system).unwrap(), driver.state());
    let other = state(&models::two_bars(9)).unwrap_err().to_string();
    assert!(other.contains("another model"));
    let refused = || checkpoint::read(&path).unwrap_err().to_string();
    let mut bytes = std::fs::read(&path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    std::fs::write(&path, &bytes).unwrap();
    assert!(refused().contains("damaged"));
    std::fs::write(&path, "a text\n").unwrap();
    assert!(refused().contains("no checkpoint"));
}
