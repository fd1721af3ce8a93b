//! Shape functions of shell elements, and the strains that replace those that lock.
//!
//! * shear of quadrilaterals: constant along an edge direction, linear across (MITC4; Dvorkin and Bathe 1984, Eng. Comput. 1, 77);
//! * membrane strains of quadrilaterals: from five points, so that a warped element that bends does not stretch (MITC4+; Ko, Lee and
//!   Bathe 2017, Comput. Struct. 182, 404). With X_r, X_s, X_d the vectors of x = x₀ + r x_r + s x_s + rs x_d, and X_d = c_r X_r +
//!   c_s X_s in the plane of both, the strain ½ |x_d|² is replaced by c_r x_r·x_d + c_s x_s·x_d - ½ |c_r x_r + c_s x_s|²: equal in a
//!   flat element, and without the part of x_d across it;
//! * shear in the plane of quadrilaterals: an element that bends in its plane has e_rs = ½ r x_r·x_d beside e_rr = s x_r·x_d. What of these linear
//!   terms a constant strain does not have, p_r = ½ x_r·x_d - c_r e_rr - c_s e_rs at the centre and p_s alike, is taken off e_rs in the axes of
//!   the centre, times j₀/j, the ratio of the areas there and at the point: constant stress does no work on it, so that the patch test holds (Simo and
//!   Rifai 1990, Int. J. Numer. Methods Eng. 29, 1595). With weights of the internal work its weighted mean is taken off besides, for the same reason;
//! * shear of triangles: MITC3 (Lee and Bathe 2004, Comput. Struct. 82, 945).

use carom_algebra::tensor::Vec3;

use super::products::{Configuration, DIRECTOR, MOST, Row, gradient};
use super::section::STRAINS;

/// Shape functions and their derivatives by r and s.
pub(super) struct Shapes {
    pub n: [f64; MOST],
    pub by: [[f64; MOST]; 2],
}

pub(super) fn shapes(nodes: usize, [r, s]: [f64; 2]) -> Shapes {
    if nodes == 3 {
        return Shapes {
            n: [1.0 - r - s, r, s, 0.0],
            by: [[-1.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0]],
        };
    }
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let of = |f: &dyn Fn(f64, f64) -> f64| corners.map(|[a, b]| 0.25 * f(a, b));
    Shapes {
        n: of(&|a, b| (1.0 + a * r) * (1.0 + b * s)),
        by: [of(&|a, b| a * (1.0 + b * s)), of(&|a, b| b * (1.0 + a * r))],
    }
}

/// Points of integration and their weights.
fn rule(nodes: usize) -> Vec<([f64; 2], f64)> {
    if nodes == 3 {
        let (near, far) = (1.0 / 6.0, 2.0 / 3.0);
        return [[near, near], [far, near], [near, far]]
            .map(|point| (point, 1.0 / 6.0))
            .to_vec();
    }
    let g = 1.0 / 3.0_f64.sqrt();
    [[-g, -g], [g, -g], [g, g], [-g, g]]
        .map(|point| (point, 1.0))
        .to_vec()
}

/// A point of integration.
pub(super) struct Point {
    pub rows: [Row; STRAINS],
    /// m².
    pub area: f64,
    /// Shape functions.
    pub shapes: [f64; MOST],
    /// Their derivatives by the lengths along both axes of the point.
    pub by: [[f64; MOST]; 2],
}

/// The points of an element in its reference configuration; `along`: the direction of the first axis; `delta`: weights of the internal work at
/// its nodes.
pub(super) fn points(
    nodes: usize,
    reference: &Configuration,
    along: &Vec3,
    delta: &[f64; MOST],
) -> Vec<Point> {
    let means = linear_means(nodes, reference, along, delta);
    let of = |(place, weight): ([f64; 2], f64)| {
        let at = shapes(nodes, place);
        let (area, to) = axes(reference, nodes, &at, along);
        let covariant = match nodes {
            3 => triangle(place),
            _ => quadrilateral(reference, place),
        };
        let by = [0, 1].map(|i: usize| {
            std::array::from_fn(|a| to[i][0] * at.by[0][a] + to[i][1] * at.by[1][a])
        });
        let mut rows = local(nodes, (&at.n, &by), &covariant, &to);
        if nodes == 4 {
            let linear = [0, 1].map(|i| place[i] / area - means[i]);
            relieve(&mut rows, reference, along, linear);
        }
        Point {
            rows,
            area: area * weight,
            shapes: at.n,
            by,
        }
    };
    rule(nodes).into_iter().map(of).collect()
}

