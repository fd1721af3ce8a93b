//! What is known of an element kind.

use crate::{Kind, Rule};

/// The largest number of nodes of any kind: the length of stack arrays in element loops.
pub const MAX_NODES: usize = 27;

/// The largest number of nodes of a kind that is a face of another.
pub const MAX_FACE_NODES: usize = 9;

/// What is known of an element kind: plain data, one static per kind.
#[derive(Debug)]
pub struct Element {
    /// The kind that this row describes.
    pub kind: Kind,
    /// Lower-case name, as in messages: `"hex8"`.
    pub name: &'static str,
    /// The kind of the same shape with the corners alone for nodes, which are the first ones here; itself if linear.
    pub linear: Kind,
    /// Dimension of the reference cell, 0 to 3.
    pub dim: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// Total degree of the shape functions under an affine map; of rational ones the least that integrates them well.
    pub degree: usize,
    /// Node coordinates in the reference cell, in node order.
    pub reference: &'static [[f64; 3]],
    /// Faces of the cell (dimension one less), each ordered so that its normal points out of the cell.
    pub faces: &'static [Face],
    /// Element type number in Gmsh files.
    pub gmsh: u32,
    /// Place of each node in the list of a Gmsh file: node `a` here is entry `gmsh_order[a]` there.
    pub gmsh_order: &'static [usize],
    /// Cell type number in VTK files.
    pub vtk: u8,
    /// Place of each node in the list of a VTK file: node `a` here is entry `vtk_order[a]` there.
    pub vtk_order: &'static [usize],
    /// Shape functions N_a(ξ) into a slice of length `nodes`, dimensionless.
    pub shape: fn(&[f64; 3], &mut [f64]),
    /// Gradients dN_a/dξ in the reference cell, into a slice of length `nodes`; components beyond `dim` are zero.
    pub gradient: fn(&[f64; 3], &mut [[f64; 3]]),
    /// Exact for the stiffness of linear elasticity on affine cells.
    pub stiffness_rule: &'static Rule,
    /// Exact for the products N_a N_b on affine cells.
    pub mass_rule: &'static Rule,
    /// Whether a reference point lies in the cell, widened on every side by the slack (in reference units).
    pub contains: fn(&[f64; 3], f64) -> bool,
}

impl Element {
    /// Exact for the stiffness of linear elasticity times a linear weight, on affine cells: quadratic triangles and tetrahedra have
    /// products of the third degree, beyond their stiffness rule.
    pub fn weighted_stiffness_rule(&self) -> &'static Rule {
        match self.kind {
            Kind::Tri6 | Kind::Tet10 => self.mass_rule,
            _ => self.stiffness_rule,
        }
    }

    /// Whether there are nodes besides the corners.
    pub fn is_quadratic(&self) -> bool {
        self.kind != self.linear
    }
}

/// The order 0, 1, 2 of a file that lists nodes as we do.
pub(crate) const fn natural(nodes: usize) -> &'static [usize] {
    const ORDER: [usize; MAX_NODES] = [
        0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24,
        25, 26,
    ];
    ORDER.split_at(nodes).0
}

/// A face of a cell, in the numbers of the cell's nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Kind of the face.
    pub kind: Kind,
    /// Nodes of the cell that make the face, in the face's own node order. Seen from outside a solid cell they
    /// turn counter-clockwise; along the edge of a plane cell the cell lies to the left.
    pub nodes: &'static [usize],
}
