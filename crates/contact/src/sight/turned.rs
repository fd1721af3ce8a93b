//! How far nodes may move before a face that is out of view may come into it.
//!
//! With every node moved by at most δ, the edges of a corner of a straight face change by 2 δ each. Its normal then turns
//! by ρ, tan ρ ≤ κ δ / (1 - κ δ), κ = 4/h, h the smaller height of the triangle at the corner.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use carom_algebra::tensor::Vec3;
use carom_elements::{Kind, MAX_FACE_NODES};
use carom_mesh::Face;

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

/// Normals of the corners of a straight face, their places, and the least height of the triangles there, m; none of a curved one.
fn corners(face: &Face, places: &Places) -> Option<(Corners, [Vec3; MAX_FACE_NODES], f64)> {
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
    Some((Corners(normals, n), x, least))
}

/// Whether a straight face is out of view wherever the foot on it is: its normals make less than 90° with all of these, or a place is
/// deeper behind it than `depth` (m).
///
/// The normals of a face are sums of those of its corners with positive factors, since ∂y/∂ξ × ∂y/∂η of a bilinear face is linear in ξ
/// and η. With n_j the unit normals at the corners and y = Σ N_k x_k, n · (x - y) is therefore below -d everywhere if n_j · (x - x_k) is for all
/// j and k.
pub(super) fn is_blind<'a>(
    face: &Face,
    mut around: impl Iterator<Item = &'a [f64; 3]>,
    (x, depth): (&[f64; 3], f64),
    places: &Places,
) -> bool {
    let Some((corners, at, _)) = corners(face, places) else {
        return false;
    };
    around.all(|normal| corners.iter().all(|n| n.dot(&Vec3::from(*normal)) > 0.0))
        || under(&corners, &at, x) > depth
}

/// How far a place is at least behind a straight face along the normal of any place of it, m; negative if it may be before it.
fn under(corners: &Corners, at: &[Vec3], x: &[f64; 3]) -> f64 {
    let x = Vec3::from(*x);
    let ways = at[..corners.1].iter().map(|corner| corner - x);
    ways.flat_map(|way| corners.iter().map(move |n| n.dot(&way)))
        .fold(f64::INFINITY, f64::min)
}

fn angle(a: &Vec3, b: &Vec3) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos()
}

/// Until a face is anywhere turned against one of those around a point, given with their normals, by more than the angle of the
/// cosine `opposed`.
pub(super) fn until_opposed<'a>(
    face: &Face,
    around: impl Iterator<Item = (&'a Face, &'a [f64; 3])>,
    (opposed, places): (f64, &Places),
) -> f64 {
    let Some((normals, _, mut height)) = corners(face, places) else {
        return 0.0;
    };
    // normals inside of a face are between those of its corners, which stay around their mean
    let mean = normals.iter().sum::<Vec3>();
    let mean = mean / mean.norm();
    let warp = normals.iter().map(|n| angle(n, &mean)).fold(0.0, f64::max);
    let mut widest = 0.0_f64;
    for (own, normal) in around {
        let Some((.., least)) = corners(own, places) else {
            return 0.0;
        };
        height = height.min(least);
        widest = widest.max(angle(&Vec3::from(*normal), &mean));
    }
    let free = opposed.acos() - widest - warp;
    motion(height, (0.5 * free).min(0.9 * FRAC_PI_2 - warp))
}

/// Until a place behind a straight face is within the depth of it, or before it; zero if it may be so now.
pub(super) fn until_behind(face: &Face, (x, depth): (&[f64; 3], f64), places: &Places) -> f64 {
    let Some((normals, at, height)) = corners(face, places) else {
        return 0.0;
    };
    // no more than the distance of the foot
    let distance = under(&normals, &at, x);
    let deep = 0.5 * (distance - SQRT_2 * depth);
    let before = (0.5 * ASIDE * distance).min(motion(height, TILTED));
    deep.min(before).max(0.0)
}

#[cfg(test)]
mod tests {
    use carom_algebra::unknowns::Unknowns;
    use carom_mesh::{ElementId, face_nodes, project};
    use carom_testing::Random;

    use super::*;
    use crate::Frames;

    #[test]
    fn bounds_over_the_corners_of_a_warped_face_hold_everywhere_on_it() {
        let mut random = Random(3);
        let mut point = |size: f64| [(); 3].map(|()| random.between(-size, size));
        let face = Face {
            kind: Kind::Quad4,
            nodes: face_nodes(&[0, 1, 2, 3]),
            parent: ElementId { block: 0, index: 0 },
            axis: [0.0; 3],
            radius: None,
        };
        let unknowns = Unknowns::translations(3, 4);
        let mut deep = 0;
        for _ in 0..2000 {
            let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
            let x = square.map(|[x, y]| {
                let shake = point(0.25);
                [x + shake[0], y + shake[1], shake[2]]
            });
            let places = Places {
                unknowns: &unknowns,
                time: 0.0,
                x: &x,
                u: &[0.0; 12],
                frames: Frames::default(),
            };
            let (normals, at, _) = corners(&face, &places).unwrap();
            let mean = normals.iter().sum::<Vec3>();
            let mean = mean / mean.norm();
            let most = normals.iter().map(|n| angle(n, &mean)).fold(0.0, f64::max);
            let place = point(2.0);
            let foot = project(&face, &x, &place);
            // rounding of places of size one
            assert!(foot.gap <= -under(&normals, &at, &place) + 1e-14);
            // that of acos near zero
            assert!(angle(&foot.normal.into(), &mean) <= most + 1e-7);
            deep += usize::from(under(&normals, &at, &place) > 0.1);
        }
        assert!(deep > 200, "{deep}");
    }
}
