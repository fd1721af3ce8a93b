//! Ropes: beams with finite rotations whose bending is small against their tension.

use std::f64::consts::PI;

use crate::verdict::result;

/// A rope around half of a drum of 0.1 m, its axis at 0.101 m: `arc` elements there, and one from either end of the arc down to 0.1 m below the axis of the
/// drum; in the format of Gmsh 2.2.
fn rope(arc: usize) -> String {
    let mut nodes = vec![[-0.101, -0.1]];
    let angle = |k: usize| PI * (1.0 - k as f64 / arc as f64);
    nodes.extend((0..=arc).map(|k| [0.101 * angle(k).cos(), 0.101 * angle(k).sin()]));
    nodes.push([0.101, -0.1]);
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n0 2 \"hold\"\n0 3 \"pull\"\n1 1 \"rope\"\n$EndPhysicalNames\n".to_owned();
    text += &format!("$Nodes\n{}\n", nodes.len());
    for (k, [x, y]) in nodes.iter().enumerate() {
        text += &format!("{} {x:?} {y:?} 0\n", k + 1);
    }
    let count = nodes.len();
    text += &format!(
        "$EndNodes\n$Elements\n{}\n1 15 2 2 2 1\n2 15 2 3 3 {count}\n",
        count + 1
    );
    for k in 1..count {
        text += &format!("{} 1 2 1 1 {k} {}\n", k + 2, k + 1);
    }
    text + "$EndElements\n"
}

/// A rope of 2 mm, held by 10 N at the one end, whose other end is pulled until all of it slides: the tensions of both ends are as exp(μ θ). The tension is
/// some 27 times what turns an element of the free ends against its chord by its bending, 12 E I/L².
#[test]
fn a_rope_that_slides_around_a_drum_has_the_tensions_of_the_capstan_equation() {
    let work = tempfile::tempdir().unwrap();
    let mesh = work.path().join("rope.msh");
    std::fs::write(&mesh, rope(18)).unwrap();
    let friction = 0.3;
    let (_, histories) = result(&format!(
        r#"
carom = 1
mesh = {{ file = {mesh:?}, dimension = 2 }}
material.rope = {{ density = 1000.0, elastic = {{ young = "1 GPa", poisson = 0.3 }} }}
body.rope = {{ region = "rope", material = "rope", section.beam = {{ shape.circle.diameter = "2 mm", theory = "timoshenko", rotations = "finite" }} }}
load.hold = {{ on = "hold", force = [0.0, -10.0] }}
support.pull = {{ on = "pull", move.y = [{{ time = 0.0, displacement = 0.0 }}, {{ time = 1.0, displacement = "-10 mm" }}] }}
time = {{ static = {{ end = 1.0, steps = 10 }}, end = 1.0 }}
[contact.drum]
secondary = "rope"
obstacle.cylinder = {{ point = [0.0, 0.0], axis = [0.0, 0.0, 1.0], radius = "0.1 m" }}
law.displacement = {{}}
friction.coulomb = {friction:?}
sliding = "finite"
"#
    ));
    let pulled = -histories["support.pull.force_y_n"].last().unwrap();
    let exact = 10.0 * (friction * PI).exp();
    // friction acts 1 mm below the axis, which is 1 % of μ θ = 0.94; a polygon with turns δ of 10° has 2 tan(δ/2)/δ of it, 0.3 % more; the bending of the rope at the
    // ends of the arc, of √(E I/N) = 9 mm in 317 mm, moves these by less
    assert!((pulled / exact - 1.0).abs() < 0.02, "{pulled} {exact}");
    let [slipping, closed] = ["slipping", "closed"].map(|what| {
        *histories[&format!("contact.drum.{what}_points")]
            .last()
            .unwrap()
    });
    assert_eq!(slipping, closed);
}

/// A string of four elements, whose tension is forty times 12 E I/L², under its weight: q L²/(8 N).
#[test]
fn a_string_of_long_elements_is_as_stiff_as_its_tension() {
    let (_, histories) = result(
        r#"
carom = 1
mesh.generate.a.line = { from = [0.0, 0.0], to = [1.0, 0.0], elements = 4 }
material.m = { density = 1000.0, elastic = { young = "1 GPa", poisson = 0.3 } }
body.a = { region = "a", material = "m", section.beam = { shape.circle.diameter = "4 mm", theory = "euler-bernoulli", rotations = "finite" } }
support.left = { on = "a.left", fix = ["x", "y"] }
support.right = { on = "a.right", fix = ["y"] }
load.tension = { on = "a.right", force = [100.0, 0.0] }
load.weight = { acceleration = [0.0, -100.0] }
probe.middle = { at = [0.5, 0.0], record = ["displacement"] }
time = { static = { end = 1.0, steps = 4 }, end = 1.0 }
"#,
    );
    let sag = -histories["probe.middle.displacement_y_m"].last().unwrap();
    let area = 0.25 * PI * 16e-6;
    // the same weight on a string that N extends by 0.8 %; with linear elements its nodes are where they must be, but for the bending of the ends, which have no
    // moment: 8 E I/(N L²) = 0.1 %, and the sag itself, (w/L)²
    let exact = 1e5 * area * (1.0 + 100.0 / (1e9 * area)) / 800.0;
    assert!((sag / exact - 1.0).abs() < 2e-3, "{sag} {exact}");
}
