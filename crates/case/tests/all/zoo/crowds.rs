//! Many bodies, bodies that hold each other, and bodies that fold onto themselves.

use std::f64::consts::{FRAC_PI_2, PI};

use carom_testing::Random;

use super::parts::{Part, Vec3};
use super::scene::{Pose, Scene};
use super::scenes::{X, cube, tumbled};
use super::shapes::{line_of_u, line_of_z, ring, strip};

/// Young's modulus of soft bodies, Pa.
const SOFT: f64 = 1e6;

/// All turned alike, with their velocities: no side lies along an axis.
fn turned_together(bodies: Vec<(Part, Vec3)>, random: &mut Random) -> Vec<(Part, Vec3)> {
    let axis = [0, 1, 2].map(|_| random.next());
    let angle = random.between(-PI, PI);
    let turned = |(part, velocity): (Part, Vec3)| {
        let arrow = Part {
            nodes: vec![velocity],
            ..part.clone()
        };
        let velocity = arrow.turned(axis, angle).nodes[0];
        (part.turned(axis, angle), velocity)
    };
    bodies.into_iter().map(turned).collect()
}

/// Cubes with room to turn, and one that flies into them.
pub fn loose_blocks(random: &mut Random, pose: Pose) -> Scene {
    const APART: f64 = 0.036;
    let mut bodies = Vec::new();
    for place in 0..35 {
        let [i, j, k] = [place % 4, place / 4 % 3, place / 12].map(f64::from);
        let part = tumbled(cube(0.02), random);
        bodies.push((part.shifted([i, j, k].map(|x| x * APART)), [0.0; 3]));
    }
    let speed = random.between(10.0, 20.0);
    let hit = [random.between(0.0, 2.0), random.between(0.0, 2.0)].map(|x| x * APART);
    let fast = tumbled(cube(0.03), random).shifted([-0.05, hit[0], hit[1]]);
    let sideways = [random.between(-0.2, 0.2), random.between(-0.2, 0.2)].map(|x| x * speed);
    bodies.push((fast, [speed, sideways[0], sideways[1]]));
    Scene::of("loose blocks", (bodies, pose), 0.15 / speed).around(SOFT, 2e-4)
}

/// Two or three links in each other, of which the last one flies away.
pub fn chain_links(random: &mut Random, pose: Pose) -> Scene {
    let sides = if random.next() < 0.0 { 4 } else { 8 };
    let inner = if sides == 4 { 0.036 } else { 0.03 };
    let count = if random.next() < 0.0 { 2 } else { 3 };
    let link = |k: usize, random: &mut Random| {
        let flat = ring(inner, inner + 0.02, 0.014, sides);
        let turn = FRAC_PI_2 * (k % 2) as f64 + random.between(-0.3, 0.3);
        flat.turned(X, turn).shifted([0.05 * k as f64, 0.0, 0.0])
    };
    let speed = random.between(4.0, 8.0);
    let mut bodies: Vec<(Part, Vec3)> = (0..count).map(|k| (link(k, random), [0.0; 3])).collect();
    if let Some((_, velocity)) = bodies.last_mut() {
        *velocity = [speed, random.between(-2.0, 2.0), random.between(-2.0, 2.0)];
    }
    let bodies = turned_together(bodies, random);
    Scene::of("chain links", (bodies, pose), 0.08 / speed).around(SOFT, 2e-4)
}

/// A part between two blocks, a gap from each, which fly at each other.
fn between_blocks(
    name: &'static str,
    (part, pose): (Part, Pose),
    (block, random): ([f64; 3], &mut Random),
) -> Scene {
    let speed = random.between(6.0, 12.0);
    let [low, high] = part.extent(2);
    let [middle, half] = [0.5 * (low + high), 0.5 * (high - low + block[2]) + 0.002];
    let place = |side: f64, random: &mut Random| {
        let at = [
            random.between(-0.01, 0.01),
            random.between(-0.01, 0.01),
            middle + side * half,
        ];
        let block = Part::bricks(block, [2, 1, 1]).shifted(at);
        (block, [0.0, 0.0, -0.5 * side * speed])
    };
    let bodies = vec![(part, [0.0; 3]), place(-1.0, random), place(1.0, random)];
    let bodies = turned_together(bodies, random);
    let way = 1.2 * (high - low);
    Scene::of(name, (bodies, pose), way / speed).folding()
}

pub fn folded_strip(random: &mut Random, pose: Pose) -> Scene {
    let line = line_of_u(0.15, random.between(0.025, 0.04));
    let strip = strip(&line, 0.008, (0.04, 1)).shifted([-0.1, 0.0, 0.0]);
    let scene = between_blocks("folded strip", (strip, pose), ([0.06, 0.06, 0.03], random));
    scene.around(SOFT, 1e-4)
}

pub fn zigzag_strip(random: &mut Random, pose: Pose) -> Scene {
    let line = line_of_z(0.2, random.between(0.03, 0.05));
    let strip = strip(&line, 0.01, (0.04, 1));
    let scene = between_blocks("zigzag strip", (strip, pose), ([0.26, 0.08, 0.03], random));
    scene.around(SOFT, 1e-4)
}

pub fn crushed_tube(random: &mut Random, pose: Pose) -> Scene {
    let inner = random.between(0.03, 0.04);
    let tube = ring(inner, inner + 0.006, 0.06, 8);
    let scene = between_blocks("crushed tube", (tube, pose), ([0.12, 0.1, 0.04], random));
    scene.around(SOFT, 1e-4)
}
