//! Implicit runs with iterations on several ranks, each of which has some rows of the matrices: the bits of one process.

use std::path::Path;

use crate::ranks::{SMALL, run_alone, run_on};

/// A block of 2 900 nodes, three chunks of rows, above a ball, a plane or another block. What else there is, and the time, are added.
const BLOCK: &str = r#"
carom = 1
[mesh]
generate.block.box = { origin = [0.0, 0.0, 0.001], size = [0.1, 0.08, 0.12], elements = [13, 13, 14] }
MESH
[material.soft]
density = 1000.0
MATERIAL
[body.block]
region = "block"
material = "soft"
initial = { velocity = [0.3, 0.0, -5.0] }
[load.weight]
acceleration = [0.0, 0.0, -9.81]
MORE
[probe.top]
on = "block.top"
record = ["displacement", "velocity"]
[time]
solver = "iterative"
"#;

const PLANE: &str = r#"
[contact.ground]
secondary = "block.bottom"
obstacle.plane = { point = [0.0, 0.0, 0.0], normal = [0.1, 0.0, 1.0] }
law.velocity = {}
"#;

const FINITE: &str = r#"neo-hooke = { young = "5 MPa", poisson = 0.3 }"#;

fn block(material: &str, more: &str, time: &str) -> String {
    let text = BLOCK.replace("MATERIAL", material).replace("MORE", more);
    text.replace("MESH", "") + time
}

/// That ranks write the histories of one process, byte by byte. The summary of the latter.
fn compare(text: &str, counts: &[usize]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let alone = folder.path().join("alone");
    run_alone(text, &alone);
    let histories = |folder: &Path| std::fs::read(folder.join("histories.csv")).unwrap();
    for &ranks in counts {
        let several = folder.path().join(ranks.to_string());
        let ended = run_on(ranks, text, &several, u64::MAX);
        let failed = ended.into_iter().find_map(Result::err);
        assert!(failed.is_none(), "{ranks}: {}", failed.unwrap());
        assert!(histories(&alone) == histories(&several), "{ranks}");
    }
    std::fs::read_to_string(alone.join("summary.json")).unwrap()
}

#[test]
fn a_linear_block_falls() {
    let time = "end = \"0.6 ms\"\nstep = \"50 us\"\nscheme.theta = {}";
    let text = block(SMALL, PLANE, time);
    compare(&text, &[2, 3, 4]);
    // and with what is predicted to cost less
    compare(&text.replace("\"iterative\"", "\"auto\""), &[2]);
    let long = text.replace("50 us", "0.3 ms").replace("0.6 ms", "0.9 ms");
    compare(&long.replace("\"iterative\"", "\"auto\""), &[2]);
    let moved = r#"
[support.side]
on = "block.left"
move = { x = [{ time = 0.0, displacement = 0.0 }, { time = "0.6 ms", displacement = "1 mm" }] }
"#;
    compare(&block(SMALL, &(PLANE.to_owned() + moved), time), &[2, 3]);
}

#[test]
fn tangents_follow_a_block_that_a_support_moves_and_a_pressure_pushes() {
    let more = r#"
[contact.ball]
secondary = "block.bottom"
obstacle.sphere = { centre = [0.05, 0.04, -0.05], radius = 0.05 }
law.velocity = {}
[signal.shake]
displacement.points = [{ time = 0.0, displacement = 0.0 }, { time = "0.6 ms", displacement = "1 mm" }]
[support.side]
on = "block.left"
move = { x = "shake" }
[load.push]
on = "block.top"
pressure = "50 kPa"
"#;
    let time = "end = \"0.5 ms\"\nstep = \"0.1 ms\"\nscheme.theta = {}";
    compare(&block(FINITE, more, time), &[2, 4]);
    let metal = r#"j2 = { young = "50 MPa", poisson = 0.3, yield-stress = "0.2 MPa", hardening = "1 MPa" }"#;
    compare(&block(metal, more, time), &[3]);
}

#[test]
fn a_step_in_which_iterations_fail_has_a_factor_on_all_ranks() {
    // three of twenty steps of a block that is crushed
    let text = block(
        FINITE,
        PLANE,
        "end = \"10 ms\"\nstep = \"0.5 ms\"\nscheme.theta = {}",
    )
    .replace(
        "[0.0, 0.0, 0.001], size = [0.1, 0.08, 0.12], elements = [13, 13, 14]",
        "[0.0, 0.0, 0.01], size = [1.0, 1.0, 1.0], elements = [14, 14, 14]",
    )
    .replace("[0.3, 0.0, -5.0]", "[0.0, 0.0, -60.0]")
    .replace("[0.1, 0.0, 1.0]", "[0.0, 0.0, 1.0]")
    .replace("\"iterative\"", "\"auto\"");
    let summary = compare(&text, &[2]);
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let factors = summary["counts"]["factorisations"].as_u64().unwrap();
    assert!((1..20).contains(&factors), "{factors}");
}

#[test]
fn energy_and_momentum_are_kept_by_stresses_between_two_instants() {
    let time = "end = \"0.4 ms\"\nstep = \"0.1 ms\"\nscheme.energy-momentum = {}";
    compare(&block(FINITE, PLANE, time), &[2, 3]);
}

#[test]
fn tangents_of_two_blocks_that_slide_on_each_other() {
    let mesh = r#"generate.lower.box = { origin = [-0.05, -0.05, -0.05], size = [0.2, 0.2, 0.05], elements = [10, 10, 4] }"#;
    let more = r#"
[body.lower]
region = "lower"
material = "soft"
[support.floor]
on = "lower.bottom"
fix = ["x", "y", "z"]
[contact.pair]
secondary = "block.bottom"
primary = "lower.top"
law.velocity = {}
friction.coulomb = 0.2
sliding = "finite"
"#;
    let time = "end = \"0.5 ms\"\nstep = \"0.1 ms\"\nscheme.theta = {}";
    let text = BLOCK
        .replace("MATERIAL", FINITE)
        .replace("MESH", mesh)
        .replace("MORE", more);
    compare(&(text + time), &[2, 3]);
}
