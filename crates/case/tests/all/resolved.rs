//! Whether the elements resolve what a run is asked for: grades of bending and of the patches in which bodies touch.

use carom_case::{Input, build, parse, run};
use carom_output::{Grade, Summary};

use crate::verdict::result;
use carom_dynamics::Silent;

/// A cantilever of 1 m, 20 mm high, under a load at its end.
fn cantilever(elements: [u32; 2], more: &str) -> Summary {
    let case = format!(
        r#"
carom = 1
mesh.generate.b.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 0.02], elements = {elements:?} }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.3 }} }}
body.s = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
support.c = {{ on = "b.left", fix = ["x", "y"] }}
load.F = {{ on = "b.right", traction = [0.0, -0.1] }}
{more}
"#
    );
    result(&case).0
}

const STATIC: &str = "time = { end = 1.0, static = { end = 1.0, steps = 1 } }";

#[test]
fn a_layer_of_long_elements_that_is_36_times_too_stiff_in_bending_is_bad() {
    let locked = cantilever([5, 1], STATIC);
    let line = locked.verdict.line("bending-locked").unwrap();
    assert_eq!((line.grade, locked.verdict.grade), (Grade::Bad, Grade::Bad));
    // in plane strain ν is 0.43: a layer of elements ten times as long as high is 36.2 times too stiff in bending. Over F² L/(E' h), with E' = E/(1 - ν²), its energy is
    // (L/h)²/18 of that, beside ½ E'/G = 1/(1 - ν) of the shear, which elements have right
    let (bending, shear) = (2500.0 / 18.0, 1.0 / 0.7);
    let too_stiff = 1.0 / (1.0 - line.value);
    let expected = (bending + shear) / (bending / 36.2 + shear);
    assert!(
        (too_stiff / expected - 1.0).abs() < 0.01,
        "{too_stiff} {expected}"
    );
    assert!(line.remedy.contains("quadratic"), "{}", line.remedy);
    // squares in four layers: 1/16 of 50 % too stiff
    let fine = cantilever([200, 4], STATIC);
    let line = fine.verdict.line("bending-locked").unwrap();
    assert!(line.value > 0.02 && line.value < 0.04, "{}", line.value);
    assert_eq!(line.grade, Grade::Good);
    let deflection = |summary: &Summary| summary.maxima.displacement.as_ref().unwrap().value;
    let ratio = deflection(&fine) / deflection(&locked);
    // at least the factor that the share tells, and nearly that of bending; the fine mesh is 3 % too stiff
    assert!(ratio > too_stiff, "{ratio} {too_stiff}");
    assert!((ratio / 36.2 - 1.0).abs() < 0.06, "{ratio}");
}

#[test]
fn explicit_steps_are_judged_by_bending_too() {
    let end = |steps: u32| {
        let scheme = "scheme.central-difference = {}";
        format!(
            "time = {{ end = {}, step = 2e-5, {scheme} }}",
            2e-5 * f64::from(steps)
        )
    };
    let grade = |elements| {
        let summary = cantilever(elements, &end(2000));
        summary.verdict.line("bending-locked").unwrap().grade
    };
    assert_eq!(grade([10, 1]), Grade::Bad);
    assert_eq!(grade([200, 4]), Grade::Good);
}

/// A block that is pressed on a rigid cylinder of 0.5 m radius, by 0.2 mm.
fn pressed(elements: [u32; 2], integration: &str) -> Summary {
    let case = format!(
        r#"
carom = 1
mesh.generate.b.rectangle = {{ origin = [-0.1, 0.0], size = [0.2, 0.1], elements = {elements:?} }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e9, poisson = 0.3 }} }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
support.top = {{ on = "b.top", fix = ["x"], move.y = [{{ time = 1.0, displacement = -2e-4 }}] }}
contact.c = {{ secondary = "b.bottom", obstacle.sphere = {{ centre = [0.0, -0.5], radius = 0.5 }}, law.displacement = {{}}{integration} }}
time = {{ end = 1.0, static = {{ end = 1.0, steps = 2 }} }}
"#
    );
    result(&case).0
}

#[test]
fn a_contact_of_one_point_of_many_is_to_be_looked_at_and_one_of_a_resolved_patch_is_not() {
    let one = pressed([4, 2], "");
    let fine = pressed([80, 40], "");
    let line = |summary: &Summary| summary.verdict.line("points-closed").unwrap().clone();
    assert_eq!(line(&one).grade, Grade::Look);
    assert_eq!(line(&one).value, 3.0);
    assert!(line(&one).sentence.contains("1 of 5 points"));
    assert_eq!(line(&fine).grade, Grade::Good, "{:?}", line(&fine));
    // the peak of one point is that of the elements, which is why it is told
    let force = |summary: &Summary| summary.contacts["c"].peak_force;
    let error = force(&one) / force(&fine) - 1.0;
    assert!(error.abs() > 0.1, "{error}");
    // in two elements
    let gauss = pressed([4, 2], ", integration = \"quadrature\"");
    assert_eq!(line(&gauss).grade, Grade::Look);
    let gauss = pressed([80, 40], ", integration = \"quadrature\"");
    assert_eq!(line(&gauss).grade, Grade::Good, "{:?}", line(&gauss));
}

#[test]
fn contacts_whose_points_are_few_by_nature_are_not_judged_by_their_number() {
    // a bar on a wall has one point, a stop the stiffness that it was given
    let bar = r#"
carom = 1
mesh.generate.a.line = { from = [0.0], to = [1.0], elements = 20 }
material.m = { density = 7800.0, elastic = { young = 2e11, poisson = 0.0 } }
body.a = { region = "a", material = "m", section.bar.area = 1e-4, initial.velocity = [-1.0] }
contact.c = { secondary = "a.left", obstacle.plane = { point = [0.0], normal = [1.0] }, law.velocity = {} }
time = { end = 5e-4, step.courant = 0.5, scheme.theta = {} }
"#;
    let (summary, _) = result(bar);
    assert!(summary.contacts["c"].peak_force > 0.0);
    assert!(summary.verdict.line("points-closed").is_none());
    // a plate bends by a finite way under a force at a point
    let plate = r#"
carom = 1
mesh.dimension = 3
mesh.generate.s.rectangle = { origin = [-0.1, -0.1], size = [0.2, 0.2], elements = [4, 4] }
material.m = { density = 1000.0, elastic = { young = 1e9, poisson = 0.3 } }
body.s = { region = "s", material = "m", section.shell.thickness = 0.01, initial.velocity = [0.0, 0.0, -1.0] }
contact.c = { secondary = "s", obstacle.sphere = { centre = [0.0, 0.0, -0.055], radius = 0.05 }, law.velocity = {} }
time = { end = 4e-4, step = 1e-5, scheme.theta = {} }
"#;
    let (summary, _) = result(plate);
    assert!(summary.contacts["c"].peak_force > 0.0);
    assert!(summary.verdict.line("points-closed").is_none());
}

/// A bar that falls on a wall with one of its corners.
#[test]
fn a_corner_touches_in_a_point_whatever_the_elements() {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../cases/oblique-bar/case.toml"
    );
    let input = Input::read(std::path::Path::new(file), &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("results");
    let finished = run((&input, &case, &built), folder, &mut Silent, &|| false).unwrap();
    let summary = finished.summary;
    assert!(summary.contacts["wall"].peak_force > 0.0);
    assert!(
        summary.verdict.line("points-closed").is_none(),
        "{:?}",
        summary.verdict
    );
}
