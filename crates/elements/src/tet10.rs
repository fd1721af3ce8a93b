//! Ten-node tetrahedron on the unit simplex: L(2L - 1) at the corners, 4 L L' in the middle of the edges 01, 12, 20, 03,
//! 13, 23. Gmsh lists the last two the other way round.

use crate::quadratic::{simplex_gradient, simplex_shape};
use crate::{Element, Face, Kind, natural, quadrature, tet4};

pub static ELEMENT: Element = Element {
    kind: Kind::Tet10,
    name: "tet10",
    linear: Kind::Tet4,
    dim: 3,
    nodes: 10,
    degree: 2,
    reference: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.0],
        [0.0, 0.0, 0.5],
        [0.5, 0.0, 0.5],
        [0.0, 0.5, 0.5],
    ],
    faces: &[
        face(&[0, 2, 1, 6, 5, 4]),
        face(&[0, 1, 3, 4, 8, 7]),
        face(&[1, 2, 3, 5, 9, 8]),
        face(&[0, 3, 2, 7, 9, 6]),
    ],
    gmsh: 11,
    gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8],
    vtk: 24,
    vtk_order: natural(10),
    shape,
    gradient,
    stiffness_rule: &quadrature::TETRAHEDRON_4,
    mass_rule: &quadrature::TETRAHEDRON_14,
    contains: tet4::ELEMENT.contains,
};

const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Tri6,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    let mut l = [0.0; 4];
    (tet4::ELEMENT.shape)(xi, &mut l);
    simplex_shape(&l, &EDGES, n);
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    let (mut l, mut dl) = ([0.0; 4], [[0.0; 3]; 4]);
    (tet4::ELEMENT.shape)(xi, &mut l);
    (tet4::ELEMENT.gradient)(xi, &mut dl);
    simplex_gradient(&l, &dl, &EDGES, dn);
}
