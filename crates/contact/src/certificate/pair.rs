//! Whether two pieces of surfaces, whose corners move along straight lines, stay apart: a node and a triangle, two edges, or parts of these.
//!
//! With `r_ij` the motion of corner i of one piece relative to corner j of the other, and any unit vector n,
//!
//! `σ_n(t) = min_ij n·(a_i(t) - b_j(t))`
//!
//! is no more than the distance of the pieces, since all of one lies on one side of a plane that all of the other is `σ_n` away from; and each
//! `n·(a_i - b_j)` is linear in t. From an instant at which n separates the pieces they are further apart than δ for
//!
//! `s = min_{n·r_ij < 0} (n·(a_i - b_j) - δ)/(-n·r_ij)`,
//!
//! and at least for `(σ_n - δ)/max |r_ij|`. Only these products certify anything: a poor direction costs passes, never a meeting that is missed.
//! A pair that comes within 1.1 δ counts as met.
//!
//! Source: conservative advancement (Mirtich 1996) with separating planes; the form is derived here. Additive continuous collision
//! detection (Li, Ferguson, Schneider, Langlois, Zorin, Panozzo, Jiang, Kaufman 2020) takes the lengths of the motions alone.

/// Passes after which a pair counts as met.
const PASSES: usize = 200;

/// Distance at which a pair counts as met, over the one that it must keep.
pub(super) const NEAR: f64 = 1.1;

/// Length of a difference below which it has no direction, over the size of what it is a difference of.
const ROUNDING: f64 = 1e-13;

type Vec3 = [f64; 3];

/// A corner that moves along a straight line, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving {
    /// Where it starts.
    pub start: Vec3,
    /// Where it ends.
    pub end: Vec3,
}

impl Moving {
    /// A corner that stands.
    pub fn still(place: Vec3) -> Moving {
        Moving {
            start: place,
            end: place,
        }
    }

    /// Where it is at a part of the way.
    pub fn at(&self, t: f64) -> Vec3 {
        [0, 1, 2].map(|i| self.start[i] + t * (self.end[i] - self.start[i]))
    }
}

/// The part of the way at which two pieces come as near as `distance` (m) or nearer, to a tenth of it; nothing if they stay further apart all
/// the way. Pieces are a node and a triangle, or two of nodes and edges: two triangles meet first where one of these pairs does.
pub fn meeting(one: &[Moving], other: &[Moving], distance: f64) -> Option<f64> {
    let pair = Pair { one, other };
    let longest = pair.longest();
    let end = pair.direction(1.0);
    let mut t = 0.0;
    for _ in 0..PASSES {
        let n = pair.direction(t);
        let apart = n.map_or(0.0, |n| pair.separation(n, t));
        if apart <= NEAR * distance {
            return Some(t);
        }
        let least = match longest > 0.0 {
            true => (apart - distance) / longest,
            false => f64::INFINITY,
        };
        let known = [n, end].into_iter().flatten();
        let planes = known.chain(pair.normals(t));
        let ways = planes.map(|n| pair.free_way(n, t, distance));
        t += ways.fold(least, f64::max);
        if t >= 1.0 {
            return None;
        }
    }
    Some(t)
}

/// How far two pieces are apart at the end, m, or less.
pub(super) fn apart_at_end(one: &[Moving], other: &[Moving]) -> f64 {
    let pair = Pair { one, other };
    let n = pair.direction(1.0);
    n.map_or(0.0, |n| pair.separation(n, 1.0))
}

/// Volume over the cube of the largest side at which four places lie in one plane.
const FLAT: f64 = 1e-12;

