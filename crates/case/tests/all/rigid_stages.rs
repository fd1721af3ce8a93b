//! Rigid bodies in static stages.

use carom_output::Grade;

use crate::verdict::result;

/// W, N; L and k A by node, m and N/m; the centre from the lower left corner, m.
const WEIGHT: f64 = 100.0;
const LENGTH: f64 = 0.2;
const STIFFNESS: f64 = 1e4;
const CENTRE: [f64; 2] = [0.13, 0.05];

/// Forces of the lower corners of a block of weight W on springs k A that are normal to a floor, at an angle θ: W balances them and has no moment about them,
/// `F₂ L = W (c_x - c_y tan θ)`, and `F₂ - F₁ = -k A L sin θ`.
fn corners() -> [f64; 2] {
    let at = |angle: f64| {
        let right = WEIGHT * (CENTRE[0] - CENTRE[1] * angle.tan()) / LENGTH;
        [WEIGHT - right, right]
    };
    let left_over = |angle: f64| {
        let [left, right] = at(angle);
        right - left + STIFFNESS * LENGTH * angle.sin()
    };
    let (mut low, mut high): (f64, f64) = (-0.5, 0.5);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        match left_over(low) * left_over(middle) <= 0.0 {
            true => high = middle,
            false => low = middle,
        }
    }
    at(low)
}

/// The least gap is that of the heavy corner. Nothing but the contact holds the block.
#[test]
fn a_rigid_block_leans_on_its_springs_as_its_weight_asks() {
    let [_, right] = corners();
    let (_, histories) = result(&format!(
        r#"
carom = 1
mesh.generate.die.rectangle = {{ origin = [0.0, 0.0], size = [{LENGTH:?}, 0.1], elements = [1, 1] }}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.0 }} }}
body.die = {{ region = "die", material = "m", section.plane-strain.thickness = 1.0, rigid = {{ mass = 10.0, centre = {CENTRE:?}, inertia = [0.1] }} }}
load.weight = {{ acceleration = [0.0, -10.0] }}
contact.c = {{ secondary = "die.bottom", obstacle.plane = {{ point = [0.0, 0.0], normal = [0.0, 1.0] }}, law.penalty.stiffness = {:?} }}
time = {{ static = {{ end = 1.0, steps = 2 }}, end = 1.0 }}
"#,
        STIFFNESS / (0.5 * LENGTH)
    ));
    let last = |name: &str| *histories[name].last().unwrap();
    assert!((last("contact.c.resultant_y_n") / WEIGHT - 1.0).abs() < 1e-9);
    // the tolerance of gaps, 1e-10 of the model, over a gap of 3 % of it
    let gap = last("contact.c.gap_m");
    assert!(
        (gap * STIFFNESS / -right - 1.0).abs() < 1e-8,
        "{gap} {right}"
    );
}

/// Rigid stamps on an elastic block, in the plane and in space, with friction, or guided without it: the block bears their weight, and they stay there in the
/// dynamics.
#[test]
fn a_rigid_stamp_rests_on_an_elastic_block() {
    let plane = r#"
mesh.generate.block.rectangle = { origin = [0.0, 0.0], size = [1.0, 0.5], elements = [10, 5] }
mesh.generate.die.rectangle = { origin = [0.23, 0.5], size = [0.54, 0.3], elements = [6, 3] }
body.block = { region = "block", material = "m", section.plane-strain.thickness = 1.0 }
body.die = { region = "die", material = "m", section.plane-strain.thickness = 1.0, rigid = {} }
support.floor = { on = "block.bottom", fix = ["x", "y"] }
load.weight = { acceleration = [0.0, -9.81] }
"#;
    let space = r#"
mesh.generate.block.box = { origin = [0.0, 0.0, 0.0], size = [1.0, 1.0, 0.5], elements = [4, 4, 2] }
mesh.generate.die.box = { origin = [0.2, 0.3, 0.5], size = [0.5, 0.4, 0.3], elements = [2, 2, 1] }
body.block = { region = "block", material = "m" }
body.die = { region = "die", material = "m", rigid = {} }
support.floor = { on = "block.bottom", fix = ["x", "y", "z"] }
load.weight = { acceleration = [0.0, 0.0, -9.81] }
"#;
    for (model, axis, volume, held) in [
        (plane, "y", 0.54 * 0.3, "[\"x\"]"),
        (space, "z", 0.5 * 0.4 * 0.3, "[\"x\", \"y\", \"rz\"]"),
    ] {
        let guide = format!("support.guide = {{ on = \"die\", fix = {held} }}");
        for (friction, guide) in [("", &guide[..]), (", friction.coulomb = 0.3", "")] {
            for sides in [
                "secondary = \"block.top\", primary = \"die.bottom\"",
                "secondary = \"die.bottom\", primary = \"block.top\"",
            ] {
                let (summary, histories) = result(&format!(
                    r#"
carom = 1
{model}
{guide}
material.m = {{ density = 1000.0, elastic = {{ young = 1e7, poisson = 0.2 }} }}
contact.c = {{ {sides}, law.velocity = {{}}{friction} }}
time = {{ static = {{ end = 1.0, steps = 2 }}, end = 1.005, step = 1e-4, scheme.theta.theta = 0.55 }}
"#
                ));
                let weight = 1000.0 * volume * 9.81;
                let resultant = &histories[&format!("contact.c.resultant_{axis}_n")];
                let start = histories["time_s"]
                    .iter()
                    .position(|time| *time >= 1.0)
                    .unwrap();
                for force in &resultant[start..] {
                    // what iterations leave of the forces in each step, 1e-10, which shakes the stamp
                    assert!(
                        (force.abs() / weight - 1.0).abs() < 1e-6,
                        "{sides}{friction}: {force} {weight}"
                    );
                }
                let bad = summary
                    .verdict
                    .lines
                    .iter()
                    .find(|line| line.grade == Grade::Bad);
                assert!(bad.is_none(), "{bad:?}");
            }
        }
    }
}
