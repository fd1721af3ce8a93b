//! A face of a surface.

use carom_elements::{Kind, MAX_FACE_NODES};

use crate::{ElementId, Rim};

/// A face of a surface, turned so that its normal points out of the parent cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Kind of the face.
    pub kind: Kind,
    /// Node numbers; only as many entries as the kind has nodes are used ([`Face::corners`]).
    pub nodes: [u32; MAX_FACE_NODES],
    /// The cell that the face bounds.
    pub parent: ElementId,
    /// For a point, the end of a bar: unit vector along the bar, outward, in the reference position. Zero for
    /// other kinds, whose normal follows from their nodes.
    pub axis: [f64; 3],
    /// Distance of the surface from the face, m: of the axis of a beam, of a point of it, or of the middle of a shell all around it, of a
    /// point with an axis along that. `None` where the face is the surface itself.
    pub radius: Option<f64>,
    /// Its edges and corners at the rim of the surface; none where nobody has looked.
    pub rim: Rim,
}

impl Face {
    /// The nodes of the face, in its own order.
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..self.kind.table().nodes]
    }

    /// The same face with its nodes in other numbers.
    pub fn renumbered(mut self, number: impl Fn(u32) -> u32) -> Face {
        for node in &mut self.nodes[..self.kind.table().nodes] {
            *node = number(*node);
        }
        self
    }

    /// Whether the surface is all around it, at its radius: normals then point from the face to the other side.
    pub fn is_round(&self) -> bool {
        self.radius.is_some() && self.axis == [0.0; 3]
    }

    /// Mean length of its edges, the lines between their ends, in m; of a line its own, of a point zero. `x`: coordinates by
    /// the numbers of its nodes.
    pub fn length(&self, x: &[[f64; 3]]) -> f64 {
        let table = self.kind.table();
        let between = |a: usize, b: usize| {
            let [a, b] = [a, b].map(|k| x[self.nodes[k] as usize]);
            let squares = (0..3).map(|i| (a[i] - b[i]).powi(2));
            squares.sum::<f64>().sqrt()
        };
        match table.dim {
            0 => 0.0,
            1 => between(0, 1),
            _ => {
                let edges = table.faces.iter();
                let lengths = edges.map(|edge| between(edge.nodes[0], edge.nodes[1]));
                lengths.sum::<f64>() / table.faces.len() as f64
            }
        }
    }
}

/// A list of nodes as in [`Face::nodes`]: entries that are not used are the largest number, so that sorted lists
/// compare.
pub fn face_nodes(nodes: &[u32]) -> [u32; MAX_FACE_NODES] {
    let mut out = [u32::MAX; MAX_FACE_NODES];
    out[..nodes.len()].copy_from_slice(nodes);
    out
}
