//! Reference shapes, shape functions and quadrature.
//!
//! Every element kind is one row of data: its file holds a static [`Element`], and [`Kind::table`] is the only
//! place that tells kinds apart. Readers, writers, surfaces and bodies use the row. The crate knows nothing of
//! meshes or neighbours. Adding an element is one file, one variant and one arm; the battery (`battery.rs`) then
//! checks it.
//!
//! Corners come first, then the middles of edges, of faces, of the cell: VTK's order of the nodes. Where Gmsh's or
//! VTK's differs, [`Element::gmsh_order`] and [`Element::vtk_order`] say how. Points always have three components; those
//! beyond the dimension of the element are zero.

pub mod map;
pub mod quadrature;

mod bar2;
mod bar3;
mod hex20;
mod hex27;
mod hex8;
mod point1;
mod pyramid5;
mod quad4;
mod quad8;
mod quad9;
mod quadratic;
mod tet10;
mod tet4;
mod tri3;
mod tri6;
mod wedge15;
mod wedge6;

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
    /// Three-node line on [-1, 1], quadratic: the face of quadratic plane cells.
    Bar3,
    /// Three-node triangle on the unit simplex, linear.
    Tri3,
    /// Six-node triangle on the unit simplex, quadratic.
    Tri6,
    /// Four-node quadrilateral on [-1, 1]², bilinear.
    Quad4,
    /// Eight-node quadrilateral on [-1, 1]², serendipity.
    Quad8,
    /// Nine-node quadrilateral on [-1, 1]², biquadratic.
    Quad9,
    /// Four-node tetrahedron on the unit simplex, linear.
    Tet4,
    /// Ten-node tetrahedron on the unit simplex, quadratic.
    Tet10,
    /// Eight-node hexahedron on [-1, 1]³, trilinear.
    Hex8,
    /// Twenty-node hexahedron on [-1, 1]³, serendipity.
    Hex20,
    /// Twenty-seven-node hexahedron on [-1, 1]³, triquadratic.
    Hex27,
    /// Six-node wedge, the unit triangle times [-1, 1].
    Wedge6,
    /// Fifteen-node wedge, serendipity.
    Wedge15,
    /// Five-node pyramid over [-1, 1]², rational.
    Pyramid5,
}

impl Kind {
    /// All kinds, in the order of their declaration.
    pub const ALL: [Kind; 16] = [
        Kind::Point1,
        Kind::Bar2,
        Kind::Bar3,
        Kind::Tri3,
        Kind::Tri6,
        Kind::Quad4,
        Kind::Quad8,
        Kind::Quad9,
        Kind::Tet4,
        Kind::Tet10,
        Kind::Hex8,
        Kind::Hex20,
        Kind::Hex27,
        Kind::Wedge6,
        Kind::Wedge15,
        Kind::Pyramid5,
    ];

    /// The row of data of this kind.
    pub fn table(self) -> &'static Element {
        match self {
            Kind::Point1 => &point1::ELEMENT,
            Kind::Bar2 => &bar2::ELEMENT,
            Kind::Bar3 => &bar3::ELEMENT,
            Kind::Tri3 => &tri3::ELEMENT,
            Kind::Tri6 => &tri6::ELEMENT,
            Kind::Quad4 => &quad4::ELEMENT,
            Kind::Quad8 => &quad8::ELEMENT,
            Kind::Quad9 => &quad9::ELEMENT,
            Kind::Tet4 => &tet4::ELEMENT,
            Kind::Tet10 => &tet10::ELEMENT,
            Kind::Hex8 => &hex8::ELEMENT,
            Kind::Hex20 => &hex20::ELEMENT,
            Kind::Hex27 => &hex27::ELEMENT,
            Kind::Wedge6 => &wedge6::ELEMENT,
            Kind::Wedge15 => &wedge15::ELEMENT,
            Kind::Pyramid5 => &pyramid5::ELEMENT,
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
    /// The kind of the same shape with the corners alone for nodes, which are the first ones here; itself if linear.
    pub linear: Kind,
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
    /// Whether there are nodes besides the corners.
    pub fn is_quadratic(&self) -> bool {
        self.kind != self.linear
    }
}

/// The order 0, 1, 2 of a file that lists nodes as we do.
const fn natural(nodes: usize) -> &'static [usize] {
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
