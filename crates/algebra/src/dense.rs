//! Dense Cholesky factorisation of small systems (up to a few thousand unknowns).
//!
//! The factor is one panel: faer computes it with one thread, the sweeps are those of the sparse factor. Its bits depend on the
//! matrix and on the instruction set alone.

use crate::{Error, solver};
use faer::{
    MatMut, Par,
    dyn_stack::{MemBuffer, MemStack},
    linalg::cholesky::llt::factor::{self, LltError, LltRegularization},
};
use pulp::{Arch, Simd, WithSimd};

/// Factor L of a dense symmetric positive definite matrix A = L Lᵀ.
#[derive(Clone, Debug)]
pub struct DenseCholesky {
    n: usize,
    /// L, column-major, lower triangle.
    values: Vec<f64>,
}

impl DenseCholesky {
    /// Factorises `matrix`: `n` squared entries, symmetric (one triangle is read).
    ///
    /// Errors: the length is not n²; an entry is not finite; the matrix is not positive definite.
    pub fn new(n: usize, matrix: &[f64]) -> Result<Self, Error> {
        let mut factor = Self {
            n,
            values: vec![0.0; n * n],
        };
        factor.refactor(matrix)?;
        Ok(factor)
    }

    /// Factorises another matrix of the same size. After an error the factor must not be used before another `refactor`
    /// succeeds.
    pub fn refactor(&mut self, matrix: &[f64]) -> Result<(), Error> {
        let n = self.n;
        if matrix.len() != n * n {
            return Err(Error::WrongLength {
                what: "dense matrix",
                expected: n * n,
                found: matrix.len(),
            });
        }
        if let Some(k) = matrix.iter().position(|a| !a.is_finite()) {
            return Err(Error::NotFinite {
                row: k / n,
                column: k % n,
                value: matrix[k],
            });
        }
        self.values.copy_from_slice(matrix);
        let requirement = factor::cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(requirement).map_err(|_| Error::Analysis {
            unknowns: n,
            reason: "out of memory".into(),
        })?;
        factor::cholesky_in_place(
            MatMut::from_column_major_slice_mut(&mut self.values, n, n),
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .map(|_| ())
        .map_err(
            |LltError::NonPositivePivot { index }| Error::NotPositiveDefinite {
                unknown: index,
                diagonal: matrix[index * n + index],
            },
        )
    }

    /// x ← A⁻¹ x; no allocation.
    pub fn solve(&self, x: &mut [f64]) {
        Arch::new().dispatch(Solve(self, x));
    }
}

struct Solve<'a>(&'a DenseCholesky, &'a mut [f64]);

impl WithSimd for Solve<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let DenseCholesky { n, values } = self.0;
        solver::forward::<S>(values, *n, *n, self.1);
        solver::backward(simd, values, *n, *n, self.1);
    }
}
