//! The closest point of one face, and the box around it.

use carom_algebra::tensor::Vec3;
use carom_elements::{Kind, MAX_FACE_NODES};
use carom_mesh::{Bounds, Face, Projection, project};

use super::kept::squared;
use crate::Places;

/// Part of the size of a face within which two places are the same, and roundings of a coordinate, of which a place and a foot have some.
const SAME: f64 = 1e-9;
const ULPS: f64 = 16.0;

/// Part of the size of a face by which a point may be beyond a rim over which its own surface reaches back: what bodies with flush sides spread
/// by as they strike, at strains of some per cent.
const OVERHANG: f64 = 0.05;

/// A place that looks for a face, m, and the surface of the point that is there.
#[derive(Clone, Copy)]
pub(crate) struct Stand<'a> {
    pub x: &'a [f64; 3],
    pub of: Own<'a>,
}

/// Where the surface of a point is, as [`Point::behind`](crate::Point) says; none where there is a place alone.
pub(crate) type Own<'a> = Option<&'a dyn Fn() -> Option<[f64; 3]>>;

impl Stand<'_> {
    /// The way from a foot to the place, less its part along the normal, m.
    fn beside(&self, foot: &Projection) -> Vec3 {
        let way = Vec3::from(*self.x) - Vec3::from(foot.point);
        way - Vec3::from(foot.normal) * foot.gap
    }

    /// How far the place may be beyond a rim and is not beside the surface, m, if what is beside the way to it is that which its own surface
    /// lies on: flush bodies spread, and their outermost nodes still stand for what is within both. `outward`: the direction over the rim, none
    /// at a corner of it.
    fn overhang(&self, foot: &Projection, outward: Option<Vec3>, size: f64) -> f64 {
        let Some(behind) = self.of.and_then(|behind| behind()) else {
            return 0.0;
        };
        let back = Vec3::from(behind) - Vec3::from(foot.point);
        let beside = self.beside(foot);
        let product = match outward {
            Some(outward) => beside.dot(&outward) * back.dot(&outward),
            None => beside.dot(&back),
        };
        match product < 0.0 {
            true => OVERHANG * size,
            false => 0.0,
        }
    }

    /// The same of the distance before a face across a ridge, in which `foot` is the foot.
    pub(crate) fn overhang_across(&self, foot: &Projection, size: f64) -> f64 {
        let Some(behind) = self.of.and_then(|behind| behind()) else {
            return 0.0;
        };
        let gap = (0..3).map(|i| (behind[i] - foot.point[i]) * foot.normal[i]);
        match gap.sum::<f64>() < 0.0 {
            true => OVERHANG * size,
            false => 0.0,
        }
    }
}

/// The closest point of one of the faces.
pub(crate) fn foot_on<'a>(
    places: &Places,
    faces: &'a [Face],
    item: u32,
    x: &[f64; 3],
) -> (Projection, &'a Face) {
    let face = &faces[item as usize];
    if face.kind == Kind::Quad4 {
        return (project(face, &corners(places, face), x), face);
    }
    let positions = places.of_face(face);
    (project(face, &positions[..face.corners().len()], x), face)
}

/// The corners of a quadrilateral, m.
#[inline]
pub(super) fn corners(places: &Places, face: &Face) -> [[f64; 3]; 4] {
    let [a, b, c, d, ..] = face.nodes;
    [places.of(a), places.of(b), places.of(c), places.of(d)]
}

/// A box that holds a face.
pub(crate) fn hull(places: &Places, face: &Face) -> Bounds {
    if face.kind == Kind::Quad4 {
        return Bounds::of(&corners(places, face));
    }
    Bounds::of_face(face.kind, &places.of_face(face)[..face.corners().len()])
}

