//! The scenes that there are, in positions and at speeds from a seed.
//!
//! Those of [`hollows`], [`crowds`] and [`sections`] are in files of their own.
//!
//! Sides that meet are coarse, and meet away from their nodes: edges across edges, tips and corners before the middles of faces, thin parts that are
//! somewhere else after one step. Up is z in space and y in the plane; the lower body is at rest with its top at zero.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use carom_testing::Random;

use super::parts::{Part, Vec3};
use super::scene::{Fate, Pose, Scene};
use super::{crowds, hollows, sections};

/// Makes a scene of numbers from a seed.
pub type Maker = fn(&mut Random, Pose) -> Scene;

/// Bodies that meet.
pub const MEETINGS: &[Maker] = &[
    cube_on_corner,
    corner_on_edge,
    bars_edge_on_edge,
    needle_across_edge,
    hollows::ball_in_pyramid,
    tetrahedron_into_face,
    rod_across_ridge,
    rods_crossing,
    wedge_between_nodes,
    corner_into_corner,
    disc_between_nodes,
    face_on_face,
    hollows::ball_in_cone,
    hollows::nut_onto_bolt,
    sections::beams_across_ridge,
    sections::beam_end_on_face,
    sections::beam_on_shell_edge,
    sections::cord_over_edge,
    sections::shell_edge_on_ridge,
    sections::shell_edge_on_face,
    sections::solid_corner_on_shell,
];

/// The same, which explicit steps do not take.
pub const IMPLICIT: &[Maker] = &[
    hollows::rigid_ball_in_cone,
    hollows::tool_on_block,
    hollows::chisel_on_block,
];

/// Bodies that meet, and with which something goes wrong with seeds beyond the first two.
pub const FEW: &[Maker] = &[crossed_plates];

/// Bodies that meet, and with which something goes wrong with some seeds at some steps.
pub const OPEN: &[Maker] = &[
    needle_rudely,
    plates_rudely,
    hollows::wedge_in_notch,
    hollows::nut_around_bolt,
    hollows::tool_on_plate,
    hollows::chisel_on_plate,
    hollows::tip_on_needle,
    hollows::thin_plates,
    hollows::thin_plates_on_edge,
    crowds::loose_blocks,
    crowds::chain_links,
    crowds::folded_strip,
    crowds::zigzag_strip,
    crowds::crushed_tube,
    sections::shells_edge_on_edge,
    sections::shell_edge_on_shell,
    sections::shell_corner_on_shell,
    corner_rudely,
    bars_rudely,
    disc_rudely,
];

/// Bodies that are on the other side after a step, where contact may see them or not.
pub const JUMPS: [Maker; 2] = [disc_in_one_step, plates_in_one_step];

/// Bodies that go through each other whatever contact does.
pub const CROSSINGS: [Maker; 3] = [
    cubes_without_contact,
    squares_without_contact,
    rods_without_contact,
];

/// Bodies that stay apart.
pub const MISSES: [Maker; 7] = [
    cubes_that_pass,
    plates_that_pass,
    rods_that_pass,
    rod_over_ridge,
    squares_that_pass,
    disc_that_is_passed,
    cubes_that_part,
];

pub(super) const X: Vec3 = [1.0, 0.0, 0.0];
pub(super) const Y: Vec3 = [0.0, 1.0, 0.0];
pub(super) const Z: Vec3 = [0.0, 0.0, 1.0];

/// With its top at zero.
pub(super) fn below(part: Part) -> Part {
    let up = part.up();
    let [low, high] = part.extent(up);
    part.starting(up, low - high)
}

/// With its bottom `gap` (m) above zero.
pub(super) fn above(part: Part, gap: f64) -> Part {
    let up = part.up();
    part.starting(up, gap)
}

/// Moved across by up to `most` (m).
pub(super) fn aside(part: Part, random: &mut Random, most: f64) -> Part {
    let mut by = [0.0; 3];
    for x in by.iter_mut().take(part.up()) {
        *x = random.between(-most, most);
    }
    part.shifted(by)
}

/// Turned about what is up.
pub(super) fn spun(part: Part, random: &mut Random) -> Part {
    part.turned(Z, random.between(-PI, PI))
}

/// Turned in any way.
pub(super) fn tumbled(part: Part, random: &mut Random) -> Part {
    match part.cells.are_plane() {
        true => spun(part, random),
        false => {
            let axis = [0, 1, 2].map(|_| random.next());
            part.turned(axis, random.between(-PI, PI))
        }
    }
}

/// A cube on its corner, any way around and a little askew.
pub(super) fn on_corner(size: f64, random: &mut Random) -> Part {
    let cube = Part::bricks([size; 3], [1; 3]);
    let upright = cube.turned([1.0, -1.0, 0.0], (1.0 / 3.0_f64.sqrt()).acos());
    spun(upright, random).turned(X, random.between(-0.2, 0.2))
}

