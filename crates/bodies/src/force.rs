//! Internal forces of W elements at a time: the inner loop of a run.
//!
//! Letters are those of the formulas: `J = ∂x/∂ξ`, `C` its cofactors (J⁻¹ = Cᵀ / det J), `H = ∂u/∂x`, `σ`, and the
//! nodal forces f_a = ∫ σ dN_a/dx dV. The bodies are the same for every instruction set; see `lanes.rs`. The
//! Jacobian is computed anew at each call: stored, it would be 640 bytes per hexahedron to read.

use std::array::from_fn;
use std::f64::consts::TAU;

use carom_algebra::lanes::{Lanes, Vector};
use carom_algebra::number::Number;

use crate::bar::Bar;
use crate::continuum::{Law, Point, Points};

use crate::weights::Weight;

/// Internal forces of elements with N nodes and D unknowns per node.
pub(crate) trait Kernel<const N: usize, const D: usize> {
    /// Adds the nodal forces (N) for the positions `x` and displacements `u` (m) to `f`; returns the strain energies (J).
    /// `w`: weight of the internal work at the points.
    fn force<const W: usize>(
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
    fn force<const W: usize>(
        &self,
        x: &[Vector<W, D>; 2],
        u: &[Vector<W, D>; 2],
        w: impl Weight,
        f: &mut [Vector<W, D>; 2],
    ) -> Lanes<W> {
        let d: Vector<W, D> = from_fn(|i| x[1][i] - x[0][i]);
        let (mut square, mut stretch) = (Lanes::ZERO, Lanes::ZERO);
        for i in 0..D {
            square = d[i].mul_add(d[i], square);
            stretch = d[i].mul_add(u[1][i] - u[0][i], stretch);
        }
        // tension over length: E A (d · Δu) / L³
        let pull = w.times(
            0,
            stretch.scale(self.young * self.area) / (square * square.sqrt()),
        );
        for i in 0..D {
            f[0][i] -= pull * d[i];
            f[1][i] += pull * d[i];
        }
        (pull * stretch).scale(0.5)
    }
}

/// Edges of the reference cell along each of its axes, E of them at most: ∂φ/∂ξ_c = Σ_e dN_b/dξ_c (φ_b - φ_a) over the edges
/// e = (a, b) of axis c. Half the work of a sum over nodes.
///
/// In quadratic simplices an edge goes from the middle of a side to its end, or from the middle of one side to that of another.
type Edges<const D: usize, const E: usize> = [[[usize; 2]; E]; D];

const TRI3: Edges<2, 1> = [[[0, 1]], [[0, 2]]];
const TRI6: Edges<2, 3> = [[[3, 0], [3, 1], [5, 4]], [[5, 0], [5, 2], [3, 4]]];
const QUAD4: Edges<2, 2> = [[[0, 1], [3, 2]], [[0, 3], [1, 2]]];
const TET4: Edges<3, 1> = [[[0, 1]], [[0, 2]], [[0, 3]]];
const TET10: Edges<3, 4> = [
    [[4, 0], [4, 1], [6, 5], [7, 8]],
    [[6, 0], [6, 2], [4, 5], [7, 9]],
    [[7, 0], [7, 3], [4, 8], [6, 9]],
];
/// The first two axes have two edges.
const WEDGE6: Edges<3, 3> = [
    [[0, 1], [3, 4], [0, 0]],
    [[0, 2], [3, 5], [0, 0]],
    [[0, 3], [1, 4], [2, 5]],
];
const HEX8: Edges<3, 4> = [
    [[0, 1], [3, 2], [4, 5], [7, 6]],
    [[0, 3], [1, 2], [4, 7], [5, 6]],
    [[0, 4], [1, 5], [2, 6], [3, 7]],
];

/// The edges of the kind with N nodes in D dimensions: known to the compiler, so that lanes of nodes stay in registers.
const fn edges<const N: usize, const D: usize, const E: usize>() -> Edges<D, E> {
    let mut out = [[[0; 2]; E]; D];
    let mut c = 0;
    while c < D {
        let mut e = 0;
        while e < E {
            out[c][e] = match (N, D) {
                (3, 2) => TRI3[c][e],
                (4, 2) => QUAD4[c][e],
                (6, 2) => TRI6[c][e],
                (4, 3) => TET4[c][e],
                (6, 3) => WEDGE6[c][e],
                (10, 3) => TET10[c][e],
                _ => HEX8[c][e],
            };
            e += 1;
        }
        c += 1;
    }
    out
}

/// Number of edges along each axis.
const fn counts<const D: usize, const E: usize>(edges: &Edges<D, E>) -> [usize; D] {
    let mut out = [0; D];
    let mut c = 0;
    while c < D {
        while out[c] < E && edges[c][out[c]][0] != edges[c][out[c]][1] {
            out[c] += 1;
        }
        c += 1;
    }
    out
}

/// An element kind whose gradients are sums over the edges of its cell.
#[derive(Clone, Copy)]
pub(crate) struct Cell<'a, const N: usize, const D: usize, const E: usize> {
    points: &'a Points,
    axisymmetric: bool,
    /// Thickness in m of a plane body; 1 otherwise.
    thickness: f64,
}

