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
