//! Reductions that are kept in a file.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use carom_bodies::Body;
use carom_case::{Built, Input, Problem};
use carom_dynamics::Driver;

const CASE: &str = r#"
carom = 1

[mesh]
generate.rod = { line = { from = [0.0, 0.0, 0.0], to = [1.0, 0.0, 0.0], elements = 20 } }

[material.steel]
density = 7800.0
elastic = { young = "210 GPa", poisson = 0.3 }

[body.rod]
region = "rod"
material = "steel"
section.beam = { shape.circle = { diameter = "2 cm" }, theory = "timoshenko", orientation = [0.0, 1.0, 0.0] }
initial.velocity = [0.0, -1.0, 0.0]
reduction = { modes = 6, file = "rod.reduction" }

[support.root]
on = "rod.left"
fix = ["x", "y", "z", "rx", "ry", "rz"]

[stop.tip]
ends = ["rod.right", "ground"]
axis = [0.0, -1.0, 0.0]
gap = "0.1 mm"
stiffness = "1 MN/m"

[time]
end = "2 ms"
step = "10 us"
scheme.newmark = {}
"#;

/// A second rod, whose end a plain constraint joins to that of the first.
const JOINED: &str = r#"
[mesh.generate.post]
line = { from = [0.0, 0.5, 0.0], to = [1.0, 0.5, 0.0], elements = 4 }

[body.post]
region = "post"
material = "steel"
section.beam = { shape.circle = { diameter = "1 cm" }, theory = "timoshenko", orientation = [0.0, 1.0, 0.0] }

[support.foot]
on = "post.left"
fix = ["x", "y", "z", "rx", "ry", "rz"]

[constraint.ends]
terms = [
    { on = "rod.right", direction = "y", factor = 1.0 },
    { on = "post.right", direction = "y", factor = -1.0 },
]
"#;

fn built(folder: &Path, overrides: &[&str]) -> Result<Built, Vec<Problem>> {
    built_of(CASE, folder, overrides)
}

fn built_of(case: &str, folder: &Path, overrides: &[&str]) -> Result<Built, Vec<Problem>> {
    let path = folder.join("case.toml");
    fs::write(&path, case).unwrap();
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    let input = Input::read(&path, &overrides).unwrap();
    let (case, locator) = carom_case::parse(&input)?;
    carom_case::build(&case, &locator, &input)
}

/// The bytes of the state after 100 steps.
fn end(built: &Built) -> Vec<u8> {
    let mut driver = Driver::new(Arc::clone(&built.system)).unwrap();
    (0..100).for_each(|_| driver.step().unwrap());
    driver.state().to_bytes().unwrap()
}

fn told(built: &Built) -> &str {
    &built.reductions[0].1
}

#[test]
fn a_run_from_a_saved_reduction_ends_in_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let first = built(folder.path(), &[]).unwrap();
    assert_eq!(told(&first), "saved to 'rod.reduction'");
    let second = built(folder.path(), &[]).unwrap();
    assert_eq!(told(&second), "read from 'rod.reduction'");
    assert_eq!(end(&first), end(&second));
    // damping is added to what the file has
    let damped = built(folder.path(), &["body.rod.reduction.damping-ratio=0.1"]).unwrap();
    assert_eq!(told(&damped), "read from 'rod.reduction'");
    assert_ne!(end(&first), end(&damped));
}

/// With all of its modes a reduced body is the full one, so that what its constraint does differs by rounding.
#[test]
fn the_nodes_of_a_constraint_are_retained() {
    let folder = tempfile::tempdir().unwrap();
    let text = CASE.replace("elements = 20", "elements = 4") + JOINED;
    // three inner nodes of six unknowns each
    let reduced = text.replace("modes = 6, file = \"rod.reduction\"", "modes = 18");
    let full = text.replace("reduction = { modes = 6, file = \"rod.reduction\" }", "");
    let motion = |text: &str| {
        let built = built_of(text, folder.path(), &[]).unwrap();
        let system = Arc::clone(&built.system);
        let mut driver = Driver::new(Arc::clone(&system)).unwrap();
        (0..100).for_each(|_| driver.step().unwrap());
        let node = |group: &str| {
            let group = &system.mesh.groups[group];
            let node = system.mesh.group_nodes(group)[0];
            system
                .unknowns
                .vector(system.number[node as usize], &driver.state().motion.u)
        };
        [node("rod.right"), node("post.right")]
    };
    let [of_reduced, of_full] = [motion(&reduced), motion(&full)];
    let size = of_full[0][1].abs();
    assert!(size > 1e-5, "{of_full:?}");
    for [rod, post] in [&of_reduced, &of_full] {
        assert!((rod[1] - post[1]).abs() < 1e-12 * size, "{rod:?} {post:?}");
    }
    for (one, other) in of_reduced.iter().flatten().zip(of_full.iter().flatten()) {
        assert!(
            (one - other).abs() < 1e-9 * size,
            "{of_reduced:?} {of_full:?}"
        );
    }
}

