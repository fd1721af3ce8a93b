//! Nine-node quadrilateral on [-1, 1]²: products of the quadratic Lagrange polynomials. Corners, the middle of the edges
//! 01, 12, 23, 30, the centre.

use crate::quadratic::{product_gradient, product_shape};
use crate::{Element, Face, Kind, natural, quad4, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Quad9,
    name: "quad9",
    linear: Kind::Quad4,
    dim: 2,
    nodes: 9,
    degree: 4,
    reference: &NODES,
    faces: &FACES,
    gmsh: 10,
    gmsh_order: natural(9),
    vtk: 28,
    vtk_order: natural(9),
    shape: |xi, n| product_shape(2, &NODES, xi, n),
    gradient: |xi, dn| product_gradient(2, &NODES, xi, dn),
    stiffness_rule: &quadrature::SQUARE_9,
    mass_rule: &quadrature::SQUARE_9,
    contains: quad4::ELEMENT.contains,
};

pub(crate) static NODES: [[f64; 3]; 9] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [-1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0],
];

/// Those of quad8 too.
pub(crate) const FACES: [Face; 4] = [
    face(&[0, 1, 4]),
    face(&[1, 2, 5]),
    face(&[2, 3, 6]),
    face(&[3, 0, 7]),
];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Bar3,
        nodes,
    }
}
