//! What a body can refuse.

use thiserror::Error as ThisError;

/// Why a body could not be built.
#[derive(Debug, ThisError)]
pub enum Error {
    /// The body has no element.
    #[error("body '{body}' has no element")]
    Empty {
        /// Name of the body.
        body: String,
    },
    /// Elements of another dimension than the kinematics asks for.
    #[error(
        "body '{body}': {found} elements cannot be {kinematics}, which takes elements of dimension {dim}"
    )]
    WrongElement {
        /// Name of the body.
        body: String,
        /// Name of the element kind found.
        found: &'static str,
        /// Name of the kinematics.
        kinematics: &'static str,
        /// Dimension of the elements that it takes.
        dim: usize,
    },
    /// An axisymmetric model lies partly at negative radius.
    #[error(
        "body '{body}': node {node} has the radius {radius:e} m, negative in an axisymmetric model"
    )]
    NegativeRadius {
        /// Name of the body.
        body: String,
        /// Number of the node in the mesh, from 0.
        node: u32,
        /// Its first coordinate in m.
        radius: f64,
    },
}
