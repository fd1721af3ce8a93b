//! Strains of shell elements as products of the places and the axes of their nodes.
//!
//! Covariant strains of the middle surface x(ξ) = Σ N_a x_a with the director d(ξ) = Σ N_a d_a are
//!
//! e_αβ = ½ (x,α·x,β - X,α·X,β), κ_αβ = ½ (x,α·d,β + x,β·d,α - …), γ_α = x,α·d - X,α·D,
//!
//! and the drilling strain is ½ (x,₁·t₂ - x,₂·t₁) less its value at the start, with the axes t₁, t₂ that turn with the nodes. All are bilinear in
//! places and axes, as are the ones that replace them:
//! shear and membrane strains that do not lock, from [`tying`](super::tying).
//!
//! A strain is therefore Σ c v_i·v_j + Σ c' v_i·a_j, with v_i = x_(i+1) - x_0 and the axes a. The element keeps c and c'.

use carom_algebra::tensor::{Mat3, Vec3};

use super::section::{AtPoint, STRAINS};
use super::tying;

/// Most nodes, and points of integration, of an element.
pub(super) const MOST: usize = 4;

/// Products v·v, and v·a for one of the axes, at most.
const PAIRS: usize = 6;
const WITH_AXIS: usize = 12;

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

/// Strains at all points of an element.
pub(super) type Strains = [AtPoint; MOST];

/// Derivatives of a strain by the place and by the rotation of each node.
pub(super) type Gradient = [[Vec3; 2]; MOST];

/// Takes the block of two unknowns of nodes: the node, and 0 for its place or 1 for its rotation.
pub(super) type AddBlock<'a> = dyn FnMut([(usize, usize); 2], &Mat3) + 'a;

/// What is summed for one strain.
#[derive(Clone, Debug, Default)]
pub(super) struct Row {
    pairs: [f64; PAIRS],
    axes: [[f64; WITH_AXIS]; 3],
}

/// The rows of a point without their zeros: membrane strains are sums of pairs, curvatures and shear of products with directors, the drilling
/// strain of products with both other axes.
#[derive(Clone, Debug)]
struct Rows {
    membrane: [[f64; PAIRS]; 3],
    director: [[f64; WITH_AXIS]; 5],
    drilling: [[f64; WITH_AXIS]; 2],
}

impl Rows {
    fn new(rows: &[Row; STRAINS]) -> Rows {
        let [first, second, _] = rows[STRAINS - 1].axes;
        Rows {
            membrane: std::array::from_fn(|k| rows[k].pairs),
            director: std::array::from_fn(|k| rows[3 + k].axes[DIRECTOR]),
            drilling: [first, second],
        }
    }

