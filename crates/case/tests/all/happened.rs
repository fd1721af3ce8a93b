//! Whether what a case asks about happened, and was seen by its steps: lines of the verdict.

use carom_output::{Grade, Summary};

use crate::verdict::result;

fn line(summary: &Summary, name: &str) -> Option<(Grade, f64)> {
    let mut lines = summary.verdict.lines.iter();
    let line = lines.find(|line| line.name == name)?;
    Some((line.grade, line.value))
}

/// Two squares of 0.1 m, 0.1 m apart, of which one moves at 10 m/s.
fn squares(contact: &str, end: f64) -> String {
    format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [0.1, 0.1], elements = [4, 4] }}
mesh.generate.b.rectangle = {{ origin = [0.2, 0.0], size = [0.1, 0.1], elements = [4, 4] }}
material.m = {{ density = 1000.0, neo-hooke = {{ young = 1e7, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 1.0, initial.velocity = [10.0, 0.0] }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 1.0 }}
time = {{ end = {end:?}, step = 1e-4, scheme.energy-momentum = {{}} }}
{contact}
"#
    )
}

#[test]
fn bodies_that_meet_without_a_contact_are_bad() {
    let contact =
        "contact.c = { secondary = \"b.left\", primary = \"a.right\", law.velocity = {} }";
    // the way of 0.1 m takes 10 ms
    for (contact, end, met) in [("", 0.012, 1.0), ("", 0.008, 0.0), (contact, 0.012, 0.0)] {
        let (summary, _) = result(&squares(contact, end));
        let grade = if met > 0.0 { Grade::Bad } else { Grade::Good };
        assert_eq!(line(&summary, "met"), Some((grade, met)), "{contact} {end}");
        assert!(summary.verdict.grade >= grade);
    }
}

#[test]
fn a_run_in_which_no_contact_closes_is_to_be_looked_at() {
    let contact =
        "contact.c = { secondary = \"b.left\", primary = \"a.right\", law.velocity = {} }";
    for (end, grade) in [(0.008, Grade::Look), (0.012, Grade::Good)] {
        let (summary, _) = result(&squares(contact, end));
        assert_eq!(line(&summary, "closed").map(|line| line.0), Some(grade));
    }
}

/// General contact has no surface of bars: it joins nothing, says so, and the bars are seen to meet.
#[test]
fn a_general_contact_that_joins_nothing_is_told_and_bad_where_bodies_meet() {
    let (summary, _) = result(
        r#"
carom = 1
mesh.generate.a.line = { from = [0.0], to = [0.1], elements = 10 }
mesh.generate.b.line = { from = [0.11], to = [0.21], elements = 10 }
material.m = { density = 1000.0, elastic = { young = 1e7, poisson = 0.3 } }
body.a = { region = "a", material = "m", section.bar.area = 1e-4, initial.velocity = [10.0] }
body.b = { region = "b", material = "m", section.bar.area = 1e-4 }
general-contact.law.velocity = {}
time = { end = 0.03, step = 1e-5, scheme.theta = {} }
"#,
    );
    for (name, grade) in [("met", Grade::Bad), ("warning", Grade::Look)] {
        let found = line(&summary, name).map(|line| line.0);
        assert_eq!(found, Some(grade), "{name}");
    }
}

/// A load of 1 kN as a triangle of 0.2 ms gives 1 kg a velocity of 0.1 m/s. Between two steps of 1 ms all of it is missed.
#[test]
fn a_pulse_between_two_steps_is_bad_and_gives_its_impulse_in_small_ones() {
    for (step, grade, speed) in [(1e-3, Grade::Bad, 0.0), (1e-5, Grade::Good, 0.1)] {
        let (summary, histories) = result(&format!(
            r#"
carom = 1
mass.p = {{ mass = 1.0, at = [0.0] }}
probe.p = {{ on = "p", record = ["velocity"] }}
time = {{ end = 0.02, step = {step:?}, scheme.newmark = {{}} }}
[load.f]
on = "p"
force = [1000.0]
amplitude = [{{ time = 0.0105, factor = 0.0 }}, {{ time = 0.0106, factor = 1.0 }}, {{ time = 0.0107, factor = 0.0 }}]
"#
        ));
        let (found, missed) = line(&summary, "sampling").unwrap();
        assert_eq!(found, grade, "{step}");
        assert!(
            (missed - if speed > 0.0 { 0.0 } else { 1.0 }).abs() < 1e-9,
            "{missed}"
        );
        // the trapezoidal rule is exact where the knots are steps
        let last = *histories["probe.p.velocity_x_m_s"].last().unwrap();
        assert!((last - speed).abs() < 1e-12, "{last}");
    }
}

/// A record of 98 Hz in steps of 10 ms is one of 2 Hz: the run is of another record.
#[test]
fn a_record_that_the_steps_alias_is_bad() {
    let points: Vec<String> = (0..=2000)
        .map(|k| {
            let time = 5e-4 * f64::from(k);
            let value = (std::f64::consts::TAU * 98.0 * time).sin();
            format!("{{ time = {time:?}, acceleration = {value:?} }}")
        })
        .collect();
    let grade = |step: f64| {
        let (summary, _) = result(&format!(
            r#"
carom = 1
mass.p = {{ mass = 1.0, at = [0.0] }}
spring.k = {{ ends = ["p", "ground"], stiffness = 157.9 }}
signal.a.acceleration.points = [{}]
load.g.base-acceleration.x = "a"
time = {{ end = 0.5, step = {step:?}, scheme.newmark = {{}} }}
"#,
            points.join(", ")
        ));
        line(&summary, "sampling").unwrap().0
    };
    assert_eq!(grade(1e-2), Grade::Bad);
    assert_eq!(grade(1e-4), Grade::Good);
}

/// A rigid square falls on the ground at 1 m/s under the law in the rate, which takes all of it: Newmark's scheme takes the rate for that of a step
/// before, and the square leaves as fast as it came; the theta scheme with the law at the end of the step stays.
#[test]
fn a_rigid_body_that_rebounds_against_its_law_is_bad() {
    let square = |scheme: &str, law: &str| {
        format!(
            r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0105], size = [0.1, 0.1], elements = [2, 2] }}
material.m = {{ density = 1000.0, neo-hooke = {{ young = 1e7, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", rigid = {{}}, section.plane-strain.thickness = 1.0, initial.velocity = [0.0, -1.0] }}
contact.c = {{ secondary = "a.bottom", obstacle.plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}, law.{law} = {{}} }}
time = {{ end = 0.03, step = 1e-3, {scheme} }}
"#
        )
    };
    let (summary, _) = result(&square("scheme.newmark = {}", "velocity"));
    assert_eq!(line(&summary, "rebound"), Some((Grade::Bad, 1.0)));
    let (summary, _) = result(&square("scheme.theta = {}", "velocity"));
    assert_eq!(line(&summary, "rebound"), None);
    // the law in the gap says nothing of the velocity after an impact, and the verdict says that
    let (summary, _) = result(&square("scheme.newmark = {}", "displacement"));
    assert_eq!(line(&summary, "rebound"), None);
    let told = |why: &String| why.contains("contact `c` part, up to 1.00");
    assert!(
        summary.verdict.unchecked.iter().any(told),
        "{:?}",
        summary.verdict
    );
}
