//! What a text may say, and that what it may not is told with its place, all at once.

use carom_case::schema::{GivenLaw, Scheme, Section, Step, StepRule, json_schema};
use carom_case::{Input, Locator, Problem, parse, reference_page, schema::Case};
use carom_materials::Law;

/// The case of the manual's first page.
const DOCUMENTED: &str = r#"
carom = 1
title = "Impact of two elastic bars"

[mesh]
file = "two-bars.msh"
unit = "mm"

[material.steel]
density = 7844.0
elastic = { young = "207 GPa", poisson = 0.0 }

[body.striker]
region = "bar1"
material = "steel"
section.bar = { area = "645 mm^2" }
mass = "lumped"
initial = { velocity = [5.1359, 0.0, 0.0] }

[body.target]
region = "bar2"
material = "steel"
section.bar = { area = "645 mm^2" }

[contact.shock]
secondary = "bar1.right"
primary = "bar2.left"
law.velocity = { capture = "half" }
integration = "node"

[time]
end = 3.0e-4
step = { courant = 0.5 }
scheme.theta = { theta = 0.5 }

[probe.A]
on = "bar1.right"
record = ["displacement", "velocity", "acceleration"]

[output]
fields = { every = "10 us", record = ["displacement", "velocity", "stress"] }

[reference.two-bars]
"#;

fn read(text: &str, overrides: &[&str]) -> Result<(Case, Locator), Vec<Problem>> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    parse(&Input::from_text("case.toml", text, &overrides))
}

/// The documented case with `old` replaced by `new`, which must be there.
fn changed(old: &str, new: &str) -> String {
    assert!(DOCUMENTED.contains(old), "{old}");
    DOCUMENTED.replacen(old, new, 1)
}

/// The problems of a text, each as `line:column path: message`.
fn told(text: &str) -> Vec<String> {
    let place = |at: usize| {
        let line = text[..at].matches('\n').count() + 1;
        let column = text[..at].chars().rev().take_while(|&c| c != '\n').count() + 1;
        format!("{line}:{column}")
    };
    let problems = read(text, &[]).expect_err("a wrong case");
    problems
        .iter()
        .map(|problem| format!("{} {problem}", place(problem.place.expect("a place").start)))
        .collect()
}

#[test]
fn the_documented_case_is_read_in_si_units() {
    let (case, locator) = read(DOCUMENTED, &[]).unwrap();
    let steel = case.material.get("steel").unwrap();
    let Law::Elastic(elastic) = steel.0 else {
        panic!("{steel:?}");
    };
    assert_eq!((elastic.density, elastic.young), (7844.0, 2.07e11));
    let striker = case.body.get("striker").unwrap();
    assert!(matches!(&striker.section, Some(Section::Bar(bar)) if bar.area.0 == 6.45e-4));
    assert_eq!(
        striker
            .initial
            .as_ref()
            .unwrap()
            .velocity
            .as_ref()
            .unwrap()
            .si(),
        [5.1359, 0.0, 0.0]
    );
    assert_eq!(case.time.step(), Step::Rule(StepRule::Courant(0.5)));
    assert!(matches!(case.time.scheme(), Scheme::Theta(theta) if theta.theta == 0.5));
    assert!(locator.contains("body.striker.section.bar.area"));
    let place = locator.value("contact.shock.primary").unwrap();
    assert_eq!(&DOCUMENTED[place.start..place.end], "\"bar2.left\"");
    let place = locator.key("contact.shock.primary").unwrap();
    assert_eq!(&DOCUMENTED[place.start..place.end], "primary");
    let place = locator.value("contact.shock.law.velocity.sign").unwrap();
    assert_eq!(&DOCUMENTED[place.start..place.end], "velocity");
}

#[test]
fn a_case_written_back_as_json_is_the_same_case() {
    let (case, _) = read(DOCUMENTED, &[]).unwrap();
    let json = serde_json::to_value(&case).unwrap();
    assert_eq!(serde_json::from_value::<Case>(json).unwrap(), case);
}

#[test]
fn every_kind_of_step_is_read() {
    let step =
        |new: &str| read(&changed("{ courant = 0.5 }", new), &[]).map(|(case, _)| case.time.step());
    assert!(matches!(step("\"0.25 us\""), Ok(Step::Fixed(step)) if step.0 == 2.5e-7));
    assert!(matches!(step("2.5e-7"), Ok(Step::Fixed(step)) if step.0 == 2.5e-7));
    assert!(step("\"0.25 mm\"").is_err());
    assert!(step("true").is_err());
    assert!(step("{}").is_err());
    assert!(step("1").is_err(), "longer than the end");
}

