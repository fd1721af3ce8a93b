//! Reference shapes, shape functions and quadrature.
//!
//! Every element kind is one row of data: its file holds a static [`Element`], and [`Kind::table`] is the only
//! place that tells kinds apart. Readers, writers, surfaces and bodies use the row. The crate knows nothing of
//! meshes or neighbours. Adding an element is one file, one variant and one arm; the battery (`battery.rs`) then
//! checks it.
//!
//! Node order is that of Gmsh and VTK, which agree for the kinds here. Points always have three components;
//! those beyond the dimension of the element are zero.

pub mod map;
pub mod quadrature;

mod bar2;
mod hex8;
mod point1;
mod quad4;
mod tet4;
mod tri3;

#[cfg(test)]
mod battery;

use serde::{Deserialize, Serialize};

pub use quadrature::Rule;

/// The largest number of nodes of any kind: the length of stack arrays in element loops.
pub const MAX_NODES: usize = 27;

/// The largest number of nodes of a kind that is a face of another.
pub const MAX_FACE_NODES: usize = 9;

/// The kind of an element: the key of its row of data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A single point: the face of a bar.
    Point1,
    /// Two-node line on [-1, 1], linear.
    Bar2,
    /// Three-node triangle on the unit simplex, linear.
    Tri3,
    /// Four-node quadrilateral on [-1, 1]², bilinear.
    Quad4,
    /// Four-node tetrahedron on the unit simplex, linear.
    Tet4,
    /// Eight-node hexahedron on [-1, 1]³, trilinear.
    Hex8,
}

impl Kind {
    /// All kinds, in the order of their declaration.
    pub const ALL: [Kind; 6] = [
        Kind::Point1,
        Kind::Bar2,
        Kind::Tri3,
        Kind::Quad4,
        Kind::Tet4,
        Kind::Hex8,
    ];

    /// The row of data of this kind.
    pub fn table(self) -> &'static Element {
        match self {
            Kind::Point1 => &point1::ELEMENT,
            Kind::Bar2 => &bar2::ELEMENT,
            Kind::Tri3 => &tri3::ELEMENT,
            Kind::Quad4 => &quad4::ELEMENT,
            Kind::Tet4 => &tet4::ELEMENT,
            Kind::Hex8 => &hex8::ELEMENT,
        }
    }

    /// The kind with this Gmsh element type number; `None` if no kind has it.
    pub fn from_gmsh(code: u32) -> Option<Kind> {
        Kind::ALL.into_iter().find(|kind| kind.table().gmsh == code)
    }
}

/// What is known of an element kind: plain data, one static per kind.
#[derive(Debug)]
pub struct Element {
    /// The kind that this row describes.
    pub kind: Kind,
    /// Lower-case name, as in messages: `"hex8"`.
    pub name: &'static str,
    /// Dimension of the reference cell, 0 to 3.
    pub dim: usize,
    /// Number of nodes.
    pub nodes: usize,
    /// Node coordinates in the reference cell, in node order.
    pub reference: &'static [[f64; 3]],
    /// Faces of the cell (dimension one less), each ordered so that its normal points out of the cell.
    pub faces: &'static [Face],
    /// Element type number in Gmsh files.
    pub gmsh: u32,
    /// Cell type number in VTK files.
    pub vtk: u8,
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

/// A face of a cell, in the numbers of the cell's nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Kind of the face.
    pub kind: Kind,
    /// Nodes of the cell that make the face, in the face's own node order. Seen from outside a solid cell they
    /// turn counter-clockwise; along the edge of a plane cell the cell lies to the left.
    pub nodes: &'static [usize],
}
