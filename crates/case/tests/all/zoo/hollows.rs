//! Solids in notches, cones and rings, under sharp tools, and thin plates at great speed.

use std::f64::consts::{FRAC_PI_2, PI};

use carom_testing::Random;

use super::parts::Part;
use super::scene::{Pose, Scene};
use super::scenes::{X, Y, Z, above, across, aside, below, fall, spun};
use super::shapes::{ball, chisel, hexagon, hollow, keel, notched, pyramid, ring};

/// Young's modulus of soft bodies, Pa.
const SOFT: f64 = 1e6;

/// Step in which what falls goes about a millimetre, s.
const STEP: f64 = 2e-4;

/// Speed (m/s) and way (m) of a fall to the bottom of a hollow.
fn deep_fall(random: &mut Random) -> (f64, f64) {
    (random.between(4.0, 8.0), 0.12)
}

/// Turned a little about all axes, rad.
fn askew(part: Part, random: &mut Random, most: f64) -> Part {
    let axes = [X, Y, Z];
    axes.into_iter().fold(part, |part, axis| {
        part.turned(axis, random.between(-most, most))
    })
}

pub fn wedge_in_notch(random: &mut Random, pose: Pose) -> Scene {
    let notch = below(notched(0.05, 0.06, 0.12));
    let wedge = keel(0.05 * random.between(0.7, 1.2), 0.06, 0.1);
    let wedge = above(aside(askew(wedge, random, 0.1), random, 0.01), 0.003);
    let scene = Scene::falling(
        "wedge in a notch",
        ([notch, wedge], pose),
        deep_fall(random),
    );
    scene.around(SOFT, STEP)
}

fn ball_above(random: &mut Random) -> Part {
    let ball = askew(ball(random.between(0.025, 0.04), 2), random, PI);
    above(aside(ball, random, 0.02), 0.003)
}

pub fn ball_in_cone(random: &mut Random, pose: Pose) -> Scene {
    let cone = below(hollow(0.08, 0.06, (4, true)));
    let parts = [cone, ball_above(random)];
    let scene = Scene::falling("ball in a cone", (parts, pose), deep_fall(random));
    scene.around(SOFT, STEP).never_rigid()
}

pub fn rigid_ball_in_cone(random: &mut Random, pose: Pose) -> Scene {
    let cone = below(hollow(0.08, 0.06, (4, true)));
    let parts = [cone, ball_above(random)];
    let scene = Scene::falling("rigid ball in a cone", (parts, pose), deep_fall(random));
    scene.around(SOFT, STEP).always_rigid().not_explicit()
}

pub fn ball_in_pyramid(random: &mut Random, pose: Pose) -> Scene {
    let pyramid = below(hollow(0.08, 0.06, (2, false)));
    let parts = [pyramid, ball_above(random)];
    let scene = Scene::falling("ball in a pyramid", (parts, pose), deep_fall(random));
    scene.around(SOFT, STEP)
}

/// A hexagonal bolt along z, and a nut around the same axis with its sides along those of the bolt.
fn bolt_and_nut() -> [Part; 2] {
    let bolt = hexagon(0.02, 0.12, 3).turned(X, FRAC_PI_2);
    let nut = ring(0.0225, 0.045, 0.03, 6).turned(X, FRAC_PI_2);
    [below(bolt), nut.turned(Z, PI / 6.0)]
}

pub fn nut_onto_bolt(random: &mut Random, pose: Pose) -> Scene {
    let [bolt, nut] = bolt_and_nut();
    let nut = above(aside(askew(nut, random, 0.1), random, 0.002), 0.003);
    let scene = Scene::falling("nut onto a bolt", ([bolt, nut], pose), deep_fall(random));
    scene.around(SOFT, STEP)
}

pub fn nut_around_bolt(random: &mut Random, pose: Pose) -> Scene {
    let [bolt, nut] = bolt_and_nut();
    let nut = askew(nut, random, 0.02).shifted([0.0, 0.0, -0.03]);
    let fall = (random.between(2.0, 4.0), 0.05);
    let mut scene = Scene::falling("nut around a bolt", ([bolt, nut], pose), fall);
    scene.bodies[1].velocity = [
        random.between(-4.0, 4.0),
        random.between(-4.0, 4.0),
        -fall.0,
    ];
    scene.around(SOFT, STEP)
}

fn block() -> Part {
    below(Part::bricks([0.12, 0.12, 0.05], [2, 2, 1]))
}