#[test]
fn an_override_replaces_the_value_at_its_key_path() {
    let sets = [
        "time.scheme={newmark={beta=0.49,gamma=0.9}}",
        "body.striker.initial.velocity=[1]",
        "mesh.unit=cm",
        "title=two words",
    ];
    let (case, locator) = read(DOCUMENTED, &sets).unwrap();
    assert!(
        matches!(case.time.scheme(), Scheme::Newmark(newmark) if newmark.beta == 0.49 && newmark.gamma == 0.9)
    );
    assert_eq!(
        case.body
            .get("striker")
            .unwrap()
            .initial
            .as_ref()
            .unwrap()
            .velocity
            .as_ref()
            .unwrap()
            .given(),
        1
    );
    assert_eq!(
        (case.mesh.unit.0.as_str(), case.title.as_deref()),
        ("cm", Some("two words"))
    );
    let place = locator.value("mesh.unit").unwrap();
    assert_eq!((place.source, &sets[2][place.start..place.end]), (3, "cm"));
}

#[test]
fn a_wrong_override_is_told_at_its_place() {
    for (set, start, message) in [
        ("time.ende=1", 5, "unknown key `ende` in `time`"),
        ("time.end=-1", 9, "out of range: it must be greater than 0"),
        ("time.end=\"3 mm\"", 9, "a length instead of a time"),
        ("time.end", 0, "an override has no `=`"),
        (
            "time end=3",
            0,
            "the left side of an override is not a key path",
        ),
        (
            "[time]\nend=3",
            0,
            "the left side of an override is not a key path",
        ),
        ("=3", 0, "the left side of an override is not a key path"),
        ("time.end.a=3", 9, "a value of the wrong kind"),
    ] {
        let problems = read(DOCUMENTED, &[set]).expect_err(set);
        let place = problems[0].place.unwrap();
        assert_eq!(
            (
                problems.len(),
                place.source,
                place.start,
                problems[0].message.as_str()
            ),
            (1, 1, start, message),
            "{set}"
        );
    }
}

#[test]
fn all_problems_are_told_at_once_in_the_order_of_the_file() {
    let text = "carom = 2\n[mesh]\nunit = \"kg\"\n[material.a]\ndensty = 1\nelastic = { young = -1, poisson = 0.5 }\n[body]\n\
                [time]\nend = nan\nstep = \"1\"\nscheme = { theta = {}, newmark = {} }\n[weather]\n";
    assert_eq!(
        told(text),
        [
            "1:9 carom: this value is not known",
            "2:2 mesh: one of `file`, `part` and `generate` is missing in `mesh`",
            "3:1 mesh.unit: `unit` without `file`, which it belongs to",
            "3:8 mesh.unit: a mass instead of a length",
            "5:1 material.a.densty: unknown key `densty` in `material.a`",
            "6:21 material.a.elastic.young: out of range: it must be greater than 0",
            "6:35 material.a.elastic.poisson: out of range: it must be above -1 and below 0.5",
            "7:2 body: empty: one is needed at least",
            "9:7 time.end: not a finite number",
            "10:8 time.step: a quantity in quotes needs its unit; a number without quotes is in SI units",
            "11:24 time.scheme.newmark: `newmark` beside `theta`: only one of them is allowed",
            "12:2 weather: unknown key `weather`",
        ]
    );
}

#[test]
fn the_nearest_name_is_offered_for_keys_choices_names_and_units() {
    for (old, new, nearest) in [
        ("secondary =", "secundary =", "secondary"),
        ("law.velocity", "law.velocty", "velocity"),
        ("\"half\"", "\"haf\"", "half"),
        ("\"stress\"", "\"strss\"", "stress"),
        ("207 GPa", "207 Gpa", "GPa"),
        ("reference.two-bars", "reference.two-bar", "two-bars"),
        ("[contact.shock]", "[contacts.shock]", "contact"),
    ] {
        let problems = read(&changed(old, new), &[]).expect_err(new);
        assert_eq!(problems.len(), 1, "{new}: {problems:?}");
        assert_eq!(problems[0].nearest.as_deref(), Some(nearest), "{new}");
    }
}

