//! Eight-node hexahedron on [-1, 1]³: N_a = (1 + ξ_a ξ)(1 + η_a η)(1 + ζ_a ζ)/8.

use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Hex8,
    name: "hex8",
    linear: Kind::Hex8,
    dim: 3,
    nodes: 8,
    degree: 3,
    reference: &NODES,
    faces: &[
        face(&[0, 3, 2, 1]),
        face(&[4, 5, 6, 7]),
        face(&[0, 1, 5, 4]),
        face(&[1, 2, 6, 5]),
        face(&[2, 3, 7, 6]),
        face(&[3, 0, 4, 7]),
    ],
    gmsh: 5,
    gmsh_order: natural(8),
    vtk: 12,
    vtk_order: natural(8),
    shape,
    gradient,
    stiffness_rule: &quadrature::CUBE_8,
    mass_rule: &quadrature::CUBE_8,
    contains: |xi, slack| xi.iter().all(|x| x.abs() <= 1.0 + slack),
};

const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Quad4,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    for (n, a) in n.iter_mut().zip(&NODES) {
        *n = 0.125 * (1.0 + a[0] * xi[0]) * (1.0 + a[1] * xi[1]) * (1.0 + a[2] * xi[2]);
    }
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    for (dn, a) in dn.iter_mut().zip(&NODES) {
        let [f, g, h] = [0, 1, 2].map(|i| 1.0 + a[i] * xi[i]);
        *dn = [
            0.125 * a[0] * g * h,
            0.125 * a[1] * h * f,
            0.125 * a[2] * f * g,
        ];
    }
}
