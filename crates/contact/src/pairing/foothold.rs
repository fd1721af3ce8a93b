//! The foot of a point on a face.

use carom_elements::{Element, MAX_FACE_NODES as NODES};
use carom_mesh::{Face, Projection};

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
    /// A foot on a face that is still to be placed. `x` and `along` as in the fields.
    pub fn new(face: &Face, x: [[f64; 3]; NODES], along: [f64; 3]) -> Foothold {
        Foothold {
            face: *face,
            x,
            xi: [0.0; 3],
            shape: [0.0; NODES],
            r: [0.0; 3],
            inside: true,
            along,
        }
    }

    /// Places it below a point, m.
    pub fn place(&mut self, foot: &Projection, point: &[f64; 3]) {
        (self.xi, self.inside) = (foot.xi, foot.inside);
        self.r = [0, 1, 2].map(|i| point[i] - foot.point[i]);
        let element = self.element();
        (element.shape)(&foot.xi, &mut self.shape[..element.nodes]);
    }

    /// Row of data of the face.
    pub fn element(&self) -> &'static Element {
        self.face.kind.table()
    }

    /// Dimension of the face.
    pub fn dim(&self) -> usize {
        self.element().dim
    }
}