/// One vector per edge of the reference cell.
pub(crate) type OfEdges<T, const D: usize, const E: usize> = [[[T; D]; E]; D];

/// Geometry of an integration point.
#[derive(Clone, Copy)]
pub(crate) struct Metric<T, const D: usize> {
    /// C.
    cofactor: [[T; D]; D],
    /// det J.
    det: T,
    /// dV / det J.
    pub(crate) measure: T,
    /// Radius in axisymmetry.
    radius: T,
}

impl<T: Number, const D: usize> Metric<T, D> {
    /// Zeros like this one.
    #[inline(always)]
    pub(crate) fn zero(zero: T) -> Self {
        Metric {
            cofactor: [[zero; D]; D],
            det: zero,
            measure: zero,
            radius: zero,
        }
    }

    /// dV.
    #[inline(always)]
    pub(crate) fn volume(&self) -> T {
        self.det * self.measure
    }
}

/// Nodes of W elements: places and displacements, and their differences over the edges.
pub(crate) struct Batch<'a, T, const N: usize, const D: usize, const E: usize> {
    pub(crate) x: &'a [[T; D]; N],
    pub(crate) u: &'a [[T; D]; N],
    pub(crate) dx: OfEdges<T, D, E>,
    pub(crate) du: OfEdges<T, D, E>,
}

impl<'a, const N: usize, const D: usize, const E: usize> Cell<'a, N, D, E> {
    /// Edges of the reference cell.
    const EDGES: Edges<D, E> = edges::<N, D, E>();
    /// Number of them along each axis.
    const COUNTS: [usize; D] = counts(&Self::EDGES);

    pub(crate) fn new(law: &Law, points: &'a Points) -> Self {
        Cell {
            points,
            axisymmetric: law.axisymmetric,
            thickness: law.thickness,
        }
    }

