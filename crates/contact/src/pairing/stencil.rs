//! A point of the secondary surface and its closest point on what it faces.
//!
//! With s_a the shape functions in the point, N_b those of the face at the foot ξ, τ_α = ∂y/∂ξ_α its tangents, n its
//! normal, r = x₁ - y(ξ):
//!
//! ```text
//! g = n · r,      r̂(δ) = Σ s_a δx_a - Σ N_b δx_b,      N(δ) = n · r̂(δ) - ρ^α S_α(δ)
//! ```
//!
//! with S_α = n·δτ_α and ρ^α = τ^α·r, the overhang, which is zero unless the foot is held at the rim of the face. The
//! coordinates of the foot follow from r·τ_k = 0 along the directions e_k in which it is free: two inside a face, one on
//! an edge, none in a corner. The second derivative collects the change of the normal, of the foot and of the shape
//! functions in it:
//!
//! ```text
//! g″ = - S_α ⊙ (τ^α·δr - ρ^β τ^α·δτ_β) - g a^{αβ} S_α S_β - E_k ⊙ ξ_k - h_kl ξ_k ξ_l - ρ^α (n·y_αk) ξ″_k
//! E_k = n · Σ (N_b,k + ρ^α N_b,αk) δx_b,      h_kl = n · (y_kl + ρ^α y_αkl),      a ⊙ b = a bᵀ + b aᵀ
//! ```
//!
//! where δr and δτ_α contain the motion of the foot, ξ_k = ∂ξ_k/∂u. Derived here; for a free foot (ρ = 0) it is the
//! second variation of the gap in Wriggers, Computational Contact Mechanics (2006), chapter 4, and Laursen, Computational
//! Contact and Impact Mechanics (2002), chapter 5, whose texts were not at hand.

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Vec3;
use carom_elements::{Element, MAX_FACE_NODES as NODES, map};
use carom_mesh::{Face, Projection};

use crate::sight::View;
use crate::{Contact, Places, Point, Rows, Search, Target};

/// The largest number of unknowns of a stencil.
const UNKNOWNS: usize = 6 * NODES;

/// A point, its gap, and what is at the other end of it.
#[derive(Clone, Debug)]
pub(crate) struct Stencil {
    point: Point,
    gap: f64,
    normal: [f64; 3],
    foot: Foot,
}

#[derive(Clone, Debug)]
// One pool of entries of one size; those on faces are the rule.
#[allow(clippy::large_enum_variant)]
enum Foot {
    /// On a face that moves.
    Face(Foothold),
    /// On an obstacle.
    Obstacle {
        /// Second derivative of the gap by the place of the point, 1/m.
        hessian: [[f64; 3]; 3],
        /// Velocity of the obstacle's particle there, m/s.
        velocity: [f64; 3],
    },
}

/// A foot on a face.
#[derive(Clone, Debug)]
struct Foothold {
    face: Face,
    /// Positions of its nodes, m.
    x: [[f64; 3]; NODES],
    /// Coordinates of the foot in the reference cell.
    xi: [f64; 3],
    /// From the foot to the point, m.
    r: [f64; 3],
    /// Whether r is normal to the face.
    inside: bool,
}

impl Stencil {
    /// The stencil of a point of a contact, `None` where it faces nothing. `search` is that of these places; `view`:
    /// what it sees of a surface.
    pub fn new(
        contact: &Contact,
        places: &Places,
        search: &mut Search,
        (point, view): (&Point, Option<View>),
    ) -> Option<Stencil> {
        let x = point.place(places);
        match &contact.target {
            Target::Rigid(obstacle) => {
                let placed = obstacle.at(places.time);
                let found = placed.distance(&x);
                if found.gap == f64::INFINITY {
                    return None;
                }
                Some(Stencil {
                    point: *point,
                    gap: found.gap,
                    normal: found.normal,
                    foot: Foot::Obstacle {
                        hessian: found.hessian,
                        velocity: placed.velocity(&x),
                    },
                })
            }
            Target::Surface(faces) => {
                let (foot, face) = search.facing(places, faces, view, &x)?;
                Some(Stencil::on_face(places, point, &x, &foot, face))
            }
        }
    }

