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

/// The list of kinds: name, module and number of nodes of each. Calls the macro `use` with the tokens behind its name and
/// with the list.
#[macro_export]
macro_rules! kinds {
    ($use:ident $($with:tt)*) => {
        $use! {
            [$($with)*]
            /// A single point: the face of a bar.
            Point1 point1 1,
            /// Two-node line on [-1, 1], linear.
            Bar2 bar2 2,
            /// Three-node line on [-1, 1], quadratic: the face of quadratic plane cells.
            Bar3 bar3 3,
            /// Three-node triangle on the unit simplex, linear.
            Tri3 tri3 3,
            /// Six-node triangle on the unit simplex, quadratic.
            Tri6 tri6 6,
            /// Four-node quadrilateral on [-1, 1]², bilinear.
            Quad4 quad4 4,
            /// Eight-node quadrilateral on [-1, 1]², serendipity.
            Quad8 quad8 8,
            /// Nine-node quadrilateral on [-1, 1]², biquadratic.
            Quad9 quad9 9,
            /// Four-node tetrahedron on the unit simplex, linear.
            Tet4 tet4 4,
            /// Ten-node tetrahedron on the unit simplex, quadratic.
            Tet10 tet10 10,
            /// Eight-node hexahedron on [-1, 1]³, trilinear.
            Hex8 hex8 8,
            /// Twenty-node hexahedron on [-1, 1]³, serendipity.
            Hex20 hex20 20,
            /// Twenty-seven-node hexahedron on [-1, 1]³, triquadratic.
            Hex27 hex27 27,
            /// Six-node wedge, the unit triangle times [-1, 1].
            Wedge6 wedge6 6,
            /// Fifteen-node wedge, serendipity.
            Wedge15 wedge15 15,
            /// Five-node pyramid over [-1, 1]², rational.
            Pyramid5 pyramid5 5,
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
