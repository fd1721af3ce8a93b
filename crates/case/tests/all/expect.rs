//! What a case must give.

use std::fmt::Write as _;
use std::fs;

use carom_case::{Input, Problem, build, parse, run};
use carom_dynamics::Silent;
use carom_output::expectations::Expectations;
use carom_output::{Grade, Summary};
use serde_json::Value;

/// Two bars with a probe, a level and an exact solution.
const BARS: &str = r#"
carom = 1
mesh.generate.one.line = { from = ["-254 mm"], to = [0.0], elements = 20 }
mesh.generate.two.line = { from = [0.0], to = ["254 mm"], elements = 20 }
material.steel = { density = 7844.0, elastic = { young = "207 GPa", poisson = 0.0 } }
body.one = { region = "one", material = "steel", section.bar.area = "645 mm^2", initial.velocity = [5.1359] }
body.two = { region = "two", material = "steel", section.bar.area = "645 mm^2" }
contact.shock = { secondary = "one.right", primary = "two.left", law.velocity = {} }
level.all = { contacts = ["shock"], allowable = { force = "1 MN" } }
probe.end = { on = "two.right", record = ["displacement", "velocity"] }
time = { end = "150 us", step.courant = 0.5, scheme.theta = {} }
reference.two-bars = {}
"#;

/// A point mass on a spring that meets a stop.
const MASS: &str = r#"
carom = 1
mass.block = { mass = "100 kg", at = [0.0], initial.velocity = [1.0] }
spring.hanger = { ends = ["block", "ground"], axis = [1.0], stiffness = "10 kN/m" }
stop.bumper = { ends = ["block", "ground"], axis = [1.0], gap = 0.0, stiffness = "1 MN/m" }
time = { end = "40 ms", step = "0.05 ms", scheme.newmark = {} }
"#;

/// A block that slides on a rough plane at finite strain.
const BLOCK: &str = r#"
carom = 1
mesh.generate.block.rectangle = { origin = [0.0, 0.0], size = [1.0, 0.5], elements = [2, 1] }
material.rubber = { density = 1000.0, neo-hooke = { young = "1 MPa", poisson = 0.3 } }
body.block = { region = "block", material = "rubber", section.plane-strain.thickness = 1.0, initial.velocity = [0.1, -0.1] }
load.weight = { acceleration = [0.0, -9.81] }
contact.floor = { secondary = "block.bottom", obstacle.plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, law.velocity = {}, friction.coulomb = 0.3, sliding = "finite", moment-about = [0.0, 0.0] }
time = { end = "20 ms", step = "1 ms", scheme.theta = {} }
"#;

/// The summary of a run, and what its file says.
fn summary(text: &str, overrides: &[&str]) -> Result<(Summary, Value), Vec<Problem>> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let input = Input::from_text("case.toml", text, &overrides);
    let (case, locator) = parse(&input)?;
    let built = build(&case, &locator, &input)?;
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("case.carom");
    let given = (&input, &case, &built);
    let finished = run(given, results.clone(), &mut Silent, &|| false).unwrap();
    let file = fs::read(results.join("summary.json")).unwrap();
    Ok((finished.summary, serde_json::from_slice(&file).unwrap()))
}

fn row(name: &str, keys: &str) -> String {
    format!("expect.{name} = {{ {keys}, kind = \"closed-form\", source = \"a formula\" }}\n")
}

fn found(text: &str, overrides: &[&str]) -> (Expectations, Grade) {
    let (summary, _) = summary(text, overrides).unwrap();
    (summary.expectations.unwrap(), summary.verdict.grade)
}

/// The problems of a row of the bars.
fn problems(keys: &str) -> Vec<Problem> {
    summary(&(BARS.to_owned() + &row("one", keys)), &[]).unwrap_err()
}