/// A bar along x with an edge above and one below, sheared along itself.
pub(super) fn ridge(random: &mut Random) -> Part {
    let shear = random.between(-0.3, 0.3);
    let bar = Part::bricks([0.4, 0.05, 0.05], [3, 1, 1]).turned(X, FRAC_PI_4);
    bar.mapped(|x| [x[0] + shear * x[2], x[1], x[2]])
}

/// Across what lies along x, at an angle of 30° at least.
pub(super) fn across(part: Part, random: &mut Random) -> Part {
    part.turned(Z, random.between(PI / 6.0, PI * 5.0 / 6.0))
}

/// A rod across what lies along x: explicit steps take it along y.
pub(super) fn rod_across(length: f64, random: &mut Random, pose: Pose) -> Part {
    let angle = random.between(PI / 6.0, PI * 5.0 / 6.0);
    let rod = Part::rod(length, 3, 0.01);
    match pose {
        Pose::Explicit => rod.mapped(|[x, y, z]| [y, x, z]),
        Pose::Rigid | Pose::Deformable => rod.turned(Z, angle),
    }
}

/// A rod along x.
pub(super) fn rod_along(length: f64, random: &mut Random) -> Part {
    Part::rod(length, 3, random.between(0.008, 0.012))
}

fn flat_plate() -> Part {
    Part::bricks([0.2, 0.2, 0.02], [1; 3])
}

fn large_and_small(random: &mut Random, part: fn(f64) -> Part) -> [Part; 2] {
    [0.1, 0.06].map(|size| tumbled(part(size), random))
}

pub(super) fn cube(size: f64) -> Part {
    Part::bricks([size; 3], [1; 3])
}

fn square(size: f64) -> Part {
    Part::squares([size; 2], [2; 2])
}

/// Speed (m/s) and way (m) of a fall through what is below.
pub(super) fn fall(random: &mut Random) -> (f64, f64) {
    (random.between(4.0, 8.0), 0.06)
}

/// The same of a fall from centre to centre, and beyond: at most 0.14 m, half the diagonals of two cubes, and a gap of 0.01 m.
fn fall_through(random: &mut Random) -> (f64, f64) {
    (random.between(8.0, 16.0), 0.15)
}

/// Speed (m/s) at which a plate or a block is 0.14 m further after half a millisecond.
fn fast(random: &mut Random) -> f64 {
    random.between(290.0, 310.0)
}

/// Height (m) and speed (m/s) of a flight over what is below.
fn flight(random: &mut Random, slowest: f64) -> (f64, f64) {
    let height = random.between(5e-4, 2e-3);
    (height, random.between(slowest, 2.0 * slowest))
}

fn cube_on_corner(random: &mut Random, pose: Pose) -> Scene {
    // the faces of the plate are the smaller ones
    let plate = below(Part::bricks([0.15, 0.15, 0.04], [3, 3, 1]));
    let cube = above(aside(on_corner(0.1, random), random, 0.03), 0.003);
    Scene::falling("cube on its corner", ([plate, cube], pose), fall(random))
}

fn corner_on_edge(random: &mut Random, pose: Pose) -> Scene {
    let [shift, beside] = [random.between(-0.03, 0.03), random.between(0.002, 0.01)];
    let cube = above(on_corner(0.06, random), 0.003).shifted([shift, beside, 0.0]);
    let parts = [below(ridge(random)), cube];
    Scene::falling("corner on an edge", (parts, pose), fall(random)).gently(true)
}

fn corner_rudely(random: &mut Random, pose: Pose) -> Scene {
    corner_on_edge(random, pose).gently(false)
}

fn bars_edge_on_edge(random: &mut Random, pose: Pose) -> Scene {
    let upper = across(ridge(random), random);
    let upper = above(aside(upper, random, 0.02), 0.003);
    let parts = [below(ridge(random)), upper];
    let scene = Scene::falling("bars edge on edge", (parts, pose), fall(random));
    scene.both_rigid().gently(true)
}

fn bars_rudely(random: &mut Random, pose: Pose) -> Scene {
    bars_edge_on_edge(random, pose).gently(false)
}

fn needle_across_edge(random: &mut Random, pose: Pose) -> Scene {
    // with an edge below, along y
    let needle = Part::tetrahedron(0.02, 0.16).shifted([0.0, 0.0, -0.08]);
    let needle = needle.turned(Z, FRAC_PI_2).turned(X, FRAC_PI_2);
    let needle = needle.turned(Z, random.between(-PI / 3.0, PI / 3.0));
    let needle = above(aside(needle, random, 0.02), 0.003);
    let parts = [below(ridge(random)), needle];
    let scene = Scene::falling("needle across an edge", (parts, pose), fall(random));
    scene.timed(3e5, [2e-4, 4e-4]).gently(true)
}