    /// The stencil of a point at `x` whose closest point on a face is known.
    pub fn on_face(
        places: &Places,
        point: &Point,
        x: &[f64; 3],
        foot: &Projection,
        face: &Face,
    ) -> Stencil {
        let mut positions = [[0.0; 3]; NODES];
        for (position, &node) in positions.iter_mut().zip(face.corners()) {
            *position = places.of(node);
        }
        Stencil {
            point: *point,
            gap: foot.gap,
            normal: foot.normal,
            foot: Foot::Face(Foothold {
                face: *face,
                x: positions,
                xi: foot.xi,
                r: [0, 1, 2].map(|i| x[i] - foot.point[i]),
                inside: foot.inside,
            }),
        }
    }

    /// Appends gap and rows.
    pub fn push(&self, dim: usize, rows: &mut Rows, tangents: &mut [Rows; 2]) {
        rows.push(self.gap, self.normal);
        rows.set_rate(self.rate(&self.normal));
        self.each_normal(|node, direction| rows.add_node(dim, node, &direction));
        let frame = tangent_vectors(&self.normal, dim);
        for (rows, t) in tangents.iter_mut().zip(&frame[..dim - 1]) {
            rows.push(0.0, *t);
            rows.set_rate(self.rate(t));
            self.each_along(t, |node, direction| rows.add_node(dim, node, &direction));
        }
    }

    /// Rate at which the obstacle's motion carries the point off along a direction, m/s.
    pub fn rate(&self, direction: &[f64; 3]) -> f64 {
        match &self.foot {
            Foot::Face(_) => 0.0,
            Foot::Obstacle { velocity, .. } => {
                -(0..3).map(|i| direction[i] * velocity[i]).sum::<f64>()
            }
        }
    }

    /// The gap in m and the unit normal.
    pub fn gap(&self) -> (f64, [f64; 3]) {
        (self.gap, self.normal)
    }

    /// The blocks of the row N: nodes and derivatives of the gap by their places.
    pub fn each_normal(&self, mut each: impl FnMut(u32, [f64; 3])) {
        match &self.foot {
            Foot::Face(foot) if !foot.inside && foot.dim() > 0 => {
                let shape = Shape::new(self, foot);
                let row = shape.row();
                for (node, block) in self.nodes().zip(row) {
                    each(node, block.into());
                }
            }
            _ => self.each_along(&self.normal, each),
        }
    }

    /// The blocks of the relative motion along a fixed direction, at a foot that keeps its coordinates.
    pub fn each_along(&self, direction: &[f64; 3], mut each: impl FnMut(u32, [f64; 3])) {
        for (node, n) in self.point.carriers() {
            each(node, direction.map(|m| n * m));
        }
        if let Foot::Face(foot) = &self.foot {
            let nodes = foot.face.corners();
            let mut shape = [0.0; NODES];
            (foot.element().shape)(&foot.xi, &mut shape[..nodes.len()]);
            for (&node, n) in nodes.iter().zip(shape) {
                each(node, direction.map(|m| -n * m));
            }
        }
    }

    /// Nodes of the point, then those of the face.
    fn nodes(&self) -> impl Iterator<Item = u32> + '_ {
        let primary = match &self.foot {
            Foot::Face(foot) => foot.face.corners(),
            Foot::Obstacle { .. } => &[],
        };
        let secondary = self.point.carriers().map(|(node, _)| node);
        secondary.chain(primary.iter().copied())
    }

    /// The unknowns of the stencil's nodes and how many they are.
    pub fn unknowns(&self, dim: usize) -> ([u32; UNKNOWNS], usize) {
        let (mut unknowns, mut n) = ([0; UNKNOWNS], 0);
        for node in self.nodes() {
            for i in 0..dim {
                unknowns[n] = (dim as u32) * node + i as u32;
                n += 1;
            }
        }
        (unknowns, n)
    }

    /// Adds factor · ∂²g/∂u².
    pub fn add_curvature(&self, dim: usize, factor: f64, matrix: &mut Csr) {
        let mut block = Block {
            dim,
            factor,
            n: self.nodes().count() * dim,
            entries: [0.0; UNKNOWNS * UNKNOWNS],
        };
        match &self.foot {
            Foot::Face(foot) if foot.dim() == 0 => return,
            Foot::Face(foot) => Shape::new(self, foot).curvature(&mut block),
            Foot::Obstacle { hessian, .. } => self.obstacle_curvature(hessian, &mut block),
        }
        let (unknowns, n) = self.unknowns(dim);
        matrix.add_block(&unknowns[..n], &block.entries[..n * n]);
    }

    fn obstacle_curvature(&self, hessian: &[[f64; 3]; 3], block: &mut Block) {
        let (n, dim) = (block.n, block.dim);
        for (a, (_, s)) in self.point.carriers().enumerate() {
            for (b, (_, t)) in self.point.carriers().enumerate() {
                for i in 0..dim {
                    for j in 0..dim {
                        let entry = block.factor * s * t * hessian[i][j];
                        block.entries[(dim * a + i) * n + dim * b + j] += entry;
                    }
                }
            }
        }
    }
}

