//! What a body can refuse.

use carom_mesh::ElementId;
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
    /// Weights that do not fit the cells.
    #[error("body '{body}': {found} weights of {quantity} for cells with {expected} nodes in all")]
    WeightCount {
        /// Name of the body.
        body: String,
        /// Which weights: inertia or stiffness.
        quantity: &'static str,
        /// Values given.
        found: usize,
        /// Sum of the numbers of nodes of the cells.
        expected: usize,
    },
    /// Weights of inertia that give a negative row sum of the mass of an element, or none that is a number.
    #[error(
        "body '{body}': the weights of inertia of a cell give its node {node} the mass {mass:e} kg, which must not be negative"
    )]
    NegativeMass {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// Number of the node in the mesh, from 0.
        node: u32,
        /// Row sum ∫ ρ α N_a dV in kg.
        mass: f64,
    },
    /// A weight of stiffness that is negative at an integration point, or no number.
    #[error(
        "body '{body}': the weight of stiffness is {weight:e} at an integration point, which must not be negative"
    )]
    NegativeStiffness {
        /// Name of the body.
        body: String,
        /// The cell.
        cell: ElementId,
        /// δ at the point.
        weight: f64,
    },
}
