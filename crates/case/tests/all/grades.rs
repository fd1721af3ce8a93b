//! Grades of runs that leave what their assumptions allow.

use carom_case::{Input, build, parse, run};
use carom_output::verdict::{Grade, Verdict};

use carom_dynamics::Silent;

fn verdict(text: &str) -> Verdict {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("results");
    let finished = run((&input, &case, &built), folder, &mut Silent, &|| false).unwrap();
    finished.summary.verdict
}

fn grade(verdict: &Verdict, line: &str) -> Grade {
    verdict.line(line).unwrap().grade
}

/// A block that comes down on a ball under one edge, at some speed.
fn block_on_an_edge(speed: f64) -> String {
    format!(
        r#"
carom = 1
mesh.generate.b.rectangle = {{ origin = [0, 0.001], size = [0.1, 0.02], elements = [10, 2] }}
material.m = {{ density = 1000, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 0.1, initial.velocity = [0, {speed:?}] }}
contact.anvil = {{ secondary = "b.bottom", obstacle.sphere = {{ centre = [0.01, -0.02], radius = 0.02 }}, law.velocity = {{}} }}
time = {{ end = "10 ms", step = "20 us", scheme.theta = {{}} }}
"#
    )
}

#[test]
fn a_small_strain_body_that_turns_is_graded_and_told_its_material() {
    // it turns at about v/l: 100 rad/s at 5 m/s make 45° in 8 ms, 2.4 rad/s at 0.12 m/s some tenths of a degree in 2 ms
    let fast = verdict(&block_on_an_edge(-5.0));
    assert_eq!(fast.grade, Grade::Bad);
    let line = fast.line("small-strain-rotation").unwrap();
    assert!(line.grade == Grade::Bad && line.value > 0.4, "{line:?}");
    let told = "neo-hooke = { young = 1e9, poisson = 0.3 } in place of elastic";
    assert!(line.remedy.contains(told), "{line:?}");
    let slow = verdict(&block_on_an_edge(-0.12));
    assert_eq!(grade(&slow, "closed"), Grade::Good);
    assert_eq!(grade(&slow, "small-strain-rotation"), Grade::Good);
}

/// Two bars of which one comes at a part of the wave speed.
fn bars(part: f64) -> Verdict {
    let speed = part * (2e11_f64 / 7800.0).sqrt();
    verdict(&format!(
        r#"
carom = 1
mesh.generate.a.line = {{ from = [-1.0], to = [0.0], elements = 20 }}
mesh.generate.b.line = {{ from = [0.0], to = [1.0], elements = 20 }}
material.m = {{ density = 7800.0, elastic = {{ young = 2e11, poisson = 0.0 }} }}
body.a = {{ region = "a", material = "m", section.bar.area = 1e-4, initial.velocity = [{speed:?}] }}
body.b = {{ region = "b", material = "m", section.bar.area = 1e-4 }}
contact.c = {{ secondary = "a.right", primary = "b.left", law.velocity = {{}} }}
time = {{ end = 5e-4, step.courant = 0.5, scheme.theta = {{}} }}
"#
    ))
}

#[test]
fn a_small_strain_bar_is_graded_by_its_strain() {
    // half the speed over that of waves is the strain behind the shock; the mesh makes up to a third more of it
    for (part, expected) in [
        (0.02, Grade::Good),
        (0.1, Grade::Look),
        (0.4, Grade::Bad),
        (40.0, Grade::Bad),
    ] {
        let verdict = bars(part);
        let line = verdict.line("small-strain").unwrap();
        assert_eq!(line.grade, expected, "{line:?}");
        assert!((line.value / (0.5 * part) - 1.17).abs() < 0.17, "{line:?}");
        assert_eq!(verdict.grade, expected, "{:?}", verdict.reasons());
    }
}

/// A block thrown at a plate of rubber.
fn thrown(x: f64, velocity: [f64; 2], sliding: &str) -> Verdict {
    verdict(&format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [{x:?}, 1.5], size = [1.0, 1.0], elements = [4, 4] }}