impl Foothold {
    fn element(&self) -> &'static Element {
        self.face.kind.table()
    }

    /// Dimension of the face.
    fn dim(&self) -> usize {
        self.element().dim
    }
}

/// A linear form of the motion of the stencil's nodes: one vector per node, m⁻¹ of what it gives.
type Form = [Vec3; 2 * NODES];

/// Small symmetric matrix over the unknowns of a stencil.
struct Block {
    dim: usize,
    factor: f64,
    /// Unknowns: rows of the matrix.
    n: usize,
    entries: [f64; UNKNOWNS * UNKNOWNS],
}

impl Block {
    /// Adds value · (a bᵀ + b aᵀ).
    fn add(&mut self, value: f64, a: &Form, b: &Form) {
        let component = |form: &Form, i: usize| form[i / self.dim][i % self.dim];
        let value = self.factor * value;
        for i in 0..self.n {
            let (a_i, b_i) = (value * component(a, i), value * component(b, i));
            for j in 0..self.n {
                self.entries[i * self.n + j] += a_i * component(b, j) + b_i * component(a, j);
            }
        }
    }
}

/// The face at the foot: derivatives of its shape functions and what they make of its nodes.
struct Shape<'a> {
    foot: &'a Foothold,
    point: &'a Point,
    /// Number of nodes of the point: where those of the face begin in a [`Form`].
    first: usize,
    gap: f64,
    n: Vec3,
    r: Vec3,
    /// N_b.
    shape: [f64; NODES],
    /// N_b,α.
    gradients: [[f64; NODES]; 2],
    /// Tangents τ_α and their reciprocals τ^α; zero beyond the dimension of the face.
    tangents: [Vec3; 2],
    reciprocal: [Vec3; 2],
    /// ρ^α = τ^α·r.
    overhang: [f64; 2],
    /// Directions e_k of the reference cell in which the foot is free; the first `free` are used.
    directions: [[f64; 2]; 2],
    free: usize,
    /// ξ_k = ∂ξ_k/∂u.
    motion: [Form; 2],
    /// (τ_k·τ_l - r·y_kl)⁻¹.
    compliance: [[f64; 2]; 2],
}

