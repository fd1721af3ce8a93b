//! Five-node pyramid over [-1, 1]² with its top at (0, 0, 1).
//!
//! N_a = [(1 + ξ_a ξ)(1 + η_a η) - ζ + ξ_a η_a ξ η ζ/(1 - ζ)]/4 at the base, N = ζ at the top. Linear on the triangles
//! and bilinear on the base, so that tetrahedra and hexahedra fit. Rational, but with ξ = x(1 - ζ) and η = y(1 - ζ) it is
//! N_a = (1 - ζ)(1 + ξ_a x)(1 + η_a y)/4: on affine cells the products N_a N_b and dN_a dN_b are polynomials in (x, y, ζ)
//! and the rules of the pyramid exact. At the top the functions have no gradient; given is the limit along the axis.
//! Bedrosian (1992).

use crate::{Element, Face, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Pyramid5,
    name: "pyramid5",
    linear: Kind::Pyramid5,
    dim: 3,
    nodes: 5,
    degree: 3,
    reference: &NODES,
    faces: &[
        face(Kind::Quad4, &[0, 3, 2, 1]),
        face(Kind::Tri3, &[0, 1, 4]),
        face(Kind::Tri3, &[1, 2, 4]),
        face(Kind::Tri3, &[2, 3, 4]),
        face(Kind::Tri3, &[3, 0, 4]),
    ],
    gmsh: 7,
    gmsh_order: natural(5),
    vtk: 14,
    vtk_order: natural(5),
    shape,
    gradient,
    stiffness_rule: &quadrature::PYRAMID_4,
    mass_rule: &quadrature::PYRAMID_8,
    contains: |xi, slack| {
        let half = 1.0 - xi[2] + slack;
        xi[2] >= -slack && xi[0].abs() <= half && xi[1].abs() <= half
    },
};

const NODES: [[f64; 3]; 5] = [
    [-1.0, -1.0, 0.0],
    [1.0, -1.0, 0.0],
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];

const fn face(kind: Kind, nodes: &'static [usize]) -> Face {
    Face { kind, nodes }
}

/// ξ/(1 - ζ) and η/(1 - ζ); zero at the height of the top.
fn collapsed(xi: &[f64; 3]) -> [f64; 2] {
    let above = 1.0 - xi[2];
    match above.abs() < 1e-12 {
        true => [0.0; 2],
        false => [xi[0] / above, xi[1] / above],
    }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    let y = collapsed(xi)[1];
    for (n, a) in n.iter_mut().zip(&NODES[..4]) {
        let bilinear = (1.0 + a[0] * xi[0]) * (1.0 + a[1] * xi[1]);
        *n = 0.25 * (bilinear - xi[2] + a[0] * a[1] * xi[0] * y * xi[2]);
    }
    n[4] = xi[2];
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    let [x, y] = collapsed(xi);
    for (dn, a) in dn.iter_mut().zip(&NODES[..4]) {
        *dn = [
            0.25 * a[0] * (1.0 + a[1] * y),
            0.25 * a[1] * (1.0 + a[0] * x),
            0.25 * (a[0] * a[1] * x * y - 1.0),
        ];
    }
    dn[4] = [0.0, 0.0, 1.0];
}
