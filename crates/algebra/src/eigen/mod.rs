//! The lowest pairs of K φ = ω² M φ of large sparse matrices, by Lanczos' method with a shift, and their number by inertia.
//!
//! With K - σ M = L Lᵀ at a shift σ below all ω² the pairs are those of the symmetric operator P L⁻¹ M L⁻ᵀ P, whose largest
//! eigenvalues are 1/(ω² - σ): `operator.rs`. P is the projection that takes out constraints C φ = 0 and the vectors found
//! before. The method of Rayleigh and Ritz makes the vectors M-orthonormal, and inertia counts the eigenvalues below a value
//! ([`QuasiDefinite::negative_eigenvalues`]): Lanczos' method may miss vectors of multiple eigenvalues, which are then sought in the
//! complement. (The matrix-free method of faer 0.24 loses vectors and returns others twice where pairs converge out of order.)
//! Source: Ericsson and Ruhe, Mathematics of Computation 35 (1980).

mod free;
mod lanczos;
mod operator;
mod search;

use crate::Error;
use crate::csr::Csr;
use crate::solver::SparseRow;

#[cfg(doc)]
use crate::solver::QuasiDefinite;

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

/// The `count` lowest pairs, or all where there are fewer.
///
/// Bits do not depend on the number of threads.
///
/// # Errors
/// K that is not positive semi-definite, or, with M, vanishes for an unknown that is not held alone; entries that are not
/// finite; no convergence; a lack of memory.
pub fn lowest(problem: &Problem, count: usize) -> Result<Eigenpairs, Error> {
    let free = free::Free::new(problem);
    let found = search::Search::new(&free)?.run(count)?;
    Ok(Eigenpairs {
        vectors: found.vectors.iter().map(|x| free.expand(x)).collect(),
        ..found
    })
}

#[cfg(test)]
mod tests;
