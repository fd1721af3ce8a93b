//! Eight-node quadrilateral on [-1, 1]², serendipity functions: corners, then the middle of the edges 01, 12, 23, 30.

use crate::quadratic::{serendipity_gradient, serendipity_shape};
use crate::{Element, Kind, natural, quad4, quad9, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Quad8,
    name: "quad8",
    linear: Kind::Quad4,
    dim: 2,
    nodes: 8,
    degree: 3,
    reference: quad9::NODES.split_at(8).0,
    faces: &quad9::FACES,
    gmsh: 16,
    gmsh_order: natural(8),
    vtk: 23,
    vtk_order: natural(8),
    shape: |xi, n| serendipity_shape(2, &quad9::NODES[..8], xi, n),
    gradient: |xi, dn| serendipity_gradient(2, &quad9::NODES[..8], xi, dn),
    stiffness_rule: &quadrature::SQUARE_9,
    mass_rule: &quadrature::SQUARE_9,
    contains: quad4::ELEMENT.contains,
};
