//! Twenty-seven-node hexahedron on [-1, 1]³: products of the quadratic Lagrange polynomials. The nodes of hex20, the
//! middle of the faces ξ = -1, ξ = 1, η = -1, η = 1, ζ = -1, ζ = 1, the centre. Gmsh lists edges and faces in another
//! order.

use crate::quadratic::{product_gradient, product_shape};
use crate::{Element, Face, Kind, hex8, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Hex27,
    name: "hex27",
    linear: Kind::Hex8,
    dim: 3,
    nodes: 27,
    degree: 6,
    reference: &NODES,
    faces: &[
        face(&[0, 3, 2, 1, 11, 10, 9, 8, 24]),
        face(&[4, 5, 6, 7, 12, 13, 14, 15, 25]),
        face(&[0, 1, 5, 4, 8, 17, 12, 16, 22]),
        face(&[1, 2, 6, 5, 9, 18, 13, 17, 21]),
        face(&[2, 3, 7, 6, 10, 19, 14, 18, 23]),
        face(&[3, 0, 4, 7, 11, 16, 15, 19, 20]),
    ],
    gmsh: 12,
    gmsh_order: &GMSH_ORDER,
    vtk: 29,
    vtk_order: natural(27),
    shape: |xi, n| product_shape(3, &NODES, xi, n),
    gradient: |xi, dn| product_gradient(3, &NODES, xi, dn),
    stiffness_rule: &quadrature::CUBE_27,
    mass_rule: &quadrature::CUBE_27,
    contains: hex8::ELEMENT.contains,
};

pub(crate) static NODES: [[f64; 3]; 27] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
    [0.0, -1.0, -1.0],
    [1.0, 0.0, -1.0],
    [0.0, 1.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, -1.0, 1.0],
    [1.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, -1.0],
    [0.0, 0.0, 1.0],
    [0.0, 0.0, 0.0],
];

/// The first twenty entries are the order of hex20.
pub(crate) static GMSH_ORDER: [usize; 27] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25,
    26,
];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Quad9,
        nodes,
    }
}
