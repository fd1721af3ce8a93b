//! The general contact: all outer sides, by pairs of bodies and materials.

use std::fmt::Write;
use std::sync::Arc;

use carom_case::{Input, build, parse};

use crate::verdict::{result, result_of};

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
    // the sides that meet are the same faces, and the others are never near; but the general contact looks both ways: at the corners of the offset
    // blocks the node of the other side is a point too, one of nine along a side of nine nodes
    for (one, other) in force.iter().zip(of_all) {
        assert!((one - other).abs() < 0.12 * largest, "{one} {other}");
    }
    let [one, other] = [&one.contacts["c"], &other.contacts["all-a-b"]];
    // equal blocks, of which one was at rest: the momentum passed over is that of the mean motion in both
    assert!((one.impulse.unwrap() / other.impulse.unwrap() - 1.0).abs() < 0.02);
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

/// Columns of a history, one after the other: the forces of both runs over the largest of the first.
fn most_apart(one: &[f64], other: &[f64]) -> (f64, f64) {
    let largest = one.iter().fold(0.0_f64, |m, f| m.max(*f));
    let pairs = one.iter().zip(other);
    let apart = pairs.map(|(one, other)| (one - other).abs());
    (apart.fold(0.0, f64::max) / largest, largest)
}

#[test]
fn two_blocks_meet_in_the_contact_of_their_material() {
    let by = |by: &str| {
        let contact = format!(r#"general-contact = {{ law.velocity = {{}}, by = "{by}" }}"#);
        result(&meeting(&contact))
    };
    let [(one, pair), (other, whole)] = ["bodies", "materials"].map(by);
    assert_eq!(other.contacts.keys().collect::<Vec<_>>(), ["all-m"]);
    let (apart, largest) = most_apart(
        &pair["contact.all_a_b.force_n"],
        &whole["contact.all_m.force_n"],
    );
    assert!(largest > 0.0);
    // both look both ways, and the blocks do not touch themselves: the same equations up to the order of points
    assert!(apart < 1e-9, "{apart}");
    let [one, other] = [&one.contacts["all-a-b"], &other.contacts["all-m"]];
    assert!((one.impulse.unwrap() / other.impulse.unwrap() - 1.0).abs() < 1e-9);
}

/// A row of `count` blocks that lie beside each other a little apart, the first one moving.
fn row(count: usize, general: &str) -> String {
    let mut text = format!(
        "carom = 1\nmaterial.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.3 }} }}\n{general}\n"
    );
    for k in 0..count {
        let x = 0.1001 * k as f64;
        writeln!(
            text,
            r#"mesh.generate.b{k}.rectangle = {{ origin = [{x}, 0.0], size = [0.1, 0.1], elements = [4, 4] }}
body.b{k} = {{ region = "b{k}", material = "m", section.plane-strain.thickness = 0.5, initial.velocity = [{}, 0.0] }}"#,
            if k == 0 { 1.0 } else { 0.0 }
        )
        .unwrap();
    }
    text + "time = { end = 4e-3, step = 2e-5, scheme.theta = {} }\n"
}

fn points(text: &str) -> usize {
    let input = Input::from_text("case.toml", text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let built = build(&case, &locator, &input).unwrap();
    built.system.points()
}

#[test]
fn contacts_of_materials_grow_with_the_faces_and_those_of_bodies_with_the_pairs() {
    let general = |by: &str| format!(r#"general-contact = {{ law.velocity = {{}}, by = "{by}" }}"#);
    let [whole, pairs] = ["materials", "bodies"].map(general);
    // 16 nodes around each block, each a point of the one contact; of pairs 16 on each side
    assert_eq!(points(&row(12, &whole)), 12 * 16);
    assert_eq!(points(&row(12, &pairs)), 2 * 16 * (12 * 11 / 2));
}

#[test]
fn a_row_of_blocks_passes_its_momentum_on_in_one_contact() {
    let general = r#"general-contact = { law.velocity = {}, by = "materials" }"#;
    let (summary, histories) = result(&row(4, general));
    // what bodies of one contact do to each other cancels in the whole: to rounding
    assert!(summary.momentum.relative_residual < 1e-9);
    // the momentum passes three gaps in turn; an elastic block that stops after its impact has given it all, one with restitution below one
    // three quarters at least, and no impact gives more than twice what there is
    let momentum = 1000.0 * 0.1 * 0.1 * 0.5;
    let carried: f64 = histories["contact.all_m.force_n"].iter().sum::<f64>() * 2e-5;
    assert!(
        carried > 0.75 * 3.0 * momentum && carried < 2.0 * 3.0 * momentum,
        "{carried}"
    );
}

#[test]
fn a_pair_that_a_contact_joins_is_no_part_of_the_contact_of_its_material() {
    let named = r#"contact.mine = { secondary = "b0.right", primary = "b1.left", law.velocity = {}, sliding = "finite" }"#;
    let general = r#"general-contact = { law.velocity = {}, by = "materials" }"#;
    let alone = result(&row(2, named)).1;
    let both = result(&row(2, &format!("{named}\n{general}")));
    let (apart, largest) = most_apart(
        &alone["contact.mine.force_n"],
        &both.1["contact.mine.force_n"],
    );
    assert!(largest > 0.0);
    // the same equations: the other contact has points, and none of them sees anything
    assert!(apart < 1e-9, "{apart}");
    assert_eq!(both.0.contacts["all-m"].peak_force, 0.0);
}

/// A block that falls on a row of two that are tied to each other; `general`: what lets them touch.
fn tied(general: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.0, 0.0], size = [0.1, 0.1], elements = [4, 4] }}
mesh.generate.b.rectangle = {{ origin = [0.1, 0.0], size = [0.1, 0.1], elements = [5, 5] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 0.5, initial.velocity = [1.0, 0.0] }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 0.5 }}
transition.glue.surfaces = ["a.right", "b.left"]
{general}
time = {{ end = 1e-3, step = 2e-5, scheme.theta = {{}} }}
"#
    )
}