fn needle_rudely(random: &mut Random, pose: Pose) -> Scene {
    needle_across_edge(random, pose).gently(false)
}

fn crossed_plates(random: &mut Random, pose: Pose) -> Scene {
    let plate = || Part::bricks([0.2, 0.02, 0.12], [1; 3]);
    let tilted = plate().turned(X, random.between(-0.1, 0.1));
    let upper = above(aside(across(tilted, random), random, 0.02), 0.003);
    let parts = [below(plate()), upper];
    let scene = Scene::falling("crossed plates", (parts, pose), fall(random));
    scene.timed(3e5, [2e-4, 4e-4]).both_rigid().gently(true)
}

fn plates_rudely(random: &mut Random, pose: Pose) -> Scene {
    crossed_plates(random, pose).gently(false)
}

fn tetrahedron_into_face(random: &mut Random, pose: Pose) -> Scene {
    let part = spun(Part::tetrahedron(0.05, 0.08), random);
    let part = part.turned(X, random.between(-0.3, 0.3));
    let upper = above(aside(part, random, 0.02), 0.003);
    let parts = [below(cube(0.12)), upper];
    Scene::falling("tetrahedron into a face", (parts, pose), fall(random))
}

fn rod_across_ridge(random: &mut Random, pose: Pose) -> Scene {
    let rod = rod_across(0.4, random, pose);
    let rod = above(aside(rod, random, 0.02), 0.003);
    let parts = [below(ridge(random)), rod];
    Scene::falling("rod across a ridge", (parts, pose), fall(random))
}

fn rods_crossing(random: &mut Random, pose: Pose) -> Scene {
    let rod = rod_across(0.4, random, pose);
    let rod = above(aside(rod, random, 0.02), 0.003);
    let parts = [below(rod_along(0.4, random)), rod];
    Scene::falling("rods crossing", (parts, pose), fall(random))
}

fn wedge_between_nodes(random: &mut Random, pose: Pose) -> Scene {
    let wedge = Part::wedge(random.between(0.04, 0.08), 0.1);
    let wedge = wedge.turned(Z, random.between(-0.2, 0.2));
    let upper = above(wedge, 0.003).shifted([random.between(0.03, 0.07), 0.0, 0.0]);
    let parts = [below(Part::squares([0.4, 0.1], [4, 2])), upper];
    Scene::falling("wedge between nodes", (parts, pose), fall(random))
}

fn corner_into_corner(random: &mut Random, pose: Pose) -> Scene {
    let [lower, upper] =
        [0.08, 0.1].map(|size| square(size).turned(Z, FRAC_PI_4 + random.between(-0.2, 0.2)));
    let upper = above(aside(upper, random, 0.01), 0.003);
    let parts = [below(lower), upper];
    Scene::falling("corner into corner", (parts, pose), fall(random))
}

fn disc_between_nodes(random: &mut Random, pose: Pose) -> Scene {
    let radius = random.between(0.012, 0.02);
    let part = Part::squares([0.4, 0.1], [4, 2]).shifted([random.between(0.03, 0.07), 0.0, 0.0]);
    let part = above(part, radius + 0.003);
    let scene = Scene::onto_disc("disc between nodes", radius, (part, pose), fall(random));
    scene.gently(true)
}

fn disc_rudely(random: &mut Random, pose: Pose) -> Scene {
    disc_between_nodes(random, pose).gently(false)
}

/// The disc is 0.04 m thick.
fn disc_in_one_step(random: &mut Random, pose: Pose) -> Scene {
    let part = aside(Part::squares([0.1, 0.05], [4, 2]), random, 0.02);
    let part = above(part, random.between(0.03, 0.05));
    let fall = (fast(random), 6.0);
    let scene = Scene::onto_disc("disc in one step", 0.02, (part, pose), fall);
    scene.timed(3e4, [5e-4, 1e-3])
}

fn face_on_face(random: &mut Random, pose: Pose) -> Scene {
    let upper = spun(Part::bricks([0.1; 3], [2; 3]), random);
    let upper = above(aside(upper, random, 0.02), 0.003);
    let parts = [below(Part::bricks([0.3, 0.3, 0.05], [3, 3, 1])), upper];
    let fall = (random.between(1.0, 2.0), 0.02);
    Scene::falling("face on face", (parts, pose), fall)
}

fn cubes_without_contact(random: &mut Random, pose: Pose) -> Scene {
    let [lower, upper] = large_and_small(random, cube);
    let parts = [below(lower), above(upper, 0.01)];
    let scene = Scene::falling("cubes without contact", (parts, pose), fall_through(random));
    scene.without_contact().fated(Fate::Crosses)
}

