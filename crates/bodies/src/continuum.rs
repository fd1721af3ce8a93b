//! Stiffness, mass and stress of one plane, axisymmetric or solid element at small strain. Its internal forces, wanted
//! at every step, are computed for several elements at a time in `force.rs`.
//!
//! Letters are those of the formulas: `H = ∂u/∂x = Σ_a u_a ⊗ dN_a`, `ε = sym H`, `σ(ε)`. In axisymmetry (x, y) is
//! (r, z), the hoop strain `ε_θ = u_r / r` fills the third diagonal entry and dV carries 2πr.

use carom_algebra::tensor::Mat3;
use carom_elements::{Kind, MAX_NODES, Rule, map};
use carom_materials::tensor::cofactor;
use carom_materials::{Elastic, Plane};

use crate::Kinematics;

/// Shape functions and reference gradients at the points of a rule, evaluated once per block.
#[derive(Clone, Debug)]
pub(crate) struct Points {
    pub(crate) points: Vec<Point>,
}

/// Weight, N_a and dN_a/dξ at one point of a rule.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub(crate) weight: f64,
    pub(crate) n: [f64; MAX_NODES],
    pub(crate) dn: [[f64; 3]; MAX_NODES],
}

impl Points {
    pub(crate) fn new(kind: Kind, rule: &Rule) -> Points {
        let points = rule.points.iter().zip(rule.weights);
        let points = points.map(|(xi, &weight)| Point::new(kind, xi, weight));
        Points {
            points: points.collect(),
        }
    }
}

impl Point {
    /// At the reference coordinates `xi`.
    pub(crate) fn new(kind: Kind, xi: &[f64; 3], weight: f64) -> Point {
        let element = kind.table();
        let mut point = Point {
            weight,
            n: [0.0; MAX_NODES],
            dn: [[0.0; 3]; MAX_NODES],
        };
        (element.shape)(xi, &mut point.n[..element.nodes]);
        (element.gradient)(xi, &mut point.dn[..element.nodes]);
        point
    }
}

/// What a kernel needs to know of its body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Law {
    material: Elastic,
    plane: Plane,
    pub(crate) lame_1: f64,
    pub(crate) shear_modulus: f64,
    /// Thickness in m of a plane body; 1 otherwise.
    pub(crate) thickness: f64,
    pub(crate) axisymmetric: bool,
    /// Dimension of the elements, and number of unknowns of a node.
    pub(crate) dim: usize,
}

impl Law {
    /// Stress of a strain, Pa.
    pub(crate) fn stress(&self, strain: &Mat3) -> Mat3 {
        self.material.stress(self.plane, strain)
    }

    pub(crate) fn new(kinematics: Kinematics, material: Elastic, dim: usize) -> Law {
        let plane = kinematics.plane();
        let thickness = match kinematics {
            Kinematics::PlaneStrain { thickness } | Kinematics::PlaneStress { thickness } => {
                thickness
            }
            Kinematics::Bar { .. }
            | Kinematics::Beam(_)
            | Kinematics::Shell(_)
            | Kinematics::Axisymmetric
            | Kinematics::Solid => 1.0,
        };
        Law {
            material,
            plane,
            lame_1: material.lame_1(plane),
            shear_modulus: material.shear_modulus(),
            thickness,
            axisymmetric: matches!(kinematics, Kinematics::Axisymmetric),
            dim,
        }
    }
}

/// Geometry of one integration point: dN_a/dx, dV in m³ and, in axisymmetry, the radius.
pub(crate) struct Local<const N: usize> {
    pub(crate) dn: [[f64; 3]; N],
    pub(crate) volume: f64,
    pub(crate) radius: f64,
}

#[inline]
pub(crate) fn local<const N: usize>(law: &Law, point: &Point, x: &[[f64; 3]; N]) -> Local<N> {
    let (jacobian, det) = map::jacobian(x, &point.dn[..N], law.dim);
    let mut dn = [[0.0; 3]; N];
    map::physical_gradient(&jacobian, det, &point.dn[..N], &mut dn);
    let mut volume = det * point.weight * law.thickness;
    let mut radius = 1.0;
    if law.axisymmetric {
        radius = map::point(x, &point.n[..N])[0];
        volume *= std::f64::consts::TAU * radius;
    }
    Local { dn, volume, radius }
}

/// H_ij = Σ_a u_ai dN_a/dx_j.
#[inline]
pub(crate) fn slope<const N: usize>(at: &Local<N>, u: &[[f64; 3]; N]) -> [[f64; 3]; 3] {
    let mut h = [[0.0; 3]; 3];
    for a in 0..N {
        for i in 0..3 {
            for j in 0..3 {
                h[i][j] += u[a][i] * at.dn[a][j];
            }
        }
    }
    h
}

