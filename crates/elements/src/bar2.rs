//! Two-node line on [-1, 1]: N = (1 ∓ ξ)/2.

use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Bar2,
    name: "bar2",
    linear: Kind::Bar2,
    dim: 1,
    nodes: 2,
    degree: 1,
    reference: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    // The outward axis runs from node 1 to node 0 at the first face, from node 0 to node 1 at the second.
    faces: &[face(&[0]), face(&[1])],
    gmsh: 1,
    gmsh_order: natural(2),
    vtk: 3,
    vtk_order: natural(2),
    shape,
    gradient,
    stiffness_rule: &quadrature::LINE_1,
    mass_rule: &quadrature::LINE_2,
    contains: |xi, slack| xi[0].abs() <= 1.0 + slack,
};

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Point1,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    n[0] = 0.5 * (1.0 - xi[0]);
    n[1] = 0.5 * (1.0 + xi[0]);
}

fn gradient(_: &[f64; 3], dn: &mut [[f64; 3]]) {
    dn[0] = [-0.5, 0.0, 0.0];
    dn[1] = [0.5, 0.0, 0.0];
}
