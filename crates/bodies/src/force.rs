//! Internal forces of W elements at a time: the inner loop of a run.
//!
//! Letters are those of the formulas: `J = ∂x/∂ξ`, `C` its cofactors (J⁻¹ = Cᵀ / det J), `H = ∂u/∂x`, `σ`, and the
//! nodal forces f_a = ∫ σ dN_a/dx dV. The bodies are the same for every instruction set; see `lanes.rs`. The
//! Jacobian is computed anew at each call: stored, it would be 640 bytes per hexahedron to read.

use std::array::from_fn;
use std::f64::consts::TAU;

use pulp::Simd;

use crate::bar::Bar;
use crate::continuum::{Law, Point, Points};
use crate::lanes::{Lanes, Vector};
use crate::weights::Weight;

/// Internal forces of elements with N nodes and D unknowns per node.
pub(crate) trait Kernel<const N: usize, const D: usize> {
    /// Adds the nodal forces (N) for the positions `x` and displacements `u` (m) to `f`; returns the strain energies (J).
    /// `w`: weight of the internal work at the points.
    fn force<S: Simd, const W: usize>(
        &self,
        x: &[Vector<W, D>; N],
        u: &[Vector<W, D>; N],
        w: impl Weight,
        f: &mut [Vector<W, D>; N],
    ) -> Lanes<W>;
}

/// T = E A ε along the axis, ε = d · Δu / L², with d from the first node to the second.
impl<const D: usize> Kernel<2, D> for Bar {
    #[inline(always)]
    fn force<S: Simd, const W: usize>(
        &self,
        x: &[Vector<W, D>; 2],
        u: &[Vector<W, D>; 2],
        w: impl Weight,
        f: &mut [Vector<W, D>; 2],
    ) -> Lanes<W> {
        let d: Vector<W, D> = from_fn(|i| x[1][i] - x[0][i]);
        let (mut square, mut stretch) = (Lanes::ZERO, Lanes::ZERO);
        for i in 0..D {
            square = d[i].mul_add::<S>(d[i], square);
            stretch = d[i].mul_add::<S>(u[1][i] - u[0][i], stretch);
        }
        // tension over length: E A (d · Δu) / L³
        let pull = w.times(
            0,
            stretch * (self.young * self.area) / (square * square.sqrt()),
        );
        for i in 0..D {
            f[0][i] -= pull * d[i];
            f[1][i] += pull * d[i];
        }
        pull * stretch * 0.5
    }
}

/// Edges of the reference cell along each of its axes, E of them: ∂φ/∂ξ_c = Σ_e dN_b/dξ_c (φ_b - φ_a) over the edges
/// e = (a, b) of axis c. Half the work of a sum over nodes.
pub(crate) type Edges<const D: usize, const E: usize> = [[[usize; 2]; E]; D];

pub(crate) const TRI3: Edges<2, 1> = [[[0, 1]], [[0, 2]]];
pub(crate) const QUAD4: Edges<2, 2> = [[[0, 1], [3, 2]], [[0, 3], [1, 2]]];
pub(crate) const TET4: Edges<3, 1> = [[[0, 1]], [[0, 2]], [[0, 3]]];
pub(crate) const HEX8: Edges<3, 4> = [
    [[0, 1], [3, 2], [4, 5], [7, 6]],
    [[0, 3], [1, 2], [4, 7], [5, 6]],
    [[0, 4], [1, 5], [2, 6], [3, 7]],
];

/// A plane, axisymmetric or solid element kind with its law.
pub(crate) struct Cell<'a, const D: usize, const E: usize> {
    law: &'a Law,
    points: &'a Points,
    edges: &'a Edges<D, E>,
}

/// One vector per edge of the reference cell.
type OfEdges<const W: usize, const D: usize, const E: usize> = [[Vector<W, D>; E]; D];

impl<const N: usize, const D: usize, const E: usize> Kernel<N, D> for Cell<'_, D, E> {
    #[inline(always)]
    fn force<S: Simd, const W: usize>(
        &self,
        x: &[Vector<W, D>; N],
        u: &[Vector<W, D>; N],
        w: impl Weight,
        f: &mut [Vector<W, D>; N],
    ) -> Lanes<W> {
        let (dx, du) = (self.differences(x), self.differences(u));
        let mut df = [[[Lanes::ZERO; D]; E]; D];
        let mut energy = Lanes::ZERO;
        for (q, point) in self.points.points.iter().enumerate() {
            let jacobian = self.gradient::<S, W>(point, &dx);
            let cofactor = cofactor(&jacobian);
            let det = product::<S, W, D>(&jacobian[0], &cofactor[0]);
            let g = self.gradient::<S, W>(point, &du);
            let inverse = Lanes([1.0; W]) / det;
            let mut h = [[Lanes::ZERO; D]; D];
            for i in 0..D {
                for k in 0..D {
                    h[i][k] = product::<S, W, D>(&g[i], &cofactor[k]) * inverse;
                }
            }
            let mut weight = Lanes([point.weight * self.law.thickness; W]);
            let mut hoop = Lanes::ZERO;
            if D == 2 && self.law.axisymmetric {
                let radius = interpolate::<S, W, N>(point, x.map(|x| x[0]));
                hoop = interpolate::<S, W, N>(point, u.map(|u| u[0])) / radius;
                weight = radius * (TAU * point.weight);
            }
            weight = w.times(q, weight);
            let (stress, hoop_stress) = stress::<S, W, D>(self.law, &h, hoop);
            let mut density = hoop_stress * hoop;
            for i in 0..D {
                density += product::<S, W, D>(&stress[i], &h[i]);
            }
            energy += density * det * weight * 0.5;
            self.spread::<S, W>(point, &stress, &cofactor, weight, &mut df);
            if D == 2 && self.law.axisymmetric {
                // ∫ σ_θ N_a / r 2πr dA: the radius drops out
                let ring = w.times(q, hoop_stress * det * (TAU * point.weight));
                for a in 0..N {
                    f[a][0] = ring.scale_add::<S>(point.n[a], f[a][0]);
                }
            }
        }
        self.add_differences(&df, f);
        energy
    }
}

