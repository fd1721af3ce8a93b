//! Runs that are cut and gone on with: what they leave is what a run that was not cut leaves, byte for byte.
//!
//! Aside from times and counts of the work, which tell what was really done. `carom verify resume` compares the states alone, over all
//! schemes, laws and features; here are the files, over kinds of bodies that the cases have.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use carom_case::{Input, NotResumed, Resume, build, parse};
use carom_output::checkpoint;

use carom_dynamics::Silent;

pub fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases")
}

pub fn words(texts: &[&str]) -> Vec<String> {
    texts.iter().map(|text| (*text).to_owned()).collect()
}

/// Stops a run after so many steps.
pub fn after(steps: u64) -> impl Fn() -> bool {
    let left = Cell::new(steps);
    move || match left.get() {
        0 => true,
        more => {
            left.set(more - 1);
            false
        }
    }
}

/// Runs a case; returns whether it came to its end.
pub fn run(input: &Input, folder: &Path, steps: u64) -> bool {
    let (case, locator) = parse(input).unwrap_or_else(|problems| panic!("{problems:?}"));
    let built = build(&case, &locator, input).unwrap_or_else(|problems| panic!("{problems:?}"));
    let parts = (input, &case, &built);
    let finished = carom_case::run(parts, folder.to_owned(), &mut Silent, &after(steps)).unwrap();
    !finished.interrupted
}

pub fn open(folder: &Path, overrides: &[&str]) -> Resume {
    match Resume::open(folder, &words(overrides)) {
        Ok(resume) => resume,
        Err(NotResumed::Folder(error)) => panic!("{error}"),
        Err(NotResumed::Case(_, problems)) => panic!("{problems:?}"),
    }
}

/// The messages of a run that cannot go on.
fn refused(folder: &Path, overrides: &[&str]) -> Vec<String> {
    match Resume::open(folder, &words(overrides)) {
        Ok(_) => panic!("it goes on"),
        Err(NotResumed::Folder(error)) => vec![error.to_string()],
        Err(NotResumed::Case(_, problems)) => problems.iter().map(ToString::to_string).collect(),
    }
}

/// The files of a folder as they are compared: tables of work and times are left out, of checkpoints all but the state.
pub fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let list = fs::read_to_string(folder.join("files.txt")).unwrap();
    let names = list
        .lines()
        .skip(1)
        .filter(|name| !name.contains("earlier-"));
    let mut files: BTreeMap<String, Vec<u8>> = names
        .map(|name| (name.to_owned(), fs::read(folder.join(name)).unwrap()))
        .collect();
    let state = checkpoint::read(&folder.join("checkpoints/last.state"))
        .unwrap()
        .state;
    files.insert("checkpoints/last.state".to_owned(), state);
    let mut summary: serde_json::Value = serde_json::from_slice(&files["summary.json"]).unwrap();
    for key in ["timings", "counts"] {
        summary.as_object_mut().unwrap().remove(key);
    }
    if let Some(newton) = summary["newton"].as_object_mut() {
        newton.remove("factorisations_per_step");
    }
    for zone in summary["zones"]["zones"]
        .as_array_mut()
        .into_iter()
        .flatten()
    {
        zone.as_object_mut().unwrap().remove("costs");
    }
    files.insert("summary.json".to_owned(), summary.to_string().into_bytes());
    let report = String::from_utf8(files["report.html"].clone()).unwrap();
    // the tables of the model's work and of the time spent stand before the text of the case; those of zones have work too
    let work = report.find("Factorisations</");
    let work = work.or_else(|| report.find("<h2 id=\"work\">")).unwrap();
    let case = report.find("<h2 id=\"case\">Case</h2>").unwrap();
    let report = format!("{}{}", &report[..work], &report[case..]);
    files.insert("report.html".to_owned(), report.into_bytes());
    files
}

