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
mod problem;
mod search;

use crate::Error;

pub use problem::{Count, Eigenpairs, Problem};

#[cfg(doc)]
use crate::solver::QuasiDefinite;

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