impl<'a> Shape<'a> {
    fn new(stencil: &'a Stencil, foot: &'a Foothold) -> Shape<'a> {
        let mut shape = [0.0; NODES];
        (foot.element().shape)(&foot.xi, &mut shape[..foot.element().nodes]);
        let gradients = [0, 1].map(|axis| derivative(foot.element(), &foot.xi, axis));
        let tangents = gradients.map(|weights| combination(&foot.x, &weights));
        let n = Vec3::from(stencil.normal);
        let r = Vec3::from(foot.r);
        let reciprocal = reciprocal(&tangents, &n, foot.dim());
        let overhang = match foot.inside {
            true => [0.0; 2],
            false => reciprocal.map(|t| t.dot(&r)),
        };
        let (directions, free) = free_directions(foot);
        let mut made = Shape {
            foot,
            point: &stencil.point,
            first: stencil.point.carriers().count(),
            gap: stencil.gap,
            n,
            r,
            shape,
            gradients,
            tangents,
            reciprocal,
            overhang,
            directions,
            free,
            motion: [[Vec3::zeros(); 2 * NODES]; 2],
            compliance: [[0.0; 2]; 2],
        };
        made.move_foot();
        made
    }

    /// Fills how the foot moves: (τ_k·τ_l - r·y_kl) ξ_l = δτ̂_k·r + τ_k·r̂.
    fn move_foot(&mut self) {
        let mut stiffness = [[0.0; 2]; 2];
        let mut metric = [[0.0; 2]; 2];
        for k in 0..self.free {
            for l in 0..self.free {
                metric[k][l] = self.tangent(k).dot(&self.tangent(l));
                stiffness[k][l] = metric[k][l] - self.r.dot(&self.bend(k, l));
            }
        }
        // Beyond the centre of curvature the foot is no minimum: there its motion is that on a flat face.
        self.compliance = inverse(&stiffness, self.free)
            .or_else(|| inverse(&metric, self.free))
            .unwrap_or_default();
        let right: [Form; 2] = [0, 1].map(|k| match k < self.free {
            true => sum(
                &self.primary(&self.gradient(k), &self.r),
                1.0,
                &self.relative(&self.tangent(k)),
            ),
            false => [Vec3::zeros(); 2 * NODES],
        });
        for k in 0..self.free {
            for (l, right) in right.iter().enumerate().take(self.free) {
                self.motion[k] = sum(&self.motion[k], self.compliance[k][l], right);
            }
        }
    }

    /// N: n·r̂ - ρ^α S_α.
    fn row(&self) -> Form {
        let mut row = self.relative(&self.n);
        for axis in 0..self.foot.dim() {
            row = sum(&row, -self.overhang[axis], &self.turning(axis));
        }
        row
    }

    /// Adds g″ to a matrix.
    fn curvature(&self, block: &mut Block) {
        let dim = self.foot.dim();
        let turning = [0, 1].map(|axis| self.turning(axis));
        for axis in 0..dim {
            block.add(-1.0, &turning[axis], &self.slide(axis));
            for (other, form) in turning.iter().enumerate().take(dim) {
                let metric = self.reciprocal[axis].dot(&self.reciprocal[other]);
                block.add(-0.5 * self.gap * metric, &turning[axis], form);
            }
        }
        for k in 0..self.free {
            let mut weights = self.gradient(k);
            for axis in 0..dim {
                let second = self.second(axis, k);
                for (w, second) in weights.iter_mut().zip(second) {
                    *w += self.overhang[axis] * second;
                }
            }
            block.add(-1.0, &self.primary(&weights, &self.n), &self.motion[k]);
            for l in 0..self.free {
                let mut bend = self.bend(k, l);
                for axis in 0..dim {
                    bend += self.overhang[axis] * self.twist(axis, k, l);
                }
                let value = -0.5 * self.n.dot(&bend);
                block.add(value, &self.motion[k], &self.motion[l]);
            }
        }
        self.foot_acceleration(block);
    }

    /// Adds - ρ^α (n·y_αk) ξ″_k. The factor vanishes unless the foot is on an edge of a curved face; there f = τ_k·r = 0
    /// gives -f_ξ ξ″ = f_uu + f_uξ ⊙ ξ + f_ξξ ξ ξ.
    fn foot_acceleration(&self, block: &mut Block) {
        if self.free != 1 {
            return;
        }
        let slope: f64 = (0..self.foot.dim())
            .map(|axis| {
                let bend = combination(&self.foot.x, &self.second(axis, 0));
                self.overhang[axis] * self.n.dot(&bend)
            })
            .sum();
        let value = -slope * self.compliance[0][0];
        let (along, bend, gradient) = (self.tangent(0), self.bend(0, 0), self.gradient(0));
        for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
            block.add(
                value,
                &self.primary(&gradient, &axis),
                &self.relative(&axis),
            );
        }
        let second = self.along(0, |axis| self.second(axis, 0));
        let mixed = sum(&self.primary(&second, &self.r), 1.0, &self.relative(&bend));
        let mixed = sum(&mixed, -2.0, &self.primary(&gradient, &along));
        block.add(value, &mixed, &self.motion[0]);
        // The third derivative along an edge is zero: edges are parabolas at most.
        let own = -3.0 * bend.dot(&along);
        block.add(0.5 * value * own, &self.motion[0], &self.motion[0]);
    }

    /// S_α = n·δτ_α.
    fn turning(&self, axis: usize) -> Form {
        self.tangent_motion(axis, &self.n)
    }

    /// τ^α·δr - ρ^β τ^α·δτ_β.
    fn slide(&self, axis: usize) -> Form {
        let direction = self.reciprocal[axis];
        let mut form = self.relative(&direction);
        for k in 0..self.free {
            form = sum(&form, -direction.dot(&self.tangent(k)), &self.motion[k]);
        }
        for other in 0..self.foot.dim() {
            let turning = self.tangent_motion(other, &direction);
            form = sum(&form, -self.overhang[other], &turning);
        }
        form
    }

    /// direction·δτ_α with the motion of the foot.
    fn tangent_motion(&self, axis: usize, direction: &Vec3) -> Form {
        let mut form = self.primary(&self.gradients[axis], direction);
        for k in 0..self.free {
            let bend = combination(&self.foot.x, &self.second(axis, k));
            form = sum(&form, direction.dot(&bend), &self.motion[k]);
        }
        form
    }

    /// direction·r̂.
    fn relative(&self, direction: &Vec3) -> Form {
        let mut form = self.primary(&self.shape.map(|n| -n), direction);
        for (form, (_, s)) in form.iter_mut().zip(self.point.carriers()) {
            *form = direction * s;
        }
        form
    }

    /// direction·Σ w_b δx_b over the nodes of the face.
    fn primary(&self, weights: &[f64; NODES], direction: &Vec3) -> Form {
        let mut form = [Vec3::zeros(); 2 * NODES];
        let nodes = self.foot.element().nodes;
        for (form, w) in form[self.first..].iter_mut().zip(&weights[..nodes]) {
            *form = direction * *w;
        }
        form
    }

    /// Σ_α e_kα of something per axis.
    fn along(&self, k: usize, per_axis: impl Fn(usize) -> [f64; NODES]) -> [f64; NODES] {
        let mut sum = [0.0; NODES];
        for axis in 0..self.foot.dim() {
            for (sum, part) in sum.iter_mut().zip(per_axis(axis)) {
                *sum += self.directions[k][axis] * part;
            }
        }
        sum
    }

    /// N_b,k.
    fn gradient(&self, k: usize) -> [f64; NODES] {
        self.along(k, |axis| self.gradients[axis])
    }

    /// N_b,αk.
    fn second(&self, axis: usize, k: usize) -> [f64; NODES] {
        let step = self.directions[k];
        // Central differences of a gradient of degree 2 are exact.
        let (after, before) = (self.at(axis, &step, 0.5), self.at(axis, &step, -0.5));
        std::array::from_fn(|b| after[b] - before[b])
    }

    /// y_αkl.
    fn twist(&self, axis: usize, k: usize, l: usize) -> Vec3 {
        let (e, d) = (self.directions[k], self.directions[l]);
        let plus = [e[0] + d[0], e[1] + d[1]];
        let minus = [e[0] - d[0], e[1] - d[1]];
        let weights: [f64; NODES] = {
            let (a, b) = (self.at(axis, &plus, 0.5), self.at(axis, &plus, -0.5));
            let (c, d) = (self.at(axis, &minus, 0.5), self.at(axis, &minus, -0.5));
            std::array::from_fn(|i| a[i] + b[i] - c[i] - d[i])
        };
        combination(&self.foot.x, &weights)
    }

    /// N_b,α at ξ + step · part.
    fn at(&self, axis: usize, step: &[f64; 2], part: f64) -> [f64; NODES] {
        let xi = self.foot.xi;
        let xi = [xi[0] + part * step[0], xi[1] + part * step[1], xi[2]];
        derivative(self.foot.element(), &xi, axis)
    }

    /// τ_k.
    fn tangent(&self, k: usize) -> Vec3 {
        self.tangents[0] * self.directions[k][0] + self.tangents[1] * self.directions[k][1]
    }

    /// y_kl.
    fn bend(&self, k: usize, l: usize) -> Vec3 {
        combination(&self.foot.x, &self.along(k, |axis| self.second(axis, l)))
    }
}