fn squares_without_contact(random: &mut Random, pose: Pose) -> Scene {
    let [lower, upper] = large_and_small(random, square);
    let parts = [below(lower), above(upper, 0.01)];
    let scene = Scene::falling(
        "squares without contact",
        (parts, pose),
        fall_through(random),
    );
    scene.without_contact().fated(Fate::Crosses)
}

fn rods_without_contact(random: &mut Random, pose: Pose) -> Scene {
    let rod = rod_across(0.4, random, pose);
    let rod = above(aside(rod, random, 0.05), 0.01);
    let parts = [below(rod_along(0.4, random)), rod];
    let scene = Scene::falling("rods without contact", (parts, pose), fall(random));
    scene.without_contact().fated(Fate::Crosses)
}

/// A step takes the upper plate seven thicknesses further. The modulus is one of plates that bear the blow, but for explicit steps, which waves bound.
fn plates_in_one_step(random: &mut Random, pose: Pose) -> Scene {
    let tilted = flat_plate().turned(X, random.between(-0.1, 0.1));
    let upper = aside(spun(tilted, random), random, 0.03);
    let upper = above(upper, random.between(0.01, 0.03));
    let parts = [below(flat_plate()), upper];
    let scene = Scene::falling("plates in one step", (parts, pose), (fast(random), 6.0));
    let young = match pose {
        Pose::Explicit => 3e4,
        Pose::Rigid | Pose::Deformable => 3e9,
    };
    scene.timed(young, [5e-4, 1e-3])
}

/// Two bodies of which the second one flies over the first at a height (m) of its own, along x at a speed (m/s).
fn passing(
    name: &'static str,
    ([lower, upper], pose): ([Part; 2], Pose),
    (height, speed): (f64, f64),
) -> Scene {
    let lower = below(lower);
    let begin = lower.extent(0)[0] - 0.02 - upper.extent(0)[1];
    let upper = above(upper, height).shifted([begin, 0.0, 0.0]);
    let way = lower.extent(0)[1] - upper.extent(0)[0] + 0.02;
    let up = lower.up();
    let mut scene = Scene::falling(name, ([lower, upper], pose), (speed, way));
    let velocity = &mut scene.bodies[1].velocity;
    velocity[up] = 0.0;
    velocity[0] = speed;
    scene.fated(Fate::Misses)
}

fn cubes_that_pass(random: &mut Random, pose: Pose) -> Scene {
    let parts = large_and_small(random, cube);
    passing("cubes that pass", (parts, pose), flight(random, 15.0))
}

/// On a way long enough for twenty steps of a millisecond.
fn plates_that_pass(random: &mut Random, pose: Pose) -> Scene {
    let parts = [flat_plate(), spun(flat_plate(), random)];
    let flight = (random.between(1e-3, 4e-3), fast(random));
    let mut scene = passing("plates that pass", (parts, pose), flight);
    scene.end = 0.02;
    scene.timed(3e4, [5e-4, 1e-3])
}

/// What is kept of two axes is half of both radii: these are a little over twice as far apart.
fn rods_that_pass(random: &mut Random, pose: Pose) -> Scene {
    let upper = rod_across(0.3, random, pose);
    let parts = [rod_along(0.3, random), upper];
    passing("rods that pass", (parts, pose), flight(random, 20.0))
}

fn rod_over_ridge(random: &mut Random, pose: Pose) -> Scene {
    let upper = rod_across(0.3, random, pose);
    let lower = ridge(random).turned(Z, FRAC_PI_2);
    passing(
        "rod over a ridge",
        ([lower, upper], pose),
        flight(random, 12.0),
    )
}

fn squares_that_pass(random: &mut Random, pose: Pose) -> Scene {
    let parts = large_and_small(random, square);
    let scene = passing("squares that pass", (parts, pose), flight(random, 12.0));
    scene.without_contact()
}

fn disc_that_is_passed(random: &mut Random, pose: Pose) -> Scene {
    let name = "disc that is passed";
    let radius = random.between(0.012, 0.02);
    let block = || Part::squares([0.1, 0.05], [4, 2]);
    let (height, speed) = flight(random, 12.0);
    let over = passing(name, ([block(), block()], pose), (radius + height, speed));
    let upper = &over.bodies[1];
    let fall = (speed, speed * over.end);
    let mut scene = Scene::onto_disc(name, radius, (upper.part.clone(), pose), fall);
    scene.bodies[0].velocity = upper.velocity;
    scene.fated(Fate::Misses)
}

fn cubes_that_part(random: &mut Random, pose: Pose) -> Scene {
    let [lower, upper] = large_and_small(random, cube);
    let parts = [below(lower), above(upper, 1e-3)];
    let (speed, way) = fall(random);
    let scene = Scene::falling("cubes that part", (parts, pose), (-speed, -way));
    scene.fated(Fate::Misses)
}
