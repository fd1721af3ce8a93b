//! First and second derivatives of the gap over a foot on a face.
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

use carom_algebra::tensor::Vec3;
use carom_elements::{MAX_FACE_NODES as NODES, map};

use super::block::{Block, Form};
use super::foothold::Foothold;
use crate::Point;

/// The face at the foot: derivatives of its shape functions and what they make of its nodes.
pub struct Shape<'a> {
    foot: &'a Foothold,
    point: &'a Point,
    /// Number of nodes of the point: where those of the face begin in a [`Form`].
    first: usize,
    /// Number of all nodes; the vectors behind them are zero.
    nodes: usize,
    gap: f64,
    n: Vec3,
    r: Vec3,
    /// N_b,α.
    gradients: [[f64; NODES]; 2],
    /// N_b,αβ.
    seconds: [[[f64; NODES]; 2]; 2],
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
    /// `gap` and `normal` are those of the point over this foot.
    pub fn new(point: &'a Point, gap: f64, normal: &[f64; 3], foot: &'a Foothold) -> Shape<'a> {
        let gradients = derivatives(foot, [0.0; 2]);
        let tangents = gradients.map(|weights| combination(&foot.x, &weights));
        let n = Vec3::from(*normal);
        let r = Vec3::from(foot.r);
        let reciprocal = reciprocal(&tangents, &n, foot.dim());
        let overhang = match foot.inside {
            true => [0.0; 2],
            false => reciprocal.map(|t| t.dot(&r)),
        };
        let (directions, free) = free_directions(foot);
        let first = point.carriers().count();
        let mut made = Shape {
            foot,
            point,
            first,
            nodes: first + foot.element().nodes,
            gap,
            n,
            r,
            gradients,
            seconds: second_derivatives(foot),
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
        for l in 0..self.free {
            let mut right = self.primary(&self.gradient(l), &self.r);
            self.add(1.0, &self.relative(&self.tangent(l)), &mut right);
            for k in 0..self.free {
                for (motion, right) in self.motion[k].iter_mut().zip(&right).take(self.nodes) {
                    *motion += right * self.compliance[k][l];
                }
            }
        }
    }

    /// a += factor b.
    fn add(&self, factor: f64, b: &Form, a: &mut Form) {
        for (a, b) in a.iter_mut().zip(b).take(self.nodes) {
            *a += b * factor;
        }
    }

    /// -ρ^α S_α.
    pub fn turn(&self) -> Form {
        let mut form = [Vec3::zeros(); 2 * NODES];
        for axis in 0..self.foot.dim() {
            self.add(-self.overhang[axis], &self.turning(axis), &mut form);
        }
        form
    }

    /// Adds factor · g″ to a block.
    pub fn curvature(&self, factor: f64, block: &mut Block) {
        let dim = self.foot.dim();
        let turning = [0, 1].map(|axis| self.turning(axis));
        for axis in 0..dim {
            let mut form = self.slide(axis);
            for (other, turning) in turning.iter().enumerate().take(dim) {
                let metric = self.reciprocal[axis].dot(&self.reciprocal[other]);
                self.add(0.5 * self.gap * metric, turning, &mut form);
            }
            block.add(-factor, &turning[axis], &form);
        }
        for k in 0..self.free {
            let mut form = self.primary(&self.carried(k), &self.n);
            for l in 0..self.free {
                let mut bend = self.bend(k, l);
                if !self.foot.inside {
                    for axis in 0..dim {
                        bend += self.overhang[axis] * self.twist(axis, k, l);
                    }
                }
                self.add(0.5 * self.n.dot(&bend), &self.motion[l], &mut form);
            }
            block.add(-factor, &form, &self.motion[k]);
        }
        if !self.foot.inside && self.free == 1 {
            self.foot_acceleration(factor, block);
        }
    }

    /// N_b,k + ρ^α N_b,αk.
    fn carried(&self, k: usize) -> [f64; NODES] {
        let mut weights = self.gradient(k);
        if !self.foot.inside {
            for axis in 0..self.foot.dim() {
                for (w, second) in weights.iter_mut().zip(self.second(axis, k)) {
                    *w += self.overhang[axis] * second;
                }
            }
        }
        weights
    }

    /// Adds - ρ^α (n·y_αk) ξ″_k. The factor vanishes unless the foot is on an edge of a curved face; there f = τ_k·r = 0
    /// gives -f_ξ ξ″ = f_uu + f_uξ ⊙ ξ + f_ξξ ξ ξ.
    fn foot_acceleration(&self, factor: f64, block: &mut Block) {
        let slope: f64 = (0..self.foot.dim())
            .map(|axis| {
                let bend = combination(&self.foot.x, &self.second(axis, 0));
                self.overhang[axis] * self.n.dot(&bend)
            })
            .sum();
        let value = -factor * slope * self.compliance[0][0];
        let (along, bend, gradient) = (self.tangent(0), self.bend(0, 0), self.gradient(0));
        for axis in [Vec3::x(), Vec3::y(), Vec3::z()] {
            block.add(
                value,
                &self.primary(&gradient, &axis),
                &self.relative(&axis),
            );
        }
        let second = self.along(0, |axis| self.second(axis, 0));
        let mut mixed = self.primary(&second, &self.r);
        self.add(1.0, &self.relative(&bend), &mut mixed);
        self.add(-2.0, &self.primary(&gradient, &along), &mut mixed);
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
            let along = direction.dot(&self.tangent(k));
            self.add(-along, &self.motion[k], &mut form);
        }
        for other in 0..self.foot.dim() {
            let turning = self.tangent_motion(other, &direction);
            self.add(-self.overhang[other], &turning, &mut form);
        }
        form
    }

    /// direction·δτ_α with the motion of the foot.
    fn tangent_motion(&self, axis: usize, direction: &Vec3) -> Form {
        let mut form = self.primary(&self.gradients[axis], direction);
        for k in 0..self.free {
            let bend = combination(&self.foot.x, &self.second(axis, k));
            self.add(direction.dot(&bend), &self.motion[k], &mut form);
        }
        form
    }

    /// direction·r̂.
    fn relative(&self, direction: &Vec3) -> Form {
        let mut form = self.primary(&self.foot.shape.map(|n| -n), direction);
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
        self.along(k, |other| self.seconds[axis][other])
    }

    /// y_αkl.
    fn twist(&self, axis: usize, k: usize, l: usize) -> Vec3 {
        let (e, d) = (self.directions[k], self.directions[l]);
        let at = |sign: f64, other: f64| {
            let step = [0, 1].map(|i| 0.5 * (sign * e[i] + other * d[i]));
            combination(&self.foot.x, &derivatives(self.foot, step)[axis])
        };
        // Exact, as a gradient is of degree 2 along each axis at most.
        at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)
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

