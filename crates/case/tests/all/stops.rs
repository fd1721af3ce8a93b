//! Stops as case files give them.

use carom_case::{Input, Problem, build, parse};

use crate::verdict::result;

const SHORT: &str = r#"end = "2 ms", scheme.theta.theta = 0.6"#;
const LONG: &str = r#"end = "20 ms", scheme.newmark = {}"#;

/// A mass of 1 kg that can move along x, and its stop.
fn case(velocity: f64, stop: &str, time: &str) -> String {
    format!(
        r#"
carom = 1
mass.m = {{ mass = 1.0, at = [0.0], initial.velocity = [{velocity:?}] }}
stop.s = {{ ends = ["m", "ground"], axis = [1.0], {stop} }}
probe.m = {{ on = "m", record = ["velocity"] }}
time = {{ step = "10 us", {time} }}
"#
    )
}

fn checked(text: &str) -> Result<Vec<String>, Vec<Problem>> {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input)?;
    build(&case, &locator, &input).map(|built| built.warnings)
}

fn refused(text: &str) -> String {
    let problems = checked(text).unwrap_err();
    let told = problems.iter().map(|problem| {
        let path = &problem.path;
        format!("{path}: {}", problem.message)
    });
    told.collect::<Vec<_>>().join("; ")
}

#[test]
fn a_stop_with_a_law_needs_no_spring() {
    let (summary, histories) = result(&case(1.0, "gap = 0.001, law.velocity = {}", SHORT));
    // an exact stop without restitution takes the momentum
    assert!((summary.contacts["s"].impulse.unwrap() - 1.0).abs() < 1e-12);
    let speed = histories["probe.m.velocity_x_m_s"].last().unwrap();
    assert!(speed.abs() < 1e-12, "{speed}");
    let told = refused(&case(1.0, "gap = 0.001", SHORT));
    assert_eq!(
        told,
        "stop.s: one of `stiffness`, `curve` and `law` is missing in `stop.s`"
    );
}

#[test]
fn a_stop_of_negative_gap_is_compressed_at_the_start_and_pushes() {
    let spring = "gap = -0.001, stiffness = 1e4";
    let warnings = checked(&case(0.0, spring, LONG)).unwrap();
    let told = warnings.iter().any(|told| {
        told.contains("stop `s`: its gap is negative") && told.contains("by 1.0000e-3 m")
    });
    assert!(told, "{warnings:?}");
    // k g²/2 becomes m v²/2 within a quarter of the period of 63 ms; the last step of the stop, a 1500th of that, is not cut
    let (_, histories) = result(&case(0.0, spring, LONG));
    let speed = histories["probe.m.velocity_x_m_s"].last().unwrap();
    assert!((speed / -0.1 - 1.0).abs() < 1e-5, "{speed}");
    // an exact law has no force for a gap that is not there
    let told = refused(&case(0.0, "gap = -0.001, law.velocity = {}", LONG));
    assert_eq!(
        told,
        "stop.s.gap: a stop that is compressed at the start needs a law that gives it a force"
    );
}

/// A bar that yields: 1 MN/m up to 100 N, which then stay. Of the energy of 0.5 J the 5 mJ of the spring come back.
#[test]
fn a_plateau_takes_the_energy_of_an_impact_and_gives_that_of_its_spring_back() {
    let curve = "[{ penetration = 1e-4, force = 100.0 }, { penetration = 2e-2, force = 100.0 }]";
    let stop = format!("gap = 0.001, curve = {curve}, crush = 'permanent'");
    let (summary, histories) = result(&case(1.0, &stop, LONG));
    // 5 mJ along the spring, and 0.495 J at 100 N; a step of a 300th of a quarter of the spring's period where it begins and ends
    let depth = summary.contacts["s"].max_penetration;
    assert!((depth / 5.05e-3 - 1.0).abs() < 1e-4, "{depth}");
    let speed = histories["probe.m.velocity_x_m_s"].last().unwrap();
    assert!((speed / -0.1 - 1.0).abs() < 1e-2, "{speed}");
    let force = summary.contacts["s"].peak_force;
    assert!((force / 100.0 - 1.0).abs() < 1e-12, "{force}");
}
