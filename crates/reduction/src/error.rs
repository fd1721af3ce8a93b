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
    /// A body of whose modes no use can be made.
    #[error("modes of body '{body}' cannot be taken: {why}")]
    Refused {
        /// Its name.
        body: String,
        /// Why, and what would do.
        why: &'static str,
    },
    /// More modes than there are.
    #[error(
        "body '{body}' has {exist} modes with its retained nodes, as many as unknowns with mass that are not held; {asked} were asked for"
    )]
    Count {
        /// Its name.
        body: String,
        /// The number asked for.
        asked: usize,
        /// The number that exist.
        exist: usize,
    },
    /// Modes of a body that cannot be damped.
    #[error("modes of body '{body}' cannot be damped: {why}")]
    Damped {
        /// Its name.
        body: String,
        /// Why.
        why: String,
    },
    /// A static response that could not be computed.
    #[error("body '{body}' cannot be reduced: {cause}")]
    Static {
        /// Its name.
        body: String,
        /// Why.
        cause: carom_algebra::Error,
    },
    /// Bytes of a reduction that cannot be used.
    #[error("the saved reduction of body '{body}' cannot be used: {why}")]
    Saved {
        /// Its name.
        body: String,
        /// Why.
        why: &'static str,
    },
    /// The body by itself could not be built.
    #[error(transparent)]
    System(#[from] carom_system::Error),
    /// A stiffness that could not be computed.
    #[error(transparent)]
    Body(#[from] carom_bodies::Error),
}