/// dN_b/dξ along one axis of the reference cell.
fn derivative(element: &Element, xi: &[f64; 3], axis: usize) -> [f64; NODES] {
    let mut gradients = [[0.0; 3]; NODES];
    (element.gradient)(xi, &mut gradients[..element.nodes]);
    gradients.map(|gradient| gradient[axis])
}

fn combination(x: &[[f64; 3]; NODES], weights: &[f64; NODES]) -> Vec3 {
    Vec3::from(map::point(x, weights))
}

/// a + factor b.
fn sum(a: &Form, factor: f64, b: &Form) -> Form {
    std::array::from_fn(|i| a[i] + b[i] * factor)
}

/// The vectors of the tangent space with τ^α·τ_β = δ; n is the unit normal.
fn reciprocal(tangents: &[Vec3; 2], n: &Vec3, dim: usize) -> [Vec3; 2] {
    match dim {
        1 => [tangents[0] / tangents[0].norm_squared(), Vec3::zeros()],
        _ => {
            let area = n.dot(&tangents[0].cross(&tangents[1]));
            [tangents[1].cross(n) / area, n.cross(&tangents[0]) / area]
        }
    }
}

/// Inverse of a positive definite matrix of one or two rows, none for another matrix.
fn inverse(a: &[[f64; 2]; 2], n: usize) -> Option<[[f64; 2]; 2]> {
    match n {
        0 => Some([[0.0; 2]; 2]),
        1 => (a[0][0] > 0.0).then(|| [[1.0 / a[0][0], 0.0], [0.0; 2]]),
        _ => {
            let det = a[0][0] * a[1][1] - a[0][1] * a[1][0];
            (det > 0.0 && a[0][0] > 0.0).then(|| {
                [
                    [a[1][1] / det, -a[0][1] / det],
                    [-a[1][0] / det, a[0][0] / det],
                ]
            })
        }
    }
}