mesh.generate.b.rectangle = {{ origin = [0.0, 0.0], size = [4.0, 1.0], elements = [8, 2] }}
material.m = {{ density = 1000.0, neo-hooke = {{ young = 1e6, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = {velocity:?} }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
contact.c = {{ secondary = "a.bottom", primary = "b.top", law.velocity = {{}}{sliding} }}
time = {{ end = 0.7, step = 4e-3, scheme.theta.theta = 0.6 }}
"#
    ))
}

#[test]
fn contacts_that_small_sliding_loses_or_invents_are_bad_and_the_default_has_none() {
    let small = ", sliding = 'small'";
    let lost = thrown(-0.6, [10.0, -3.0], small);
    assert_eq!(
        grade(&lost, "small-sliding-lost"),
        Grade::Bad,
        "{:?}",
        lost.reasons()
    );
    let line = lost.line("small-sliding-lost").unwrap();
    assert!(
        line.remedy.contains("contact.c.sliding = \"finite\""),
        "{line:?}"
    );
    let invented = thrown(3.0, [10.0, -1.0], small);
    assert_eq!(
        grade(&invented, "small-sliding-invented"),
        Grade::Bad,
        "{:?}",
        invented.reasons()
    );
    // steps are not linear: the default slides
    for (x, velocity) in [(-0.6, [10.0, -3.0]), (3.0, [10.0, -1.0])] {
        let verdict = thrown(x, velocity, "");
        assert!(
            verdict
                .lines
                .iter()
                .all(|line| !line.name.starts_with("small-")),
            "{verdict:?}"
        );
        assert_ne!(verdict.grade, Grade::Bad, "{:?}", verdict.reasons());
    }
}

/// A mass that meets a stop at 1 m/s, for half a period of `steps` steps.
fn on_a_stop(steps: f64, law: &str) -> Verdict {
    let step = std::f64::consts::PI / steps;
    verdict(&format!(
        r#"
carom = 1
mass.ball = {{ mass = 1.0, at = [0.0], initial.velocity = [1.0] }}
stop.wall = {{ ends = ["ball", "ground"], axis = [1.0], gap = {:?}, stiffness = 1.0{law} }}
time = {{ end = 5.0, step = {step:?}, scheme.newmark = {{}} }}
"#,
        0.5 * step
    ))
}

#[test]
fn a_peak_of_few_steps_is_to_be_looked_at() {
    // contact for π s; it begins and ends within a step
    for (steps, expected) in [(40.0, Grade::Good), (5.0, Grade::Look)] {
        let verdict = on_a_stop(steps, "");
        let line = verdict.line("step-in-contact").unwrap();
        assert!((1.0 / line.value - steps).abs() <= 1.5, "{line:?}");
        assert_eq!(line.grade, expected, "{line:?}");
    }
}

#[test]
fn a_force_without_a_duration_is_told_as_such() {
    let verdict = on_a_stop(40.0, ", law.velocity = {}");
    assert!(verdict.line("step-in-contact").is_none());
    let told = |why: &String| why.starts_with("peak forces of contact `wall`");
    assert!(verdict.unchecked.iter().any(told), "{verdict:?}");
}

#[test]
fn what_is_not_known_of_reduced_bodies_is_told() {
    let verdict = verdict(
        r#"
carom = 1
mesh.dimension = 2
mesh.generate.rod.line = { from = [0.0, 0.0], to = [1.0, 0.0], elements = 10 }
material.m = { density = 7800.0, elastic = { young = 2e11, poisson = 0.3 } }
body.rod = { region = "rod", material = "m", section.beam.shape.circle.diameter = 0.02, initial.velocity = [0.0, -1.0], reduction.modes = 3 }
stop.end = { ends = ["rod.right", "ground"], axis = [0.0, -1.0], gap = 1e-3, stiffness = 1e6 }
time = { end = 5e-3, step = 1e-5, scheme.newmark = {} }
"#,
    );
    assert!(verdict.line("small-strain").is_none());
    for start in [
        "whether rotations and strains of `rod`",
        "whether the modes of `rod`",
    ] {
        let told = |why: &String| why.starts_with(start);
        assert!(verdict.unchecked.iter().any(told), "{verdict:?}");
    }
}
