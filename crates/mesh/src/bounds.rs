//! Boxes with sides along the axes: around points, around faces.

use std::ops::Range;

use carom_elements::{Kind, MAX_FACE_NODES};

/// A box with sides along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: [f64; 3],
    /// Largest coordinates.
    pub max: [f64; 3],
}

impl Bounds {
    /// The box that holds nothing; a union with it is the other box.
    pub const EMPTY: Bounds = Bounds {
        min: [f64::INFINITY; 3],
        max: [f64::NEG_INFINITY; 3],
    };

    /// The smallest box around some points.
    #[inline]
    pub fn of(points: &[[f64; 3]]) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for x in points {
            for (i, &x) in x.iter().enumerate() {
                bounds.min[i] = smaller(bounds.min[i], x);
                bounds.max[i] = larger(bounds.max[i], x);
            }
        }
        bounds
    }

    /// A box around the whole of a face with these node positions, curved or not: around its Bézier points.
    ///
    /// A quadratic face bulges out of the box of its nodes, but not out of that of the coefficients of its Bernstein
    /// polynomials, which are positive and sum to one. Farin (2002).
    pub fn of_face(kind: Kind, nodes: &[[f64; 3]]) -> Bounds {
        // a straight face is in the box of its corners
        if matches!(kind, Kind::Point1 | Kind::Bar2 | Kind::Tri3 | Kind::Quad4) {
            return Bounds::of(nodes);
        }
        let mut points = [[0.0; 3]; MAX_FACE_NODES];
        let points = &mut points[..nodes.len()];
        points.copy_from_slice(nodes);
        bezier(kind, points);
        let mut bounds = Bounds::of(points);
        if kind == Kind::Quad8 {
            // the coefficient that belongs to the middle, for which there is no node
            let sum =
                |range: Range<usize>, i: usize| -> f64 { nodes[range].iter().map(|x| x[i]).sum() };
            let middle = [0, 1, 2].map(|i| sum(4..8, i) - 0.75 * sum(0..4, i));
            bounds = bounds.union(&Bounds::of(&[middle]));
        }
        bounds
    }

    /// The smallest box around two.
    #[inline]
    pub fn union(&self, other: &Bounds) -> Bounds {
        let mut both = *self;
        for i in 0..3 {
            both.min[i] = smaller(both.min[i], other.min[i]);
            both.max[i] = larger(both.max[i], other.max[i]);
        }
        both
    }

    /// The box moved outward by `margin` on every side, in m.
    pub fn widened(&self, margin: f64) -> Bounds {
        Bounds {
            min: self.min.map(|x| x - margin),
            max: self.max.map(|x| x + margin),
        }
    }

    /// Whether two boxes have a point in common, their boundaries included.
    pub fn overlaps(&self, other: &Bounds) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// Squared distance from a point to the box, in m²; zero inside.
    #[inline]
    pub fn distance_squared(&self, point: &[f64; 3]) -> f64 {
        (0..3)
            .map(|i| {
                let out = (self.min[i] - point[i]).max(point[i] - self.max[i]);
                out.max(0.0).powi(2)
            })
            .sum()
    }

    /// Distance of two boxes, m; zero where they have a point in common.
    pub fn apart(&self, other: &Bounds) -> f64 {
        let out = |i: usize| (self.min[i] - other.max[i]).max(other.min[i] - self.max[i]);
        (0..3).map(|i| out(i).max(0.0).powi(2)).sum::<f64>().sqrt()
    }

    /// Square of the largest distance of a place of the box from another one, m².
    #[inline]
    pub(crate) fn beyond_squared(&self, other: &Bounds) -> f64 {
        let beyond = |i: usize| {
            let out = larger(other.min[i] - self.min[i], self.max[i] - other.max[i]);
            larger(0.0, out).powi(2)
        };
        beyond(0) + beyond(1) + beyond(2)
    }

    /// Length of the diagonal, m.
    pub fn diagonal(&self) -> f64 {
        let side = |i: usize| (self.max[i] - self.min[i]).powi(2);
        (side(0) + side(1) + side(2)).sqrt()
    }

    /// The largest absolute value of a coordinate, m; zero for the empty box.
    #[inline]
    pub fn reach(&self) -> f64 {
        let ends = self.min.iter().chain(&self.max);
        ends.filter(|x| x.is_finite())
            .fold(0.0, |reach, x| reach.max(x.abs()))
    }

    pub(crate) fn centre(&self, axis: usize) -> f64 {
        0.5 * (self.min[axis] + self.max[axis])
    }
}

