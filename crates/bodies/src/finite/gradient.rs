//! The gradient operator B of an integration point, δF = B δu, and what is made of it.
//!
//! F_ij = δ_ij + Σ_a u_ai dN_a/dX_j; in axisymmetry (X, Y) is (R, Z) and F_33 = 1 + Σ_a u_ar N_a/R = r/R. In plane strain
//! F_33 = 1.

use carom_algebra::tensor::Mat3;
use carom_materials::Tangent;

/// B of one point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gradient<'a> {
    /// Unknowns of a node.
    pub(super) dim: usize,
    pub(super) axisymmetric: bool,
    /// dN_a/dX in 1/m; in axisymmetry the third entry is N_a/R.
    pub(super) dn: &'a [[f64; 3]],
}

impl Gradient<'_> {
    /// F at the displacement `u` of the element, m.
    pub(super) fn deformation(&self, u: &[f64]) -> Mat3 {
        let mut f = Mat3::identity();
        for (u, dn) in u.chunks_exact(self.dim).zip(self.dn) {
            for i in 0..self.dim {
                for j in 0..self.dim {
                    f[(i, j)] += u[i] * dn[j];
                }
            }
            if self.axisymmetric {
                f[(2, 2)] += u[0] * dn[2];
            }
        }
        f
    }

    /// Adds `factor` B^T P to `f`.
    pub(super) fn add_transposed(&self, factor: f64, p: &Mat3, f: &mut [f64]) {
        for (f, dn) in f.chunks_exact_mut(self.dim).zip(self.dn) {
            for (i, f) in f.iter_mut().enumerate() {
                let sum: f64 = (0..self.dim).map(|j| p[(i, j)] * dn[j]).sum();
                *f += factor * sum;
            }
            if self.axisymmetric {
                f[0] += factor * p[(2, 2)] * dn[2];
            }
        }
    }

    /// Adds B^T A B to the blocks on and above the diagonal of a row-major matrix.
    pub(super) fn add_product(&self, a: &Tangent, matrix: &mut [f64]) {
        self.add_blocks(a, |node| node, matrix);
    }

    /// Adds B^T A B to a row-major matrix.
    pub(super) fn add_whole_product(&self, a: &Tangent, matrix: &mut [f64]) {
        self.add_blocks(a, |_| 0, matrix);
    }

    /// `first`: the first node whose block is wanted in the rows of a node.
    fn add_blocks(&self, a: &Tangent, first: impl Fn(usize) -> usize, matrix: &mut [f64]) {
        let (dim, n) = (self.dim, self.dim * self.dn.len());
        for (node, dn) in self.dn.iter().enumerate() {
            let first = first(node);
            for i in 0..dim {
                let row = self.row(a, i, dn);
                let out = &mut matrix[(dim * node + i) * n + dim * first..][..n - dim * first];
                for (out, dn) in out.chunks_exact_mut(dim).zip(&self.dn[first..]) {
                    for (k, out) in out.iter_mut().enumerate() {
                        *out += (0..dim).map(|l| row[3 * k + l] * dn[l]).sum::<f64>();
                    }
                    if self.axisymmetric {
                        out[0] += row[8] * dn[2];
                    }
                }
            }
        }
    }

    /// Row of B^T A for component `i` of the node with these gradients.
    fn row(&self, a: &Tangent, i: usize, dn: &[f64; 3]) -> [f64; 9] {
        let mut row = [0.0; 9];
        for j in 0..self.dim {
            for (row, a) in row.iter_mut().zip(&a[3 * i + j]) {
                *row += dn[j] * a;
            }
        }
        if self.axisymmetric && i == 0 {
            for (row, a) in row.iter_mut().zip(&a[8]) {
                *row += dn[2] * a;
            }
        }
        row
    }
}

/// `factor` A.
pub(super) fn scaled(factor: f64, a: &Tangent) -> Tangent {
    a.map(|row| row.map(|entry| factor * entry))
}

/// `factor` times the symmetric part of A: tangents of stresses with a potential are symmetric but for rounding.
pub(super) fn symmetric(factor: f64, a: &Tangent) -> Tangent {
    let mut out = [[0.0; 9]; 9];
    for (r, row) in out.iter_mut().enumerate() {
        for (c, out) in row.iter_mut().enumerate() {
            *out = 0.5 * factor * (a[r][c] + a[c][r]);
        }
    }
    out
}

/// Copies what is above the diagonal of a row-major matrix below it.
pub(super) fn mirror(matrix: &mut [f64]) {
    let n = matrix.len().isqrt();
    for row in 1..n {
        for column in 0..row {
            matrix[row * n + column] = matrix[column * n + row];
        }
    }
}
