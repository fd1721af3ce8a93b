//! The edge of the target that a point of an edge is closed at.

use serde::{Deserialize, Serialize};

/// The edge of the target that a point of an edge is closed at. Faces that are not plane may leave the cone of both while the edges still are in each
/// other: it stays with that edge, and on its side, until it is open or passes an end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Faced {
    /// Its number among the edges of the target.
    pub edge: u32,
    /// Whether the normal is -e × f, along the edge of the point and along the other one.
    pub is_reversed: bool,
}