#[test]
fn rows_that_are_met_leave_the_verdict_and_a_missed_one_makes_it_bad() {
    let met = row(
        "impulse",
        r#"summary = "contacts.shock.impulse", value = "6.6 N s", tolerance = 0.05"#,
    ) + &row(
        "end",
        r#"column = "probe.end.velocity_x_m_s", take = "largest", at-least = "5 m/s""#,
    ) + &row(
        "early",
        r#"column = "probe.end.displacement_x_m", take = { at = "10 us" }, value = 0.0, tolerance = "1 um""#,
    );
    let (judged, grade) = found(&(BARS.to_owned() + &met), &[]);
    assert_eq!((judged.missed, grade), (0, Grade::Good), "{judged:?}");
    assert!(judged.rows.values().all(|row| row.met == Some(true)));
    let missed = met.replace("6.6 N s", "7.6 N s");
    let text = BARS.to_owned() + &missed;
    let (summary, file) = summary(&text, &[]).unwrap();
    let judged = summary.expectations.as_ref().unwrap();
    assert_eq!(judged.missed, 1);
    assert_eq!(summary.verdict.grade, Grade::Bad);
    let line = summary.verdict.line("expectations").unwrap();
    assert!(line.sentence.contains("`impulse`"), "{}", line.sentence);
    let impulse = &file["expectations"]["rows"]["impulse"];
    assert_eq!(impulse["met"], Value::Bool(false));
    assert_eq!(impulse["found"], file["contacts"]["shock"]["impulse"]);
    let again = Summary::from_json(&file.to_string()).unwrap();
    assert_eq!(again.expectations, summary.expectations);
}

