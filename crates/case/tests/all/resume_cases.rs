//! Every case of the project is stopped, has a report, goes on and leaves the bytes of a run that was not stopped.
//!
//! A few steps of each: what a checkpoint must hold does not depend on their number. Meshes are the coarsest that the case has.

use std::collections::BTreeSet;
use std::fs;

use carom_case::{Input, build, parse};

use crate::resume::{after, cases, content, open, run, words};
use carom_dynamics::Silent;

/// A case file and the overrides that make it small.
pub type Small = (&'static str, &'static [&'static str]);

/// Bars, and masses on stops.
pub const BARS: &[Small] = &[
    ("arlequin-bars/case-fine.toml", &[]),
    ("arlequin-bars/case.toml", &[]),
    ("bar-on-wall/case.toml", &[]),
    ("bars-in-zones/case.toml", &[]),
    ("hertz-points/case.toml", &[]),
    ("mass-on-stop/case.toml", &[]),
    ("oscillators-in-earthquake/case.toml", &[]),
    ("pounding/case.toml", &[]),
    ("stiff-soft/case.toml", &[]),
    ("crossed-bars/case.toml", &[]),
    ("two-bars-newmark/case.toml", &[]),
    ("two-bars/case.toml", &[]),
];

/// Masses in the plane.
const MASSES: &[Small] = &[("stick-slip/case.toml", &[])];

/// Beams, shells, and what is reduced to modes.
pub const THIN: &[Small] = &[
    ("beam-on-stop/case.toml", &[]),
    ("bolted-plates/case.toml", &[]),
    ("dropped-box/case.toml", &[]),
    ("flexible-pendulum/case.toml", &[]),
    ("mast-in-zones/case.toml", &[]),
    (
        "reduced-bracket/case.toml",
        &["mesh.refine=0", "body.bracket.reduction.modes=6"],
    ),
    ("rod-in-grid/case.toml", &[]),
    ("rolling-rod/case.toml", &[]),
    ("shell-strips/case.toml", &[]),
    ("struck-pipe/case.toml", &[]),
    ("wrapped-sheet/case-full.toml", &[]),
    ("wrapped-sheet/case.toml", &[]),
];

/// Plane and axisymmetric bodies.
pub const PLANE: &[Small] = &[
    ("conveyor/case.toml", &[]),
    ("crushed-tube/case.toml", &["mesh.file=\"tube-coarse.msh\""]),
    ("oblique-bar/case.toml", &["mesh.file=\"bar-coarse.msh\""]),
    ("pile/case.toml", &[]),
    ("rigid-hammer/case.toml", &[]),
    ("ring-sector/case-single.toml", &[]),
    ("ring-sector/case.toml", &[]),
    ("rings/case.toml", &[]),
    ("sdnl111/case.toml", &["mesh.file=\"two-beams-coarse.msh\""]),
    ("spinning-bar/case.toml", &[]),
    ("taylor-bar/case.toml", &[]),
    ("turning-bar/case.toml", &[]),
];

/// Static stages, of more steps than one.
pub const STATIC: &[Small] = &[
    ("blocks-non-matching/case-solid.toml", &[]),
    ("blocks-non-matching/case.toml", &[]),
    ("bolted-plates/solid.toml", &[]),
    (
        "hertz-cylinder/case-force.toml",
        &["mesh.file=\"cylinder-coarse.msh\"", "time.static.steps=3"],
    ),
    (
        "hertz-cylinder/case.toml",
        &["mesh.file=\"cylinder-coarse.msh\"", "time.static.steps=3"],
    ),
    (
        "hertz/case.toml",
        &["mesh.file=\"spheres-coarse.msh\"", "time.static.steps=3"],
    ),
    ("ironing/case.toml", &[]),
    ("sliding-block/case.toml", &[]),
];

/// Solids.
pub const SOLID: &[Small] = &[
    ("bird-on-plate/case.toml", &[]),
    ("block-drop/case.toml", &[]),
    (
        "drop-test/case.toml",
        &[
            "mesh.refine=0",
            "body.walls.mass-scaling.step=\"0.48 us\"",
            "body.corners.mass-scaling.step=\"0.48 us\"",
        ],
    ),
    ("tied-bar/case.toml", &[]),
    ("tori/case.toml", &[]),
];

/// Solids in zones, and beside beams, shells and masses.
pub const MIXED: &[Small] = &[
    ("assembly-row/case-5.toml", &[]),
    ("beam-and-solid/case-solid.toml", &[]),
    ("beam-and-solid/case.toml", &[]),
    ("rod-arlequin/case-stops.toml", &[]),
];

/// Left out: references that are larger than the case which they are for, and overlaps in space that take minutes to be built.
pub const LARGE: &[Small] = &[
    ("arlequin-block/case-fine.toml", &[]),
    ("arlequin-block/case.toml", &[]),
    ("assembly-row/case.toml", &[]),
    ("rod-arlequin/case.toml", &[]),
    ("struck-plate/case.toml", &[]),
    ("tube-on-support/case.toml", &[]),
];

/// The steps of a run, at the middle of which another one is stopped.
const STEPS: u64 = 4;

/// Stops each run, writes its report, goes on with it, and compares what it leaves with a run that was not stopped.
fn stopped_and_gone_on_with(list: &[Small]) {
    for &(name, overrides) in list {
        let input = Input::read(&cases().join(name), &words(overrides));
        let input = input.unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
        let (case, locator) = parse(&input).unwrap_or_else(|problems| panic!("{problems:?}"));
        let built = build(&case, &locator, &input);
        let built = built.unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
        let work = tempfile::tempdir().unwrap();
        let [whole, cut] = ["whole", "cut"].map(|folder| work.path().join(folder));
        for (folder, steps) in [(&whole, STEPS), (&cut, STEPS / 2)] {
            let parts = (&input, &case, &built);
            let ended = carom_case::run(parts, folder.clone(), &mut Silent, &after(steps));
            assert!(ended.unwrap().interrupted || steps == STEPS, "{name}");
        }
        let reported = open(&cut, &[]).report();
        assert!(reported.is_ok(), "{name} has no report: {reported:?}");
        let gone_on = open(&cut, &[]).run(&mut Silent, &after(STEPS / 2));
        assert!(gone_on.is_ok(), "{name} does not go on: {gone_on:?}");
        let [whole, cut] = [&whole, &cut].map(|folder| content(folder));
        let names = [&whole, &cut].map(|files| files.keys().cloned().collect::<Vec<_>>());
        assert_eq!(names[0], names[1], "{name}");
        for (file, bytes) in &whole {
            // a run that goes on begins a new part of what is compressed
            let same = match file.ends_with(".gz") {
                true => unpacked(&cut[file]) == unpacked(bytes),
                false => cut[file] == *bytes,
            };
            assert!(same, "{name}: {file} differs");
        }
    }
}

/// What is in a compressed table.
fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let mut text = Vec::new();
    let mut decoder = flate2::read::MultiGzDecoder::new(bytes);
    std::io::Read::read_to_end(&mut decoder, &mut text).unwrap();
    text
}

#[test]
fn cases_of_bars_and_masses_go_on_with_the_same_bytes() {
    stopped_and_gone_on_with(BARS);
    stopped_and_gone_on_with(MASSES);
}

#[test]
fn cases_of_thin_bodies_go_on_with_the_same_bytes() {
    stopped_and_gone_on_with(THIN);
}

#[test]
fn cases_of_plane_bodies_go_on_with_the_same_bytes() {
    stopped_and_gone_on_with(PLANE);
}

#[test]
fn static_cases_go_on_with_the_same_bytes() {
    stopped_and_gone_on_with(STATIC);
}

#[test]
fn cases_of_solids_go_on_with_the_same_bytes() {
    stopped_and_gone_on_with(SOLID);
}

#[test]
fn cases_of_solids_beside_other_bodies_go_on_with_the_same_bytes() {
    stopped_and_gone_on_with(MIXED);
}

#[test]
fn no_case_of_the_project_is_forgotten() {
    let lists = [BARS, MASSES, THIN, PLANE, STATIC, SOLID, MIXED, LARGE];
    let own = lists.into_iter().flatten().map(|(name, _)| *name);
    let own: BTreeSet<String> = own.map(str::to_owned).collect();
    let mut found = BTreeSet::new();
    for folder in fs::read_dir(cases()).unwrap().map(Result::unwrap) {
        for file in fs::read_dir(folder.path()).unwrap().map(Result::unwrap) {
            if file.path().extension().is_some_and(|end| end == "toml") {
                let [folder, file] = [folder.file_name(), file.file_name()];
                found.insert([folder, file].map(|n| n.into_string().unwrap()).join("/"));
            }
        }
    }
    assert_eq!(own, found);
}

/// A block beside a mass that falls on a stop: the point of the stop is no node of anything that is drawn.
const MASS_BESIDE_A_BLOCK: &str = r#"
carom = 1
mesh.generate.s.rectangle = { origin = [0.0, 0.0], size = [1.0, 1.0], elements = [1, 1] }
material.m = { density = 1000.0, elastic = { young = "1 GPa", poisson = 0.3 } }
body.s = { region = "s", material = "m", section.plane-strain.thickness = 1.0 }
mass.h = { mass = 1.0, at = [2.5, 0.5], initial.velocity = [0.0, -1.0] }
stop.st = { ends = ["h", "ground"], axis = [0.0, -1.0], stiffness = "1 MN/m" }
time = { end = 1e-3, step = "0.1 ms", scheme.newmark = {} }
"#;

#[test]
fn a_mass_on_a_stop_beside_a_solid_goes_on_and_is_marked_where_it_is() {
    let work = tempfile::tempdir().unwrap();
    let file = work.path().join("case.toml");
    fs::write(&file, MASS_BESIDE_A_BLOCK).unwrap();
    let input = Input::read(&file, &[]).unwrap();
    let [whole, cut] = ["whole", "cut"].map(|folder| work.path().join(folder));
    assert!(run(&input, &whole, u64::MAX));
    assert!(!run(&input, &cut, 5));
    open(&cut, &[]).report().unwrap();
    open(&cut, &[]).run(&mut Silent, &|| false).unwrap();
    assert!(content(&whole) == content(&cut));
}
