//! How far nodes may move before a face that is out of view may come into it.
//!
//! With every node moved by at most δ, the edges of a corner of a straight face change by 2 δ each. Its normal then turns
//! by ρ, tan ρ ≤ κ δ / (1 - κ δ), κ = 4/h, h the smaller height of the triangle at the corner.

use std::f64::consts::{FRAC_PI_2, SQRT_2};

use carom_algebra::tensor::Vec3;
use carom_elements::Kind;
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

/// The corners of a straight face.
#[derive(Clone, Debug)]
pub(crate) struct Corners {
    /// Unit normals there.
    normals: [Vec3; 4],
    /// Their places, m.
    at: [Vec3; 4],
    count: usize,
    /// The least height of the triangles there, m.
    height: f64,
}

impl Corners {
    /// Those of a straight face; none of a curved one.
    pub(crate) fn of(face: &Face, places: &Places) -> Option<Corners> {
        let n = match face.kind {
            Kind::Tri3 => 3,
            Kind::Quad4 => 4,
            _ => return None,
        };
        let (mut at, mut normals) = ([Vec3::zeros(); 4], [Vec3::zeros(); 4]);
        for (at, &node) in at.iter_mut().zip(&face.nodes[..n]) {
            *at = places.of(node).into();
        }
        let mut height = f64::INFINITY;
        for k in 0..n {
            let (one, other) = (at[(k + 1) % n] - at[k], at[(k + n - 1) % n] - at[k]);
            let cross = one.cross(&other);
            let double = cross.norm();
            height = height.min(double / one.norm().max(other.norm()));
            normals[k] = cross / double;
        }
        Some(Corners {
            normals,
            at,
            count: n,
            height,
        })
    }

    fn normals(&self) -> &[Vec3] {
        &self.normals[..self.count]
    }

    /// Whether the face is out of view wherever the foot on it is: its normals make less than 90° with all of these, or a place is deeper
    /// behind it than `depth` (m).
    ///
    /// The normals of a face are sums of those of its corners with positive factors, since ∂y/∂ξ × ∂y/∂η of a bilinear face is linear in
    /// ξ and η. With n_j the unit normals at the corners and y = Σ N_k x_k, n · (x - y) is therefore below -d everywhere if
    /// n_j · (x - x_k) is for all j and k.
    pub(super) fn is_blind<'a>(
        &self,
        mut around: impl Iterator<Item = &'a [f64; 3]>,
        (x, depth): (&[f64; 3], f64),
    ) -> bool {
        let along = |normal: &[f64; 3]| {
            let normal = Vec3::from(*normal);
            self.normals().iter().all(|n| n.dot(&normal) > 0.0)
        };
        around.all(along) || self.under(x) > depth
    }

    /// How far a place is at least behind the face along the normal of any place of it, m; negative if it may be before it.
    fn under(&self, x: &[f64; 3]) -> f64 {
        let x = Vec3::from(*x);
        let mut least = f64::INFINITY;
        for corner in &self.at[..self.count] {
            let way = corner - x;
            for normal in self.normals() {
                least = least.min(normal.dot(&way));
            }
        }
        least
    }
}

fn angle(a: &Vec3, b: &Vec3) -> f64 {
    a.dot(b).clamp(-1.0, 1.0).acos()
}

/// The least height of the triangles at the corners of some faces, m; zero if one is curved.
pub(super) fn least_height<'a>(faces: impl Iterator<Item = &'a Face>, places: &Places) -> f64 {
    let heights = faces.map(|face| Corners::of(face, places).map_or(0.0, |corners| corners.height));
    heights.fold(f64::INFINITY, f64::min)
}

/// Until a face is anywhere turned against one of those around a point, given with their normals and [`least_height`], by more than the angle of
/// the cosine `opposed`.
pub(super) fn until_opposed<'a>(
    corners: &Corners,
    (around, height): (impl Iterator<Item = &'a [f64; 3]>, f64),
    opposed: f64,
) -> f64 {
    let normals = corners.normals();
    // normals inside of a face are between those of its corners, which stay around their mean
    let mean = normals.iter().sum::<Vec3>();
    let mean = mean / mean.norm();
    let warp = normals.iter().map(|n| angle(n, &mean)).fold(0.0, f64::max);
    let widest = around.map(|normal| angle(&Vec3::from(*normal), &mean));
    let free = opposed.acos() - widest.fold(0.0, f64::max) - warp;
    let height = height.min(corners.height);
    motion(height, (0.5 * free).min(0.9 * FRAC_PI_2 - warp))
}

/// Until a place behind a straight face is within the depth of it, or before it; zero if it may be so now.
pub(super) fn until_behind(corners: &Corners, (x, depth): (&[f64; 3], f64)) -> f64 {
    // no more than the distance of the foot
    let distance = corners.under(x);
    let deep = 0.5 * (distance - SQRT_2 * depth);
    let before = (0.5 * ASIDE * distance).min(motion(corners.height, TILTED));
    deep.min(before).max(0.0)
}

#[cfg(test)]
mod tests {
    use carom_algebra::unknowns::Unknowns;
    use carom_mesh::{ElementId, Rim, face_nodes, project};
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
            rim: Rim::default(),
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
            let corners = Corners::of(&face, &places).unwrap();
            let normals = corners.normals();
            let mean = normals.iter().sum::<Vec3>();
            let mean = mean / mean.norm();
            let most = normals.iter().map(|n| angle(n, &mean)).fold(0.0, f64::max);
            let place = point(2.0);
            let foot = project(&face, &x, &place);
            // rounding of places of size one
            assert!(foot.gap <= -corners.under(&place) + 1e-14);
            // that of acos near zero
            assert!(angle(&foot.normal.into(), &mean) <= most + 1e-7);
            deep += usize::from(corners.under(&place) > 0.1);
        }
        assert!(deep > 200, "{deep}");
    }
}