/// The directions of the reference cell in which a foot can move both ways, and their number.
///
/// Along the slanted edge of a triangle that is (-1, 1); a square holds its rim along the axes.
fn free_directions(foot: &Foothold) -> ([[f64; 2]; 2], usize) {
    let dim = foot.dim();
    let axes = [[1.0, 0.0], [0.0, 1.0]];
    if foot.inside {
        return (axes, dim);
    }
    let stays = |direction: &[f64; 2]| {
        [1e-7, -1e-7].iter().all(|step| {
            let xi = [
                foot.xi[0] + step * direction[0],
                foot.xi[1] + step * direction[1],
                0.0,
            ];
            (foot.element().contains)(&xi, 1e-9)
        })
    };
    let (mut directions, mut free) = (axes, 0);
    for direction in axes.iter().take(dim).chain(&[[-1.0, 1.0]][..dim - 1]) {
        if free < dim && stays(direction) {
            directions[free] = *direction;
            free += 1;
        }
    }
    (directions, free)
}

/// Unit vectors square to the normal and to each other; `dim - 1` of them are used.
///
/// In the plane the normal turned by a quarter, (-n_y, n_x). In space the rotation that takes a fixed direction e to n
/// the shortest way, applied to two vectors square to e: smooth but for n = -e, where a step is unavoidable and e is
/// chosen so that it is far from the axes. The formula is that of the rotation between two unit vectors.
pub(super) fn tangent_vectors(n: &[f64; 3], dim: usize) -> [[f64; 3]; 2] {
    if dim < 3 {
        return [[-n[1], n[0], 0.0], [0.0; 3]];
    }
    // 2/7, 3/7, 6/7 are the components of a unit vector; the other two complete it to a rotation.
    let [first, second, e] =
        [[3.0, -6.0, 2.0], [6.0, 2.0, -3.0], [2.0, 3.0, 6.0]].map(|v| Vec3::from(v) / 7.0);
    let n = Vec3::from(*n);
    let (middle, height) = (n + e, 1.0 + n.dot(&e));
    let turn = |f: Vec3| match height > 1e-12 {
        true => f - middle * (n.dot(&f) / height),
        false => f,
    };
    [turn(first).into(), turn(second).into()]
}
