//! Twenty-node hexahedron on [-1, 1]³, serendipity functions: corners, then the middle of the edges 01, 12, 23, 30, 45,
//! 56, 67, 74, 04, 15, 26, 37. Gmsh lists the edges in another order.

use crate::quadratic::{serendipity_gradient, serendipity_shape};
use crate::{Element, Face, Kind, hex8, hex27, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Hex20,
    name: "hex20",
    linear: Kind::Hex8,
    dim: 3,
    nodes: 20,
    degree: 4,
    reference: hex27::NODES.split_at(20).0,
    faces: &[
        face(&[0, 3, 2, 1, 11, 10, 9, 8]),
        face(&[4, 5, 6, 7, 12, 13, 14, 15]),
        face(&[0, 1, 5, 4, 8, 17, 12, 16]),
        face(&[1, 2, 6, 5, 9, 18, 13, 17]),
        face(&[2, 3, 7, 6, 10, 19, 14, 18]),
        face(&[3, 0, 4, 7, 11, 16, 15, 19]),
    ],
    gmsh: 17,
    gmsh_order: hex27::GMSH_ORDER.split_at(20).0,
    vtk: 25,
    vtk_order: natural(20),
    shape: |xi, n| serendipity_shape(3, &hex27::NODES[..20], xi, n),
    gradient: |xi, dn| serendipity_gradient(3, &hex27::NODES[..20], xi, dn),
    stiffness_rule: &quadrature::CUBE_27,
    mass_rule: &quadrature::CUBE_27,
    contains: hex8::ELEMENT.contains,
};

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Quad8,
        nodes,
    }
}
