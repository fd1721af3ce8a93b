//! Contacts that are judged together.

use carom_case::{Input, Problem, build, parse};

use crate::verdict::result;

/// Two bars, or two point masses, of which one comes.
fn case(bodies: &str, ends: [&str; 2], law: &str) -> String {
    let [one, other] = ends;
    format!(
        r#"
carom = 1
{bodies}
contact.c = {{ secondary = "{one}", primary = "{other}", law.{law} }}
level.l = {{ contacts = ["c"], allowable = {{ force = "1 MN", energy = "1 J" }} }}
time = {{ end = "20 us", step = "1 us", scheme.theta = {{}} }}
"#
    )
}

const BARS: &str = r#"
mesh.generate.a.line = { from = [-0.1], to = [0.0], elements = 4 }
mesh.generate.b.line = { from = [0.0], to = [0.1], elements = 4 }
material.m = { density = 7800.0, elastic = { young = "200 GPa", poisson = 0.0 } }
body.a = { region = "a", material = "m", section.bar.area = 1e-4, initial.velocity = [1.0] }
body.b = { region = "b", material = "m", section.bar.area = 1e-4 }
"#;

fn checked(text: &str) -> Result<Vec<String>, Vec<Problem>> {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input)?;
    build(&case, &locator, &input).map(|built| built.warnings)
}

#[test]
fn an_allowable_energy_of_a_contact_that_takes_none_is_refused() {
    let ends = ["a.right", "b.left"];
    for law in [
        "velocity = {}",
        "displacement = {}",
        "restitution.coefficient = 1.0",
    ] {
        let problems = checked(&case(BARS, ends, law)).unwrap_err();
        assert_eq!(problems[0].path, "level.l.allowable.energy", "{law}");
        assert!(problems[0].message.contains("takes up no energy"), "{law}");
        // a force alone is judged
        let force = case(BARS, ends, law).replace(r#", energy = "1 J""#, "");
        assert!(checked(&force).is_ok(), "{law}");
    }
    let (summary, _) = result(&case(BARS, ends, "penalty.stiffness = 1e15"));
    let margin = summary.levels["l"].energy_margin.as_ref().unwrap();
    assert!(margin.found > 0.0 && margin.margin.is_some(), "{margin:?}");
}

/// Of masses the velocity law makes an impact without restitution, whose loss is half the energy of equal ones; a stop under it has no margin.
#[test]
fn bodies_that_cannot_deform_lose_their_energy_to_the_law() {
    let masses = r#"
mass.a = { mass = 1.0, at = [0.0], initial.velocity = [1.0] }
mass.b = { mass = 1.0, at = [0.001] }
"#;
    let stop = format!(
        r#"
carom = 1
{masses}
stop.c = {{ ends = ["a", "b"], axis = [1.0], gap = 1e-5, law.LAW }}
level.l = {{ contacts = ["c"], allowable.energy = "1 J" }}
time = {{ end = "20 us", step = "1 us", scheme.theta = {{}} }}
"#
    );
    let (summary, _) = result(&stop.replace("LAW", "velocity = {}"));
    let margin = summary.levels["l"].energy_margin.as_ref().unwrap();
    // 1/4 J of 1/2 J
    assert!((margin.found - 0.25).abs() < 1e-12, "{margin:?}");
    let warnings = checked(&stop.replace("LAW", "restitution.coefficient = 1.0")).unwrap();
    let told = |warning: &String| warning.contains("stop `c` takes up no energy");
    assert!(warnings.iter().any(told), "{warnings:?}");
}