/// Cuts a run after so many steps, twice, goes on with it, and compares what it leaves with a run that was not cut.
pub fn compare(name: &str, input: &Input, cuts: [u64; 2]) {
    let work = tempfile::tempdir().unwrap();
    let (whole, cut) = (
        work.path().join("whole.carom"),
        work.path().join("cut.carom"),
    );
    assert!(run(input, &whole, u64::MAX));
    assert!(!run(input, &cut, cuts[0]), "{name} was not cut");
    let resume = open(&cut, &[]);
    assert_eq!(resume.instant().0, cuts[0]);
    assert!(
        resume
            .run(&mut Silent, &after(cuts[1]))
            .unwrap()
            .interrupted
    );
    assert!(
        !open(&cut, &[])
            .run(&mut Silent, &|| false)
            .unwrap()
            .interrupted
    );
    let (whole, cut) = (content(&whole), content(&cut));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&whole), names(&cut), "{name}");
    for (file, bytes) in &whole {
        assert!(cut[file] == *bytes, "{name}: {file} differs");
    }
}

/// A case of the project up to an end, with fields and a probe's histories where it has them.
fn of_project(name: &str, overrides: &[&str], cuts: [u64; 2]) {
    let input = Input::read(&cases().join(name).join("case.toml"), &words(overrides)).unwrap();
    compare(name, &input, cuts);
}

const FIELDS: &str = "output.fields={ every = \"1 ms\", record = [\"displacement\", \"stress\"] }";

#[test]
fn bars_in_contact_with_an_exact_solution_go_on_with_the_same_bytes() {
    of_project("two-bars", &[], [30, 40]);
    of_project("two-bars", &["output.histories.every=\"3.3 us\""], [31, 17]);
    of_project("bars-in-zones", &[], [20, 20]);
}

#[test]
fn bodies_of_every_kind_go_on_with_the_same_bytes() {
    of_project(
        "oscillators-in-earthquake",
        &["time.end=\"1 s\""],
        [300, 50],
    );
    of_project("rolling-rod", &["time.end=\"3 ms\""], [25, 10]);
    of_project("beam-on-stop", &["time.end=\"5 ms\""], [400, 200]);
    of_project("mast-in-zones", &["time.end=\"10 ms\"", FIELDS], [90, 30]);
    of_project("arlequin-bars", &["time.end=\"2 ms\"", FIELDS], [30, 20]);
    of_project(
        "flexible-pendulum",
        &["time.end=\"60 ms\"", FIELDS],
        [11, 10],
    );
    of_project("conveyor", &["time.end=\"30 ms\""], [9, 9]);
    of_project("blocks-non-matching", &[], [1, 1]);
}

#[test]
fn another_end_is_that_of_a_run_with_it() {
    let work = tempfile::tempdir().unwrap();
    let file = cases().join("two-bars/case.toml");
    let [short, long] = ["time.end=\"80 us\"", "time.end=\"120 us\""];
    let (whole, cut) = (
        work.path().join("whole.carom"),
        work.path().join("cut.carom"),
    );
    let read = |set: &[&str]| Input::read(&file, &words(set)).unwrap();
    assert!(run(&read(&[short, long]), &whole, u64::MAX));
    assert!(run(&read(&[short]), &cut, u64::MAX));
    assert!(
        !open(&cut, &[long])
            .run(&mut Silent, &|| false)
            .unwrap()
            .interrupted
    );
    let (mut whole, mut cut) = (content(&whole), content(&cut));
    // the exact solution is the one up to the end of the case
    for files in [&mut whole, &mut cut] {
        files.retain(|name, _| {
            name.ends_with(".csv") || name.ends_with(".state") || name == "case.toml"
        });
        assert_eq!(files.len(), 4);
    }
    assert!(whole == cut);
}