    fn values(&self, of: &Products) -> AtPoint {
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
    fn add(&self, forces: &AtPoint, to: &mut Products) {
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
struct Products {
    pairs: [f64; PAIRS],
    axes: [[f64; WITH_AXIS]; 3],
}

/// The strains of an element.
#[derive(Debug)]
pub(super) struct Form {
    nodes: usize,
    rows: Vec<Rows>,
    /// Area of each point, m².
    pub areas: Vec<f64>,
    /// Derivatives of the shape functions at each point by the lengths along its two axes in the reference configuration.
    by: Vec<[[f64; MOST]; 2]>,
    /// Shape functions at each point.
    pub shapes: Vec<[f64; MOST]>,
    /// Sums in the reference configuration.
    start: Strains,
}

/// Place of v_i·v_j among the products.
fn pair(i: usize, j: usize) -> usize {
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
        for i in 1..nodes {
            for j in 1..nodes {
                row.pairs[pair(i - 1, j - 1)] += 0.5 * a[i] * b[j];
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
        for i in 1..nodes {
            for j in 0..nodes {
                row.axes[axis][(i - 1) * nodes + j] += a[i] * b[j];
            }
        }
        row
    }
}

/// The director among the axes.
pub(super) const DIRECTOR: usize = 2;

impl Form {
    /// The strains of an element in its reference configuration; `along`: the direction of the first axis.
    pub(super) fn new(nodes: usize, reference: &Configuration, along: &Vec3) -> Form {
        let mut form = Form {
            nodes,
            rows: Vec::new(),
            areas: Vec::new(),
            by: Vec::new(),
            shapes: Vec::new(),
            start: Strains::default(),
        };
        for point in tying::points(nodes, reference, along) {
            form.rows.push(Rows::new(&point.rows));
            form.areas.push(point.area);
            form.by.push(point.by);
            form.shapes.push(point.shapes);
        }
        form.start = form.sums(reference);
        form
    }

    /// Derivatives of the place by the lengths along both axes of a point.
    pub(super) fn tangents(&self, of: &Configuration, point: usize) -> [Vec3; 2] {
        self.by[point].map(|by| gradient(of, self.nodes, &by))
    }

    /// Strains of a configuration.
    pub(super) fn strains(&self, of: &Configuration) -> Strains {
        let mut strains = self.sums(of);
        for (strains, start) in strains
            .iter_mut()
            .flatten()
            .zip(self.start.iter().flatten())
        {
            *strains -= start;
        }
        strains
    }

    fn sums(&self, of: &Configuration) -> Strains {
        let products = self.products(of);
        let mut sums = Strains::default();
        for (sums, rows) in sums.iter_mut().zip(&self.rows) {
            *sums = rows.values(&products);
        }
        sums
    }

    fn ways(&self, of: &Configuration) -> [Vec3; MOST - 1] {
        std::array::from_fn(|i| of.x[i + 1] - of.x[0])
    }

    fn products(&self, of: &Configuration) -> Products {
        let (v, n) = (self.ways(of), self.nodes);
        let mut products = Products::default();
        for i in 0..n - 1 {
            for j in i..n - 1 {
                products.pairs[pair(i, j)] = v[i].dot(&v[j]);
            }
            for j in 0..n {
                for (axis, products) in products.axes.iter_mut().enumerate() {
                    products[i * n + j] = v[i].dot(&of.axes[j][axis]);
                }
            }
        }
        products
    }

    /// What acts on the products where these act on the strains of the points.
    fn on_products(&self, forces: &Strains) -> Products {
        let mut sum = Products::default();
        for (forces, rows) in forces.iter().zip(&self.rows) {
            rows.add(forces, &mut sum);
        }
        sum
    }

    /// Derivative by places and rotations of Σ forces · strains.
    pub(super) fn gradient(&self, of: &Configuration, forces: &Strains) -> Gradient {
        self.gradient_of(of, &self.on_products(forces))
    }

    fn gradient_of(&self, of: &Configuration, by: &Products) -> Gradient {
        let (v, n) = (self.ways(of), self.nodes);
        let mut on_ways = [Vec3::zeros(); MOST - 1];
        let mut found = [[Vec3::zeros(); 2]; MOST];
        for i in 0..n - 1 {
            for j in i..n - 1 {
                let by = by.pairs[pair(i, j)];
                on_ways[i] += v[j] * by;
                on_ways[j] += v[i] * by;
            }
            for j in 0..n {
                let mut on_axis = Vec3::zeros();
                for (axis, by) in by.axes.iter().enumerate() {
                    let axis = &of.axes[j][axis];
                    on_ways[i] += axis * by[i * n + j];
                    // a changes by ω × a
                    on_axis += axis.cross(&v[i]) * by[i * n + j];
                }
                found[j][1] += on_axis;
            }
        }
        for (i, force) in on_ways.iter().enumerate().take(n - 1) {
            found[i + 1][0] += force;
            found[0][0] -= force;
        }
        found
    }

    /// Derivatives of the strains of a point.
    pub(super) fn derivatives(&self, of: &Configuration, point: usize) -> [Gradient; STRAINS] {
        std::array::from_fn(|k| {
            let (mut unit, mut by) = ([0.0; STRAINS], Products::default());
            unit[k] = 1.0;
            self.rows[point].add(&unit, &mut by);
            self.gradient_of(of, &by)
        })
    }

    /// Symmetric second derivative by places and rotations of Σ forces · strains: calls `add` with the nodes, the parts (0 place, 1
    /// rotation) and the block.
    pub(super) fn curvature(&self, of: &Configuration, forces: &Strains, add: &mut AddBlock) {
        let (v, n, by) = (self.ways(of), self.nodes, self.on_products(forces));
        // a way is the difference of two places
        let mut on_ways = |i: usize, other: (usize, usize), block: &Mat3| {
            add([(i + 1, 0), other], block);
            add([(0, 0), other], &-block);
        };
        for i in 0..n - 1 {
            for j in 0..n - 1 {
                let twice = if i == j { 2.0 } else { 1.0 };
                let block = Mat3::identity() * (twice * by.pairs[pair(i, j)]);
                on_ways(i, (j + 1, 0), &block);
                on_ways(i, (0, 0), &-block);
            }
        }
        for j in 0..n {
            let mut turning = Mat3::zeros();
            for i in 0..n - 1 {
                let mut mixed = Mat3::zeros();
                for (axis, by) in by.axes.iter().enumerate() {
                    let (axis, by) = (&of.axes[j][axis], by[i * n + j]);
                    mixed -= axis.cross_matrix() * by;
                    let outer = axis * v[i].transpose();
                    turning += ((outer + outer.transpose()) * 0.5
                        - Mat3::identity() * axis.dot(&v[i]))
                        * by;
                }
                for (node, sign) in [(i + 1, 1.0), (0, -1.0)] {
                    add([(node, 0), (j, 1)], &(mixed * sign));
                    add([(j, 1), (node, 0)], &(mixed.transpose() * sign));
                }
            }
            add([(j, 1), (j, 1)], &turning);
        }
    }
}

pub(super) fn gradient(of: &Configuration, nodes: usize, by: &[f64; MOST]) -> Vec3 {
    (0..nodes).map(|a| of.x[a] * by[a]).sum()
}
