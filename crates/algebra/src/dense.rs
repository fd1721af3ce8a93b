//! Dense factorisations of small systems (up to a few thousand unknowns): Cholesky, and LU for unsymmetric matrices.
//!
//! faer computes them with one thread; the Cholesky factor is one panel, and its sweeps are those of the sparse factor. Their
//! bits depend on the matrix and on the instruction set alone.

use crate::{Error, solver};
use faer::{
    MatMut, Par,
    dyn_stack::{MemBuffer, MemStack},
    linalg::{
        cholesky::llt::factor::{self, LltError, LltRegularization},
        lu::partial_pivoting::factor as lu,
    },
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

    /// Factorises a matrix of any size in the memory at hand. Errors are those of [`DenseCholesky::new`]; after one the factor must not be used
    /// before another matrix is factorised.
    pub fn renew(&mut self, n: usize, matrix: &[f64]) -> Result<(), Error> {
        self.n = n;
        self.values.clear();
        self.values.resize(n * n, 0.0);
        self.refactor(matrix)
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
        if n == 1 && matrix[0] > 0.0 {
            self.values[0] = matrix[0].sqrt();
            return Ok(());
        }
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

    /// Least pivot over the diagonal entry that it is left of: L_kk² / A_kk, 1 for a diagonal matrix, about the rounding unit
    /// for a singular one. Infinite without unknowns.
    pub fn least_pivot(&self) -> f64 {
        let n = self.n;
        let ratio = |k: usize| {
            let row = (0..=k).map(|j| self.values[j * n + k].powi(2));
            self.values[k * n + k].powi(2) / row.sum::<f64>()
        };
        (0..n).map(ratio).fold(f64::INFINITY, f64::min)
    }

    /// L, column-major; above the diagonal the entries of the matrix.
    pub(crate) fn lower(&self) -> &[f64] {
        &self.values
    }

    /// x ← A⁻¹ x; no allocation.
    pub fn solve(&self, x: &mut [f64]) {
        Arch::new().dispatch(Solve(self, x));
    }

    /// x ← L⁻¹ x; no allocation.
    pub fn forward(&self, x: &mut [f64]) {
        Arch::new().dispatch(Forward(self, x));
    }
}

struct Forward<'a>(&'a DenseCholesky, &'a mut [f64]);

impl WithSimd for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let DenseCholesky { n, values } = self.0;
        solver::forward::<S>(values, *n, *n, self.1);
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

/// Factors P A = L U of a dense matrix A, with the largest entry of a column as pivot.
///
/// A pivot of zero is no error here: a caller that cannot exclude it must look at the result, which then is not finite.
#[derive(Clone, Debug)]
pub struct DenseLu {
    n: usize,
    /// L without its unit diagonal, and U, column-major.
    values: Vec<f64>,
    /// Row of A that is row i of P A.
    rows: Vec<usize>,
}

impl DenseLu {
    /// Factorises `matrix`: `n` squared entries, column-major.
    ///
    /// Errors: the length is not n²; an entry is not finite.
    pub fn new(n: usize, matrix: Vec<f64>) -> Result<Self, Error> {
        if matrix.len() != n * n {
            return Err(Error::WrongLength {
                what: "dense matrix",
                expected: n * n,
                found: matrix.len(),
            });
        }
        if let Some(k) = matrix.iter().position(|a| !a.is_finite()) {
            return Err(Error::NotFinite {
                row: k % n,
                column: k / n,
                value: matrix[k],
            });
        }
        let mut values = matrix;
        let (mut rows, mut inverse) = (vec![0_usize; n], vec![0_usize; n]);
        let requirement = lu::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        let mut memory = MemBuffer::try_new(requirement).map_err(|_| Error::Analysis {
            unknowns: n,
            reason: "out of memory".into(),
        })?;
        lu::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut values, n, n),
            &mut rows,
            &mut inverse,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        Ok(Self { n, values, rows })
    }

    /// A⁻¹ b.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let n = self.n;
        let mut x: Vec<f64> = self.rows.iter().map(|&row| b[row]).collect();
        for j in 0..n {
            let (above, below) = x.split_at_mut(j + 1);
            subtract(above[j], &self.values[j * n + j + 1..(j + 1) * n], below);
        }
        for j in (0..n).rev() {
            let column = &self.values[j * n..=j * n + j];
            x[j] /= column[j];
            let (above, below) = x.split_at_mut(j);
            subtract(below[0], &column[..j], above);
        }
        x
    }
}

/// y ← y - a x
fn subtract(a: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= a * x;
    }
}
