//! Four-node tetrahedron on the unit simplex: N = (1 - ξ - η - ζ, ξ, η, ζ).

use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Tet4,
    name: "tet4",
    linear: Kind::Tet4,
    dim: 3,
    nodes: 4,
    degree: 1,
    reference: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ],
    faces: &[
        face(&[0, 2, 1]),
        face(&[0, 1, 3]),
        face(&[1, 2, 3]),
        face(&[0, 3, 2]),
    ],
    gmsh: 4,
    gmsh_order: natural(4),
    vtk: 10,
    vtk_order: natural(4),
    shape,
    gradient,
    stiffness_rule: &quadrature::TETRAHEDRON_1,
    mass_rule: &quadrature::TETRAHEDRON_4,
    contains: |xi, slack| xi.iter().all(|&x| x >= -slack) && xi[0] + xi[1] + xi[2] <= 1.0 + slack,
};

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Tri3,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    n[0] = 1.0 - xi[0] - xi[1] - xi[2];
    n[1..4].copy_from_slice(xi);
}

fn gradient(_: &[f64; 3], dn: &mut [[f64; 3]]) {
    dn[0] = [-1.0, -1.0, -1.0];
    dn[1] = [1.0, 0.0, 0.0];
    dn[2] = [0.0, 1.0, 0.0];
    dn[3] = [0.0, 0.0, 1.0];
}
