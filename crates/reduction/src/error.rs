//! Why there are no modes.

use thiserror::Error as ThisError;

/// Errors of this crate.
#[derive(Debug, ThisError)]
pub enum Error {
    /// The eigenvalues of a part were not found.
    #[error("modes of {}: {cause}", bodies.join(", "))]
    Eigenvalues {
        /// Bodies of the part.
        bodies: Vec<String>,
        /// Why.
        cause: carom_algebra::Error,
    },
}
