//! Solvers of sparse systems.
//!
//! [`Cholesky`] factorises a symmetric positive definite matrix once and offers the two halves of a solve apart, because a
//! step with contact costs one forward and one backward sweep: with A = Pᵀ L Lᵀ P and contact rows N,
//! y = L⁻¹ P r, Y = L⁻¹ P Nᵀ (sparse, computed once), W = Yᵀ Y = N A⁻¹ Nᵀ, N x_free = Yᵀ y, x = Pᵀ L⁻ᵀ (y + Y p).

mod cholesky;
mod front;
mod fronts;
mod gram;
mod iterative;
mod panel;
mod quasi_definite;
mod response;
mod saddle;
mod shared_rows;
mod squares;
mod supernodal;
mod sweep;
mod symmetric_blocks;

pub use crate::ordering::{Ordering, Place};
pub use cholesky::{Cholesky, FactorStats};
pub use gram::gram;
pub use iterative::Iterative;
pub use quasi_definite::QuasiDefinite;
pub use response::{Response, SparseRow};
pub use saddle::Saddle;
pub use shared_rows::SharedRows;

pub(crate) use panel::{backward, forward};
