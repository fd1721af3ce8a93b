//! Contacts of shells whose middle surface is beside their nodes.
//!
//! The middle moves by u + (R - I) e n. A strip with nodes beside its middle by e is therefore the strip with nodes in its middle, in other unknowns: clamped ends are clamped in both, and a contact
//! around the middle has the same forces. With small rotations the consistent mass is the same too; with finite ones masses are at the nodes, so that the equilibrium is compared.
//!
//! Tolerance: 1e-8 of the largest value with small rotations, rounding over a hundred steps of an impact; 1e-6 of equilibria, to which the iterations are solved.

use std::fs;
use std::sync::Arc;

use carom_case::{Built, Input, Problem};
use carom_dynamics::Driver;

/// A strip of 4 mm, clamped at x = 0, with its middle beside its nodes by `offset`, m. `rest`: its motion, contact and steps.
fn case(offset: f64, rotations: &str, rest: &str) -> String {
    format!(
        r#"
carom = 1

[mesh]
dimension = 3
generate.strip.rectangle = {{ origin = [0.0, 0.0], size = [0.4, 0.1], elements = [8, 2] }}

[material.steel]
density = 7800.0
elastic = {{ young = "210 GPa", poisson = 0.3 }}

[support.root]
on = "strip.left"
fix = ["x", "y", "z", "rx", "ry", "rz"]

[body.strip]
region = "strip"
material = "steel"
mass = "consistent"
section.shell = {{ thickness = "4 mm", offset = {offset:?}, rotations = "{rotations}" }}
{rest}"#
    )
}

/// It flies along z towards a plane half a millimetre away, on the side of this sign.
fn flying(offset: f64, side: f64) -> String {
    let rest = format!(
        r#"
initial.velocity = [0.0, 0.0, {velocity:?}]

[contact.plane]
secondary = "strip"
obstacle.plane = {{ point = [0.0, 0.0, {plane:?}], normal = [0.0, 0.0, {normal:?}] }}
law.velocity = {{}}
friction.coulomb = 0.2
sliding = "small"

[time]
end = "1 ms"
step = "10 us"
scheme.newmark = {{}}
"#,
        velocity = 5.0 * side,
        plane = offset + side * 2.5e-3,
        normal = -side,
    );
    case(offset, "small", &rest)
}

/// A cylinder along y lifts it by a quarter of its length.
fn lifted(offset: f64, side: f64) -> String {
    let rest = format!(
        r#"
[contact.roll]
secondary = "strip"
obstacle.cylinder = {{ point = [0.3, 0.0, {height:?}], axis = [0.0, 1.0, 0.0], radius = 0.05, motion.velocity = [0.0, 0.0, {velocity:?}] }}
law.displacement = {{}}
sliding = "finite"

[time]
end = 1.0
static = {{ end = 1.0, steps = 20 }}
"#,
        height = offset + side * 0.052,
        velocity = -0.1 * side,
    );
    case(offset, "finite", &rest)
}

fn built(text: &str) -> Result<Built, Vec<Problem>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("case.toml");
    fs::write(&path, text).unwrap();
    let input = Input::read(&path, &[]).unwrap();
    let (case, locator) = carom_case::parse(&input)?;
    carom_case::build(&case, &locator, &input)
}

/// Contact force and energy of each step.
fn run(text: &str, steps: usize) -> Vec<[f64; 2]> {
    let built = built(text).unwrap();
    let mut driver = Driver::new(Arc::clone(&built.system)).unwrap();
    let step = |_| {
        driver.step().unwrap();
        let report = driver.report();
        [report.contacts[0].force, report.balance.energy()]
    };
    (0..steps).map(step).collect()
}

fn assert_same(one: &[[f64; 2]], other: &[[f64; 2]], tolerance: f64) {
    for k in 0..2 {
        let largest = one.iter().fold(0.0_f64, |most, step| most.max(step[k]));
        assert!(largest > 0.0, "{one:?}");
        for (own, that) in one.iter().zip(other) {
            let error = (own[k] - that[k]).abs();
            assert!(error < tolerance * largest, "{k}: {own:?} {that:?}");
        }
    }
}

#[test]
fn a_strip_beside_its_nodes_meets_a_plane_as_one_in_its_nodes() {
    for side in [-1.0, 1.0] {
        let [plain, beside] = [0.0, 7e-3].map(|offset| run(&flying(offset, side), 100));
        assert_same(&plain, &beside, 1e-8);
    }
}

#[test]
fn it_is_lifted_by_a_roll_through_large_rotations_with_the_same_force() {
    for side in [-1.0, 1.0] {
        let [plain, beside] = [0.0, 7e-3].map(|offset| run(&lifted(offset, side), 20));
        assert_same(&plain, &beside, 1e-6);
    }
}