#[test]
fn another_model_is_refused_with_the_keys_that_differ() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("cut.carom");
    let input = Input::read(&cases().join("two-bars/case.toml"), &[]).unwrap();
    assert!(!run(&input, &folder, 20));
    let before = content(&folder);
    for (set, key) in [
        (
            "material.steel.elastic.young=\"200 GPa\"",
            "material.steel.elastic.young",
        ),
        (
            "contact.shock.friction.coulomb=0.1",
            "contact.shock.friction",
        ),
        ("time.step={ courant = 0.4 }", "time.step.courant"),
        ("time.end=\"1 us\"", "time.end"),
    ] {
        let found = refused(&folder, &[set]);
        assert!(
            found.len() == 1 && found[0].starts_with(&format!("{key}: ")),
            "{found:?}"
        );
    }
    // nor where the case in the folder was changed
    let file = folder.join("case.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(&file, text.replace("7844", "7800")).unwrap();
    assert!(refused(&folder, &[])[0].starts_with("material.steel.density: "));
    fs::write(&file, text).unwrap();
    assert!(content(&folder) == before, "a refusal changes nothing");
}

#[test]
fn a_mesh_with_another_content_is_refused_and_the_same_one_elsewhere_taken() {
    let work = tempfile::tempdir().unwrap();
    let source = cases().join("conveyor");
    for entry in fs::read_dir(&source).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, work.path().join(path.file_name().unwrap())).unwrap();
    }
    let folder = work.path().join("case.carom");
    let input = Input::read(
        &work.path().join("case.toml"),
        &words(&["time.end=\"20 ms\""]),
    )
    .unwrap();
    let (case, _) = parse(&input).unwrap();
    let mesh = case.mesh.file.clone().unwrap();
    assert!(!run(&input, &folder, 5));
    let (here, elsewhere) = (work.path().join(&mesh), work.path().join("elsewhere.msh"));
    fs::rename(&here, &elsewhere).unwrap();
    open(&folder, &["mesh.file=\"elsewhere.msh\""]);
    let bytes = fs::read(&elsewhere).unwrap();
    fs::write(&here, [&bytes[..], b"\n"].concat()).unwrap();
    let found = refused(&folder, &[]);
    assert!(
        found.len() == 1 && found[0].starts_with("mesh.file: ") && found[0].contains("content"),
        "{found:?}"
    );
}

#[test]
fn damaged_checkpoints_and_other_folders_are_refused() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("cut.carom");
    let set = words(&["output.checkpoint={ every = \"2 us\", keep = 3 }"]);
    let input = Input::read(&cases().join("two-bars/case.toml"), &set).unwrap();
    assert!(refused(&folder, &[])[0].contains("is not a results folder"));
    assert!(!run(&input, &folder, 70));
    let newest = folder.join(checkpoint::name(0));
    let whole = fs::read(&newest).unwrap();
    // one that is damaged is told, and the one before it taken
    let mut bytes = whole.clone();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&newest, &bytes).unwrap();
    let resume = open(&folder, &[]);
    assert!(resume.instant().0 < 70 && resume.unusable[0].to_string().contains("damaged"));
    drop(resume);
    for place in [1, 2] {
        fs::remove_file(folder.join(checkpoint::name(place))).unwrap();
    }
    assert!(refused(&folder, &[])[0].contains("damaged"));
    for cut in [0, 10, 60, whole.len() / 2, whole.len() - 1] {
        fs::write(&newest, &whole[..cut]).unwrap();
        assert_eq!(refused(&folder, &[]).len(), 1, "{cut}");
    }
    let text = b"carom-checkpoint 2 00\n";
    fs::write(&newest, text).unwrap();
    assert!(refused(&folder, &[])[0].contains("another format"));
    fs::write(&newest, b"mine").unwrap();
    assert!(refused(&folder, &[])[0].contains("no checkpoint of carom"));
    fs::remove_file(&newest).unwrap();
    assert!(refused(&folder, &[])[0].contains("there is none"));
    // a table that is shorter than at the checkpoint
    fs::write(&newest, &whole).unwrap();
    fs::write(folder.join("histories.csv"), b"time_s\n").unwrap();
    let error = open(&folder, &[]).run(&mut Silent, &|| false).unwrap_err();
    assert!(error.to_string().contains("histories.csv"), "{error}");
}

