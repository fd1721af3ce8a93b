//! Bodies that pass through each other: what they did to each other is not in the result, and the verdict says so.

use carom_case::{Input, build, parse, run};
use carom_dynamics::Silent;
use carom_output::{Grade, Summary, Verdict};

/// The summary of a case of the folder `tests/crossings`, with some keys changed.
fn summary(name: &str, changed: &[String]) -> Summary {
    let folder = format!(
        "{}/../../tests/crossings/{name}",
        env!("CARGO_MANIFEST_DIR")
    );
    let path = std::path::Path::new(&folder).join("case.toml");
    let input = Input::read(&path, changed).unwrap();
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let results = tempfile::tempdir().unwrap();
    let results = results.path().join("results");
    let finished = run((&input, &case, &built), results, &mut Silent, &|| false);
    finished.unwrap().summary
}

fn found(verdict: &Verdict, line: &str) -> Option<(Grade, f64)> {
    verdict.line(line).map(|line| (line.grade, line.value))
}

/// In each of these two meet between their nodes, or in one step, and no contact has a force.
#[test]
fn what_passes_between_nodes_is_bad() {
    for (name, line) in [
        ("general-contact-bars", "met"),
        ("no-contact-declared", "met"),
    ] {
        let verdict = summary(name, &[]).verdict;
        assert_eq!(found(&verdict, line), Some((Grade::Bad, 1.0)), "{name}");
        assert_eq!(verdict.grade, Grade::Bad, "{name}");
    }
}

/// A general contact, by bodies and by materials, tells of sharp edges that cross. The upper bar of two alike and rigid is stopped by half of its
/// velocity, m v/2: both go on together.
#[test]
fn edges_between_nodes_touch() {
    const STEP: f64 = 5e-6;
    // the lower edge of one at z = 0.0371447 m, the upper edge of the other at 0.0353553 m, 5 m/s
    let meet = (0.037_144_660_940_672_62 - 0.035_355_339_059_327_376) / 5.0;
    for (by, name) in [("bodies", "all-a-b"), ("materials", "all-m")] {
        let changed = [
            format!("general-contact.by=\"{by}\""),
            format!("time.step={STEP}"),
        ];
        let summary = summary("edge-on-edge-solids", &changed);
        let contact = &summary.contacts[name];
        let first = contact.first_closing.unwrap();
        // the step in which the gap closes, or the next one
        assert!((first - meet).abs() <= STEP, "{first} {meet}");
        // 0.5 · 1.5 kg · 5 m/s
        assert!((contact.impulse.unwrap() / 3.75 - 1.0).abs() < 1e-9);
        let found = found(&summary.verdict, "surfaces");
        assert!(found.is_none_or(|(_, value)| value <= 0.0), "{found:?}");
        assert!(summary.momentum.relative_residual < 1e-10);
    }
}

/// The axis of a beam of a radius of 10 mm comes down on a ridge between its nodes: it touches when the axis is that far from it.
#[test]
fn a_beam_touches_a_ridge_between_its_nodes() {
    let summary = summary("beam-on-solid-ridge", &[]);
    let contact = &summary.contacts["all-a-w"];
    let first = contact.first_closing.unwrap();
    // the axis from z = 60 mm, the ridge at 35.3553 mm, 5 m/s, steps of 50 µs
    let meet = (0.06 - 0.035_355_339_059_327_376 - 0.01) / 5.0;
    assert!((first - meet).abs() <= 5e-5, "{first} {meet}");
    assert!(summary.momentum.relative_residual < 1e-10);
    let found = found(&summary.verdict, "surfaces");
    assert_eq!(found, Some((Grade::Good, 0.0)));
}

/// A ball and a disc that fit between nodes: 60 mm before a beam at 5 m/s, and 1 mm before a block. The block of 50 kg is thrown back: more than m v and less
/// than 2 m v.
#[test]
fn what_is_round_touches_between_nodes() {
    for (name, step, meet) in [
        ("beam-on-sphere-between-nodes", 1e-4, 0.06 / 5.0),
        ("disc-between-nodes", 1e-4, 1e-3 / 5.0),
    ] {
        let summary = summary(name, &[]);
        let contact = &summary.contacts["c"];
        let first = contact.first_closing.unwrap();
        assert!((first - meet).abs() <= step, "{name}: {first} {meet}");
        let found = found(&summary.verdict, "surfaces");
        assert_eq!(found, Some((Grade::Good, 0.0)), "{name}");
        if name == "disc-between-nodes" {
            let momentum = 50.0 * 5.0;
            let impulse = contact.impulse.unwrap();
            assert!(impulse > momentum && impulse < 2.0 * momentum, "{impulse}");
        }
    }
}

