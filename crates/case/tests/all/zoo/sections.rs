//! Shells and beams that meet with their edges, corners and ends, each other and solids.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use carom_testing::Random;

use super::parts::{Part, Vec3};
use super::scene::{Pose, Scene};
use super::scenes::{
    X, Y, above, across, aside, below, cube, fall, on_corner, ridge, rod_across, spun,
};
use super::shapes::sheet;

/// Young's modulus of shells and beams, Pa: so stiff that they keep their length.
const STIFF: f64 = 1e8;

/// Young's modulus of solids, Pa.
const SOFT: f64 = 1e6;

/// Thickness of shells, m.
const THICKNESS: f64 = 0.004;

/// With a step in which what falls goes less than half of that thickness.
fn of_sections(name: &'static str, (parts, pose): ([Part; 2], Pose), random: &mut Random) -> Scene {
    let scene = Scene::falling(name, (parts, pose), fall(random));
    scene.around(SOFT, 2e-4).with_sections(STIFF)
}

/// A shell that lies.
fn lying() -> Part {
    sheet([0.2, 0.2], [2, 2], THICKNESS)
}

/// A shell along x that stands on its edge.
fn standing(size: [f64; 2]) -> Part {
    sheet(size, [3, 2], THICKNESS).turned(X, FRAC_PI_2)
}

/// Tilted a little to both sides.
fn tilted(part: Part, random: &mut Random) -> Part {
    let [first, second] = [0, 1].map(|_| random.between(-0.15, 0.15));
    part.turned(X, first).turned(Y, second)
}

pub fn shells_edge_on_edge(random: &mut Random, pose: Pose) -> Scene {
    let upper = across(tilted(standing([0.2, 0.1]), random), random);
    let upper = above(aside(upper, random, 0.02), 0.003);
    let parts = [below(standing([0.2, 0.1])), upper];
    of_sections("shells edge on edge", (parts, pose), random)
}

pub fn shell_edge_on_shell(random: &mut Random, pose: Pose) -> Scene {
    let upper = spun(tilted(standing([0.1, 0.08]), random), random);
    let parts = [below(lying()), above(aside(upper, random, 0.03), 0.003)];
    of_sections("shell edge on a shell", (parts, pose), random)
}

pub fn shell_corner_on_shell(random: &mut Random, pose: Pose) -> Scene {
    let upper = standing([0.08, 0.08]).turned(Y, FRAC_PI_4);
    let upper = above(
        aside(spun(tilted(upper, random), random), random, 0.03),
        0.003,
    );
    let parts = [below(lying()), upper];
    of_sections("shell corner on a shell", (parts, pose), random)
}

pub fn shell_edge_on_ridge(random: &mut Random, pose: Pose) -> Scene {
    let upper = across(tilted(standing([0.2, 0.1]), random), random);
    let parts = [
        below(ridge(random)),
        above(aside(upper, random, 0.02), 0.003),
    ];
    of_sections("shell edge on a ridge", (parts, pose), random)
}

pub fn shell_edge_on_face(random: &mut Random, pose: Pose) -> Scene {
    let upper = spun(tilted(standing([0.06, 0.08]), random), random);
    let parts = [below(cube(0.12)), above(aside(upper, random, 0.02), 0.003)];
    of_sections("shell edge on a face", (parts, pose), random)
}

pub fn solid_corner_on_shell(random: &mut Random, pose: Pose) -> Scene {
    let upper = above(aside(on_corner(0.06, random), random, 0.05), 0.003);
    let parts = [below(spun(lying(), random)), upper];
    of_sections("solid corner on a shell", (parts, pose), random)
}

pub fn beams_across_ridge(random: &mut Random, pose: Pose) -> Scene {
    let rod = |k: f64, random: &mut Random| {
        let rod = rod_across(0.3, random, pose);
        let velocity = [0.0, 0.0, -random.between(4.0, 8.0)];
        (
            above(rod, 0.003 + 0.025 * (k + 1.0)).shifted([0.06 * k, 0.0, 0.0]),
            velocity,
        )
    };
    let rods = [-1.0, 0.0, 1.0].map(|k| rod(k, random));
    let mut bodies: Vec<(Part, Vec3)> = vec![(below(ridge(random)), [0.0; 3])];
    bodies.extend(rods);
    let scene = Scene::of("beams across a ridge", (bodies, pose), 0.02);
    scene.around(SOFT, 2e-4).with_sections(STIFF)
}

pub fn beam_end_on_face(random: &mut Random, pose: Pose) -> Scene {
    let upright = Part::rod(0.2, 3, 0.008).mapped(|[x, y, z]| [y, z, x]);
    let rod = match pose {
        Pose::Explicit => upright,
        Pose::Rigid | Pose::Deformable => tilted(upright, random),
    };
    let parts = [below(cube(0.12)), above(aside(rod, random, 0.03), 0.003)];
    of_sections("beam end on a face", (parts, pose), random)
}

pub fn beam_on_shell_edge(random: &mut Random, pose: Pose) -> Scene {
    let rod = rod_across(0.3, random, pose);
    let parts = [
        below(standing([0.2, 0.1])),
        above(aside(rod, random, 0.02), 0.003),
    ];
    of_sections("beam on the edge of a shell", (parts, pose), random)
}

/// A cord that is thrown over a ridge, and whose ends go on.
pub fn cord_over_edge(random: &mut Random, pose: Pose) -> Scene {
    let cord = Part::rod(0.5, 10, 0.005).mapped(|[x, y, z]| [y, -x, z]);
    let cord = match pose {
        Pose::Explicit => cord,
        Pose::Rigid | Pose::Deformable => cord.turned([0.0, 0.0, 1.0], random.between(-0.8, 0.8)),
    };
    let cord = above(aside(cord, random, 0.03), 0.003);
    let fall = (random.between(6.0, 10.0), 0.15);
    let scene = Scene::falling(
        "cord over an edge",
        ([below(ridge(random)), cord], pose),
        fall,
    );
    scene.around(SOFT, 2e-4).with_sections(1e7)
}
