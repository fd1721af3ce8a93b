//! Three-node line on [-1, 1], the ends first, then the middle: N = (ξ(ξ - 1)/2, ξ(ξ + 1)/2, 1 - ξ²). The face of
//! quadratic plane cells.

use crate::quadratic::{product_gradient, product_shape};
use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Bar3,
    name: "bar3",
    linear: Kind::Bar2,
    dim: 1,
    nodes: 3,
    degree: 2,
    reference: &NODES,
    faces: &[face(&[0]), face(&[1])],
    gmsh: 8,
    gmsh_order: natural(3),
    vtk: 21,
    vtk_order: natural(3),
    shape: |xi, n| product_shape(1, &NODES, xi, n),
    gradient: |xi, dn| product_gradient(1, &NODES, xi, dn),
    stiffness_rule: &quadrature::LINE_2,
    mass_rule: &quadrature::LINE_3,
    contains: |xi, slack| xi[0].abs() <= 1.0 + slack,
};

const NODES: [[f64; 3]; 3] = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Point1,
        nodes,
    }
}