#[test]
fn what_is_built_to_be_looked_at_saves_no_reduction() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, CASE).unwrap();
    let look = || {
        let input = Input::read(&path, &[]).unwrap();
        let (case, locator) = carom_case::parse(&input).unwrap();
        carom_case::build_to_look(&case, &locator, &input).unwrap()
    };
    let told_at_first = "made anew; a run saves it to 'rod.reduction'";
    assert_eq!(told(&look()), told_at_first);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    built(folder.path(), &[]).unwrap();
    assert_eq!(told(&look()), "read from 'rod.reduction'");
}

#[test]
fn a_saved_reduction_of_something_else_is_made_anew() {
    for change in [
        "material.steel.density=7801.0",
        "material.steel.elastic.young=2e11",
        "mesh.generate.rod.line.to=[1.01,0,0]",
        "body.rod.section.beam.shape.circle.diameter=0.021",
        "body.rod.reduction.modes=7",
        "body.rod.reduction.massless=true",
        "body.rod.reduction.retain=[\"rod.left\"]",
        "support.root.fix=[\"x\",\"y\",\"z\",\"rx\"]",
    ] {
        let folder = tempfile::tempdir().unwrap();
        built(folder.path(), &[]).unwrap();
        let anew = built(folder.path(), &[change]).unwrap();
        assert!(
            told(&anew).starts_with("made anew"),
            "{change}: {}",
            told(&anew)
        );
        let again = built(folder.path(), &[change]).unwrap();
        assert_eq!(told(&again), "read from 'rod.reduction'", "{change}");
        assert!(matches!(again.system.bodies[0], Body::Reduced(_)));
    }
}

#[test]
fn a_file_that_is_cut_or_changed_is_refused_and_stays() {
    let folder = tempfile::tempdir().unwrap();
    built(folder.path(), &[]).unwrap();
    let path = folder.path().join("rod.reduction");
    let whole = fs::read(&path).unwrap();
    let mut changed = whole.clone();
    changed[whole.len() / 2] ^= 1;
    for bytes in [&whole[..whole.len() - 1], &whole[..10], &[], &changed] {
        fs::write(&path, bytes).unwrap();
        let problems = built(folder.path(), &[]).unwrap_err();
        assert_eq!(problems.len(), 1);
        assert_eq!(problems[0].path, "body.rod.reduction.file");
        assert!(problems[0].place.is_some());
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
}

/// A clamped rod in a static stage, its end loaded.
const BENT: &str = r#"
carom = 1
mesh.generate.rod.line = { from = [0.0, 0.0], to = [1.0, 0.0], elements = 10 }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.0 } }
load.tip = { on = "rod.right", force = [0.0, -0.01] }
support.root = { on = "rod.left", fix = ["x", "y", "rz"] }
time = { end = 1.0, static = { end = 1.0, steps = 1 } }
[body.rod]
region = "rod"
material = "m"
section.beam = { shape.rectangle = { height = 0.01, width = 0.1 }, theory = "euler-bernoulli" }
reduction.modes = 3
"#;