impl<'a, const D: usize, const E: usize> Cell<'a, D, E> {
    pub(crate) fn new(law: &'a Law, points: &'a Points, edges: &'a Edges<D, E>) -> Self {
        Cell { law, points, edges }
    }

    /// φ_b - φ_a over the edges.
    #[inline(always)]
    fn differences<const W: usize, const N: usize>(
        &self,
        nodes: &[Vector<W, D>; N],
    ) -> OfEdges<W, D, E> {
        let mut differences = [[[Lanes::ZERO; D]; E]; D];
        for c in 0..D {
            for e in 0..E {
                let [a, b] = self.edges[c][e];
                for i in 0..D {
                    differences[c][e][i] = nodes[b][i] - nodes[a][i];
                }
            }
        }
        differences
    }

    /// Gradient in the reference cell, row i of the result being ∂φ_i/∂ξ.
    #[inline(always)]
    fn gradient<S: Simd, const W: usize>(
        &self,
        point: &Point,
        differences: &OfEdges<W, D, E>,
    ) -> [Vector<W, D>; D] {
        let mut gradient = [[Lanes::ZERO; D]; D];
        for c in 0..D {
            for e in 0..E {
                let slope = point.dn[self.edges[c][e][1]][c];
                for i in 0..D {
                    gradient[i][c] = differences[c][e][i].scale_add::<S>(slope, gradient[i][c]);
                }
            }
        }
        gradient
    }

    /// Adds the share of one point, σ C weight dN_b/dξ_c, to the forces along the edges.
    #[inline(always)]
    fn spread<S: Simd, const W: usize>(
        &self,
        point: &Point,
        stress: &[Vector<W, D>; D],
        cofactor: &[Vector<W, D>; D],
        weight: Lanes<W>,
        edge_forces: &mut OfEdges<W, D, E>,
    ) {
        for c in 0..D {
            let mut pull = [Lanes::ZERO; D];
            for i in 0..D {
                for k in 0..D {
                    pull[i] = stress[i][k].mul_add::<S>(cofactor[k][c], pull[i]);
                }
                pull[i] = pull[i] * weight;
            }
            for e in 0..E {
                let slope = point.dn[self.edges[c][e][1]][c];
                for i in 0..D {
                    edge_forces[c][e][i] = pull[i].scale_add::<S>(slope, edge_forces[c][e][i]);
                }
            }
        }
    }

    /// The transpose of [`Cell::differences`]: an edge pulls its two nodes with opposite forces.
    #[inline(always)]
    fn add_differences<const W: usize, const N: usize>(
        &self,
        edge_forces: &OfEdges<W, D, E>,
        f: &mut [Vector<W, D>; N],
    ) {
        for c in 0..D {
            for e in 0..E {
                let [a, b] = self.edges[c][e];
                for i in 0..D {
                    f[a][i] -= edge_forces[c][e][i];
                    f[b][i] += edge_forces[c][e][i];
                }
            }
        }
    }
}

/// σ = λ tr(ε) I + μ (H + Hᵀ) in the plane or in space, and the hoop stress.
#[inline(always)]
fn stress<S: Simd, const W: usize, const D: usize>(
    law: &Law,
    h: &[Vector<W, D>; D],
    hoop: Lanes<W>,
) -> ([Vector<W, D>; D], Lanes<W>) {
    let mut trace = hoop;
    for i in 0..D {
        trace += h[i][i];
    }
    let pressure = trace * law.lame_1;
    let mut stress = [[Lanes::ZERO; D]; D];
    for i in 0..D {
        stress[i][i] = pressure;
        for k in 0..D {
            stress[i][k] = (h[i][k] + h[k][i]).scale_add::<S>(law.shear_modulus, stress[i][k]);
        }
    }
    let hoop_stress = hoop.scale_add::<S>(2.0 * law.shear_modulus, pressure);
    (stress, hoop_stress)
}

/// Cofactors C_ik of a matrix of two or three rows: J Cᵀ = det J.
#[inline(always)]
fn cofactor<const W: usize, const D: usize>(j: &[Vector<W, D>; D]) -> [Vector<W, D>; D] {
    let mut cofactor = [[Lanes::ZERO; D]; D];
    for i in 0..D {
        for k in 0..D {
            cofactor[i][k] = if D == 2 {
                let minor = j[1 - i][1 - k];
                if i == k { minor } else { -minor }
            } else {
                // in cyclic order the minors carry their sign
                let (i1, i2, k1, k2) = ((i + 1) % D, (i + 2) % D, (k + 1) % D, (k + 2) % D);
                j[i1][k1] * j[i2][k2] - j[i1][k2] * j[i2][k1]
            };
        }
    }
    cofactor
}

#[inline(always)]
fn product<S: Simd, const W: usize, const D: usize>(
    a: &Vector<W, D>,
    b: &Vector<W, D>,
) -> Lanes<W> {
    let mut sum = a[0] * b[0];
    for i in 1..D {
        sum = a[i].mul_add::<S>(b[i], sum);
    }
    sum
}

/// Σ_a N_a φ_a.
#[inline(always)]
fn interpolate<S: Simd, const W: usize, const N: usize>(
    point: &Point,
    nodes: [Lanes<W>; N],
) -> Lanes<W> {
    let mut sum = Lanes::ZERO;
    for a in 0..N {
        sum = nodes[a].scale_add::<S>(point.n[a], sum);
    }
    sum
}
