//! A matrix that an engine of the ranks solves with: PETSc, with the feature `petsc`, and nothing without.

/// Rows of a symmetric positive definite matrix that ranks share.
pub struct OwnRows<'a> {
    /// Where the rows of each rank begin, and their end.
    pub starts: &'a [usize],
    /// Where each own row begins in the entries, and their end.
    pub offsets: Vec<i32>,
    /// Column of each entry.
    pub columns: Vec<i32>,
    /// Entries, N/m.
    pub values: Vec<f64>,
    /// Unknowns of a node; 1 where nodes have different numbers of them.
    pub block: usize,
    /// Places of the own nodes, as many coordinates as unknowns, m; empty where unknowns are not displacements alone. Rigid motions follow
    /// from them.
    pub places: Vec<f64>,
}

/// Why a solve did not end.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsolved {
    /// Iterations taken.
    pub iterations: usize,
    /// Residual in the norm of the preconditioner over that of the load.
    pub residual: f64,
    /// What the engine says.
    pub cause: String,
}

/// The solver of a matrix; there is none without an engine.
#[cfg(not(feature = "petsc"))]
pub enum Engine {}

#[cfg(not(feature = "petsc"))]
impl Engine {
    /// x of A x = b, whole on all ranks, and the iterations taken.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub fn solve(
        &mut self,
        _b: &[f64],
        _x: &mut [f64],
        _tolerance: f64,
    ) -> Result<usize, Unsolved> {
        match *self {}
    }
}

#[cfg(feature = "petsc")]
pub use crate::petsc::Engine;
