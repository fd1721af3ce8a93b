//! The problem of eigenvalues, and its solution.

use crate::csr::Csr;
use crate::solver::SparseRow;

/// K φ = ω² M φ with unknowns held at zero and constraints.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// K, symmetric and positive semi-definite.
    pub stiffness: &'a Csr,
    /// M, symmetric and positive semi-definite, with no entry outside the pattern of K.
    pub mass: &'a Csr,
    /// Which unknowns are held at zero.
    pub fixed: &'a [bool],
    /// Node of each unknown, ascending.
    pub groups: &'a [u32],
    /// Rows of C in C φ = 0; dependent ones do no harm.
    pub constraints: &'a [SparseRow],
}

/// How many eigenvalues there are below a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Count {
    /// The value, infinite where all are meant.
    pub below: f64,
    /// Eigenvalues below it: by inertia, or all that the matrices have.
    pub exist: usize,
    /// Those found.
    pub found: usize,
}

/// Eigenvalues ω², ascending, and their vectors.
#[derive(Clone, Debug, PartialEq)]
pub struct Eigenpairs {
    /// ω²: of a free body those of rigid motions are zero to rounding, of either sign.
    pub values: Vec<f64>,
    /// Vectors over all unknowns, with φᵀ M φ = 1 and the entry of largest magnitude positive.
    pub vectors: Vec<Vec<f64>>,
    /// For each value a bound δ of its error: an eigenvalue lies within `δ (ω² - σ)` of it.
    pub bounds: Vec<f64>,
    /// The shift σ, negative.
    pub shift: f64,
    /// The number of eigenvalues up to one that is not below the last of `values`.
    pub count: Count,
    /// Number of all pairs with a finite eigenvalue.
    pub existing: usize,
}