    pub(crate) fn points(&self) -> &'a [Point] {
        &self.points.points
    }

    /// Whether third components of tensors are those around the axis.
    #[inline(always)]
    pub(crate) fn has_hoop(&self) -> bool {
        D == 2 && self.axisymmetric
    }

    #[inline(always)]
    pub(crate) fn batch<'b, T: Number>(
        &self,
        x: &'b [[T; D]; N],
        u: &'b [[T; D]; N],
    ) -> Batch<'b, T, N, D, E> {
        Batch {
            x,
            u,
            dx: self.differences(x),
            du: self.differences(u),
        }
    }

    /// Geometry at a point.
    #[inline(always)]
    pub(crate) fn metric<T: Number>(&self, point: &Point, of: &Batch<T, N, D, E>) -> Metric<T, D> {
        let jacobian = self.gradient(point, &of.dx);
        let cofactor = cofactor(&jacobian);
        let det = product(&jacobian[0], &cofactor[0]);
        let mut measure = det.like(point.weight * self.thickness);
        let mut radius = det.like(1.0);
        if self.has_hoop() {
            radius = interpolate(point, of.x);
            measure = radius.scale(TAU * point.weight);
        }
        Metric {
            cofactor,
            det,
            measure,
            radius,
        }
    }

    /// Geometry and displacement gradient at a point, and u_r / r in axisymmetry.
    #[inline(always)]
    pub(crate) fn at_point<T: Number>(
        &self,
        point: &Point,
        of: &Batch<T, N, D, E>,
    ) -> (Metric<T, D>, [[T; D]; D], T) {
        let metric = self.metric(point, of);
        let (h, hoop) = self.slope((point, &metric), &of.du, of.u);
        (metric, h, hoop)
    }

    /// dN_a/dX of the nodes at a point in 1/m, and N_a / r in axisymmetry.
    #[inline(always)]
    pub(crate) fn shape_gradients<T: Number>(
        &self,
        (point, metric): (&Point, &Metric<T, D>),
    ) -> ([[T; D]; N], [T; N]) {
        let zero = metric.det.like(0.0);
        let inverse = metric.det.like(1.0) / metric.det;
        let mut c = metric.cofactor;
        for row in &mut c {
            for entry in row {
                *entry = *entry * inverse;
            }
        }
        let (mut gradients, mut ring) = ([[zero; D]; N], [zero; N]);
        for a in 0..N {
            for k in 0..D {
                let mut sum = c[k][0].scale(point.dn[a][0]);
                for axis in 1..D {
                    sum = c[k][axis].scale_add(point.dn[a][axis], sum);
                }
                gradients[a][k] = sum;
            }
        }
        if self.has_hoop() {
            let inverse = metric.radius.like(1.0) / metric.radius;
            for a in 0..N {
                ring[a] = inverse.scale(point.n[a]);
            }
        }
        (gradients, ring)
    }

    /// Displacement gradient at a point, and u_r / r in axisymmetry.
    #[inline(always)]
    pub(crate) fn slope<T: Number>(
        &self,
        (point, metric): (&Point, &Metric<T, D>),
        du: &OfEdges<T, D, E>,
        u: &[[T; D]; N],
    ) -> ([[T; D]; D], T) {
        let g = self.gradient(point, du);
        let zero = metric.det.like(0.0);
        let inverse = metric.det.like(1.0) / metric.det;
        let mut h = [[zero; D]; D];
        for i in 0..D {
            for k in 0..D {
                h[i][k] = product(&g[i], &metric.cofactor[k]) * inverse;
            }
        }
        let mut hoop = zero;
        if self.has_hoop() {
            hoop = interpolate(point, u) / metric.radius;
        }
        (h, hoop)
    }

    /// φ_b - φ_a over the edges.
    #[inline(always)]
    pub(crate) fn differences<T: Number>(&self, nodes: &[[T; D]; N]) -> OfEdges<T, D, E> {
        let mut differences = [[[nodes[0][0].like(0.0); D]; E]; D];
        for c in 0..D {
            for e in 0..Self::COUNTS[c] {
                let [a, b] = Self::EDGES[c][e];
                for i in 0..D {
                    differences[c][e][i] = nodes[b][i] - nodes[a][i];
                }
            }
        }
        differences
    }

    /// Gradient in the reference cell, row i of the result being ∂φ_i/∂ξ.
    #[inline(always)]
    fn gradient<T: Number>(&self, point: &Point, differences: &OfEdges<T, D, E>) -> [[T; D]; D] {
        let mut gradient = [[differences[0][0][0].like(0.0); D]; D];
        for c in 0..D {
            for e in 0..Self::COUNTS[c] {
                let slope = point.dn[Self::EDGES[c][e][1]][c];
                for i in 0..D {
                    gradient[i][c] = differences[c][e][i].scale_add(slope, gradient[i][c]);
                }
            }
        }
        gradient
    }

    /// Adds the share of one point, σ C weight dN_b/dξ_c, to the forces along the edges.
    #[inline(always)]
    pub(crate) fn spread<T: Number>(
        &self,
        (point, at): (&Point, &Metric<T, D>),
        stress: &[[T; D]; D],
        weight: T,
        edge_forces: &mut OfEdges<T, D, E>,
    ) {
        for c in 0..D {
            let mut pull = [weight.like(0.0); D];
            for i in 0..D {
                for k in 0..D {
                    pull[i] = stress[i][k].mul_add(at.cofactor[k][c], pull[i]);
                }
                pull[i] = pull[i] * weight;
            }
            for e in 0..Self::COUNTS[c] {
                let slope = point.dn[Self::EDGES[c][e][1]][c];
                for i in 0..D {
                    edge_forces[c][e][i] = pull[i].scale_add(slope, edge_forces[c][e][i]);
                }
            }
        }
    }

    /// Adds ∫ σ_θ N_a / r 2πr dA of one point: the radius drops out. `factor`: of the stress.
    #[inline(always)]
    pub(crate) fn spread_hoop<T: Number>(
        &self,
        (point, at): (&Point, &Metric<T, D>),
        stress: T,
        factor: T,
        f: &mut [[T; D]; N],
    ) {
        let ring = (stress * at.det * factor).scale(TAU * point.weight);
        for a in 0..N {
            f[a][0] = ring.scale_add(point.n[a], f[a][0]);
        }
    }

    /// The transpose of [`Cell::differences`]: an edge pulls its two nodes with opposite forces.
    #[inline(always)]
    pub(crate) fn add_differences<T: Number>(
        &self,
        edge_forces: &OfEdges<T, D, E>,
        f: &mut [[T; D]; N],
    ) {
        for c in 0..D {
            for e in 0..Self::COUNTS[c] {
                let [a, b] = Self::EDGES[c][e];
                for i in 0..D {
                    f[a][i] -= edge_forces[c][e][i];
                    f[b][i] += edge_forces[c][e][i];
                }
            }
        }
    }
}

