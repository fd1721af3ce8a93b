//! How the linear equations of implicit steps are solved.

/// How the linear equations of implicit steps are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Solver {
    /// As predicted to cost less.
    #[default]
    Auto,
    /// A sparse Cholesky factor.
    Direct,
    /// Conjugate gradients; contact forces and motion are found together.
    Iterative,
}
