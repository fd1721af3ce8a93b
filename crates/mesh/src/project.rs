//! Closest point of a face to a point, and the gap.
//!
//! One face at a time: which face of a surface is nearest is decided by whoever loops over candidates. The sign:
//! the normal m of a face points away from its own body, and the gap of a point x over its projection y is
//! g = m·(x - y), positive when open. Around an axis with a radius R it is g = |x - y| - R, with m = (x - y)/|x - y|.

use carom_algebra::lanes::{Lanes, Vector};
use carom_algebra::number::Number;
use carom_elements::{Kind, MAX_FACE_NODES, MAX_NODES, map};
use pulp::{Arch, Simd, WithSimd};

use crate::patch::{self, Foot};
use crate::vector::{difference, dot};
use crate::{Face, curved};

/// How far outside a face, in reference units, a projection still counts as inside: round-off at shared edges.
const SLACK: f64 = 1e-9;

/// Where a point falls on a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// Closest point of the face, in reference coordinates, in the cell.
    pub xi: [f64; 3],
    /// The same in space, y, in m.
    pub point: [f64; 3],
    /// Unit normal m of the face at y, out of the body that the face belongs to.
    pub normal: [f64; 3],
    /// g = m·(x - y) in m, less the radius around an axis, positive when open.
    pub gap: f64,
    /// |x - y| in m; equal to |g| where the point projects inside a face without radius.
    pub distance: f64,
    /// Whether x - y is normal to the face: false where the foot of the perpendicular lies beyond an edge (by more
    /// than 1e-9 in reference units) and y is the nearest point of that edge. Always true for a point, and around an axis.
    pub inside: bool,
}

/// The closest point of a face to `point`.
///
/// `positions`: those of the face's corners, in its order, reference or current, in m. min |x - y(ξ)| over the
/// reference cell; exact for bars (in the plane of the first two axes), straight or quadratic, and for triangles of three
/// nodes; for the other faces by Newton's method with clamping, to round-off, from the centre of the face or, if it is
/// quadratic, from the nearest of its nodes. A warped or curved face can have several points that are closest in their
/// neighbourhood: the result is then one of them, and it is the closest of all if the point is nearer than the face's
/// radius of curvature. For the end of a bar the normal is the face's axis.
pub fn project(face: &Face, positions: &[[f64; 3]], point: &[f64; 3]) -> Projection {
    if let (Kind::Quad4, Some(corners)) = (face.kind, positions.first_chunk()) {
        return of_quad(face, point, &Foot::new(corners, point), 0);
    }
    if let (Kind::Bar2, [a, b]) = (face.kind, positions) {
        return on_bar(face, [a, b], point);
    }
    let element = face.kind.table();
    // Seen from the point: far from the origin the rounding of places would keep iterations from their end.
    let mut local = [[0.0; 3]; MAX_FACE_NODES];
    for (local, x) in local.iter_mut().zip(positions) {
        *local = difference(x, point);
    }
    let (local, origin) = (&local[..element.nodes], &[0.0; 3]);
    let (xi, free) = match (element.dim, element.is_quadratic()) {
        (0, _) => ([0.0; 3], [0.0; 3]),
        (1, true) => curved::on_curve(element, local, origin),
        (2, false) => on_triangle(positions, point),
        (2, true) => curved::on_patch(element, local, origin),
        _ => unreachable!("a face has two dimensions at most"),
    };
    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    (element.shape)(&xi, &mut n[..element.nodes]);
    (element.gradient)(&xi, &mut dn[..element.nodes]);
    let foot = map::point(positions, &n[..element.nodes]);
    let normal = match face.kind {
        Kind::Point1 => face.axis,
        _ => map::measure(positions, &dn[..element.nodes], element.dim).1,
    };
    let inside = (element.contains)(&free, SLACK);
    placed(face, point, (xi, foot, normal), inside)
}

/// Quadrilaterals that [`project_quads`] takes side by side.
pub const QUADS: usize = patch::MOST;

