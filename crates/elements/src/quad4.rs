//! Four-node quadrilateral on [-1, 1]²: N_a = (1 + ξ_a ξ)(1 + η_a η)/4.

use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Quad4,
    name: "quad4",
    linear: Kind::Quad4,
    dim: 2,
    nodes: 4,
    degree: 2,
    reference: &NODES,
    faces: &[face(&[0, 1]), face(&[1, 2]), face(&[2, 3]), face(&[3, 0])],
    gmsh: 3,
    gmsh_order: natural(4),
    vtk: 9,
    vtk_order: natural(4),
    shape,
    gradient,
    stiffness_rule: &quadrature::SQUARE_4,
    mass_rule: &quadrature::SQUARE_4,
    contains: |xi, slack| xi[0].abs() <= 1.0 + slack && xi[1].abs() <= 1.0 + slack,
};

const NODES: [[f64; 3]; 4] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Bar2,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    for (n, a) in n.iter_mut().zip(&NODES) {
        *n = 0.25 * (1.0 + a[0] * xi[0]) * (1.0 + a[1] * xi[1]);
    }
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    for (dn, a) in dn.iter_mut().zip(&NODES) {
        let [f, g] = [1.0 + a[0] * xi[0], 1.0 + a[1] * xi[1]];
        *dn = [0.25 * a[0] * g, 0.25 * a[1] * f, 0.0];
    }
}
