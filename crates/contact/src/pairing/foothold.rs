//! The foot of a point on a face.

use carom_elements::{Element, MAX_FACE_NODES as NODES};
use carom_mesh::Face;

/// A foot on a face.
#[derive(Clone, Debug)]
pub struct Foothold {
    pub face: Face,
    /// Positions of its nodes, m.
    pub x: [[f64; 3]; NODES],
    /// Coordinates of the foot in the reference cell.
    pub xi: [f64; 3],
    /// N_b there.
    pub shape: [f64; NODES],
    /// From the foot to the point, m.
    pub r: [f64; 3],
    /// Whether r is normal to the face.
    pub inside: bool,
    /// Of a point that crosses the face, the derivative of its place along its own line, m; zero of others.
    pub along: [f64; 3],
}

impl Foothold {
    /// Row of data of the face.
    pub fn element(&self) -> &'static Element {
        self.face.kind.table()
    }

    /// Dimension of the face.
    pub fn dim(&self) -> usize {
        self.element().dim
    }
}
