//! Three-node triangle on the unit simplex: N = (1 - ξ - η, ξ, η).

use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Tri3,
    name: "tri3",
    linear: Kind::Tri3,
    dim: 2,
    nodes: 3,
    degree: 1,
    reference: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    faces: &[face(&[0, 1]), face(&[1, 2]), face(&[2, 0])],
    gmsh: 2,
    gmsh_order: natural(3),
    vtk: 5,
    vtk_order: natural(3),
    shape,
    gradient,
    stiffness_rule: &quadrature::TRIANGLE_1,
    mass_rule: &quadrature::TRIANGLE_3,
    contains: |xi, slack| xi[0] >= -slack && xi[1] >= -slack && xi[0] + xi[1] <= 1.0 + slack,
};

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Bar2,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    n[0] = 1.0 - xi[0] - xi[1];
    n[1] = xi[0];
    n[2] = xi[1];
}

fn gradient(_: &[f64; 3], dn: &mut [[f64; 3]]) {
    dn[0] = [-1.0, -1.0, 0.0];
    dn[1] = [1.0, 0.0, 0.0];
    dn[2] = [0.0, 1.0, 0.0];
}
