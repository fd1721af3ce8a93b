//! A body that touches nothing, far from all others, changes neither the forces nor the grades of the cases of the project.
//!
//! Twenty steps of each at its smallest. The body is elastic, flies, and steps as all do; where each body is in a zone, it is in one of its own, in
//! the first and in the last of the case. A case without a mesh has a mass beside it. Displacements are compared besides. What is solved at once differs by the rounding of the
//! order of sums, what is iterated by the tolerance of the iterations: 1e-6 of the largest force of the case covers both, twenty steps of 1e-10
//! times the condition of the equations of a contact, a thousand.

use crate::project::{Compared, Project, differences};
use crate::resume_cases::{BARS, LARGE, MIXED, PLANE, SOLID, STATIC, Small, THIN};
use crate::verdict::result;

/// The zone that the body is in.
#[derive(Clone, Copy)]
enum In {
    /// None, or one of its own where each body has to be in one.
    Own,
    /// The first of the case.
    First,
    /// The last of the case.
    Last,
}

/// Adds the body to a case: a mass where the case has no mesh.
fn add(case: &mut Project, zone: In) {
    let Some(mesh) = case.mesh() else {
        case.set("mass.zz={mass=\"1 t\",at=[1e3],initial.velocity=[3.0]}");
        return;
    };
    let size = mesh.size();
    let corner = |i: usize| mesh.nodes.iter().map(|x| x[i]).fold(f64::MIN, f64::max);
    let at = [0, 1, 2].map(|i| corner(i) + 10.0 * size);
    let vector = |values: &[f64]| format!("{:?}", &values[..mesh.dim]);
    let (origin, extent) = (vector(&at), vector(&[size; 3]));
    let ones = &[1; 3][..mesh.dim];
    let (shape, section) = match mesh.dim {
        1 => ("line", "section.bar.area=\"1 cm^2\""),
        2 if case.is_axisymmetric() => ("rectangle", "section.axisymmetric={}"),
        2 => ("rectangle", "section.plane-strain.thickness=\"10 mm\""),
        _ => ("box", ""),
    };
    let part = match mesh.dim {
        1 => format!("from={origin},to={},elements=1", vector(&[at[0] + size; 3])),
        _ => format!("origin={origin},size={extent},elements={ones:?}"),
    };
    case.set(&format!(
        "mesh.generate.zz.{shape}={{{part}}}
         material.zz={{density=1000.0,elastic={{young=1e9,poisson={}}}}}
         [body.zz]
         region=\"zz\"
         material=\"zz\"
         initial.velocity={}
         {section}",
        if mesh.dim == 1 { 0.0 } else { 0.3 },
        vector(&[3.0, 2.0, 1.0])
    ));
    let time = case.table["time"].as_table();
    if time.is_some_and(|time| time.contains_key("static")) {
        case.set("body.zz.hold=true");
    }
    let zones: Vec<String> = case.named("zone").map(|(name, _)| name.clone()).collect();
    let zone = match zone {
        In::Own => "zz",
        In::First => zones.first().map_or("zz", String::as_str),
        In::Last => zones.last().map_or("zz", String::as_str),
    };
    if !zones.is_empty() {
        let bodies = case.table["zone"].get(zone).map(|zone| &zone["bodies"]);
        let mut bodies = bodies
            .and_then(|all| all.as_array().cloned())
            .unwrap_or_default();
        bodies.push("zz".into());
        case.set(&format!(
            "zone.{zone}.bodies={}",
            toml::Value::Array(bodies)
        ));
        let time = case.table["time"].as_table();
        // each zone has a scheme of its own
        if zone == "zz" && time.is_some_and(|time| !time.contains_key("scheme")) {
            case.set("zone.zz.scheme.newmark={}");
        }
    }
}

fn unchanged(list: &[Small]) {
    let mut broken = Vec::new();
    for small in list {
        let case = Project::read(small);
        let alone = case.answer();
        // refinement adds nodes after those of all parts
        let mut coarse = case.clone();
        if case.has("mesh") {
            coarse.set("mesh.refine=0");
        }
        let nodes = coarse.mesh().map_or(usize::MAX, |mesh| mesh.nodes.len());
        let zones = match case.has("zone") {
            true => &[In::Own, In::First, In::Last][..],
            false => &[In::Own],
        };
        for &zone in zones {
            let mut beside = case.clone();
            add(&mut beside, zone);
            let beside = beside.answer();
            let compared = Compared {
                nodes: (0..nodes.min(alone.motion.len()) as u32).collect(),
                ..Compared::default()
            };
            broken.extend(differences(case.name, (&alone, &beside), &[], &compared));
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn cases_of_bars_and_masses_do_not_see_a_body_far_away() {
    unchanged(BARS);
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

#[test]
fn cases_of_solids_beside_other_bodies_do_not_see_a_body_far_away() {
    unchanged(MIXED);
}

/// The cases that no override makes small: some minutes, with the variable `CAROM_WHOLE` of the environment, as a stage of CI has it.
#[test]
fn large_cases_do_not_see_a_body_far_away() {
    if std::env::var_os("CAROM_WHOLE").is_some() {
        unchanged(LARGE);
    }
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