/// The smaller of two numbers, the first where the second is none, in one operation: [`f64::min`] looks at both.
#[inline(always)]
pub(crate) fn smaller<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

/// The larger of two numbers, the first where the second is none, in one operation.
#[inline(always)]
pub(crate) fn larger<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// The largest absolute value of a coordinate, m.
#[inline]
pub(crate) fn size(x: &[f64; 3]) -> f64 {
    x[0].abs().max(x[1].abs()).max(x[2].abs())
}

/// Replaces the nodes between the corners of a quadratic face by the coefficients of its Bernstein polynomials.
fn bezier(kind: Kind, points: &mut [[f64; 3]]) {
    const LINE: [[usize; 3]; 1] = [[0, 1, 2]];
    const TRIANGLE: [[usize; 3]; 3] = [[0, 1, 3], [1, 2, 4], [2, 0, 5]];
    const SQUARE: [[usize; 3]; 4] = [[0, 1, 4], [1, 2, 5], [2, 3, 6], [3, 0, 7]];
    let edges: &[[usize; 3]] = match kind {
        Kind::Bar3 => &LINE,
        Kind::Tri6 => &TRIANGLE,
        Kind::Quad8 | Kind::Quad9 => &SQUARE,
        _ => &[],
    };
    let mean = |a: &[f64; 3], b: &[f64; 3]| [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
    if kind == Kind::Quad9 {
        // along ξ in the middle row, then along η in the middle column
        let rows = [[3, 2, 6], [0, 1, 4]]
            .map(|[a, b, m]| beyond(&points[m], &mean(&points[a], &points[b])));
        let row = beyond(&points[8], &mean(&points[5], &points[7]));
        points[8] = beyond(&row, &mean(&rows[0], &rows[1]));
    }
    for &[a, b, m] in edges {
        points[m] = beyond(&points[m], &mean(&points[a], &points[b]));
    }
}

/// The coefficient of 2 t (1 - t) of a parabola through `middle` whose ends have this mean.
fn beyond(middle: &[f64; 3], ends: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| 2.0 * middle[i] - ends[i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_box_of_a_face_holds_all_of_it_and_no_more_if_it_is_straight() {
        let mut random = Random::new(5);
        for kind in [
            Kind::Bar2,
            Kind::Bar3,
            Kind::Tri3,
            Kind::Tri6,
            Kind::Quad4,
            Kind::Quad8,
            Kind::Quad9,
        ] {
            let table = kind.table();
            for _ in 0..100 {
                let x: Vec<[f64; 3]> = (0..table.nodes).map(|_| random.point(1.0)).collect();
                let bounds = Bounds::of_face(kind, &x).widened(1e-13);
                for _ in 0..200 {
                    let xi = random.point(1.0);
                    if (table.contains)(&xi, 0.0) {
                        let mut n = vec![0.0; table.nodes];
                        (table.shape)(&xi, &mut n);
                        let point = carom_elements::map::point(&x, &n);
                        assert_eq!(bounds.distance_squared(&point), 0.0, "{kind:?}");
                    }
                }
            }
            // a straight face is in the box of its corners
            let flat = Bounds::of_face(kind, table.reference);
            assert_eq!(flat, Bounds::of(table.reference), "{kind:?}");
        }
    }
}