/// A plate that stands on its edge.
fn standing_plate() -> Part {
    below(Part::bricks([0.2, 0.012, 0.1], [3, 1, 1]))
}

fn tool(name: &'static str, (parts, pose): ([Part; 2], Pose), random: &mut Random) -> Scene {
    let scene = Scene::falling(name, (parts, pose), fall(random));
    scene.around(SOFT, STEP).always_rigid().not_explicit()
}

pub fn tool_on_block(random: &mut Random, pose: Pose) -> Scene {
    let tip = pyramid(random.between(0.01, 0.03), 0.05);
    let tip = above(
        aside(spun(askew(tip, random, 0.2), random), random, 0.03),
        0.003,
    );
    tool("rigid tip on a block", ([block(), tip], pose), random)
}

pub fn tool_on_plate(random: &mut Random, pose: Pose) -> Scene {
    let tip = spun(pyramid(random.between(0.01, 0.03), 0.05), random);
    let tip = above(askew(tip, random, 0.1), 0.003);
    let beside = [
        random.between(-0.06, 0.06),
        random.between(-0.005, 0.005),
        0.0,
    ];
    let parts = [standing_plate(), tip.shifted(beside)];
    tool("rigid tip on the edge of a plate", (parts, pose), random)
}

pub fn chisel_on_block(random: &mut Random, pose: Pose) -> Scene {
    let edge = chisel(random.between(0.005, 0.02), 0.05, 0.06);
    let edge = above(
        aside(spun(askew(edge, random, 0.1), random), random, 0.04),
        0.003,
    );
    tool("rigid chisel on a block", ([block(), edge], pose), random)
}

pub fn chisel_on_plate(random: &mut Random, pose: Pose) -> Scene {
    let edge = chisel(random.between(0.005, 0.02), 0.05, 0.06);
    let edge = across(askew(edge.turned(Z, FRAC_PI_2), random, 0.1), random);
    let beside = [
        random.between(-0.06, 0.06),
        random.between(-0.02, 0.02),
        0.0,
    ];
    let parts = [standing_plate(), above(edge, 0.003).shifted(beside)];
    tool("rigid chisel across a plate", (parts, pose), random)
}

pub fn tip_on_needle(random: &mut Random, pose: Pose) -> Scene {
    // with an edge above, along y
    let lying = Part::tetrahedron(0.02, 0.16).shifted([0.0, 0.0, -0.08]);
    let lying = lying.turned(Z, FRAC_PI_2).turned(X, -FRAC_PI_2);
    let tip = askew(Part::tetrahedron(0.02, 0.1), random, 0.2);
    let beside = [
        random.between(-0.003, 0.003),
        random.between(-0.03, 0.03),
        0.0,
    ];
    let parts = [below(lying), above(tip, 0.003).shifted(beside)];
    let scene = Scene::falling("tip on a needle", (parts, pose), fall(random));
    scene.around(3e5, STEP)
}

/// Two plates of a thickness (m) at 300 m/s: a sixteenth of it, a quarter and all of it in a step.
fn at_speed(
    name: &'static str,
    (parts, pose): ([Part; 2], Pose),
    (thickness, random): (f64, &mut Random),
) -> Scene {
    let speed = random.between(290.0, 310.0);
    let fall = (speed, 4.0 * thickness + 0.005);
    Scene::falling(name, (parts, pose), fall).around(1e9, 0.25 * thickness / speed)
}

pub fn thin_plates(random: &mut Random, pose: Pose) -> Scene {
    let thickness = random.between(0.002, 0.02);
    let [lower, upper] = [0.12, 0.1].map(|size| Part::bricks([size, size, thickness], [2, 2, 1]));
    let upper = above(
        aside(spun(askew(upper, random, 0.02), random), random, 0.03),
        0.001,
    );
    let parts = [below(lower), upper];
    at_speed("thin plates", (parts, pose), (thickness, random))
}

pub fn thin_plates_on_edge(random: &mut Random, pose: Pose) -> Scene {
    let thickness = random.between(0.002, 0.02);
    let plate = || Part::bricks([0.1, thickness, 0.06], [2, 1, 1]);
    let upper = across(plate().turned(X, random.between(-0.1, 0.1)), random);
    let parts = [below(plate()), above(aside(upper, random, 0.02), 0.001)];
    at_speed(
        "thin plates edge on edge",
        (parts, pose),
        (thickness, random),
    )
}