#[test]
fn tied_bodies_have_no_contact_with_each_other() {
    let (summary, _) = result(&tied("general-contact.law.velocity = {}"));
    assert!(summary.contacts.is_empty());
    let (summary, _) = result(&tied(
        r#"general-contact = { law.velocity = {}, by = "materials" }"#,
    ));
    assert_eq!(summary.contacts["all-m"].peak_force, 0.0);
}

/// Two zones of which each has a block, under the schemes `one` and `other`.
fn zoned(contact: &str, [one, other]: [&str; 2]) -> String {
    let zones = format!(
        "zone.left = {{ bodies = [\"a\"], scheme.{one} = {{}} }}\nzone.right = {{ bodies = [\"b\"], scheme.{other} = {{}} }}"
    );
    meeting(&format!("{contact}\n{zones}"))
}

#[test]
fn bodies_of_two_zones_meet_where_their_schemes_permit() {
    let named = r#"contact.c = { secondary = "a.right", primary = "b.left", sliding = "finite", law.velocity = {}, depth = 0.025 }"#;
    let schemes = ["theta", "theta"];
    let (_, one) = result(&zoned(named, schemes));
    for (by, name) in [("bodies", "all_a_b"), ("materials", "all_m_m_2")] {
        let general = format!(r#"general-contact = {{ law.velocity = {{}}, by = "{by}" }}"#);
        let (_, all) = result(&zoned(&general, schemes));
        let (apart, largest) = most_apart(
            &one["contact.c.force_n"],
            &all[&format!("contact.{name}.force_n")],
        );
        assert!(largest > 0.0);
        assert!(apart < 1e-9, "{by}: {apart}");
    }
}

#[test]
fn zones_whose_schemes_cannot_meet_are_told_by_the_contact() {
    let general = "general-contact.law.displacement = {}";
    // no force of an explicit step changes the gap at its end
    let text = zoned(general, ["newmark", "central-difference"]);
    let input = Input::from_text("case.toml", &text, &[]);
    let (case, locator) = parse(&input).unwrap();
    let problems = build(&case, &locator, &input).err().unwrap();
    let told = problems[0].to_string();
    assert!(
        told.contains("general-contact") || told.contains("all-a-b"),
        "{told}"
    );
}

/// A wide, coarse block that falls on a narrow, fine one; `upper`: what it is, `contact`: what lets them touch.
fn falling(upper: &str, contact: &str) -> String {
    format!(
        r#"
carom = 1
mesh.generate.a.rectangle = {{ origin = [0.1, 0.0], size = [0.1, 0.1], elements = [8, 8] }}
mesh.generate.b.rectangle = {{ origin = [-0.1, 0.104], size = [0.6, 0.1], elements = [12, 2] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.3 }} }}
body.a = {{ region = "a", material = "m", section.plane-strain.thickness = 0.5 }}
body.b = {{ region = "b", material = "m", section.plane-strain.thickness = 0.5, {upper} }}
support.s = {{ on = "a.bottom", fix = ["x", "y"] }}
{contact}
time = {{ end = 2e-2, step = 5e-5, scheme.theta = {{}} }}
"#
    )
}

#[test]
fn nodes_that_others_carry_look_for_what_is_near_and_meet_the_same() {
    let rigid = "rigid = {}, initial = { velocity = [0.0, -1.0], spin = [3.0] }";
    let reduced = "reduction.modes = 4, initial.velocity = [0.0, -1.0]";
    for upper in [rigid, reduced] {
        let text = falling(upper, "general-contact.law.velocity = {}");
        let looking = |near_only: bool| {
            result_of(&text, "histories.csv", |built| {
                let system = Arc::get_mut(&mut built.system).unwrap();
                assert!(system.contacts[0].near_only);
                system.contacts[0].contact.near_only = near_only;
            })
        };
        let [(_, near), (_, all)] = [true, false].map(looking);
        let name = "contact.all_a_b.force_n";
        let (apart, largest) = most_apart(&all[name], &near[name]);
        assert!(largest > 0.0);
        // the same equations in the same order
        assert!(apart < 1e-12, "{upper}: {apart}");
    }
}