/// A plane, axisymmetric or solid element kind with the law of small strain.
pub(crate) struct Elastic<'a, const N: usize, const D: usize, const E: usize> {
    law: &'a Law,
    cell: Cell<'a, N, D, E>,
}

impl<'a, const N: usize, const D: usize, const E: usize> Elastic<'a, N, D, E> {
    pub(crate) fn new(law: &'a Law, points: &'a Points) -> Self {
        Elastic {
            law,
            cell: Cell::new(law, points),
        }
    }
}

impl<const N: usize, const D: usize, const E: usize> Kernel<N, D> for Elastic<'_, N, D, E> {
    #[inline(always)]
    fn force<const W: usize>(
        &self,
        x: &[Vector<W, D>; N],
        u: &[Vector<W, D>; N],
        w: impl Weight,
        f: &mut [Vector<W, D>; N],
    ) -> Lanes<W> {
        let batch = self.cell.batch(x, u);
        let mut df = [[[Lanes::ZERO; D]; E]; D];
        let mut energy = Lanes::ZERO;
        for (q, point) in self.cell.points().iter().enumerate() {
            let (at, h, hoop) = self.cell.at_point(point, &batch);
            let weight = w.times(q, at.measure);
            let (stress, hoop_stress) = stress::<W, D>(self.law, &h, hoop);
            let mut density = hoop_stress * hoop;
            for i in 0..D {
                density += product(&stress[i], &h[i]);
            }
            energy += (density * at.det * weight).scale(0.5);
            self.cell.spread((point, &at), &stress, weight, &mut df);
            if self.cell.has_hoop() {
                let one = w.times(q, Lanes::ONE);
                self.cell.spread_hoop((point, &at), hoop_stress, one, f);
            }
        }
        self.cell.add_differences(&df, f);
        energy
    }
}

/// σ = λ tr(ε) I + μ (H + Hᵀ) in the plane or in space, and the hoop stress.
#[inline(always)]
fn stress<const W: usize, const D: usize>(
    law: &Law,
    h: &[Vector<W, D>; D],
    hoop: Lanes<W>,
) -> ([Vector<W, D>; D], Lanes<W>) {
    let mut trace = hoop;
    for i in 0..D {
        trace += h[i][i];
    }
    let pressure = trace.scale(law.lame_1);
    let mut stress = [[Lanes::ZERO; D]; D];
    for i in 0..D {
        stress[i][i] = pressure;
        for k in 0..D {
            stress[i][k] = (h[i][k] + h[k][i]).scale_add(law.shear_modulus, stress[i][k]);
        }
    }
    let hoop_stress = hoop.scale_add(2.0 * law.shear_modulus, pressure);
    (stress, hoop_stress)
}

/// Cofactors C_ik of a matrix of two or three rows: J Cᵀ = det J.
#[inline(always)]
pub(crate) fn cofactor<T: Number, const D: usize>(j: &[[T; D]; D]) -> [[T; D]; D] {
    let mut cofactor = *j;
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
fn product<T: Number, const D: usize>(a: &[T; D], b: &[T; D]) -> T {
    let mut sum = a[0] * b[0];
    for i in 1..D {
        sum = a[i].mul_add(b[i], sum);
    }
    sum
}

/// First component of Σ_a N_a φ_a.
#[inline(always)]
fn interpolate<T: Number, const N: usize, const D: usize>(point: &Point, nodes: &[[T; D]; N]) -> T {
    let mut sum = nodes[0][0].like(0.0);
    for a in 0..N {
        sum = nodes[a][0].scale_add(point.n[a], sum);
    }
    sum
}
