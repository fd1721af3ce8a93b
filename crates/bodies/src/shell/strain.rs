//! Strains of shell elements as products of the places and the axes of their nodes.
//!
//! Covariant strains of the middle surface x(ξ) = Σ N_a x_a with the director d(ξ) = Σ N_a d_a are
//!
//! e_αβ = ½ (x,α·x,β - X,α·X,β), κ_αβ = ½ (x,α·d,β + x,β·d,α - …), γ_α = x,α·d - X,α·D,
//!
//! and the drilling strain is ½ (x,₁·t₂ - x,₂·t₁) less its value at the start, with the axes t₁, t₂ that turn with the nodes. All are bilinear in
//! places and axes, as are the values that replace them:
//!
//! * shear of quadrilaterals: constant along an edge direction, linear across (MITC4; Dvorkin and Bathe 1984, Eng. Comput. 1, 77);
//! * membrane strains of quadrilaterals: from five points, so that a warped element that bends does not stretch (MITC4+; Ko, Lee and
//!   Bathe 2017, Comput. Struct. 182, 404). With X_r, X_s, X_d the vectors of x = x₀ + r x_r + s x_s + rs x_d, and X_d = c_r X_r +
//!   c_s X_s in the plane of both, the strain ½ |x_d|² is replaced by c_r x_r·x_d + c_s x_s·x_d - ½ |c_r x_r + c_s x_s|²: equal in a
//!   flat element, and without the part of x_d across it;
//! * shear of triangles: MITC3 (Lee and Bathe 2004, Comput. Struct. 82, 945).
//!
//! A strain is therefore Σ c v_i·v_j + Σ c' v_i·a_j, with v_i = x_(i+1) - x_0 and the axes a. The element keeps c and c'.

use carom_algebra::tensor::{Mat3, Vec3};

use super::section::{AtPoint, STRAINS};

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

/// What is summed for one strain.
#[derive(Clone, Debug, Default)]
struct Row {
    pairs: [f64; PAIRS],
    axes: [[f64; WITH_AXIS]; 3],
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
    rows: Vec<[Row; STRAINS]>,
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

/// Shape functions and their derivatives by r and s.
struct Shapes {
    n: [f64; MOST],
    by: [[f64; MOST]; 2],
}

fn shapes(nodes: usize, [r, s]: [f64; 2]) -> Shapes {
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

impl Row {
    fn add(&mut self, factor: f64, other: &Row) {
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

    fn sum(rows: &[(f64, &Row)]) -> Row {
        let mut sum = Row::default();
        rows.iter().for_each(|(factor, row)| sum.add(*factor, row));
        sum
    }

    /// ½ (Σ a_i x_i)·(Σ b_j x_j), sums of coefficients zero.
    fn half_metric(nodes: usize, a: &[f64; MOST], b: &[f64; MOST]) -> Row {
        let mut row = Row::default();
        for i in 1..nodes {
            for j in 1..nodes {
                row.pairs[pair(i - 1, j - 1)] += 0.5 * a[i] * b[j];
            }
        }
        row
    }

    /// (Σ a_i x_i)·(Σ b_j axis_j), the sum of the first coefficients zero.
    fn with_axis(nodes: usize, a: &[f64; MOST], (axis, b): (usize, &[f64; MOST])) -> Row {
        let mut row = Row::default();
        for i in 1..nodes {
            for j in 0..nodes {
                row.axes[axis][(i - 1) * nodes + j] += a[i] * b[j];
            }
        }
        row
    }

    fn value(&self, of: &Products) -> f64 {
        let pairs: f64 = self.pairs.iter().zip(&of.pairs).map(|(c, y)| c * y).sum();
        let axes = self.axes.iter().flatten().zip(of.axes.iter().flatten());
        pairs + axes.map(|(c, y)| c * y).sum::<f64>()
    }
}

const DIRECTOR: usize = 2;

/// The covariant strains at a point: membrane rr, ss, rs; shear r, s.
struct Covariant {
    membrane: [Row; 3],
    shear: [Row; 2],
}

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
        for (point, weight) in rule(nodes) {
            let at = shapes(nodes, point);
            let tangents = at.by.map(|by| gradient(reference, nodes, &by));
            let normal = tangents[0].cross(&tangents[1]);
            let (area, normal) = (normal.norm(), normal.normalize());
            let first = (along - normal * normal.dot(along)).normalize();
            let second = normal.cross(&first);
            // derivatives by the lengths along both axes, from those by r and s
            let [r, s] = tangents.map(|tangent| [tangent.dot(&first), tangent.dot(&second)]);
            let to = [[s[1] / area, -r[1] / area], [-s[0] / area, r[0] / area]];
            let covariant = match nodes {
                3 => triangle(point),
                _ => quadrilateral(reference, point),
            };
            let by = [0, 1].map(|i: usize| {
                std::array::from_fn(|a| to[i][0] * at.by[0][a] + to[i][1] * at.by[1][a])
            });
            form.rows.push(local(nodes, (&at.n, &by), &covariant, &to));
            form.areas.push(area * weight);
            form.by.push(by);
            form.shapes.push(at.n);
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
            for (sum, row) in sums.iter_mut().zip(rows) {
                *sum = row.value(&products);
            }
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
        let mut sum = Row::default();
        for (forces, rows) in forces.iter().zip(&self.rows) {
            for (force, row) in forces.iter().zip(rows) {
                sum.add(*force, row);
            }
        }
        Products {
            pairs: sum.pairs,
            axes: sum.axes,
        }
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
            let row = &self.rows[point][k];
            let by = Products {
                pairs: row.pairs,
                axes: row.axes,
            };
            self.gradient_of(of, &by)
        })
    }