/// Whether an edge goes through a triangle.
pub(super) fn pierces(edge: &[Vec3; 3], triangle: &[Vec3; 3]) -> bool {
    let [a, b, c] = triangle;
    let volume =
        |p: &Vec3, q: &Vec3, r: &Vec3, s: &Vec3| dot(&sub(q, p), &cross(&sub(r, p), &sub(s, p)));
    let ends = [&edge[0], &edge[1]].map(|end| volume(a, b, c, end));
    let around = [(a, b), (b, c), (c, a)].map(|(from, to)| volume(&edge[0], &edge[1], from, to));
    // volumes of what lies in one plane are rounding, and of any sign
    let places = [a, b, c, &edge[0], &edge[1]];
    let sides = places.iter().flat_map(|p| sub(p, a));
    let size = sides.fold(0.0, |most: f64, side| most.max(side.abs()));
    let flat = FLAT * size.powi(3);
    let one_sided = around.iter().all(|v| *v > flat) || around.iter().all(|v| *v < -flat);
    if ends.iter().any(|v| v.abs() <= flat) {
        return false;
    }
    ends[0] * ends[1] < 0.0 && one_sided
}

/// Whether two edges in the plane cross.
pub(super) fn crosses(one: &[Vec3; 3], other: &[Vec3; 3]) -> bool {
    let side = |edge: &[Vec3; 3], p: &Vec3| cross(&sub(&edge[1], &edge[0]), &sub(p, &edge[0]))[2];
    let apart =
        |edge: &[Vec3; 3], other: &[Vec3; 3]| side(edge, &other[0]) * side(edge, &other[1]) < 0.0;
    apart(one, other) && apart(other, one)
}

struct Pair<'a> {
    one: &'a [Moving],
    other: &'a [Moving],
}

impl Pair<'_> {
    fn corners(&self) -> impl Iterator<Item = (&Moving, &Moving)> {
        self.one
            .iter()
            .flat_map(|a| self.other.iter().map(move |b| (a, b)))
    }

    /// Largest relative motion of two corners, m.
    fn longest(&self) -> f64 {
        let lengths = self.corners().map(|(a, b)| norm(&relative(a, b)));
        lengths.fold(0.0, f64::max)
    }

    /// σ_n, m.
    fn separation(&self, n: Vec3, t: f64) -> f64 {
        let along = self
            .corners()
            .map(|(a, b)| dot(&n, &sub(&a.at(t), &b.at(t))));
        along.fold(f64::INFINITY, f64::min)
    }

    /// How long n keeps the pieces apart from t on; nothing if it does not at t.
    fn free_way(&self, n: Vec3, t: f64, distance: f64) -> f64 {
        let mut way = f64::INFINITY;
        for (a, b) in self.corners() {
            let left = dot(&n, &sub(&a.at(t), &b.at(t))) - distance;
            if left <= 0.0 {
                return 0.0;
            }
            let speed = dot(&n, &relative(a, b));
            if speed < 0.0 {
                way = way.min(left / -speed);
            }
        }
        way
    }

    /// Direction from the closest point of the other piece to that of the first one.
    fn direction(&self, t: f64) -> Option<Vec3> {
        let places = |piece: &[Moving]| -> [Vec3; 3] {
            [0, 1, 2].map(|k| piece[k.min(piece.len() - 1)].at(t))
        };
        let (a, b) = (places(self.one), places(self.other));
        let between = match (self.one.len(), self.other.len()) {
            (1, 1) => sub(&a[0], &b[0]),
            (1, 2) => from_segment(&a[0], &b),
            (2, 1) => from_segment(&b[0], &a).map(|x| -x),
            (1, _) => from_triangle(&a[0], &b),
            (_, 1) => from_triangle(&b[0], &a).map(|x| -x),
            _ => between_segments(&a, &b),
        };
        unit(&between, self.size(t))
    }

    /// Normals of the triangle or of both edges.
    fn normals(&self, t: f64) -> impl Iterator<Item = Vec3> {
        let edge = |piece: &[Moving], k: usize| sub(&piece[k].at(t), &piece[0].at(t));
        let [one, other] = [self.one, self.other];
        let normal = match (one.len(), other.len()) {
            (3, _) => Some(cross(&edge(one, 1), &edge(one, 2))),
            (_, 3) => Some(cross(&edge(other, 1), &edge(other, 2))),
            (2, 2) => Some(cross(&edge(one, 1), &edge(other, 1))),
            _ => None,
        };
        let n = normal.and_then(|normal| unit(&normal, 0.0));
        n.into_iter().flat_map(|n| [n, n.map(|x| -x)])
    }

    /// Size of the differences of places, m.
    fn size(&self, t: f64) -> f64 {
        let lengths = self.corners().map(|(a, b)| norm(&sub(&a.at(t), &b.at(t))));
        lengths.fold(0.0, f64::max)
    }
}