/// Means of r/j and s/j over the area j dr ds, with weights: without them zero.
fn linear_means(
    nodes: usize,
    reference: &Configuration,
    along: &Vec3,
    delta: &[f64; MOST],
) -> [f64; 2] {
    let (mut sums, mut whole) = ([0.0; 2], 0.0);
    for (place, weight) in rule(nodes) {
        let at = shapes(nodes, place);
        let delta: f64 = at.n.iter().zip(delta).map(|(n, d)| n * d).sum();
        let (area, _) = axes(reference, nodes, &at, along);
        whole += weight * delta * area;
        (0..2).for_each(|i| sums[i] += weight * delta * place[i]);
    }
    match whole > 0.0 {
        true => sums.map(|sum| sum / whole),
        false => [0.0; 2],
    }
}

/// The covariant strains at a point: membrane rr, ss, rs; shear r, s.
pub(super) struct Covariant {
    pub membrane: [Row; 3],
    pub shear: [Row; 2],
}

/// Area over that of the parent cell, and derivatives by the lengths along both axes of a point from those by r and s.
pub(super) fn axes(
    reference: &Configuration,
    nodes: usize,
    at: &Shapes,
    along: &Vec3,
) -> (f64, [[f64; 2]; 2]) {
    let tangents = at.by.map(|by| gradient(reference, nodes, &by));
    let normal = tangents[0].cross(&tangents[1]);
    let (area, normal) = (normal.norm(), normal.normalize());
    let first = (along - normal * normal.dot(along)).normalize();
    let second = normal.cross(&first);
    let [r, s] = tangents.map(|tangent| [tangent.dot(&first), tangent.dot(&second)]);
    let to = [[s[1] / area, -r[1] / area], [-s[0] / area, r[0] / area]];
    (area, to)
}

/// Strains in the axes of a point from covariant ones; `to`: derivatives along both axes from those by r and s.
pub(super) fn local(
    nodes: usize,
    (n, by): (&[f64; MOST], &[[f64; MOST]; 2]),
    covariant: &Covariant,
    to: &[[f64; 2]; 2],
) -> [Row; STRAINS] {
    let membrane = |i: usize, j: usize, factor: f64| {
        let [rr, ss, rs] = &covariant.membrane;
        let both = to[i][0] * to[j][1] + to[i][1] * to[j][0];
        Row::sum(&[
            (factor * to[i][0] * to[j][0], rr),
            (factor * to[i][1] * to[j][1], ss),
            (factor * both, rs),
        ])
    };
    let curvature = |i: usize, j: usize| Row::with_axis(nodes, &by[i], (DIRECTOR, &by[j]));
    let shear = |i: usize| {
        let [r, s] = &covariant.shear;
        Row::sum(&[(to[i][0], r), (to[i][1], s)])
    };
    let skew = [
        Row::with_axis(nodes, &by[0], (1, n)),
        Row::with_axis(nodes, &by[1], (0, n)),
    ];
    [
        membrane(0, 0, 1.0),
        membrane(1, 1, 1.0),
        membrane(0, 1, 2.0),
        curvature(0, 0),
        curvature(1, 1),
        Row::sum(&[(1.0, &curvature(0, 1)), (1.0, &curvature(1, 0))]),
        shear(0),
        shear(1),
        Row::sum(&[(0.5, &skew[0]), (-0.5, &skew[1])]),
    ]
}

/// x,α·d at a place of the parent cell.
pub(super) fn shear_at(nodes: usize, place: [f64; 2], along: usize) -> Row {
    let at = shapes(nodes, place);
    Row::with_axis(nodes, &at.by[along], (DIRECTOR, &at.n))
}

fn triangle([r, s]: [f64; 2]) -> Covariant {
    let by = shapes(3, [0.0; 2]).by;
    let edge = |place: [f64; 2], along: usize| shear_at(3, place, along);
    let (first, second) = (edge([0.5, 0.0], 0), edge([0.0, 0.5], 1));
    let third = [0, 1].map(|along| edge([0.5, 0.5], along));
    let slope = [
        (1.0, &second),
        (-1.0, &first),
        (-1.0, &third[1]),
        (1.0, &third[0]),
    ];
    let slope = Row::sum(&slope);
    Covariant {
        membrane: [
            Row::half_metric(3, &by[0], &by[0]),
            Row::half_metric(3, &by[1], &by[1]),
            Row::half_metric(3, &by[0], &by[1]),
        ],
        shear: [
            Row::sum(&[(1.0, &first), (s, &slope)]),
            Row::sum(&[(1.0, &second), (-r, &slope)]),
        ],
    }
}

/// Membrane strains at five points: rr where s is 1 and -1, ss where r is, rs at the centre; and ½ |x_d|² from these.
struct Five {
    a: Row,
    b: Row,
    c: Row,
    d: Row,
    e: Row,
    half: Row,
}