    /// Symmetric second derivative by places and rotations of Σ forces · strains: calls `add` with the nodes, the parts (0 place, 1
    /// rotation) and the block.
    pub(super) fn curvature(
        &self,
        of: &Configuration,
        forces: &Strains,
        add: &mut dyn FnMut([(usize, usize); 2], &Mat3),
    ) {
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

fn gradient(of: &Configuration, nodes: usize, by: &[f64; MOST]) -> Vec3 {
    (0..nodes).map(|a| of.x[a] * by[a]).sum()
}

/// Strains in the axes of a point from covariant ones; `to`: derivatives along both axes from those by r and s.
fn local(
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
fn shear_at(nodes: usize, place: [f64; 2], along: usize) -> Row {
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

fn quadrilateral(reference: &Configuration, [r, s]: [f64; 2]) -> Covariant {
    let metric = |place: [f64; 2], i: usize, j: usize| {
        let by = shapes(4, place).by;
        Row::half_metric(4, &by[i], &by[j])
    };
    let (a, b) = (metric([0.0, 1.0], 0, 0), metric([0.0, -1.0], 0, 0));
    let (c, d) = (metric([1.0, 0.0], 1, 1), metric([-1.0, 0.0], 1, 1));
    let e = metric([0.0, 0.0], 0, 1);
    let [c_r, c_s] = twist(reference);
    let whole = c_r * c_r + c_s * c_s - 1.0;
    // the strain ½ |x_d|² from those of the five points
    let half = |c: f64| (0.5 * c * (c - 1.0) / whole, 0.5 * c * (c + 1.0) / whole);
    let ((at_a, at_b), (at_c, at_d)) = (half(c_r), half(c_s));
    let of_twist = Row::sum(&[
        (at_a, &a),
        (at_b, &b),
        (at_c, &c),
        (at_d, &d),
        (2.0 * c_r * c_s / whole, &e),
    ]);
    let across = |x: f64, plus: &Row, minus: &Row| {
        Row::sum(&[
            (0.5 * (1.0 + x), plus),
            (0.5 * (1.0 - x), minus),
            (x * x - 1.0, &of_twist),
        ])
    };
    let both = Row::sum(&[
        (1.0, &e),
        (0.25 * r, &a),
        (-0.25 * r, &b),
        (0.25 * s, &c),
        (-0.25 * s, &d),
        (r * s, &of_twist),
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

/// c_r and c_s of X_d = c_r X_r + c_s X_s + its part across both.
fn twist(reference: &Configuration) -> [f64; 2] {
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