/// The closest points of quadrilaterals of four nodes to as many points, those of [`project`] bit for bit. `corners`: of each face its corners,
/// in m.
pub fn project_quads(
    faces: &[&Face; QUADS],
    corners: &[[[f64; 3]; 4]; QUADS],
    points: &[[f64; 3]; QUADS],
) -> [Projection; QUADS] {
    let zero = Lanes::<QUADS>::ZERO;
    let (mut own, mut seen) = ([[zero; 3]; 4], [zero; 3]);
    for k in 0..QUADS {
        for i in 0..3 {
            seen[i].0[k] = points[k][i];
            for a in 0..4 {
                own[a][i].0[k] = corners[k][a][i];
            }
        }
    }
    let foot = Arch::new().dispatch(Quads(&own, &seen));
    std::array::from_fn(|k| of_quad(faces[k], &points[k], &foot, k))
}

/// Corners and points side by side.
struct Quads<'a>(&'a [Vector<QUADS, 3>; 4], &'a Vector<QUADS, 3>);

impl WithSimd for Quads<'_> {
    type Output = Foot<Lanes<QUADS>>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Quads(corners, points) = self;
        Foot::new(corners, points)
    }
}

/// The foot of lane `k`.
#[inline]
fn of_quad<N: Number>(face: &Face, point: &[f64; 3], foot: &Foot<N>, k: usize) -> Projection {
    let of = |n: &N| n.lanes()[k];
    let inside = foot.free.iter().all(|free| of(free).abs() <= 1.0 + SLACK);
    let [x, y] = &foot.xi;
    let [at, normal] = [&foot.point, &foot.normal].map(|v| [of(&v[0]), of(&v[1]), of(&v[2])]);
    placed(face, point, ([of(x), of(y), 0.0], at, normal), inside)
}

/// What is known of a foot, from its reference coordinates, place and normal; `inside` as in [`Projection`].
#[inline]
fn placed(
    face: &Face,
    point: &[f64; 3],
    (xi, foot, normal): ([f64; 3], [f64; 3], [f64; 3]),
    inside: bool,
) -> Projection {
    let to_point = difference(point, &foot);
    let distance = dot(&to_point, &to_point).sqrt();
    if let Some(radius) = face.radius.filter(|_| face.is_round()) {
        return Projection {
            xi,
            point: foot,
            // in the axis any normal will do
            normal: match distance > 0.0 {
                true => to_point.map(|r| r / distance),
                false => normal,
            },
            gap: distance - radius,
            distance,
            inside: true,
        };
    }
    Projection {
        xi,
        point: foot,
        normal,
        gap: dot(&normal, &to_point) - face.radius.unwrap_or(0.0),
        distance,
        inside,
    }
}

/// The closest point of a straight line.
fn on_bar(face: &Face, x: [&[f64; 3]; 2], point: &[f64; 3]) -> Projection {
    let ([xi, ..], [free, ..]) = on_segment(x, point);
    let xi = [xi, 0.0, 0.0];
    let n = [0.5 * (1.0 - xi[0]), 0.5 * (1.0 + xi[0])];
    let foot = [0, 1, 2].map(|i| n[0] * x[0][i] + n[1] * x[1][i]);
    let tangent = difference(x[1], x[0]);
    let length = dot(&tangent, &tangent).sqrt();
    let normal = match length > 0.0 {
        true => [tangent[1] / length, -tangent[0] / length, 0.0],
        false => [0.0; 3],
    };
    let inside = free.abs() <= 1.0 + SLACK;
    placed(face, point, (xi, foot, normal), inside)
}

/// Closest point of a segment in [-1, 1], and the foot of the perpendicular on its line.
fn on_segment(x: [&[f64; 3]; 2], point: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
    let along = difference(x[1], x[0]);
    let t = dot(&difference(point, x[0]), &along) / dot(&along, &along);
    let free = 2.0 * t - 1.0;
    ([free.clamp(-1.0, 1.0), 0.0, 0.0], [free, 0.0, 0.0])
}