impl Five {
    fn new(reference: &Configuration) -> Five {
        let metric = |place: [f64; 2], i: usize, j: usize| {
            let by = shapes(4, place).by;
            Row::half_metric(4, &by[i], &by[j])
        };
        let (a, b) = (metric([0.0, 1.0], 0, 0), metric([0.0, -1.0], 0, 0));
        let (c, d) = (metric([1.0, 0.0], 1, 1), metric([-1.0, 0.0], 1, 1));
        let e = metric([0.0, 0.0], 0, 1);
        let [c_r, c_s] = twist(reference);
        let whole = c_r * c_r + c_s * c_s - 1.0;
        let of = |c: f64| (0.5 * c * (c - 1.0) / whole, 0.5 * c * (c + 1.0) / whole);
        let ((at_a, at_b), (at_c, at_d)) = (of(c_r), of(c_s));
        let both = 2.0 * c_r * c_s / whole;
        let half = Row::sum(&[(at_a, &a), (at_b, &b), (at_c, &c), (at_d, &d), (both, &e)]);
        Five {
            a,
            b,
            c,
            d,
            e,
            half,
        }
    }
}

fn quadrilateral(reference: &Configuration, [r, s]: [f64; 2]) -> Covariant {
    let Five {
        a,
        b,
        c,
        d,
        e,
        half,
    } = Five::new(reference);
    let across = |x: f64, plus: &Row, minus: &Row| {
        Row::sum(&[
            (0.5 * (1.0 + x), plus),
            (0.5 * (1.0 - x), minus),
            (x * x - 1.0, &half),
        ])
    };
    let both = Row::sum(&[
        (1.0, &e),
        (0.25 * r, &a),
        (-0.25 * r, &b),
        (0.25 * s, &c),
        (-0.25 * s, &d),
        (r * s, &half),
    ]);
    let shear = |x: f64, plus: Row, minus: Row| {
        Row::sum(&[(0.5 * (1.0 + x), &plus), (0.5 * (1.0 - x), &minus)])
    };
    Covariant {
        membrane: [across(s, &a, &b), across(r, &c, &d), both],
        shear: [
            shear(s, shear_at(4, [0.0, 1.0], 0), shear_at(4, [0.0, -1.0], 0)),
            shear(r, shear_at(4, [1.0, 0.0], 1), shear_at(4, [-1.0, 0.0], 1)),
        ],
    }
}

/// Takes from the membrane strains of a point the shear that bending in the plane would have; r and s over the area, less their means.
fn relieve(rows: &mut [Row; STRAINS], reference: &Configuration, along: &Vec3, [r, s]: [f64; 2]) {
    let (five, [c_r, c_s]) = (Five::new(reference), twist(reference));
    let Five {
        a,
        b,
        c,
        d,
        e,
        half,
    } = &five;
    let excess = |[plus, minus]: [&Row; 2], own: f64, other: f64| {
        Row::sum(&[
            (0.25 - 0.5 * own, plus),
            (-0.25 - 0.5 * own, minus),
            (own, half),
            (-other, e),
        ])
    };
    let (p_r, p_s) = (excess([a, b], c_r, c_s), excess([c, d], c_s, c_r));
    let (centre, to) = axes(reference, 4, &shapes(4, [0.0; 2]), along);
    let part = -centre;
    for (row, (i, j), twice) in [(0, (0, 0), 1.0), (1, (1, 1), 1.0), (2, (0, 1), 2.0)] {
        let both = twice * part * (to[i][0] * to[j][1] + to[i][1] * to[j][0]);
        rows[row].add(both * r, &p_r);
        rows[row].add(both * s, &p_s);
    }
}

/// c_r and c_s of X_d = c_r X_r + c_s X_s + its part across both.
pub(super) fn twist(reference: &Configuration) -> [f64; 2] {
    let sum = |signs: [f64; MOST]| gradient(reference, 4, &signs.map(|sign| 0.25 * sign));
    let along_r = sum([-1.0, 1.0, 1.0, -1.0]);
    let along_s = sum([-1.0, -1.0, 1.0, 1.0]);
    let twist = sum([1.0, -1.0, 1.0, -1.0]);
    let (rr, ss, rs) = (
        along_r.norm_squared(),
        along_s.norm_squared(),
        along_r.dot(&along_s),
    );
    let (r, s) = (twist.dot(&along_r), twist.dot(&along_s));
    let determinant = rr * ss - rs * rs;
    [
        (ss * r - rs * s) / determinant,
        (rr * s - rs * r) / determinant,
    ]
}