#[test]
fn a_ring_holds_the_newest_checkpoints() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("all.carom");
    // 150 us: checkpoints at 20, 40, ..., 140 us and at the end
    let set = words(&["output.checkpoint={ every = \"20 us\", keep = 3 }"]);
    let input = Input::read(&cases().join("two-bars/case.toml"), &set).unwrap();
    assert!(run(&input, &folder, u64::MAX));
    let time = |place| {
        checkpoint::read(&folder.join(checkpoint::name(place)))
            .unwrap()
            .head
            .time
    };
    let dt = {
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().system.dt
    };
    for (place, expected) in [(0, 150e-6), (1, 140e-6), (2, 120e-6)] {
        assert!(
            (time(place) - expected).abs() < dt,
            "{place} {}",
            time(place)
        );
    }
    assert!(!folder.join(checkpoint::name(3)).exists());
}

/// What is in a compressed table.
fn unpacked(path: &Path) -> String {
    let file = fs::File::open(path).unwrap();
    let mut text = String::new();
    let mut decoder = flate2::read::MultiGzDecoder::new(file);
    std::io::Read::read_to_string(&mut decoder, &mut text).unwrap();
    text
}

#[test]
fn compressed_histories_go_on_without_gap_or_duplicate() {
    let work = tempfile::tempdir().unwrap();
    let file = cases().join("two-bars/case.toml");
    let plain = work.path().join("plain.carom");
    assert!(run(&Input::read(&file, &[]).unwrap(), &plain, u64::MAX));
    let expected = fs::read_to_string(plain.join("histories.csv")).unwrap();
    let packed = work.path().join("packed.carom");
    let input = Input::read(&file, &words(&["output.compress-histories=true"])).unwrap();
    assert!(!run(&input, &packed, 30));
    let told = refused(&packed, &["output.compress-histories=false"]);
    assert!(told[0].contains("keep their format"), "{told:?}");
    let path = packed.join("histories.csv.gz");
    let cut = unpacked(&path);
    assert!(
        expected.starts_with(&cut) && cut.lines().count() == 32,
        "{cut}"
    );
    // what a run has written after its last checkpoint, when it was killed
    let mut bytes = fs::read(&path).unwrap();
    let more = bytes[..bytes.len() / 2].to_vec();
    bytes.extend(more);
    fs::write(&path, bytes).unwrap();
    open(&packed, &[]).run(&mut Silent, &|| false).unwrap();
    assert!(unpacked(&path) == expected);
    assert!(!packed.join("histories.csv").exists());
}

#[test]
fn a_report_made_from_the_checkpoint_is_that_of_the_run() {
    let work = tempfile::tempdir().unwrap();
    let input = Input::read(&cases().join("two-bars/case.toml"), &[]).unwrap();
    let made = ["report.html", "summary.json", "plots/contact.svg"];
    for steps in [u64::MAX, 30] {
        let folder = work.path().join("results.carom");
        run(&input, &folder, steps);
        let before = content(&folder);
        for name in made {
            fs::remove_file(folder.join(name)).unwrap();
        }
        let summary = open(&folder, &[]).report().unwrap().summary;
        let after = content(&folder);
        let cut = steps == 30;
        assert_eq!(summary.verdict.unfinished.is_some(), cut, "{summary:?}");
        for (name, bytes) in &before {
            // the run was interrupted, its report says that it has not come to its end
            if !(cut && made[..2].contains(&name.as_str())) {
                assert!(after[name] == *bytes, "{name} differs after {steps}");
            }
        }
        let [one, other] = [&before, &after].map(|files| {
            let all: serde_json::Value = serde_json::from_slice(&files["summary.json"]).unwrap();
            ["contacts", "energy", "momentum", "maxima", "time"].map(|key| all[key].clone())
        });
        assert_eq!(one, other);
    }
    // and the run goes on as if nothing had been
    let folder = work.path().join("results.carom");
    open(&folder, &[]).run(&mut Silent, &|| false).unwrap();
    let whole = work.path().join("whole.carom");
    run(&input, &whole, u64::MAX);
    let [one, other] = [&folder, &whole].map(|folder| content(folder));
    for (name, bytes) in &one {
        assert!(other[name] == *bytes, "{name} differs");
    }
}
