//! The lines of the verdict on energy that mesh and step take, and the command that varies both.

use carom_case::{Axis, Input, build, parse, run};
use carom_output::{Grade, Verdict};

use carom_dynamics::Silent;

fn verdict(text: &str, overrides: &[&str]) -> Verdict {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let input = Input::from_text("cases/spring.toml", text, &overrides);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path().join("results");
    let finished = run((&input, &case, &built), folder, &mut Silent, &|| false);
    finished.unwrap().summary.verdict
}

/// A mass on a spring, ω = 1, that starts with a velocity: `steps` steps of 0.1 under the theta scheme.
fn oscillator(theta: f64, steps: u32) -> Verdict {
    let end = 0.1 * f64::from(steps);
    let text = format!(
        r#"
carom = 1
mass.ball = {{ mass = 1.0, at = [0.0], initial.velocity = [1.0] }}
spring.s = {{ ends = ["ball", "ground"], axis = [1.0], stiffness = 1.0 }}
time = {{ end = {end:?}, step = 0.1, scheme.theta.theta = {theta:?} }}
"#
    );
    verdict(&text, &[])
}

#[test]
fn energy_lost_to_the_scheme_is_graded_and_is_that_of_its_amplification() {
    for (theta, steps, grade) in [
        (0.5, 500, Grade::Good),
        (0.55, 20, Grade::Good),
        (0.55, 100, Grade::Look),
        // 39 %: every balance closes, and no other line says a word
        (0.55, 494, Grade::Bad),
    ] {
        let verdict = oscillator(theta, steps);
        let line = verdict.line("scheme-loss").unwrap();
        // |amplification|² of a step with Ω = ω dt
        let step = (1.0 + (1.0 - theta).powi(2) * 0.01) / (1.0 + theta.powi(2) * 0.01);
        let lost = 1.0 - f64::powi(step, steps as i32);
        // rounding of some hundred steps
        assert!((line.value - lost).abs() < 1e-12, "{line:?} {lost}");
        assert_eq!(line.grade, grade, "{line:?}");
        assert_eq!(verdict.grade, grade, "{:?}", verdict.reasons());
    }
}

/// A bar that hits a rigid wall, until a wave has gone along it once.
fn on_wall(elements: usize) -> Verdict {
    let text = format!(
        r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [1.0], elements = {elements} }}
material.m = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "m", section.bar.area = 1.0, initial.velocity = [-0.01] }}
contact.wall = {{ secondary = "bar.left", obstacle.plane = {{ point = [0.0], normal = [1.0] }}, law.velocity = {{}} }}
time = {{ end = 1.0, step.courant = 0.1, scheme.theta = {{}} }}
"#
    );
    verdict(&text, &[])
}

#[test]
fn energy_lost_where_nodes_close_is_that_of_the_node_and_bad_where_the_node_is_much_of_the_bar() {
    for (elements, grade) in [(1, Grade::Bad), (5, Grade::Look), (20, Grade::Good)] {
        let verdict = on_wall(elements);
        let line = verdict.line("contact-loss").unwrap();
        // the node that stops has half the mass of an element; the stiffness within the step adds C²/2 = 0.5 % to it
        let lost = 0.5 / elements as f64;
        assert!((line.value / lost - 1.0).abs() < 0.01, "{line:?} {lost}");
        assert_eq!(line.grade, grade, "{line:?}");
    }
}

/// The command that the verdict names for what one run cannot tell.
fn command(step: &str, overrides: &[&str]) -> String {
    let text = format!(
        r#"
carom = 1
mesh.generate.bar.line = {{ from = [0.0], to = [1.0], elements = 4 }}
material.m = {{ density = 1.0, elastic = {{ young = 1.0, poisson = 0.0 }} }}
body.bar = {{ region = "bar", material = "m", section.bar.area = 1.0, initial.velocity = [-0.01] }}
time = {{ end = 1.0, {step}, scheme.central-difference = {{}} }}
"#
    );
    let verdict = verdict(&text, overrides);
    let unchecked = verdict.unchecked.iter();
    let mut found = unchecked.filter_map(|why| {
        why.split_once('`')
            .filter(|(start, _)| start.starts_with("whether mesh"))
    });
    let (_, rest) = found.next().unwrap();
    rest.trim_end_matches('`').to_owned()
}

#[test]
fn the_study_that_a_verdict_names_varies_the_mesh_and_the_step_of_its_case() {
    for (step, expected) in [
        ("step = 0.05", "time.step=0.05,0.025"),
        ("step.courant = 0.5", "time.step.courant=0.5,0.25"),
        ("step.critical = 0.5", "time.step.critical=0.5,0.25"),
        (
            "step.adaptive.largest.courant = 0.5",
            "time.step.adaptive.largest.courant=0.5,0.25",
        ),
    ] {
        let command = command(step, &[]);
        let wanted = format!("carom study spring.toml --vary mesh.refine=0,1 --vary {expected}");
        assert_eq!(command, wanted);
        for axis in command.split(" --vary ").skip(1) {
            Axis::read(axis).unwrap();
        }
    }
    let command = command(
        "step = 0.05",
        &["mesh.refine=1", "body.bar.initial.velocity=[-0.02]"],
    );
    assert_eq!(
        command,
        "carom study spring.toml --vary mesh.refine=1,2 --vary time.step=0.05,0.025 --set 'body.bar.initial.velocity=[-0.02]'"
    );
}
