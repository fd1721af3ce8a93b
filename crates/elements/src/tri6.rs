//! Six-node triangle on the unit simplex: L(2L - 1) at the corners, 4 L L' in the middle of the edges 01, 12, 20.

use crate::quadratic::{simplex_gradient, simplex_shape};
use crate::{Element, Face, Kind, natural, quadrature, tri3};

pub static ELEMENT: Element = Element {
    kind: Kind::Tri6,
    name: "tri6",
    linear: Kind::Tri3,
    dim: 2,
    nodes: 6,
    degree: 2,
    reference: &[
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.0],
    ],
    faces: &[face(&[0, 1, 3]), face(&[1, 2, 4]), face(&[2, 0, 5])],
    gmsh: 9,
    gmsh_order: natural(6),
    vtk: 22,
    vtk_order: natural(6),
    shape,
    gradient,
    stiffness_rule: &quadrature::TRIANGLE_3,
    mass_rule: &quadrature::TRIANGLE_6,
    contains: tri3::ELEMENT.contains,
};

const EDGES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

const fn face(nodes: &'static [usize]) -> Face {
    Face {
        kind: Kind::Bar3,
        nodes,
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    let mut l = [0.0; 3];
    (tri3::ELEMENT.shape)(xi, &mut l);
    simplex_shape(&l, &EDGES, n);
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    let (mut l, mut dl) = ([0.0; 3], [[0.0; 3]; 3]);
    (tri3::ELEMENT.shape)(xi, &mut l);
    (tri3::ELEMENT.gradient)(xi, &mut dl);
    simplex_gradient(&l, &dl, &EDGES, dn);
}