/// N_b,α at ξ + step.
fn derivatives(foot: &Foothold, step: [f64; 2]) -> [[f64; NODES]; 2] {
    let xi = [foot.xi[0] + step[0], foot.xi[1] + step[1], 0.0];
    let mut gradients = [[0.0; 3]; NODES];
    (foot.element().gradient)(&xi, &mut gradients[..foot.element().nodes]);
    [0, 1].map(|axis| gradients.map(|gradient| gradient[axis]))
}

/// N_b,αβ, by central differences: exact, as a gradient is of degree 2 along each axis at most.
fn second_derivatives(foot: &Foothold) -> [[[f64; NODES]; 2]; 2] {
    let mut seconds = [[[0.0; NODES]; 2]; 2];
    let affine = foot.element().nodes == foot.dim() + 1;
    for beta in 0..if affine { 0 } else { foot.dim() } {
        let mut step = [0.0; 2];
        step[beta] = 0.5;
        let (after, before) = (derivatives(foot, step), derivatives(foot, step.map(|s| -s)));
        for alpha in 0..foot.dim() {
            seconds[alpha][beta] = std::array::from_fn(|b| after[alpha][b] - before[alpha][b]);
        }
    }
    seconds
}

fn combination(x: &[[f64; 3]; NODES], weights: &[f64; NODES]) -> Vec3 {
    Vec3::from(map::point(x, weights))
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