#[test]
fn keys_that_exclude_or_need_each_other_are_told() {
    for (old, new, message) in [
        (
            "primary = \"bar2.left\"",
            "",
            "one of `primary`, `obstacle` and `self` is missing in `contact.shock`",
        ),
        (
            "primary = \"bar2.left\"",
            "primary = \"b\"\nobstacle.plane = { point = [0], normal = [1] }",
            "`primary` and `obstacle` exclude each other",
        ),
        (
            "law.velocity = { capture = \"half\" }",
            "law.damped = { damping = 1, damping-factor = 0.5 }",
            "`damping` and `damping-factor` exclude each other",
        ),
        (
            "primary = \"bar2.left\"",
            "primary = \"bar1.right\"",
            "a surface cannot be its own partner in contact",
        ),
    ] {
        let problems = read(&changed(old, new), &[]).expect_err(new);
        assert_eq!(
            (problems.len(), problems[0].message.as_str()),
            (1, message),
            "{problems:?}"
        );
    }
}

#[test]
fn syntax_errors_of_toml_are_told_together() {
    let problems =
        read("carom = \n[mesh\nfile = \"a\"\na = 1\na = 2\n", &[]).expect_err("not TOML");
    assert!(problems.len() >= 2, "{problems:?}");
    assert!(problems.iter().all(|problem| problem.place.is_some()));
}

#[test]
fn no_prefix_of_a_case_and_no_flipped_byte_panics() {
    for end in (0..DOCUMENTED.len()).filter(|&end| DOCUMENTED.is_char_boundary(end)) {
        let _ = read(&DOCUMENTED[..end], &[]);
        for other in ["\"", "[", "=", "µ", "\0", "9"] {
            let _ = read(
                &format!("{}{other}{}", &DOCUMENTED[..end], &DOCUMENTED[end + 1..]),
                &[],
            );
        }
    }
}

#[test]
fn the_schema_uses_only_keywords_that_the_check_understands() {
    const KNOWN: &[&str] = &[
        "$defs",
        "$ref",
        "$schema",
        "additionalProperties",
        "anyOf",
        "const",
        "default",
        "dependentRequired",
        "description",
        "enum",
        "exclusiveMaximum",
        "exclusiveMinimum",
        "format",
        "items",
        "maxItems",
        "maximum",
        "minItems",
        "minProperties",
        "minimum",
        "not",
        "oneOf",
        "properties",
        "propertyNames",
        "required",
        "title",
        "type",
        "uniqueItems",
        "x-any-dimension",
        "x-dimension",
        "x-example",
        "x-length-unit",
        "x-unit",
    ];
    fn check(schema: &serde_json::Value) {
        for (keyword, value) in schema.as_object().into_iter().flatten() {
            assert!(KNOWN.contains(&keyword.as_str()), "{keyword}");
            match keyword.as_str() {
                "$defs" | "properties" => value.as_object().unwrap().values().for_each(check),
                "items" | "additionalProperties" | "not" => check(value),
                "oneOf" | "anyOf" => value.as_array().unwrap().iter().for_each(check),
                _ => {}
            }
        }
    }
    check(&json_schema());
}

#[test]
fn every_key_of_the_schema_is_described_and_stands_in_the_manual() {
    let page = reference_page();
    fn check(schema: &serde_json::Value, page: &str) {
        for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
            assert!(page.contains(key), "{key}");
            let described = inner
                .get("description")
                .or(schema.get("description"))
                .is_some();
            assert!(described, "{key} has no description");
        }
    }
    let schema = json_schema();
    check(&schema, &page);
    schema["$defs"]
        .as_object()
        .unwrap()
        .values()
        .for_each(|table| check(table, &page));
}

#[test]
fn the_manual_holds_the_page_that_the_schema_gives() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/reference.md");
    let page = std::fs::read_to_string(path).unwrap();
    assert!(
        page == reference_page(),
        "docs/src/reference.md is out of date: carom schema --reference > docs/src/reference.md"
    );
}

#[test]
fn the_law_is_a_choice_of_keys() {
    let law = |new: &str| {
        read(&changed("law.velocity = { capture = \"half\" }", new), &[])
            .map(|(case, _)| case.contact.get("shock").unwrap().law.clone())
    };
    assert!(matches!(
        law("law.displacement = {}"),
        Ok(GivenLaw::Displacement(_))
    ));
    assert!(
        matches!(law("law.damped = { stiffness = \"1 GPa/mm\" }"), Ok(GivenLaw::Damped(law)) if law.stiffness.unwrap().0 == 1e12)
    );
    assert!(
        matches!(law("law.velocity = {}"), Ok(GivenLaw::Velocity(law)) if law.capture.is_none())
    );
    assert!(law("law = \"velocity\"").is_err());
    assert!(law("law = {}").is_err());
}
