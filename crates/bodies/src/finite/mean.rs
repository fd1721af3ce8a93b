//! Mean gradients of elements that have one point in place of all, and the displacement gradient by them.

use carom_algebra::number::Number;

use super::batch::POINTS;
use super::passes::Elements;
use crate::force::Batch;

/// Means of several elements.
pub(super) struct Mean<T, const N: usize, const D: usize> {
    /// (1/V) ∫ dN_a/dX dV, in 1/m.
    pub(super) gradients: [[T; D]; N],
    /// (1/V) ∫ N_a/R dV, its first component.
    pub(super) ring: [[T; D]; N],
    /// H and u_r/R.
    pub(super) h: [[T; D]; D],
    pub(super) hoop: T,
    /// ∫ δ dV, m³.
    pub(super) weighted: T,
}

/// Integrals of gradients.
struct Integrals<T, const N: usize, const D: usize> {
    gradients: [[T; D]; N],
    ring: [[T; D]; N],
    volume: T,
    weighted: T,
}

impl<const N: usize, const D: usize, const E: usize> Elements<'_, N, D, E> {
    /// Mean gradients, and H by them.
    #[inline(always)]
    pub(super) fn mean_gradient<T: Number>(
        &self,
        of: &Batch<T, N, D, E>,
        weights: &[T; POINTS],
    ) -> Mean<T, N, D> {
        let zero = of.x[0][0].like(0.0);
        let Integrals {
            mut gradients,
            mut ring,
            volume,
            weighted,
        } = match (D, N) == (3, 8) && !self.weighted {
            true => in_closed_form(of.x),
            false => self.summed(of, weights),
        };
        let inverse = zero.like(1.0) / volume;
        for a in 0..N {
            for j in 0..D {
                gradients[a][j] = gradients[a][j] * inverse;
            }
        }
        if self.cell.has_hoop() {
            for a in 0..N {
                ring[a][0] = ring[a][0] * inverse;
            }
        }
        let (h, hoop) = self.by_mean((&gradients, &ring), of.u);
        Mean {
            gradients,
            ring,
            h,
            hoop,
            weighted,
        }
    }

    /// H and u_r/R by mean gradients, from the displacements relative to the first node.
    #[inline(always)]
    pub(super) fn by_mean<T: Number>(
        &self,
        (gradients, ring): (&[[T; D]; N], &[[T; D]; N]),
        u: &[[T; D]; N],
    ) -> ([[T; D]; D], T) {
        let zero = u[0][0].like(0.0);
        let (mut h, mut hoop) = ([[zero; D]; D], zero);
        for a in 1..N {
            for i in 0..D {
                let moved = u[a][i] - u[0][i];
                for j in 0..D {
                    h[i][j] = moved.mul_add(gradients[a][j], h[i][j]);
                }
            }
        }
        if self.cell.has_hoop() {
            for a in 0..N {
                hoop = ring[a][0].mul_add(u[a][0], hoop);
            }
        }
        (h, hoop)
    }

    /// Sums over the points.
    #[inline(always)]
    fn summed<T: Number>(
        &self,
        of: &Batch<T, N, D, E>,
        weights: &[T; POINTS],
    ) -> Integrals<T, N, D> {
        let (zero, one) = (of.x[0][0].like(0.0), of.x[0][0].like(1.0));
        let mut unit = [[zero; D]; D];
        for i in 0..D {
            unit[i][i] = one;
        }
        let (mut slopes, mut ring) = ([[[zero; D]; E]; D], [[zero; D]; N]);
        let (mut volume, mut weighted) = (zero, zero);
        for (q, point) in self.cell.points().iter().enumerate() {
            let metric = self.cell.metric(point, of);
            volume += metric.volume();
            weighted = metric.volume().mul_add(weights[q], weighted);
            self.cell
                .spread((point, &metric), &unit, metric.measure, &mut slopes);
            if self.cell.has_hoop() {
                self.cell.spread_hoop((point, &metric), one, one, &mut ring);
            }
        }
        let mut gradients = [[zero; D]; N];
        self.cell.add_differences(&slopes, &mut gradients);
        Integrals {
            gradients,
            ring,
            volume,
            weighted,
        }
    }
}

/// Hexahedra: ∫ dN_a/dX_i dV = ∂V/∂X_ai, V = Σ_a X_ai ∂V/∂X_ai for each i. Places count from the first node, whose integral is what
/// those of the others leave. Flanagan and Belytschko (1981).
#[inline(always)]
fn in_closed_form<T: Number, const N: usize, const D: usize>(
    x: &[[T; D]; N],
) -> Integrals<T, N, D> {
    let zero = x[0][0].like(0.0);
    let mut place = [[zero; 8]; 3];
    for i in 0..D {
        for a in 1..N {
            place[i % 3][a % 8] = x[a][i] - x[0][i];
        }
    }
    let [x, y, z] = &place;
    let columns = [column(y, z), column(z, x), column(x, y)];
    let (mut gradients, mut volume) = ([[zero; D]; N], zero);
    for a in 1..N {
        for i in 0..D {
            gradients[a][i] = columns[i % 3][a % 8];
            gradients[0][i] -= gradients[a][i];
        }
        volume = columns[0][a % 8].mul_add(x[a % 8], volume);
    }
    Integrals {
        gradients,
        ring: [[zero; D]; N],
        volume,
        weighted: volume,
    }
}

/// ∂V/∂x of all nodes but the first, from the other two coordinates.
#[inline(always)]
fn column<T: Number>(y: &[T; 8], z: &[T; 8]) -> [T; 8] {
    [
        y[0].like(0.0),
        slope(y, z, [2, 3, 0, 5, 6, 4]),
        slope(y, z, [3, 0, 1, 6, 7, 5]),
        slope(y, z, [0, 1, 2, 7, 4, 6]),
        slope(y, z, [7, 6, 5, 0, 3, 1]),
        slope(y, z, [4, 7, 6, 1, 0, 2]),
        slope(y, z, [5, 4, 7, 2, 1, 3]),
        slope(y, z, [6, 5, 4, 3, 2, 0]),
    ]
}

/// ∂V/∂x of a node with the neighbours b, d, e along its edges; c, f, g lie across its faces: c between b and d, f between b and e,
/// g between d and e.
#[inline(always)]
fn slope<T: Number>(y: &[T; 8], z: &[T; 8], [b, c, d, e, f, g]: [usize; 6]) -> T {
    let (bd, de, eb) = (z[b] - z[d], z[d] - z[e], z[e] - z[b]);
    let (fc, cg, gf) = (z[f] - z[c], z[c] - z[g], z[g] - z[f]);
    let edges = y[b] * (fc - de) + y[d] * (cg - eb) + y[e] * (gf - bd);
    let faces = y[c] * bd + y[f] * eb + y[g] * de;
    (edges + faces).scale(1.0 / 12.0)
}
