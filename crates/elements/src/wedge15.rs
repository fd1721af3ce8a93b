//! Fifteen-node wedge, the unit triangle times [-1, 1], serendipity functions. With z = ζ_a ζ: at the corners
//! N = L [(2L - 1)(1 + z) - (1 - ζ²)]/2, in the middle of the edges 01, 12, 20, 34, 45, 53 of the triangles
//! N = 2 L L' (1 + z), in the middle of the edges 03, 14, 25 N = L (1 - ζ²). Gmsh lists the edges in another order.

use crate::{Element, Face, Kind, natural, quadrature, tri3, wedge6};

pub static ELEMENT: Element = Element {
    kind: Kind::Wedge15,
    name: "wedge15",
    linear: Kind::Wedge6,
    dim: 3,
    nodes: 15,
    degree: 3,
    reference: &[
        [0.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [0.5, 0.0, -1.0],
        [0.5, 0.5, -1.0],
        [0.0, 0.5, -1.0],
        [0.5, 0.0, 1.0],
        [0.5, 0.5, 1.0],
        [0.0, 0.5, 1.0],
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
    ],
    faces: &[
        face(Kind::Tri6, &[0, 2, 1, 8, 7, 6]),
        face(Kind::Tri6, &[3, 4, 5, 9, 10, 11]),
        face(Kind::Quad8, &[0, 1, 4, 3, 6, 13, 9, 12]),
        face(Kind::Quad8, &[1, 2, 5, 4, 7, 14, 10, 13]),
        face(Kind::Quad8, &[2, 0, 3, 5, 8, 12, 11, 14]),
    ],
    gmsh: 18,
    gmsh_order: &[0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11],
    vtk: 26,
    vtk_order: natural(15),
    shape,
    gradient,
    stiffness_rule: &quadrature::WEDGE_18,
    mass_rule: &quadrature::WEDGE_18,
    contains: wedge6::ELEMENT.contains,
};

const fn face(kind: Kind, nodes: &'static [usize]) -> Face {
    Face { kind, nodes }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    let mut l = [0.0; 3];
    (tri3::ELEMENT.shape)(xi, &mut l);
    let bubble = 1.0 - xi[2] * xi[2];
    for a in 0..3 {
        let b = (a + 1) % 3;
        for (layer, end) in [1.0 - xi[2], 1.0 + xi[2]].into_iter().enumerate() {
            n[a + 3 * layer] = 0.5 * l[a] * ((2.0 * l[a] - 1.0) * end - bubble);
            n[a + 3 * layer + 6] = 2.0 * l[a] * l[b] * end;
        }
        n[a + 12] = l[a] * bubble;
    }
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    let (mut l, mut dl) = ([0.0; 3], [[0.0; 3]; 3]);
    (tri3::ELEMENT.shape)(xi, &mut l);
    (tri3::ELEMENT.gradient)(xi, &mut dl);
    let (bubble, slope) = (1.0 - xi[2] * xi[2], -2.0 * xi[2]);
    for a in 0..3 {
        let b = (a + 1) % 3;
        for (layer, sign) in [-1.0, 1.0].into_iter().enumerate() {
            let end = 1.0 + sign * xi[2];
            // derivative by l, then by ζ
            let by_l = 0.5 * ((4.0 * l[a] - 1.0) * end - bubble);
            let by_zeta = 0.5 * l[a] * ((2.0 * l[a] - 1.0) * sign - slope);
            dn[a + 3 * layer] = [by_l * dl[a][0], by_l * dl[a][1], by_zeta];
            let middle = [0, 1].map(|i| 2.0 * (l[a] * dl[b][i] + dl[a][i] * l[b]) * end);
            dn[a + 3 * layer + 6] = [middle[0], middle[1], 2.0 * l[a] * l[b] * sign];
        }
        dn[a + 12] = [dl[a][0] * bubble, dl[a][1] * bubble, l[a] * slope];
    }
}