/// Whether a point faces the face on which its closest point lies.
///
/// On an edge where the surface goes on: if the way to the point runs sideways by no more than it runs along the normal, or if the closest point
/// is that of `all` faces and the point is behind them, in a fold. At the rim of the surface: if it does not run over the rim, since a point
/// beyond it is beside the surface, above its plane or below it; what runs along the rim is as on other edges. On a sharp ridge so is a point
/// above it. A point whose own surface reaches back over the rim may be beyond it by [`OVERHANG`]. `positions`: of the face, m.
pub(crate) fn faces_point(
    (stand, foot): (Stand, &Projection),
    face: &Face,
    all: bool,
    positions: impl FnOnce() -> [[f64; 3]; MAX_FACE_NODES],
) -> bool {
    if foot.inside || face.kind == Kind::Point1 {
        return true;
    }
    let whole = sideways(foot);
    let along = match foot.gap < 0.0 && all {
        true => f64::INFINITY,
        false => foot.gap.abs(),
    };
    let above_ridge = foot.gap > 0.0 && face.rim.is_ridge(face.kind, &foot.xi);
    let ends = face.rim.holds(face.kind, &foot.xi) || above_ridge;
    if whole <= if ends { 0.0 } else { along } {
        return true;
    }
    let positions = positions();
    let corners = &positions[..face.corners().len()];
    let size = Bounds::of_face(face.kind, corners).diagonal();
    let same = rounding(foot, size);
    if whole <= same || !ends {
        return whole <= same;
    }
    let edge = face.rim.edge(face.kind, &foot.xi).filter(|_| !above_ridge);
    let Some(outward) = edge.map(|edge| outward(face, corners, edge, foot)) else {
        return whole <= stand.overhang(foot, None, size);
    };
    let beyond = stand.beside(foot).dot(&outward).abs();
    let beside = (whole.powi(2) - beyond.powi(2)).max(0.0).sqrt();
    beside <= along.max(same)
        && (beyond <= same || beyond <= stand.overhang(foot, Some(outward), size))
}

/// The direction out of a face over one of its edges, in the plane of the foot: of length 1, or 0 where the edge has no length.
fn outward(face: &Face, corners: &[[f64; 3]], edge: usize, foot: &Projection) -> Vec3 {
    let [a, b, ..] = face.kind.table().faces[edge].nodes[..] else {
        return Vec3::zeros();
    };
    let along = Vec3::from(corners[b]) - Vec3::from(corners[a]);
    let outward = Vec3::from(foot.normal).cross(&along);
    outward.try_normalize(0.0).unwrap_or_default()
}

/// Whether a point is below the plane of a face and beyond the rim of the surface there.
pub(crate) fn is_beside_rim(
    (stand, foot): (Stand, &Projection),
    face: &Face,
    positions: impl FnOnce() -> [[f64; 3]; MAX_FACE_NODES],
) -> bool {
    let beyond = foot.gap < 0.0 && face.rim.holds(face.kind, &foot.xi);
    beyond && !faces_point((stand, foot), face, true, positions)
}

/// How far the way from a foot to its point runs beside the normal, m.
fn sideways(foot: &Projection) -> f64 {
    (foot.distance.powi(2) - foot.gap.powi(2)).max(0.0).sqrt()
}

/// Distance beside a face of this size (m) that is rounding, m: matching rims coincide only to rounding. That of a length is the root of
/// what two squares lose that cancel.
fn rounding(foot: &Projection, size: f64) -> f64 {
    let far = foot.point.iter().fold(0.0_f64, |far, x| far.max(x.abs()));
    let root = foot.distance * f64::EPSILON.sqrt();
    (SAME * size).max(ULPS * f64::EPSILON * far).max(root)
}

/// Diagonal of the box around a face, m.
pub(crate) fn diagonal(places: &Places, face: &Face) -> f64 {
    let bounds = hull(places, face);
    squared(&bounds.min, &bounds.max).sqrt()
}

/// The most that Σ |N_a| is on a face: places between its nodes move by that times the motion of the nodes at most.
pub(crate) fn spread(kind: Kind) -> f64 {
    match kind {
        Kind::Point1 | Kind::Bar2 | Kind::Tri3 | Kind::Quad4 => 1.0,
        // eight nodes, at the centre: four times 1/4 and four times 1/2; other kinds have less
        _ => 3.0,
    }
}
