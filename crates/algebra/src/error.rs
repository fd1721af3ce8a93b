//! What can go wrong in a factorisation.

/// Why a matrix could not be analysed or factorised.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// A pivot was not positive: the matrix is indefinite, singular, or nearly so.
    #[error(
        "the matrix is not positive definite: the pivot of unknown {unknown} is not positive (its diagonal entry is {diagonal:e})"
    )]
    NotPositiveDefinite {
        /// Number of the unknown, in the numbering of the matrix.
        unknown: usize,
        /// Diagonal entry of that unknown before the factorisation.
        diagonal: f64,
    },
    /// An entry is infinite or not a number.
    #[error("entry ({row}, {column}) of the matrix is {value}")]
    NotFinite {
        /// Row of the entry.
        row: usize,
        /// Column of the entry.
        column: usize,
        /// Value found.
        value: f64,
    },
    /// An array has the wrong length.
    #[error("{what}: {found} entries given, {expected} needed")]
    WrongLength {
        /// Name of the array.
        what: &'static str,
        /// Length needed.
        expected: usize,
        /// Length found.
        found: usize,
    },
    /// A matrix given for a new factorisation has other entries than the one that was analysed.
    #[error(
        "the pattern of the matrix is not the one that was analysed ({found} stored entries, {expected} then)"
    )]
    PatternChanged {
        /// Stored entries of the analysed matrix.
        expected: usize,
        /// Stored entries of the matrix given now.
        found: usize,
    },
    /// The symbolic factorisation failed: out of memory, or more entries than an index can hold.
    #[error("analysis of {unknowns} unknowns failed: {reason}")]
    Analysis {
        /// Number of unknowns.
        unknowns: usize,
        /// Cause, as the library reports it.
        reason: String,
    },
    /// The factor has no room.
    #[error(transparent)]
    Memory(#[from] carom_ranks::memory::Short),
    /// Iterations do not end: the matrix is not positive definite, or nearly singular.
    #[error(
        "after {iterations} iterations the residual is {residual:.1e} of the first, most of it at unknown {unknown}"
    )]
    Iterations {
        /// Iterations made.
        iterations: usize,
        /// Least residual over the first.
        residual: f64,
        /// Unknown with the largest residual.
        unknown: usize,
    },
    /// The engine of the ranks does not solve.
    #[error("{cause}")]
    Engine {
        /// What it says.
        cause: String,
    },
}
