//! Directions of displacements and rotations.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A direction of the axes.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first axis.
    X,
    /// The second axis.
    Y,
    /// The third axis.
    Z,
    /// The rotation about the first axis.
    Rx,
    /// The rotation about the second axis.
    Ry,
    /// The rotation about the third axis, the only one in the plane.
    Rz,
}

impl Axis {
    /// Component number, from 0, and whether it is a rotation.
    pub fn index(self) -> (usize, bool) {
        match self {
            Axis::X => (0, false),
            Axis::Y => (1, false),
            Axis::Z => (2, false),
            Axis::Rx => (0, true),
            Axis::Ry => (1, true),
            Axis::Rz => (2, true),
        }
    }
}