/// The corner of a rigid cube, 2 mm above a plate at 5 m/s, touches at 0.4 ms between the nodes of the plate, to within a step of 50 µs.
#[test]
fn the_corner_of_a_cube_touches_between_nodes() {
    let summary = summary("cube-corner", &[]);
    let first = summary.contacts["all-a-b"].first_closing.unwrap();
    assert!((first - 4e-4).abs() <= 5e-5, "{first}");
    let found = found(&summary.verdict, "surfaces");
    assert_eq!(found, Some((Grade::Good, 0.0)));
    assert!(summary.momentum.relative_residual < 1e-10);
}

/// The tip of a wedge, 5 mm above a block at 5 m/s, touches at 1 ms, to within a step of 0.1 ms, though no face of it is turned against the block.
#[test]
fn the_tip_of_a_wedge_touches_between_two_nodes() {
    let summary = summary("wedge-between-nodes", &[]);
    let contact = summary
        .contacts
        .values()
        .find(|contact| contact.impulse > Some(0.0));
    let first = contact.and_then(|contact| contact.first_closing);
    assert!(
        first.is_some_and(|first| (first - 1e-3).abs() <= 1e-4),
        "{first:?}"
    );
    assert_eq!(
        found(&summary.verdict, "surfaces"),
        Some((Grade::Good, 0.0))
    );
}

/// The same until just before they meet: 5 m/s over less than the gap, and nothing to tell.
#[test]
fn before_they_meet_nothing_has_crossed() {
    for (name, end) in [
        ("beam-on-solid-ridge", 0.003),
        ("disc-between-nodes", 1e-4),
        ("edge-on-edge-solids", 0.001),
        ("no-contact-declared", 0.0098),
    ] {
        let verdict = summary(name, &[format!("time.end={end}")]).verdict;
        for line in ["surfaces", "met"] {
            let found = found(&verdict, line);
            assert!(
                found.is_none_or(|found| found == (Grade::Good, 0.0)),
                "{name} {line}: {found:?}"
            );
        }
    }
}

/// A block of 5 kg at 100 m/s that would fly over a rigid disc in one step: it is stopped or thrown back, so its impulse is m v to 2 m v.
#[test]
fn a_step_in_which_a_body_would_pass_its_obstacle_is_cut() {
    let summary = summary("tunnel-rigid-sphere", &[]);
    assert!(summary.time.rejected.passage > 0);
    let impulse = summary.contacts["c"].impulse;
    let stopped = impulse.is_some_and(|impulse| (500.0..1000.0).contains(&impulse));
    assert!(stopped, "{impulse:?}");
    assert_eq!(found(&summary.verdict, "crossing"), None);
}

/// What is said before the run: two bodies with nothing between them meet after 0.1 m at 10 m/s, plus 1/20 of an
/// element of 25 mm on both sides, less what cores keep: at most 0.14 mm on each side.
#[test]
fn bodies_that_fly_towards_each_other_are_told_before_the_run() {
    let warnings = |changed: &[String]| {
        let folder = concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../tests/crossings/no-contact-declared"
        );
        let path = std::path::Path::new(folder).join("case.toml");
        let input = Input::read(&path, changed).unwrap();
        let (case, locator) = parse(&input).unwrap();
        build(&case, &locator, &input).unwrap().warnings
    };
    let told = warnings(&[]);
    let told = told
        .iter()
        .find(|text| text.contains("meet at"))
        .expect("a warning");
    let (_, after) = told.split_once("meet at ").unwrap();
    let (when, _) = after.split_once(" s ").unwrap();
    let when: f64 = when.parse().unwrap();
    let latest = 0.1 + 2.0 * 0.025 / 20.0;
    assert!(
        10.0 * when > latest - 3e-4 && 10.0 * when <= latest,
        "{told}"
    );
    for changed in ["time.end=0.009", "body.a.initial.velocity=[-10.0, 0.0]"] {
        let told = warnings(&[changed.to_owned()]);
        assert!(
            !told.iter().any(|text| text.contains("meet at")),
            "{changed}: {told:?}"
        );
    }
}

/// Two spheres are pressed together in one static step. Nodes of one side tell the contact, and those of the other, which leave it to them and have no
/// force, have not passed anything.
#[test]
fn points_that_leave_their_contact_have_passed_nothing() {
    let summary = summary("../../cases/hertz", &[]);
    let found = found(&summary.verdict, "crossing");
    assert!(found.is_none_or(|(_, value)| value == 0.0), "{found:?}");
    assert_eq!(summary.verdict.grade, Grade::Good);
    assert_eq!(summary.time.rejected.passage, 0);
}
