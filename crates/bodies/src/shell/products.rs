//! What strains of shells are sums of: products of ways between nodes, and of ways and axes of nodes.
//!
//! The ways v of a triangle are its edges from the first node, those of a quadrilateral g_r, g_s and x_h of x = x_m + r g_r + s g_s + r s x_h. Ways from the first node would do there too,
//! but two of them are long where the cell is wide, and a strain along its short sides would be a difference of their squares: rounding times the square of the ratio of the sides.

use carom_algebra::tensor::Vec3;

use super::section::{AtPoint, STRAINS};

/// Most nodes, and points of integration, of an element.
pub(super) const MOST: usize = 4;

/// Products v·v, and v·a for one of the axes, at most.
const PAIRS: usize = 6;
const WITH_AXIS: usize = 12;

/// Coefficients of the nodes of a quadrilateral in g_r, g_s and x_h; four times those of these in the places of the nodes.
pub(super) const ALONG_R: [f64; MOST] = [-0.25, 0.25, 0.25, -0.25];
pub(super) const ALONG_S: [f64; MOST] = [-0.25, -0.25, 0.25, 0.25];
pub(super) const CROSSED: [f64; MOST] = [0.25, -0.25, 0.25, -0.25];

/// Coefficients of the nodes in the ways.
pub(super) fn in_ways(nodes: usize) -> &'static [[f64; MOST]; MOST - 1] {
    const QUADRILATERAL: [[f64; MOST]; MOST - 1] = [ALONG_R, ALONG_S, CROSSED];
    const TRIANGLE: [[f64; MOST]; MOST - 1] =
        [[-1.0, 1.0, 0.0, 0.0], [-1.0, 0.0, 1.0, 0.0], [0.0; MOST]];
    match nodes {
        3 => &TRIANGLE,
        _ => &QUADRILATERAL,
    }
}

/// Coefficients of the ways in Σ a_i x_i, the sum of the coefficients zero.
fn over_ways(nodes: usize, a: &[f64; MOST]) -> [f64; MOST - 1] {
    match nodes {
        3 => [a[1], a[2], 0.0],
        _ => in_ways(nodes).map(|way| 4.0 * way.iter().zip(a).map(|(w, a)| w * a).sum::<f64>()),
    }
}

/// Places of the nodes, and their axes t₁, t₂, d.
#[derive(Clone, Copy, Debug)]
pub(super) struct Configuration {
    pub x: [Vec3; MOST],
    pub axes: [[Vec3; 3]; MOST],
}

impl Configuration {
    /// The same with places beside the nodes along the directors.
    pub(super) fn beside(&self, offset: f64) -> Configuration {
        let mut beside = *self;
        for (x, axes) in beside.x.iter_mut().zip(&self.axes) {
            *x += axes[DIRECTOR] * offset;
        }
        beside
    }

    /// The ways of an element.
    pub(super) fn ways(&self, nodes: usize) -> [Vec3; MOST - 1] {
        let [a, b, c, d] = &self.x;
        if nodes == 3 {
            return [b - a, c - a, Vec3::zeros()];
        }
        let (low, high) = (b - a, c - d);
        [
            (low + high) * 0.25,
            ((d - a) + (c - b)) * 0.25,
            (high - low) * 0.25,
        ]
    }

    /// Halfway between two.
    pub(super) fn mean(&self, other: &Configuration) -> Configuration {
        let mean = |a: &Vec3, b: &Vec3| (a + b) * 0.5;
        Configuration {
            x: std::array::from_fn(|a| mean(&self.x[a], &other.x[a])),
            axes: std::array::from_fn(|a| {
                std::array::from_fn(|i| mean(&self.axes[a][i], &other.axes[a][i]))
            }),
        }
    }
}

/// What is summed for one strain.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    pairs: [f64; PAIRS],
    axes: [[f64; WITH_AXIS]; 3],
}

/// The rows of a point without their zeros: membrane strains are sums of pairs, curvatures and shear of products with directors, the drilling
/// strain of products with both other axes.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    membrane: [[f64; PAIRS]; 3],
    director: [[f64; WITH_AXIS]; 5],
    drilling: [[f64; WITH_AXIS]; 2],
}