/// Closest point of a triangle, and the foot of the perpendicular on its plane.
fn on_triangle(x: &[[f64; 3]], point: &[f64; 3]) -> ([f64; 3], [f64; 3]) {
    let (s, t) = (difference(&x[1], &x[0]), difference(&x[2], &x[0]));
    let r = difference(point, &x[0]);
    let (ss, st, tt) = (dot(&s, &s), dot(&s, &t), dot(&t, &t));
    let (sr, tr) = (dot(&s, &r), dot(&t, &r));
    let det = ss * tt - st * st;
    let free = [(tt * sr - st * tr) / det, (ss * tr - st * sr) / det, 0.0];
    if free[0] >= 0.0 && free[1] >= 0.0 && free[0] + free[1] <= 1.0 {
        return (free, free);
    }
    // The closest point is on an edge: the nearest of three, the first of equals.
    let edges = [[0, 1], [1, 2], [2, 0]];
    let corners = Kind::Tri3.table().reference;
    let mut best = (f64::INFINITY, [0.0; 3]);
    for [a, b] in edges {
        let along = on_segment([&x[a], &x[b]], point).0[0];
        let weights = [0.5 * (1.0 - along), 0.5 * (1.0 + along)];
        let gap = difference(point, &map::point(&[x[a], x[b]], &weights));
        let squared = dot(&gap, &gap);
        if squared < best.0 {
            best = (squared, map::point(&[corners[a], corners[b]], &weights));
        }
    }
    (best.1, free)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::{ElementId, Rim};

    fn face(kind: Kind, axis: [f64; 3]) -> Face {
        Face {
            kind,
            nodes: crate::face_nodes(&[0, 1, 2, 3, 4, 5, 6, 7, 8]),
            parent: ElementId { block: 0, index: 0 },
            axis,
            radius: None,
            rim: Rim::default(),
        }
    }

    const KINDS: [Kind; 7] = [
        Kind::Bar2,
        Kind::Bar3,
        Kind::Tri3,
        Kind::Tri6,
        Kind::Quad4,
        Kind::Quad8,
        Kind::Quad9,
    ];

    fn position(kind: Kind, x: &[[f64; 3]], xi: &[f64; 3]) -> [f64; 3] {
        let mut n = vec![0.0; x.len()];
        (kind.table().shape)(xi, &mut n);
        map::point(x, &n)
    }

    fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
        let r = difference(a, b);
        dot(&r, &r).sqrt()
    }

    /// Least distance by sampling the reference cell and refining around the best sample.
    fn least_distance(kind: Kind, x: &[[f64; 3]], point: &[f64; 3]) -> f64 {
        let contains = kind.table().contains;
        let (mut centre, mut half) = ([0.0; 3], 1.0);
        let mut best = f64::INFINITY;
        let steps = 24;
        for _ in 0..30 {
            let mut nearest = centre;
            for code in 0..(steps + 1) * (steps + 1) {
                let offset = [code % (steps + 1), code / (steps + 1)];
                let mut xi = centre;
                for i in 0..kind.table().dim {
                    let t = 2.0 * offset[i] as f64 / steps as f64 - 1.0;
                    xi[i] = (centre[i] + half * t).clamp(-1.0, 1.0);
                }
                if kind.table().linear == Kind::Tri3 {
                    // Onto the simplex along a ray, so that its slanted edge is sampled too.
                    xi = xi.map(|c| c.max(0.0));
                    let sum = (xi[0] + xi[1]).max(1.0);
                    xi = xi.map(|c| c / sum);
                }
                assert!(contains(&xi, 1e-12));
                let found = distance(point, &position(kind, x, &xi));
                if found < best {
                    (best, nearest) = (found, xi);
                }
            }
            (centre, half) = (nearest, half * 0.3);
        }
        best
    }

    /// A face of size about one: the reference cell moved by a random map near a rotation, corners shaken.
    fn random_face(kind: Kind, random: &mut Random) -> Vec<[f64; 3]> {
        let plane = kind.table().dim == 1;
        let (a, b, origin) = (random.point(1.0), random.point(1.0), random.point(1.0));
        let flat = |x: [f64; 3]| if plane { [x[0], x[1], 0.0] } else { x };
        // The second direction is made square to the first, so that the face is no needle.
        let a = flat([a[0] + a[0].signum() * 0.3, a[1], a[2]]);
        let shift = dot(&a, &b) / dot(&a, &a);
        let b = [0, 1, 2].map(|i| b[i] - shift * a[i]);
        let scale = (dot(&a, &a) / dot(&b, &b)).sqrt();
        let corners = kind.table().reference.iter();
        corners
            .map(|xi| {
                let shake = random.point(0.1);
                flat([0, 1, 2].map(|i| origin[i] + xi[0] * a[i] + scale * xi[1] * b[i] + shake[i]))
            })
            .collect()
    }

    #[test]
    fn the_projection_is_the_closest_point_of_the_face() {
        let mut random = Random::new(2);
        for kind in KINDS {
            let mut inside = 0;
            for _ in 0..200 {
                let x = random_face(kind, &mut random);
                let mut point = random.point(1.5);
                if kind.table().dim == 1 {
                    point[2] = 0.0;
                }
                let found = project(&face(kind, [0.0; 3]), &x, &point);
                let expected = least_distance(kind, &x, &point);
                assert!(
                    (found.distance - expected).abs() < 1e-9,
                    "{kind:?} {found:?} {expected}"
                );
                assert_eq!(found.point, position(kind, &x, &found.xi));
                assert!((kind.table().contains)(&found.xi, 1e-15));
                if found.inside {
                    inside += 1;
                    assert!((found.gap.abs() - found.distance).abs() < 1e-9);
                }
            }
            assert!((5..195).contains(&inside), "{kind:?} {inside}");
        }
    }

    /// Some of them converge at once, others along edges or in many passes: none changes what is beside it.
    #[test]
    fn quadrilaterals_side_by_side_have_the_bits_of_each_alone() {
        let mut random = Random::new(8);
        let mut inside = 0;
        for _ in 0..200 {
            let faces = [face(Kind::Quad4, [0.0; 3]); QUADS];
            let corners = std::array::from_fn(|k| {
                let mut x = random_face(Kind::Quad4, &mut random);
                if k % 3 == 0 {
                    // strongly warped
                    x[2] = random.point(3.0);
                }
                [x[0], x[1], x[2], x[3]]
            });
            let points = std::array::from_fn(|_| random.point(1.5));
            let found = project_quads(&faces.each_ref(), &corners, &points);
            for k in 0..QUADS {
                assert_eq!(found[k], project(&faces[k], &corners[k], &points[k]));
                inside += usize::from(found[k].inside);
            }
        }
        assert!((100..1500).contains(&inside), "{inside}");
    }

    #[test]
    fn a_point_lifted_off_the_face_along_the_normal_comes_back_with_its_gap() {
        let mut random = Random::new(3);
        for kind in KINDS {
            for _ in 0..200 {
                let x = random_face(kind, &mut random);
                let mut xi = [0.8 * random.unit(), 0.8 * random.unit(), 0.0];
                match kind.table().linear {
                    Kind::Bar2 => xi[1] = 0.0,
                    Kind::Tri3 => xi[1] *= 1.0 - xi[0],
                    _ => (),
                }
                let mut dn = vec![[0.0; 3]; x.len()];
                (kind.table().gradient)(&xi, &mut dn);
                let (_, normal) = map::measure(&x, &dn, kind.table().dim);
                let foot = position(kind, &x, &xi);
                for gap in [-0.03, 0.0, 0.03] {
                    let point = [0, 1, 2].map(|i| foot[i] + gap * normal[i]);
                    let found = project(&face(kind, [0.0; 3]), &x, &point);
                    assert!(found.inside);
                    assert!((found.gap - gap).abs() < 1e-14, "{kind:?} {found:?} {gap}");
                    (0..2).for_each(|i| assert!((found.xi[i] - xi[i]).abs() < 1e-12));
                    (0..3).for_each(|i| assert!((found.normal[i] - normal[i]).abs() < 1e-12));
                }
            }
        }
    }

    #[test]
    fn the_gap_is_positive_outside_the_body_and_negative_in_it() {
        let mesh = crate::generate::box_("a", [0.0; 3], [1.0; 3], [1, 1, 1], false);
        for side in ["left", "right", "front", "back", "bottom", "top"] {
            let group = &mesh.groups[&format!("a.{side}")];
            let surface = crate::Surface::new(&mesh, group, &mesh.groups["a"].elements).unwrap();
            let face = &surface.faces[0];
            let mut x = [[0.0; 3]; MAX_NODES];
            let x = crate::gather(&mesh.nodes, face.corners(), &mut x);
            let inner = project(face, x, &[0.5; 3]);
            assert_eq!((inner.gap, inner.distance, inner.inside), (-0.5, 0.5, true));
            let outer = [0, 1, 2].map(|i| 0.5 + 1.5 * inner.normal[i]);
            let outer = project(face, x, &outer);
            assert_eq!((outer.gap, outer.distance, outer.inside), (1.0, 1.0, true));
        }
    }

    #[test]
    fn the_end_of_a_bar_measures_its_gap_along_the_axis() {
        let end = face(Kind::Point1, [-1.0, 0.0, 0.0]);
        let found = project(&end, &[[2.0, 0.0, 0.0]], &[1.5, 0.0, 0.0]);
        assert_eq!((found.gap, found.distance, found.inside), (0.5, 0.5, true));
        assert_eq!((found.normal, found.point), (end.axis, [2.0, 0.0, 0.0]));
        // Pushed into the bar; beside its axis.
        assert_eq!(
            project(&end, &[[2.0, 0.0, 0.0]], &[2.25, 0.0, 0.0]).gap,
            -0.25
        );
        let beside = project(&end, &[[2.0, 0.0, 0.0]], &[1.6, 0.3, 0.0]);
        assert!((beside.gap - 0.4).abs() < 1e-15 && (beside.distance - 0.5).abs() < 1e-15);
    }

    #[test]
    fn beyond_an_edge_the_closest_point_is_on_the_edge() {
        let square = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let found = project(&face(Kind::Quad4, [0.0; 3]), &square, &[1.3, 0.25, 0.4]);
        assert!(!found.inside);
        assert!((found.distance - 0.5).abs() < 1e-15 && (found.gap - 0.4).abs() < 1e-15);
        assert_eq!(found.xi, [1.0, -0.5, 0.0]);
        let found = project(&face(Kind::Tri3, [0.0; 3]), &square[..3], &[2.0, 3.0, 0.0]);
        assert!(!found.inside);
        assert_eq!(found.point, [1.0, 1.0, 0.0]);
    }

    #[test]
    fn a_point_over_a_shared_edge_is_inside_both_faces() {
        let mut random = Random::new(4);
        for _ in 0..200 {
            let x = random_face(Kind::Quad4, &mut random);
            let opposite = [0, 1, 2].map(|i| x[0][i] + x[1][i] - x[2][i]);
            // Two triangles of one plane on either side of the edge from 0 to 1.
            let t = random.unit();
            let foot = map::point(&x[..2], &[1.0 - t, t]);
            let on = |x: &[[f64; 3]]| project(&face(Kind::Tri3, [0.0; 3]), x, &foot).inside;
            assert!(on(&[x[0], x[1], x[2]]) && on(&[x[1], x[0], opposite]));
        }
    }
}
