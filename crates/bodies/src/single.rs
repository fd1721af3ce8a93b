//! Internal forces of one element at a time, of the kinds for which `force.rs` has no kernel: pyramids, and quadratic cells
//! other than simplices. Their nodes are many, and so the loops over them long enough for the compiler.
//!
//! Letters are those of the formulas: `H = ∂u/∂x`, `σ`, and f_a = ∫ σ dN_a/dx dV.

use crate::continuum::{self, Law, Points};

/// Adds the nodal forces (N) of one element to `f` and returns its strain energy (J). `x`, `u`: positions and
/// displacements of its nodes, m. `weight`: of the internal work at each point.
pub(crate) fn force<const N: usize>(
    law: &Law,
    points: &Points,
    weight: impl Fn(usize) -> f64,
    [x, u]: [&[[f64; 3]; N]; 2],
    f: &mut [[f64; 3]; N],
) -> f64 {
    // without the translation, whose strain would be nothing but round-off
    let relative = u.map(|u_a| [0, 1, 2].map(|i| u_a[i] - u[0][i]));
    let mut energy = 0.0;
    for (q, point) in points.points.iter().enumerate() {
        let at = continuum::local(law, point, x);
        let volume = at.volume * weight(q);
        let mut h = continuum::slope(&at, &relative);
        if law.axisymmetric {
            h[2][2] = (0..N).map(|a| point.n[a] * u[a][0]).sum::<f64>() / at.radius;
        }
        let pressure = law.lame_1 * (h[0][0] + h[1][1] + h[2][2]);
        let mut stress = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                stress[i][j] = law.shear_modulus * (h[i][j] + h[j][i]) * volume;
            }
            stress[i][i] += pressure * volume;
        }
        for i in 0..3 {
            energy += 0.5 * (0..3).map(|j| stress[i][j] * h[i][j]).sum::<f64>();
        }
        for a in 0..N {
            for i in 0..law.dim {
                f[a][i] += (0..law.dim)
                    .map(|j| stress[i][j] * at.dn[a][j])
                    .sum::<f64>();
            }
            if law.axisymmetric {
                f[a][0] += stress[2][2] * point.n[a] / at.radius;
            }
        }
    }
    energy
}