impl Rows {
    pub(super) fn new(rows: &[Row; STRAINS]) -> Rows {
        let [first, second, _] = rows[STRAINS - 1].axes;
        Rows {
            membrane: std::array::from_fn(|k| rows[k].pairs),
            director: std::array::from_fn(|k| rows[3 + k].axes[DIRECTOR]),
            drilling: [first, second],
        }
    }

    pub(super) fn values(&self, of: &Products) -> AtPoint {
        let mut values = [0.0; STRAINS];
        for (value, row) in values.iter_mut().zip(&self.membrane) {
            *value = sum(row, &of.pairs);
        }
        for (value, row) in values[3..].iter_mut().zip(&self.director) {
            *value = sum(row, &of.axes[DIRECTOR]);
        }
        for (row, axis) in self.drilling.iter().zip(&of.axes) {
            values[STRAINS - 1] += sum(row, axis);
        }
        values
    }

    /// Adds what acts on the products where these act on the strains.
    pub(super) fn add(&self, forces: &AtPoint, to: &mut Products) {
        for (force, row) in forces.iter().zip(&self.membrane) {
            add(*force, row, &mut to.pairs);
        }
        for (force, row) in forces[3..].iter().zip(&self.director) {
            add(*force, row, &mut to.axes[DIRECTOR]);
        }
        for (row, axis) in self.drilling.iter().zip(&mut to.axes) {
            add(forces[STRAINS - 1], row, axis);
        }
    }
}

fn sum<const N: usize>(row: &[f64; N], of: &[f64; N]) -> f64 {
    row.iter().zip(of).map(|(c, y)| c * y).sum()
}

fn add<const N: usize>(force: f64, row: &[f64; N], to: &mut [f64; N]) {
    for (to, c) in to.iter_mut().zip(row) {
        *to += force * c;
    }
}

/// Products of the vectors of an element, or what acts on them.
#[derive(Default)]
pub(super) struct Products {
    pub pairs: [f64; PAIRS],
    pub axes: [[f64; WITH_AXIS]; 3],
}

/// Place of v_i·v_j among the products.
pub(super) fn pair(i: usize, j: usize) -> usize {
    let (i, j) = (i.min(j), i.max(j));
    [[0, 1, 2], [1, 3, 4], [2, 4, 5]][i][j]
}

impl Row {
    pub(super) fn add(&mut self, factor: f64, other: &Row) {
        for (own, other) in self.pairs.iter_mut().zip(&other.pairs) {
            *own += factor * other;
        }
        for (own, other) in self
            .axes
            .iter_mut()
            .flatten()
            .zip(other.axes.iter().flatten())
        {
            *own += factor * other;
        }
    }

    pub(super) fn sum(rows: &[(f64, &Row)]) -> Row {
        let mut sum = Row::default();
        rows.iter().for_each(|(factor, row)| sum.add(*factor, row));
        sum
    }

    /// ½ (Σ a_i x_i)·(Σ b_j x_j), sums of coefficients zero.
    pub(super) fn half_metric(nodes: usize, a: &[f64; MOST], b: &[f64; MOST]) -> Row {
        let mut row = Row::default();
        let (a, b) = (over_ways(nodes, a), over_ways(nodes, b));
        for (i, a) in a.iter().enumerate() {
            for (j, b) in b.iter().enumerate() {
                row.pairs[pair(i, j)] += 0.5 * a * b;
            }
        }
        row
    }

    /// (Σ a_i x_i)·(Σ b_j axis_j), the sum of the first coefficients zero.
    pub(super) fn with_axis(
        nodes: usize,
        a: &[f64; MOST],
        (axis, b): (usize, &[f64; MOST]),
    ) -> Row {
        let mut row = Row::default();
        let a = over_ways(nodes, a);
        for (i, a) in a.iter().enumerate().take(nodes - 1) {
            for (j, b) in b.iter().enumerate().take(nodes) {
                row.axes[axis][i * nodes + j] += a * b;
            }
        }
        row
    }
}

/// The director among the axes.
pub(super) const DIRECTOR: usize = 2;

/// Derivative of the place with these derivatives of the shape functions.
pub(super) fn gradient(of: &Configuration, nodes: usize, by: &[f64; MOST]) -> Vec3 {
    (0..nodes).map(|a| of.x[a] * by[a]).sum()
}