fn relative(a: &Moving, b: &Moving) -> Vec3 {
    [0, 1, 2].map(|i| (a.end[i] - a.start[i]) - (b.end[i] - b.start[i]))
}

/// From the closest point of a segment to p.
fn from_segment(p: &Vec3, segment: &[Vec3; 3]) -> Vec3 {
    let [a, b] = [&segment[0], &segment[1]];
    let (along, from) = (sub(b, a), sub(p, a));
    let square = dot(&along, &along);
    let t = match square > 0.0 {
        true => (dot(&from, &along) / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    [0, 1, 2].map(|i| from[i] - t * along[i])
}

/// From the closest point of a triangle to p.
fn from_triangle(p: &Vec3, corners: &[Vec3; 3]) -> Vec3 {
    let [a, b, c] = corners;
    let normal = cross(&sub(b, a), &sub(c, a));
    let square = dot(&normal, &normal);
    let sides = [(a, b), (b, c), (c, a)];
    let inside = |(from, to): (&Vec3, &Vec3)| dot(&cross(&sub(to, from), &sub(p, from)), &normal);
    if square > 0.0 && sides.into_iter().all(|side| inside(side) >= 0.0) {
        let height = dot(&sub(p, a), &normal) / square;
        return normal.map(|x| height * x);
    }
    let ways = sides.map(|(from, to)| from_segment(p, &[*from, *to, *to]));
    let shorter = |one: Vec3, other: Vec3| match dot(&other, &other) < dot(&one, &one) {
        true => other,
        false => one,
    };
    shorter(shorter(ways[0], ways[1]), ways[2])
}

/// From the closest point of the second of two segments to that of the first.
fn between_segments(one: &[Vec3; 3], other: &[Vec3; 3]) -> Vec3 {
    let (d1, d2) = (sub(&one[1], &one[0]), sub(&other[1], &other[0]));
    let between = sub(&one[0], &other[0]);
    let (a, e, b) = (dot(&d1, &d1), dot(&d2, &d2), dot(&d1, &d2));
    let determinant = a * e - b * b;
    // inside both, unless they are parallel
    if determinant > 1e-14 * a * e {
        let (c, f) = (dot(&d1, &between), dot(&d2, &between));
        let (s, t) = ((b * f - c * e) / determinant, (a * f - b * c) / determinant);
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return [0, 1, 2].map(|i| between[i] + s * d1[i] - t * d2[i]);
        }
    }
    let ends = [
        from_segment(&one[0], other),
        from_segment(&one[1], other),
        from_segment(&other[0], one).map(|x| -x),
        from_segment(&other[1], one).map(|x| -x),
    ];
    ends.into_iter().fold([f64::INFINITY; 3], |least, way| {
        match dot(&way, &way) < dot(&least, &least) {
            true => way,
            false => least,
        }
    })
}

fn sub(a: &Vec3, b: &Vec3) -> Vec3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: &Vec3, b: &Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Vec3, b: &Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn norm(a: &Vec3) -> f64 {
    dot(a, a).sqrt()
}

fn unit(a: &Vec3, size: f64) -> Option<Vec3> {
    let length = norm(a);
    (length > ROUNDING * size && length > 0.0).then(|| a.map(|x| x / length))
}
