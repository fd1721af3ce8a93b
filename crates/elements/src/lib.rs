//! Reference shapes, shape functions and quadrature.
//!
//! Every element kind is one row of data: its file holds a static [`Element`], and [`Kind::table`] is the only
//! place that tells kinds apart. Readers, writers, surfaces and bodies use the row. The crate knows nothing of
//! meshes or neighbours. Adding an element is one file and its lines here; the battery (`battery.rs`) then
//! checks it.
//!
//! Corners come first, then the middles of edges, of faces, of the cell: VTK's order of the nodes. Where Gmsh's or
//! VTK's differs, [`Element::gmsh_order`] and [`Element::vtk_order`] say how. Points always have three components; those
//! beyond the dimension of the element are zero.

/// The list of kinds: name and module of each.
macro_rules! kinds {
    ($declare:ident) => {
        $declare! {
            /// A single point: the face of a bar.
            Point1 point1,
            /// Two-node line on [-1, 1], linear.
            Bar2 bar2,
            /// Three-node line on [-1, 1], quadratic: the face of quadratic plane cells.
            Bar3 bar3,
            /// Three-node triangle on the unit simplex, linear.
            Tri3 tri3,
            /// Six-node triangle on the unit simplex, quadratic.
            Tri6 tri6,
            /// Four-node quadrilateral on [-1, 1]², bilinear.
            Quad4 quad4,
            /// Eight-node quadrilateral on [-1, 1]², serendipity.
            Quad8 quad8,
            /// Nine-node quadrilateral on [-1, 1]², biquadratic.
            Quad9 quad9,
            /// Four-node tetrahedron on the unit simplex, linear.
            Tet4 tet4,
            /// Ten-node tetrahedron on the unit simplex, quadratic.
            Tet10 tet10,
            /// Eight-node hexahedron on [-1, 1]³, trilinear.
            Hex8 hex8,
            /// Twenty-node hexahedron on [-1, 1]³, serendipity.
            Hex20 hex20,
            /// Twenty-seven-node hexahedron on [-1, 1]³, triquadratic.
            Hex27 hex27,
            /// Six-node wedge, the unit triangle times [-1, 1].
            Wedge6 wedge6,
            /// Fifteen-node wedge, serendipity.
            Wedge15 wedge15,
            /// Five-node pyramid over [-1, 1]², rational.
            Pyramid5 pyramid5,
        }
    };
}

pub mod map;
pub mod quadrature;

mod bar2;
mod bar3;
mod element;
mod hex20;
mod hex27;
mod hex8;
mod kind;
mod point1;
mod pyramid5;
mod quad4;
mod quad8;
mod quad9;
mod quadratic;
mod table;
mod tet10;
mod tet4;
mod tri3;
mod tri6;
mod wedge15;
mod wedge6;

#[cfg(test)]
mod battery;

use element::natural;
pub use element::{Element, Face, MAX_FACE_NODES, MAX_NODES};
pub use kind::Kind;
pub use quadrature::Rule;
