//! A body that touches nothing, far from all others, changes neither the forces nor the grades of the cases of the project.
//!
//! Twenty steps of each at its smallest. The body is elastic, flies, and steps as all do. What is solved at once differs by the rounding of the
//! order of sums, what is iterated by the tolerance of the iterations: 1e-6 of the largest force of the case covers both, twenty steps of 1e-10
//! times the condition of the equations of a contact, a thousand.

use std::collections::BTreeMap;

use carom_case::{Built, Input, build, parse};
use carom_mesh::Mesh;
use carom_output::{Grade, Summary};

use crate::compare::Nobody;
use crate::resume::{after, cases, words};
use crate::resume_cases::{PLANE, SOLID, STATIC, Small, THIN};
use crate::verdict::result;

/// Steps of each run.
const STEPS: u64 = 20;

/// What is compared of it.
const BOUND: f64 = 1e-6;

/// The keys that add the body to a case in a mesh of this size; none where each body has to be in a zone, or where each has to be of a kind.
fn far(text: &str, mesh: &Mesh) -> Option<Vec<String>> {
    // an exact solution is of its bodies alone
    if text.contains("[zone") || text.contains("zone.") || text.contains("[reference") {
        return None;
    }
    let size = mesh.size();
    let corner = |i: usize| mesh.nodes.iter().map(|x| x[i]).fold(f64::MIN, f64::max);
    let at = [0, 1, 2].map(|i| corner(i) + 10.0 * size);
    let (shape, section) = match mesh.dim {
        1 => return None,
        2 if text.contains("section.axisymmetric") => {
            ("rectangle", Some("section.axisymmetric={}"))
        }
        2 => (
            "rectangle",
            Some("section.plane-strain.thickness=\"10 mm\""),
        ),
        _ => ("box", None),
    };
    let vector = |values: &[f64]| format!("{:?}", &values[..mesh.dim]);
    let mut keys = vec![
        format!(
            "mesh.generate.zz.{shape}={{origin={},size={},elements={:?}}}",
            vector(&at),
            vector(&[size; 3]),
            &[1; 3][..mesh.dim]
        ),
        "material.zz={density=1000.0,elastic={young=1e9,poisson=0.3}}".to_owned(),
        "body.zz.region=\"zz\"".to_owned(),
        "body.zz.material=\"zz\"".to_owned(),
        format!("body.zz.initial.velocity={}", vector(&[3.0, 2.0, 1.0])),
    ];
    if text.contains("static") {
        keys.push("body.zz.hold=true".to_owned());
    }
    keys.extend(section.map(|section| format!("body.zz.{section}")));
    Some(keys)
}

/// A case and what it amounts to.
fn built(name: &str, overrides: &[String]) -> (Input, carom_case::schema::Case, Built) {
    let input = Input::read(&cases().join(name), overrides);
    let input = input.unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
    let (case, locator) = parse(&input).unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
    let built = build(&case, &locator, &input);
    let built = built.unwrap_or_else(|problems| panic!("{name}: {problems:?}"));
    (input, case, built)
}

fn summary((input, case, built): &(Input, carom_case::schema::Case, Built)) -> Summary {
    let folder = tempfile::tempdir().unwrap();
    let ended = carom_case::run(
        (input, case, built),
        folder.path().join("results"),
        &mut Nobody,
        &after(STEPS),
    );
    ended.unwrap().summary
}

fn grades(summary: &Summary) -> BTreeMap<&str, Grade> {
    let lines = summary.verdict.lines.iter();
    lines.map(|line| (line.name.as_str(), line.grade)).collect()
}

