//! Runs that are right are good: interferences, springs with a force at rest, plates whose bending is soft beside their other stiffnesses.

use carom_output::{Grade, Summary};

use crate::verdict::result;

fn assert_good(summary: &Summary) {
    assert_eq!(summary.verdict.grade, Grade::Good, "{:#?}", summary.verdict);
}

/// Two bars of 1 m that go 0.1 mm into each other, both held at their far ends; with `after`, the time of the run beyond its static stage of 1 s.
fn press_fit(after: f64) -> Summary {
    let case = format!(
        r#"
carom = 1
mesh.generate.a.line = {{ from = [0.0], to = [1.0], elements = 4 }}
mesh.generate.b.line = {{ from = [0.9999], to = [2.0], elements = 4 }}
material.steel = {{ density = 7800.0, elastic = {{ young = "200 GPa", poisson = 0.0 }} }}
body.a = {{ region = "a", material = "steel", section.bar.area = "1 cm^2" }}
body.b = {{ region = "b", material = "steel", section.bar.area = "1 cm^2" }}
support.left = {{ on = "a.left", fix = ["x"] }}
support.right = {{ on = "b.right", fix = ["x"] }}
contact.fit = {{ secondary = "a.right", primary = "b.left", law.displacement = {{}}, initial = "keep" }}
time = {{ end = {end:?}, step = 1e-4, static = {{ end = 1.0, steps = 1 }}, scheme.newmark = {{}} }}
"#,
        end = 1.0 + after
    );
    result(&case).0
}

#[test]
fn the_energy_of_an_interference_is_not_made() {
    // E A δ over both lengths
    let exact = 2e11 * 1e-4 * 1e-4 / (1.0 + 1.0001);
    for after in [0.0, 0.02] {
        let summary = press_fit(after);
        let force = summary.contacts["fit"].peak_force;
        // the equilibrium is found to a millionth of its forces
        assert!((force / exact - 1.0).abs() < 1e-6, "{force} {exact}");
        assert_good(&summary);
    }
}

#[test]
fn a_spring_with_a_force_at_rest_has_an_energy_of_either_sign() {
    // 4 N at elongation zero; 0.1 m from its place, where its energy is half of (2 π)² N/m times the square of 4/(2 π)² m less than at rest
    let summary = result(
        r#"
carom = 1
mass.p = { mass = 1.0, at = [0.1, 0.0] }
spring.k = { ends = ["p", "ground"], axis = [1.0, 0.0], curve = [{ elongation = -1.0, force = -35.4784176043574 }, { elongation = 0.0, force = 4.0 }, { elongation = 1.0, force = 43.4784176043574 }] }
load.g = { acceleration = [0.0, -9.81] }
stop.s = { ends = ["p", "ground"], obstacle.plane = { point = [0.0, 0.0], normal = [0.0, 1.0] }, stiffness = 1e6, law.velocity = {}, friction.coulomb = 0.02 }
time = { end = 5.0, step = 0.001, scheme.theta = {} }
"#,
    )
    .0;
    assert_good(&summary);
    // the floor carries the weight, and friction its coefficient times it
    let contact = &summary.contacts["s"];
    assert!((contact.peak_force / 9.81 - 1.0).abs() < 1e-9);
    let friction = contact.friction.unwrap().peak_force;
    assert!((friction / (0.02 * 9.81) - 1.0).abs() < 1e-9, "{friction}");
}

/// A square plate of steel of 1 m, clamped at a side, that moves across itself; its thickness in m.
fn plate(thickness: f64, scheme: &str) -> Summary {
    let case = format!(
        r#"
carom = 1
mesh.dimension = 3
mesh.generate.p.rectangle = {{ origin = [0.0, 0.0], size = [1.0, 1.0], elements = [12, 12] }}
material.m = {{ density = 7800.0, elastic = {{ young = "200 GPa", poisson = 0.3 }} }}
body.p = {{ region = "p", material = "m", section.shell = {{ thickness = {thickness:?}, rotations = "small" }}, initial.velocity = [0.0, 0.0, 1e-3] }}
support.s = {{ on = "p.left", fix = ["x", "y", "z", "rx", "ry", "rz"] }}
time = {{ end = 0.5, step = 1e-3, scheme.{scheme} = {{}} }}
"#
    );
    result(&case).0
}

#[test]
fn thin_shells_are_solved_to_what_rounding_leaves_of_their_shear() {
    for scheme in ["newmark", "theta"] {
        for thickness in [1e-2, 1e-3, 1e-4, 1e-5] {
            assert_good(&plate(thickness, scheme));
        }
    }
}
