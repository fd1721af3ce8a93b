//! How far nodes may move before a face that is out of view may come into it.
//!
//! With every node moved by at most δ, the edges of a corner of a straight face change by 2 δ each. Its normal then turns
//! by ρ, tan ρ ≤ κ δ / (1 - κ δ), κ = 4/h, h the smaller height of the triangle at the corner.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use carom_algebra::tensor::Vec3;
use carom_elements::Kind;
use carom_mesh::{Face, Projection};

use crate::Places;

/// Directions to the sides of a plane from which a point cannot come to face it before one of these angles is turned, rad: the way
/// to it and the normal together turn by less than the 45° that are between the plane and a direction in which a face looks.
const TILTED: f64 = 0.34;

/// Part of a distance over which the direction to a point turns by less than the rest of these 45°.
const ASIDE: f64 = 0.3;

/// The motion, m, in which no normal of a face turns more than an angle (rad).
fn motion(height: f64, angle: f64) -> f64 {
    let t = angle.clamp(0.0, 1.5).tan();
    0.25 * height * t / (1.0 + t)
}

/// Unit normals of the corners of a straight face, and their number.
struct Corners([Vec3; 4], usize);

impl Corners {
    fn iter(&self) -> impl Iterator<Item = &Vec3> {
        self.0[..self.1].iter()
    }
}

/// Normals of the corners of a straight face, and the least height of the triangles there, m; none of a curved one.
fn corners(face: &Face, places: &Places) -> Option<(Corners, f64)> {
    let n = match face.kind {
        Kind::Tri3 => 3,
        Kind::Quad4 => 4,
        _ => return None,
    };
    let x = places.of_face(face).map(Vec3::from);
    let mut least = f64::INFINITY;
    let mut normals = [Vec3::zeros(); 4];
    for k in 0..n {
        let (one, other) = (x[(k + 1) % n] - x[k], x[(k + n - 1) % n] - x[k]);
        let cross = one.cross(&other);
        least = least.min(cross.norm() / one.norm().max(other.norm()));
        normals[k] = cross / cross.norm();
    }
    Some((Corners(normals, n), least))
}

/// Whether the normals of a straight face make less than 90° with these: they are sums of those of its corners.
pub(super) fn turns_away<'a>(
    face: &Face,
    mut around: impl Iterator<Item = &'a [f64; 3]>,
    places: &Places,
) -> bool {
    let Some((corners, _)) = corners(face, places) else {
        return false;
    };
    around.all(|normal| corners.iter().all(|n| n.dot(&Vec3::from(*normal)) > 0.0))
}

fn angle(a: &Vec3, b: &Vec3) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos()
}

/// Until a face is turned against one of those around a point, given with their normals, by more than the angle of the cosine
/// `opposed`.
pub(super) fn until_opposed<'a>(
    (face, foot): (&Face, &Projection),
    around: impl Iterator<Item = (&'a Face, &'a [f64; 3])>,
    (opposed, places): (f64, &Places),
) -> f64 {
    let Some((normals, mut height)) = corners(face, places) else {
        return 0.0;
    };
    // normals inside of a face are between those of its corners, which stay around their mean
    let mean = normals.iter().sum::<Vec3>();
    let mean = mean / mean.norm();
    let warp = normals
        .iter()
        .map(|n| angle(n, &mean))
        .fold(angle(&foot.normal.into(), &mean), f64::max);
    let mut widest = 0.0_f64;
    for (own, normal) in around {
        let Some((_, least)) = corners(own, places) else {
            return 0.0;
        };
        height = height.min(least);
        widest = widest.max(angle(&Vec3::from(*normal), &mean));
    }
    let free = opposed.acos() - widest - warp;
    motion(height, (0.5 * free).min(0.9 * FRAC_PI_2 - warp))
}

/// Until a point behind a face is within the depth of it, or before it.
pub(super) fn until_behind((face, foot): (&Face, &Projection), depth: f64, places: &Places) -> f64 {
    if foot.gap > 0.0 {
        return 0.0;
    }
    let Some((_, height)) = corners(face, places) else {
        return 0.0;
    };
    let deep = 0.5 * (foot.distance - SQRT_2 * depth);
    let before = (0.5 * ASIDE * foot.distance).min(motion(height, TILTED));
    deep.min(before)
}