fn unchanged(list: &[Small]) {
    let mut broken = Vec::new();
    for &(name, overrides) in list {
        let mut overrides = words(overrides);
        let alone = built(name, &overrides);
        let text = std::fs::read_to_string(cases().join(name)).unwrap();
        let Some(body) = far(&text, &alone.2.system.mesh) else {
            continue;
        };
        overrides.extend(body);
        let [alone, beside] = [alone, built(name, &overrides)].map(|of| summary(&of));
        let peak = |of: &Summary, contact: &str| of.contacts[contact].peak_force;
        let largest = alone
            .contacts
            .keys()
            .map(|of| peak(&alone, of))
            .fold(0.0, f64::max);
        for contact in alone.contacts.keys() {
            let [one, other] = [&alone, &beside].map(|of| peak(of, contact));
            if (one - other).abs() > BOUND * largest {
                broken.push(format!("{name}: {contact}: {one:e} N, {other:e} N"));
            }
        }
        let [one, other] = [&alone, &beside].map(grades);
        for (line, grade) in one {
            if other.get(line) != Some(&grade) {
                broken.push(format!("{name}: {line}: {grade:?}, {:?}", other.get(line)));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn cases_of_thin_bodies_do_not_see_a_body_far_away() {
    unchanged(THIN);
}

#[test]
fn static_cases_do_not_see_a_body_far_away() {
    unchanged(STATIC);
}

#[test]
fn cases_of_plane_bodies_do_not_see_a_body_far_away() {
    unchanged(PLANE);
}

#[test]
fn cases_of_solids_do_not_see_a_body_far_away() {
    unchanged(SOLID);
}

/// A rubber block of 1 g strikes a plane, alone and beside a block of steel of 700 t that flies at 100 m/s: the tolerance of its forces is relative to
/// them, so that the iterations are the same, and forces differ by rounding, 1e-16 times a condition of some 1e6.
#[test]
fn the_forces_of_a_light_block_are_as_accurate_beside_a_heavy_one() {
    let light = r#"
carom = 1
mesh.generate.small.rectangle = { origin = [0.0, 0.0], size = [0.01, 0.01], elements = [6, 6] }
material.rubber = { density = 1000.0, neo-hooke = { young = "1 MPa", poisson = 0.4 } }
body.small = { region = "small", material = "rubber", section.plane-strain.thickness = 0.01, initial.velocity = [0.0, -10.0] }
contact.ground = { secondary = "small.bottom", obstacle.plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, law.velocity = {} }
time = { end = "1.5 ms", step = "10 us", scheme.theta.theta = 0.5 }
"#;
    let heavy = r#"
mesh.generate.big.rectangle = { origin = [100.0, 0.0], size = [3.0, 3.0], elements = [2, 2] }
material.steel = { density = 7800.0, neo-hooke = { young = "210 GPa", poisson = 0.3 } }
body.big = { region = "big", material = "steel", section.plane-strain.thickness = 10.0, initial.velocity = [100.0, 0.0] }
"#;
    let force = |text: &str| result(text).1["contact.ground.force_n"].clone();
    let [alone, beside] = [light.to_owned(), format!("{light}{heavy}")].map(|text| force(&text));
    let largest = alone.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1.0, "{largest} N");
    for (alone, beside) in alone.iter().zip(&beside) {
        assert!(
            (alone - beside).abs() <= 1e-10 * largest,
            "{alone} N, {beside} N"
        );
    }
}

/// A rigid body of 700 t at 30 m/s strikes the same block on a floor. Its momentum per step is 2e13 N, of which the tolerance of 1e-10 is a force as large as that
/// of the block: the block has its own. With the smallest tolerance the impulse is the same to 1e-10, with the default one to what that leaves of the forces of each step,
/// 1e-10, times the condition, a hundred; by the momentum it was off by 2.6e-7.
#[test]
fn a_light_block_is_as_accurate_under_a_heavy_body_as_its_own_forces_ask() {
    let case = |tolerance: f64| {
        format!(
            r#"
carom = 1
mesh.generate.small.rectangle = {{ origin = [0.0, 0.0], size = [0.01, 0.01], elements = [6, 6] }}
mesh.generate.big.rectangle = {{ origin = [-5.0, 0.0101], size = [10.0, 9.0], elements = [10, 9] }}
material.rubber = {{ density = 1000.0, neo-hooke = {{ young = "1 MPa", poisson = 0.4 }} }}
material.steel = {{ density = 7800.0, neo-hooke = {{ young = "210 GPa", poisson = 0.3 }} }}
body.small = {{ region = "small", material = "rubber", section.plane-strain.thickness = 0.01 }}
body.big = {{ region = "big", material = "steel", section.plane-strain.thickness = 1.0, rigid.mass = 7e5, initial.velocity = [0.0, -30.0] }}
support.floor = {{ on = "small.bottom", fix = ["x", "y"] }}
contact.c = {{ secondary = "small.top", primary = "big.bottom", law.velocity = {{}} }}
time = {{ end = "100 us", step = "1 us", scheme.theta = {{}}, newton.tolerance = {tolerance:?} }}
"#
        )
    };
    let [usual, least] = [1e-10, 1e-14].map(|tolerance| {
        let (summary, _) = result(&case(tolerance));
        summary.contacts["c"].impulse.unwrap()
    });
    assert!(usual > 0.01, "{usual} N s");
    assert!((usual - least).abs() < 1e-8 * usual, "{usual} {least}");
}
