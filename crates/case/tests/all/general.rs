//! The general contact: all outer sides, by pairs of bodies and materials.

use carom_case::{Input, build, parse};

use crate::verdict::result;

/// Two blocks that meet, the second one at rest; `contact`: what lets them.
fn meeting(contact: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [0.2, 0.1], elements = [8, 4] }}
mesh.generate.b.rectangle = {{ origin = [0.2001, 0.02], size = [0.2, 0.1], elements = [8, 4] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 0.5, initial.velocity = [1.0, 0.0] }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 0.5 }}
{contact}
time = {{ end = 8e-3, step = 2e-5, scheme.theta = {{}} }}
"#
    )
}

#[test]
fn two_blocks_meet_as_under_a_contact_of_their_sides() {
    let named = meeting(
        r#"contact.c = { secondary = "a.right", primary = "b.left", sliding = "finite", law.velocity = {}, depth = 0.025 }"#,
    );
    let general = meeting("general-contact.law.velocity = {}");
    let [(one, histories), (other, all)] = [named, general].map(|text| result(&text));
    assert_eq!(other.contacts.keys().collect::<Vec<_>>(), ["all-a-b"]);
    let [force, of_all] = [
        &histories["contact.c.force_n"],
        &all["contact.all_a_b.force_n"],
    ];
    let largest = force.iter().fold(0.0_f64, |m, f| m.max(*f));
    assert!(largest > 0.0);
    // the sides that meet are the same faces, and the others are never near: the same equations up to the order of points
    for (one, other) in force.iter().zip(of_all) {
        assert!((one - other).abs() < 1e-9 * largest, "{one} {other}");
    }
    let [one, other] = [&one.contacts["c"], &other.contacts["all-a-b"]];
    assert!((one.impulse.unwrap() / other.impulse.unwrap() - 1.0).abs() < 1e-9);
    assert_eq!(one.impacts, other.impacts);
}

/// Three bodies of two materials; `b` and `c` share nodes.
const STACK: &str = r#"
carom = 1
mesh.generate.a.rectangle = { origin = [0.0, 0.0], size = [0.4, 0.1], elements = [8, 2] }
mesh.generate.b.rectangle = { origin = [0.0, 0.101], size = [0.1, 0.1], elements = [4, 4] }
mesh.generate.c.rectangle = { origin = [0.2, 0.101], size = [0.1, 0.1], elements = [4, 4] }
material.m = { density = 1000.0, neo-hooke = { young = 1e7, poisson = 0.3 } }
material.k = { density = 1000.0, elastic = { young = 1e7, poisson = 0.3 } }
body.a = { region = "a", material = "m", section.plane-strain.thickness = 0.5 }
body.b = { region = "b", material = "k", section.plane-strain.thickness = 0.5 }
body.c = { region = "c", material = "m", section.plane-strain.thickness = 0.5 }
support.s = { on = "a.bottom", fix = ["x", "y"] }
load.weight.acceleration = [0.0, -10.0]
time = { end = 2e-4, step = 2e-5, scheme.theta = {} }
"#;

#[test]
fn pairs_of_materials_have_their_own_friction() {
    let general = r#"
general-contact = { law.velocity = {}, friction.coulomb = 0.1, pairs = [{ materials = ["k", "m"], friction.coulomb = 0.5 }] }
"#;
    let (summary, _) = result(&format!("{STACK}{general}"));
    let friction = |name: &str| summary.contacts[name].friction.unwrap().coefficient;
    // bodies at finite strain may fold, the one at small strain cannot
    let names: Vec<&String> = summary.contacts.keys().collect();
    assert_eq!(names, ["all-a", "all-a-b", "all-a-c", "all-b-c", "all-c"]);
    for (name, expected) in [
        ("all-a-b", 0.5),
        ("all-b-c", 0.5),
        ("all-a-c", 0.1),
        ("all-a", 0.1),
    ] {
        assert_eq!(friction(name), expected, "{name}");
    }
    // a contact by name takes the pair out
    let named = r#"contact.mine = { secondary = "b.bottom", primary = "a.top", law.velocity = {}, sliding = "finite" }"#;
    let (summary, _) = result(&format!("{STACK}{general}{named}"));
    assert!(summary.contacts.contains_key("mine"));
    assert!(!summary.contacts.contains_key("all-a-b"));
}

#[test]
fn materials_that_are_none_are_told() {
    let text = format!(
        "{STACK}{}",
        r#"general-contact = { law.velocity = {}, pairs = [{ materials = ["k", "rubber"], friction.coulomb = 0.5 }] }"#
    );
    let input = Input::from_text("case.toml", &text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let problems = build(&case, &locator, &input).err().unwrap();
    let told = problems[0].to_string();
    assert!(
        told.contains("general-contact.pairs[0].materials"),
        "{told}"
    );
    assert!(format!("{:?}", problems[0]).contains("rubber"));
}

/// A plate between a block that rises and a rod that falls; `contact`: what lets them.
fn thin(contact: &str) -> String {
    format!(
        r#"
carom = 1
mesh.dimension = 3
mesh.generate.plate.rectangle = {{ origin = [0.0, 0.0], size = [0.2, 0.2], elements = [8, 8] }}
mesh.generate.block.box = {{ origin = [0.04, 0.04, -0.1215], size = [0.12, 0.12, 0.12], elements = [2, 2, 2] }}
mesh.generate.rod.line = {{ from = [0.02, 0.1, 0.0065], to = [0.18, 0.1, 0.0065], elements = 9 }}
material.steel = {{ density = 7800.0, elastic = {{ young = "200 GPa", poisson = 0.3 }} }}
body.plate = {{ region = "plate", material = "steel", section.shell.thickness = "2 mm" }}
body.block = {{ region = "block", material = "steel", initial.velocity = [0.0, 0.0, 2.0] }}
body.rod = {{ region = "rod", material = "steel", section.beam.shape.circle.diameter = "10 mm", initial.velocity = [0.0, 0.0, -3.0] }}
{contact}
time = {{ end = "0.32 ms", step = "2 us", scheme.theta = {{}} }}
"#
    )
}

#[test]
fn shells_and_beams_meet_as_under_contacts_of_their_middles_and_axes() {
    let named = thin(
        r#"
contact.a = { secondary = "plate", primary = "block.top", law.velocity = {}, sliding = "finite" }
contact.b = { secondary = "rod", primary = "plate", law.velocity = {}, sliding = "finite" }
"#,
    );
    let general = thin("general-contact.law.velocity = {}");
    let [(one, named), (other, all)] = [named, general].map(|text| result(&text));
    let names: Vec<&String> = other.contacts.keys().collect();
    assert_eq!(names, ["all-block-plate", "all-block-rod", "all-plate-rod"]);
    for (contact, name) in [("a", "all_block_plate"), ("b", "all_plate_rod")] {
        let [force, of_all] = [
            &named[&format!("contact.{contact}.force_n")],
            &all[&format!("contact.{name}.force_n")],
        ];
        let largest = force.iter().fold(0.0_f64, |m, f| m.max(*f));
        assert!(largest > 0.0, "{name} touches");
        // the middle of the top and the axis are the same faces in both
        for (one, other) in force.iter().zip(of_all) {
            assert!(
                (one - other).abs() < 1e-9 * largest,
                "{name}: {one} {other}"
            );
        }
    }
    assert_eq!(other.contacts["all-block-rod"].peak_force, 0.0);
    assert_eq!(one.contacts["a"].law, other.contacts["all-block-plate"].law);
}