/// Stiffness of one element, row-major, `dim * N` squared entries in N/m:
/// K_ab,ij = ∫ λ t_ai t_bj + μ (dN_a,j dN_b,i + δ_ij dN_a · dN_b) dV, with t_a the divergence of N_a, which in
/// axisymmetry holds N_a/r in its first component, beside the term 2μ N_a N_b / r². `weights`: at the points, factors
/// of dV.
pub(crate) fn stiffness<const N: usize>(
    law: &Law,
    points: &Points,
    weights: &[f64],
    x: &[[f64; 3]; N],
    k: &mut [f64],
) {
    let dim = law.dim;
    let n = dim * N;
    k.fill(0.0);
    for (point, weight) in points.points.iter().zip(weights) {
        let mut at = local(law, point, x);
        at.volume *= weight;
        let mu = law.shear_modulus;
        let hoop = |a: usize| {
            if law.axisymmetric {
                point.n[a] / at.radius
            } else {
                0.0
            }
        };
        for a in 0..N {
            let mut ta = at.dn[a];
            ta[0] += hoop(a);
            for b in 0..N {
                let mut tb = at.dn[b];
                tb[0] += hoop(b);
                let (da, db) = (&at.dn[a], &at.dn[b]);
                let dot = da[0] * db[0] + da[1] * db[1] + da[2] * db[2];
                for i in 0..dim {
                    for j in 0..dim {
                        let mut value = law.lame_1 * ta[i] * tb[j] + mu * da[j] * db[i];
                        if i == j {
                            value += mu * dot;
                        }
                        k[(dim * a + i) * n + dim * b + j] += value * at.volume;
                    }
                }
                k[dim * a * n + dim * b] += 2.0 * mu * hoop(a) * hoop(b) * at.volume;
            }
        }
    }
}

/// Scalar consistent mass ∫ ρ N_a N_b dV of one element in kg, row-major N x N. `weights`: at the points, factors of dV.
pub(crate) fn mass<const N: usize>(
    law: &Law,
    points: &Points,
    weights: &[f64],
    x: &[[f64; 3]; N],
    m: &mut [f64],
) {
    m.fill(0.0);
    for (point, weight) in points.points.iter().zip(weights) {
        let mut at = local(law, point, x);
        at.volume *= weight;
        for a in 0..N {
            for b in 0..N {
                m[a * N + b] += law.material.density * point.n[a] * point.n[b] * at.volume;
            }
        }
    }
}

/// Volume of one element in m³ (a plane element times its thickness, an axisymmetric one over the full turn) and
/// its mean stress tensor in Pa, which is the stress of the mean strain.
pub(crate) fn stress<const N: usize>(
    law: &Law,
    points: &Points,
    x: &[[f64; 3]; N],
    u: &[[f64; 3]; N],
) -> (f64, Mat3) {
    let (mut volume, mut h) = (0.0, Mat3::zeros());
    for point in &points.points {
        let dn = &point.dn[..N];
        let (jacobian, det) = map::jacobian(x, dn, law.dim);
        // ∂u/∂x = ∂u/∂ξ Cᵀ / det J
        let cofactors = cofactor(&jacobian);
        let slope = by_reference(u, dn) * Mat3::from_fn(|k, i| cofactors[i][k]);
        let mut weight = point.weight * law.thickness;
        if law.axisymmetric {
            let radius = map::point(x, &point.n[..N])[0];
            weight *= std::f64::consts::TAU * radius;
            let out = (0..N).map(|a| point.n[a] * u[a][0]).sum::<f64>();
            h[(2, 2)] += weight * det * out / radius;
        }
        h += weight * slope;
        volume += weight * det;
    }
    let mean = h / volume;
    let strain = 0.5 * (mean + mean.transpose());
    (volume, law.stress(&strain))
}

/// Means over an element of ∂N_a/∂x, 1/m, and in axisymmetry of N_a/r, 1/m.
pub(crate) fn mean_gradients<const N: usize>(
    law: &Law,
    points: &Points,
    x: &[[f64; 3]; N],
) -> ([[f64; 3]; N], [f64; N]) {
    let (mut volume, mut gradients, mut hoops) = (0.0, [[0.0; 3]; N], [0.0; N]);
    for point in &points.points {
        let dn = &point.dn[..N];
        let (jacobian, det) = map::jacobian(x, dn, law.dim);
        let cofactors = cofactor(&jacobian);
        let radius = map::point(x, &point.n[..N])[0];
        let around = if law.axisymmetric {
            std::f64::consts::TAU * radius
        } else {
            1.0
        };
        let weight = point.weight * law.thickness * around;
        volume += weight * det;
        for a in 0..N {
            for (sum, cofactors) in gradients[a].iter_mut().zip(&cofactors) {
                *sum += weight * dn[a].iter().zip(cofactors).map(|(d, c)| d * c).sum::<f64>();
            }
            hoops[a] += weight * det * point.n[a] / radius;
        }
    }
    let mean = |sum: f64| sum / volume;
    (
        gradients.map(|gradient| gradient.map(mean)),
        hoops.map(mean),
    )
}

/// ∂u/∂ξ.
#[inline]
fn by_reference(u: &[[f64; 3]], dn: &[[f64; 3]]) -> Mat3 {
    let mut sum = Mat3::zeros();
    for (u, dn) in u.iter().zip(dn) {
        for i in 0..3 {
            for k in 0..3 {
                sum[(i, k)] += u[i] * dn[k];
            }
        }
    }
    sum
}
