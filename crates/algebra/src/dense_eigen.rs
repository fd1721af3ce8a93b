//! Eigenvalues and eigenvectors of dense symmetric matrices, and of pairs of them.
//!
//! faer computes them with one thread, so that their bits depend on the matrices and on the instruction set alone.

use faer::{
    Auto, MatMut, MatRef, Par, Spec,
    diag::Diag,
    dyn_stack::{MemBuffer, MemStack},
    linalg::{
        evd::{
            ComputeEigenvectors, SelfAdjointEvdParams, self_adjoint_evd, self_adjoint_evd_scratch,
        },
        triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place},
    },
};

use crate::Error;
use crate::dense::DenseCholesky;

/// Eigenvalues λ of K x = λ M x, ascending: `k` and `m` have `n` squared entries, row-major, symmetric, and M is positive
/// definite.
///
/// # Errors
/// A length that is not n²; an entry that is not finite; M not positive definite; no convergence.
pub fn eigenvalues(n: usize, k: &[f64], m: &[f64]) -> Result<Vec<f64>, Error> {
    Ok(eigenpairs(n, k, m)?.0)
}

/// Eigenvalues λ of K x = λ M x, ascending, and the vectors x, one after the other, with xᵀ M x = 1.
///
/// They are those of L⁻¹ K L⁻ᵀ with M = L Lᵀ, and x = L⁻ᵀ z. `k`, `m`: `n` squared entries, row-major, symmetric.
///
/// # Errors
/// A length that is not n²; an entry that is not finite; M not positive definite; no convergence.
pub fn eigenpairs(n: usize, k: &[f64], m: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Error> {
    let factor = DenseCholesky::new(n, m)?;
    check(n, k)?;
    let lower = MatRef::from_column_major_slice(factor.lower(), n, n);
    // L⁻¹ K, then L⁻¹ (L⁻¹ K)ᵀ
    let mut first = k.to_vec();
    let mut first = MatMut::from_column_major_slice_mut(&mut first, n, n);
    solve_lower_triangular_in_place(lower, first.as_mut(), Par::Seq);
    let mut reduced = vec![0.0; n * n];
    let mut second = MatMut::from_column_major_slice_mut(&mut reduced, n, n);
    second.copy_from(first.as_ref().transpose());
    solve_lower_triangular_in_place(lower, second.as_mut(), Par::Seq);
    let (values, mut vectors) = symmetric(n, &reduced)?;
    let columns = MatMut::from_column_major_slice_mut(&mut vectors, n, n);
    solve_upper_triangular_in_place(lower.transpose(), columns, Par::Seq);
    Ok((values, vectors))
}

/// Eigenvalues of a symmetric matrix, ascending, and its orthonormal eigenvectors, one after the other. `a`: `n` squared
/// entries; the lower triangle of the column-major matrix is read.
///
/// # Errors
/// A length that is not n²; an entry that is not finite; no convergence.
pub fn symmetric(n: usize, a: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Error> {
    check(n, a)?;
    let (mut values, mut vectors) = (vec![0.0; n], vec![0.0; n * n]);
    if n == 0 {
        return Ok((values, vectors));
    }
    let failed = |reason: &str| Error::Analysis {
        unknowns: n,
        reason: reason.into(),
    };
    // the QR algorithm at any size: divide and conquer of faer 0.24.4 drops couplings below a bound that does not know the scale of the
    // matrix, so that of a stiffness in N/m the vectors had residuals of 1e-5 of its norm
    let parameters = Spec::new(SelfAdjointEvdParams {
        recursion_threshold: usize::MAX,
        ..Auto::<f64>::auto()
    });
    let scratch =
        self_adjoint_evd_scratch::<f64>(n, ComputeEigenvectors::Yes, Par::Seq, parameters);
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| failed("out of memory"))?;
    let mut diagonal = Diag::<f64>::zeros(n);
    self_adjoint_evd(
        MatRef::from_column_major_slice(a, n, n),
        diagonal.as_mut(),
        Some(MatMut::from_column_major_slice_mut(&mut vectors, n, n)),
        Par::Seq,
        MemStack::new(&mut memory),
        parameters,
    )
    .map_err(|_| failed("the iterations for the eigenvalues do not converge"))?;
    for (value, found) in values.iter_mut().zip(diagonal.column_vector().iter()) {
        *value = *found;
    }
    Ok((values, vectors))
}

fn check(n: usize, a: &[f64]) -> Result<(), Error> {
    if a.len() != n * n {
        return Err(Error::WrongLength {
            what: "dense matrix",
            expected: n * n,
            found: a.len(),
        });
    }
    match a.iter().position(|entry| !entry.is_finite()) {
        Some(k) => Err(Error::NotFinite {
            row: k / n,
            column: k % n,
            value: a[k],
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pair_is_diagonal_in_its_vectors() {
        let n = 6;
        let entry = |i: usize, j: usize, power: f64| {
            let own = if i == j { 3.0 + i as f64 } else { 0.0 };
            own + 1.0 / (1.0 + (i + j) as f64).powf(power)
        };
        let full =
            |power: f64| -> Vec<f64> { (0..n * n).map(|e| entry(e / n, e % n, power)).collect() };
        let (k, m) = (full(1.0), full(2.0));
        let (values, vectors) = eigenpairs(n, &k, &m).unwrap();
        assert!(values.is_sorted());
        let form = |a: &[f64], x: &[f64], y: &[f64]| -> f64 {
            (0..n * n).map(|e| x[e / n] * a[e] * y[e % n]).sum()
        };
        for (i, x) in vectors.chunks_exact(n).enumerate() {
            for (j, y) in vectors.chunks_exact(n).enumerate() {
                let delta = if i == j { 1.0 } else { 0.0 };
                assert!((form(&m, x, y) - delta).abs() < 1e-13);
                assert!((form(&k, x, y) - delta * values[i]).abs() < 1e-13);
            }
        }
    }

    /// Springs between the points of a grid and their neighbours, also across cells, in three directions: a crude solid.
    fn solid(counts: [usize; 3]) -> (usize, Vec<f64>) {
        let n = 3 * counts.iter().product::<usize>();
        let place = |i: usize| {
            [
                i % counts[0],
                i / counts[0] % counts[1],
                i / counts[0] / counts[1],
            ]
        };
        let mut k = vec![0.0; n * n];
        for a in 0..n / 3 {
            for b in 0..a {
                let apart: Vec<f64> = place(a)
                    .iter()
                    .zip(place(b))
                    .map(|(x, y)| *x as f64 - y as f64)
                    .collect();
                let square: f64 = apart.iter().map(|x| x * x).sum();
                if square > 3.0 {
                    continue;
                }
                for (i, x) in apart.iter().enumerate() {
                    for (j, y) in apart.iter().enumerate() {
                        let entry = x * y / square;
                        for (p, q, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
                            k[(3 * p + i) * n + 3 * q + j] += sign * entry;
                        }
                    }
                }
            }
        }
        // one end on springs
        (0..n)
            .filter(|i| place(i / 3)[0] == 0)
            .for_each(|i| k[i * n + i] += 1.0);
        (n, k)
    }

    #[test]
    fn vectors_of_a_solid_have_residuals_of_rounding() {
        // the bound of a backward stable method is some n ε |A|, whatever the units: with the stiffness of a metal, and as small as
        // the inverses of its ω² are
        for scale in [1e10, 1.0, 1e-8] {
            let (n, mut a) = solid([30, 2, 2]);
            a.iter_mut().for_each(|a| *a *= scale);
            let (values, vectors) = symmetric(n, &a).unwrap();
            let norm = values[n - 1];
            for (value, x) in values.iter().zip(vectors.chunks_exact(n)) {
                let terms = a.chunks_exact(n).zip(x).map(|(row, own)| {
                    let image: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
                    (image - value * own).powi(2)
                });
                let residual = terms.sum::<f64>().sqrt();
                assert!(residual < 1e-13 * norm, "{scale} {value}: {residual}");
            }
        }
    }
}