#[test]
fn rows_are_stated_for_the_file_as_it_is() {
    let wrong = row(
        "impulse",
        r#"summary = "contacts.shock.impulse", value = "7 N s", tolerance = 0.01"#,
    );
    let text = BARS.to_owned() + &wrong;
    let (judged, grade) = found(&text, &["time.step.courant=1"]);
    assert_eq!((judged.missed, grade), (0, Grade::Good));
    assert_eq!(judged.rows["impulse"].met, None);
    assert!(judged.rows["impulse"].found.is_some());
    let why = judged.unjudged.unwrap();
    assert!(why.contains("--set time.step.courant=1"), "{why}");
    // a number that the changed model has not is left out
    let moved = row("error", r#"summary = "exact.force_error", at-most = 0.2"#);
    let without = (text.clone() + &moved).replace("reference.two-bars = {}", "");
    assert!(summary(&without, &[]).is_err());
    let (judged, _) = found(&without, &["time.step.courant=1"]);
    assert_eq!(judged.rows.keys().collect::<Vec<_>>(), ["impulse"]);
    // these do not change the model
    let harmless = [
        "title=\"bars\"",
        "expect.impulse.tolerance=0.1",
        "output.checkpoint.keep=2",
    ];
    assert_eq!(found(&text, &harmless).0.rows["impulse"].met, Some(true));
    assert_eq!(found(&text, &harmless[..1]).0.missed, 1);
}

#[test]
fn what_is_no_number_of_a_run_is_refused_with_what_is_accepted_and_the_nearest() {
    let one = |keys: &str| {
        let mut all = problems(keys);
        assert_eq!(all.len(), 1, "{all:?}");
        all.remove(0)
    };
    let unknown = one(r#"summary = "contacts.shock.impulze", value = 1.0, tolerance = 0.1"#);
    assert_eq!(unknown.path, "expect.one.summary");
    assert_eq!(unknown.nearest.as_deref(), Some("contacts.shock.impulse"));
    assert!(
        unknown
            .accepted
            .contains(&"contacts.shock.peak_force".to_owned())
    );
    assert!(
        unknown
            .accepted
            .iter()
            .all(|name| name.starts_with("contacts.shock."))
    );
    let table = one(r#"summary = "contact.shock.impulse", value = 1.0, tolerance = 0.1"#);
    assert!(table.accepted.contains(&"contacts".to_owned()), "{table:?}");
    let column = one(r#"column = "probe.end.velocity_y_m_s", take = "last", at-most = 1.0"#);
    assert_eq!(column.nearest.as_deref(), Some("probe.end.velocity_x_m_s"));
    for (keys, path, message) in [
        (
            r#"summary = "contacts.shock.impulse", value = "6.6 m", tolerance = 0.1"#,
            "expect.one.value",
            "a length instead of an impulse",
        ),
        (
            r#"summary = "exact.force_error", at-most = "5 m""#,
            "expect.one.at-most",
            "a length instead of a number",
        ),
        (
            r#"summary = "contacts.shock.impulse", value = 6.6, tolerance = "1 N""#,
            "expect.one.tolerance",
            "a force instead of an impulse",
        ),
        (
            r#"summary = "contacts.shock.impulse", value = 6.6, tolerance = -0.1"#,
            "expect.one.tolerance",
            "a tolerance is not negative",
        ),
        (
            r#"summary = "contacts.shock.impulse", value = 0.0, tolerance = 0.1"#,
            "expect.one.tolerance",
            "a bare number is a part of the value, and zero has no parts",
        ),
        (
            r#"summary = "contacts.shock.impulse", value = 6.6, tolerance = 0.1, at-most = 7.0"#,
            "expect.one.at-most",
            "a row has a value or bounds, not both",
        ),
        (
            r#"summary = "contacts.shock.impulse", at-least = 7.0, at-most = 6.0"#,
            "expect.one.at-least",
            "above `at-most`",
        ),
        (
            r#"column = "probe.end.velocity_x_m_s", take = { at = "1 s" }, at-most = 6.0"#,
            "expect.one.take.at",
            "after the end of the run",
        ),
    ] {
        let problem = one(keys);
        assert_eq!(
            (problem.path.as_str(), problem.message.as_str()),
            (path, message)
        );
    }
    let regression = BARS.to_owned()
        + "expect.one = { summary = \"time.steps\", at-most = 1e6, kind = \"regression\", source = \"a run\" }";
    let problem = summary(&regression, &[]).unwrap_err().remove(0);
    assert_eq!(problem.path, "expect.one.kind");
}

/// Tables of the summary that are no results of a case, or that repeat others.
const LEFT_OUT: [&str; 26] = [
    "about",
    "allowable",
    "bodies",
    // a run that goes on has others
    "counts",
    "factorisations_per_step",
    "damped_modes",
    "dimension",
    "elements",
    "energy_classes",
    "expectations",
    "force_classes",
    "governing",
    "identity",
    "instants",
    "mass",
    "place",
    "reduced",
    "stress_every",
    "timings",
    "unchecked",
    "verdict",
    "von_mises_of_bodies",
    "warnings",
    "worst",
    "links",
    "zones",
];

/// Adds the paths of all numbers below a value.
fn numbers(path: &str, value: &Value, all: &mut Vec<String>) {
    let join = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match value {
        Value::Number(_) => all.push(path.to_owned()),
        Value::Object(table) => {
            for (key, value) in table
                .iter()
                .filter(|(key, _)| !LEFT_OUT.contains(&key.as_str()))
            {
                numbers(&join(key), value, all);
            }
        }
        Value::Array(values) => {
            for (k, value) in values.iter().enumerate() {
                numbers(&join(&k.to_string()), value, all);
            }
        }
        _ => {}
    }
}

#[test]
fn every_number_of_a_summary_can_be_expected() {
    for case in [BARS, MASS, BLOCK] {
        let (_, file) = summary(case, &[]).unwrap();
        let mut all = Vec::new();
        numbers("", &file, &mut all);
        assert!(all.len() > 50, "{all:?}");
        let mut text = case.to_owned();
        for (k, name) in all.iter().enumerate() {
            let keys = format!("summary = \"{name}\", at-least = -1e300, at-most = 1e300");
            let _ = write!(text, "{}", row(&format!("row-{k}"), &keys));
        }
        let (judged, _) = match summary(&text, &[]) {
            Ok((summary, _)) => (summary.expectations.unwrap(), ()),
            Err(problems) => {
                let names: Vec<_> = problems.iter().filter_map(|p| p.found.as_ref()).collect();
                panic!("{names:?}");
            }
        };
        let missed: Vec<_> = judged
            .rows
            .values()
            .filter(|row| row.met != Some(true))
            .collect();
        assert!(missed.is_empty(), "{missed:?}");
    }
}

#[test]
fn every_column_of_the_histories_can_be_expected() {
    for case in [BARS, MASS, BLOCK] {
        let input = Input::from_text("case.toml", case, &[]);
        let (parsed, locator) = parse(&input).unwrap();
        let built = build(&parsed, &locator, &input).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let results = folder.path().join("case.carom");
        run(
            (&input, &parsed, &built),
            results.clone(),
            &mut Silent,
            &|| false,
        )
        .unwrap();
        let table = fs::read_to_string(results.join("histories.csv")).unwrap();
        let mut text = case.to_owned();
        for (k, name) in table.lines().next().unwrap().split(',').enumerate() {
            let keys = format!("column = \"{name}\", take = \"last\", at-most = 1e300");
            let _ = write!(text, "{}", row(&format!("row-{k}"), &keys));
        }
        let (judged, _) = found(&text, &[]);
        assert_eq!(judged.missed, 0, "{judged:?}");
    }
}