/// A block on a plane strain block that is clamped at its bottom, both of 1 m².
const STACK: &str = r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 1.0], size = [1.0, 1.0], elements = [2, 2] }
mesh.generate.b.rectangle = { origin = [0.0, 0.0], size = [1.0, 1.0], elements = [2, 2] }
material.m = { density = 7800.0, elastic = { young = "200 GPa", poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 1.0 }
body.b = { region = "b", material = "m", section.plane-strain.thickness = 1.0, reduction.modes = 6 }
contact.c = { secondary = "a.bottom", primary = "b.top", law.velocity = {}, sliding = "small" }
support.foot = { on = "b.bottom", fix = ["x", "y"] }
load.g.acceleration = [0.0, -10.0]
time = { end = 1.001, step = "20 us", static = { end = 1.0, steps = 1 }, scheme.theta = {} }
"#;

/// A driver after its first step.
fn pressed(text: &str) -> Driver {
    let folder = tempfile::tempdir().unwrap();
    let built = built_of(text, folder.path(), &[]).unwrap();
    let mut driver = Driver::new(Arc::clone(&built.system)).unwrap();
    driver.step().unwrap();
    driver
}

fn moved(driver: &Driver, group: &str) -> [f64; 3] {
    let system = driver.system();
    let node = system.mesh.group_nodes(&system.mesh.groups[group])[0];
    let node = system.number[node as usize];
    system.unknowns.vector(node, &driver.state().motion.u)
}

#[test]
fn a_static_stage_knows_the_supports_inside_a_reduced_body() {
    let driver = pressed(BENT);
    // F L³/(3 E I): static responses to the retained unknowns are exact; 1e-8 for the condition of the full matrix, about 1e7
    let inertia = 0.1 * 0.01_f64.powi(3) / 12.0;
    let expected = -0.01 / (3.0 * 1e7 * inertia);
    let found = moved(&driver, "rod.right")[1];
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
}

/// With all of its modes a reduced body is the full one.
#[test]
fn a_reduced_body_carries_another_one_in_a_static_stage_as_the_full_body_does() {
    let full = pressed(&STACK.replace(", reduction.modes = 6", ""));
    let reduced = pressed(STACK);
    // 7800 kg at 10 m/s²; iterations end at 1e-10 of the forces
    for driver in [&full, &reduced] {
        let force = driver.report().contacts[0].force;
        assert!((force / 78e3 - 1.0).abs() < 1e-9, "{force}");
    }
    let [of_full, of_reduced] = [&full, &reduced].map(|driver| moved(driver, "a.top"));
    let size = of_full[1].abs();
    for (one, other) in of_full.iter().zip(of_reduced) {
        assert!(
            (one - other).abs() < 1e-8 * size,
            "{of_full:?} {of_reduced:?}"
        );
    }
}

#[test]
fn a_reduced_body_that_supports_leave_free_is_named_with_its_motion() {
    let told = |text: &str| {
        let folder = tempfile::tempdir().unwrap();
        let problems = built_of(text, folder.path(), &[]).err().unwrap_or_default();
        let messages = problems.into_iter().map(|problem| problem.message);
        messages.collect::<Vec<_>>().join("; ")
    };
    let free =
        |motion: &str| format!("in a static stage the body `rod` can {motion} without any force");
    let rolls = BENT.replace(r#"fix = ["x", "y", "rz"]"#, r#"fix = ["y", "rz"]"#);
    assert_eq!(told(&rolls), free("move along x"));
    let hinged = BENT.replace(r#"fix = ["x", "y", "rz"]"#, r#"fix = ["x", "y"]"#);
    assert_eq!(told(&hinged), free("turn about z"));
    // amplitudes alone, those of rigid motions among them
    let modal = BENT.replace("modes = 3", "modes = 6");
    let modal = modal.replace(
        r#"on = "rod.right", force = [0.0, -0.01]"#,
        "acceleration = [0.0, -1.0]",
    );
    let modal = modal.replace(
        r#"support.root = { on = "rod.left", fix = ["x", "y", "rz"] }"#,
        "",
    );
    assert_eq!(told(&modal), free("move along x"));
}

/// Nodes that are not retained have no unknowns: what is said of the body before the run is said of its retained nodes and amplitudes.
#[test]
fn facts_of_a_reduced_body_that_falls_are_those_of_the_full_one() {
    let text = CASE.replace(
        "modes = 6, file = \"rod.reduction\"",
        "modes = 1, retain = [\"rod.left\"]",
    );
    let text = text.replace(
        "[support.root]\non = \"rod.left\"\nfix = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]",
        "[load.g]\nacceleration = [0.0, -10.0, 0.0]",
    );
    let full = text.replace("reduction = { modes = 1, retain = [\"rod.left\"] }", "");
    let impact = |text: &str| {
        let folder = tempfile::tempdir().unwrap();
        let built = built_of(text, folder.path(), &[]).unwrap();
        let facts = carom_case::facts(&built);
        let fact = facts.iter().find(|fact| fact.name.contains("tip"));
        fact.unwrap().value.clone()
    };
    assert_eq!(impact(&text), impact(&full));
    // with one mode and supports its last node has the last unknown
    let held = CASE.replace("modes = 6, file = \"rod.reduction\"", "modes = 1");
    assert!(
        impact(&held).contains("first possible impact"),
        "{}",
        impact(&held)
    );
}
