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
//! A strain is therefore Σ c v_i·v_j + Σ c' v_i·a_j, with the ways v of [`products`](super::products) and the axes a. The element keeps c and c'.

use carom_algebra::tensor::{Mat3, Vec3};

use super::one_point::Centre;
use super::products::{Configuration, MOST, Products, Rows, gradient, in_ways, pair};
use super::section::{AtPoint, STRAINS};
use super::tying;

/// Strains at all points of an element.
pub(super) type Strains = [AtPoint; MOST];

/// Derivatives of a strain by the place and by the rotation of each node.
pub(super) type Gradient = [[Vec3; 2]; MOST];

/// Takes the block of two unknowns of nodes: the node, and 0 for its place or 1 for its rotation.
pub(super) type AddBlock<'a> = dyn FnMut([(usize, usize); 2], &Mat3) + 'a;

/// The strains of an element.
#[derive(Debug)]
pub(super) struct Form {
    nodes: usize,
    /// Of the points; with one point, more that have energy follow.
    rows: Vec<Rows>,
    /// Area of each point, m².
    pub areas: Vec<f64>,
    /// Derivatives of the shape functions at each point by the lengths along its two axes in the reference configuration.
    by: Vec<[[f64; MOST]; 2]>,
    /// Shape functions at each point of the mass, and its area, m².
    pub shapes: Vec<[f64; MOST]>,
    pub inert: Vec<f64>,
    /// Sums in the reference configuration.
    pub start: Strains,
}

impl Form {
    /// The strains of an element in its reference configuration; `along`: the direction of the first axis; `delta`: weights of the internal
    /// work at its nodes.
    pub(super) fn new(
        nodes: usize,
        reference: &Configuration,
        along: &Vec3,
        delta: &[f64; MOST],
    ) -> Form {
        let mut form = Form {
            nodes,
            rows: Vec::new(),
            areas: Vec::new(),
            by: Vec::new(),
            shapes: Vec::new(),
            inert: Vec::new(),
            start: Strains::default(),
        };
        for point in tying::points(nodes, reference, along, delta) {
            form.rows.push(Rows::new(&point.rows));
            form.areas.push(point.area);
            form.by.push(point.by);
            form.shapes.push(point.shapes);
            form.inert.push(point.area);
        }
        form.start = form.sums(reference);
        form
    }

    /// The same with one point.
    pub(super) fn with_one_point(self, reference: &Configuration, centre: &Centre) -> Form {
        let (point, rest) = centre.rows();
        let mut form = Form {
            rows: std::iter::once(Rows::new(&point.rows))
                .chain(rest)
                .collect(),
            areas: vec![point.area],
            by: vec![point.by],
            ..self
        };
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

    fn products(&self, of: &Configuration) -> Products {
        let (v, n) = (of.ways(self.nodes), self.nodes);
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

    /// Derivative of the strains at a configuration along a change of its places and axes.
    pub(super) fn changes(&self, of: &Configuration, by: &Configuration) -> Strains {
        let (v, dv, n) = (of.ways(self.nodes), by.ways(self.nodes), self.nodes);
        let mut products = Products::default();
        for i in 0..n - 1 {
            for j in i..n - 1 {
                products.pairs[pair(i, j)] = v[i].dot(&dv[j]) + dv[i].dot(&v[j]);
            }
            for j in 0..n {
                for (axis, products) in products.axes.iter_mut().enumerate() {
                    products[i * n + j] =
                        dv[i].dot(&of.axes[j][axis]) + v[i].dot(&by.axes[j][axis]);
                }
            }
        }
        let mut changes = Strains::default();
        for (changes, rows) in changes.iter_mut().zip(&self.rows) {
            *changes = rows.values(&products);
        }
        changes
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
        let (v, n) = (of.ways(self.nodes), self.nodes);
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
        for (force, way) in on_ways.iter().zip(in_ways(n)) {
            for (found, part) in found.iter_mut().zip(way) {
                found[0] += force * *part;
            }
        }
        found
    }

    /// Derivatives of the strains of a point, or of a list that follows.
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
        let (v, n, by) = (of.ways(self.nodes), self.nodes, self.on_products(forces));
        let parts = in_ways(n);
        let (mut straight, mut turning) = ([[0.0; MOST]; MOST], [Mat3::zeros(); MOST]);
        let mut mixed = [[Mat3::zeros(); MOST]; MOST];
        for i in 0..n - 1 {
            for j in 0..n - 1 {
                let twice = if i == j { 2.0 } else { 1.0 };
                let by = twice * by.pairs[pair(i, j)];
                for (straight, a) in straight.iter_mut().zip(&parts[i]) {
                    for (straight, b) in straight.iter_mut().zip(&parts[j]) {
                        *straight += a * b * by;
                    }
                }
            }
            for j in 0..n {
                let mut of_way = Mat3::zeros();
                for (axis, by) in by.axes.iter().enumerate() {
                    let (axis, by) = (&of.axes[j][axis], by[i * n + j]);
                    of_way -= axis.cross_matrix() * by;
                    let outer = axis * v[i].transpose();
                    turning[j] += ((outer + outer.transpose()) * 0.5
                        - Mat3::identity() * axis.dot(&v[i]))
                        * by;
                }
                for (mixed, a) in mixed.iter_mut().zip(&parts[i]) {
                    mixed[j] += of_way * *a;
                }
            }
        }
        for a in 0..n {
            add([(a, 1), (a, 1)], &turning[a]);
            for b in 0..n {
                add([(a, 0), (b, 0)], &(Mat3::identity() * straight[a][b]));
                add([(a, 0), (b, 1)], &mixed[a][b]);
                add([(b, 1), (a, 0)], &mixed[a][b].transpose());
            }
        }
    }
}
