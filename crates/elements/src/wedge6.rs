//! Six-node wedge, the unit triangle times [-1, 1]: N_a = L_a (1 + ζ_a ζ)/2. The triangle 012 is at ζ = -1; VTK wants it
//! turned outward.

use crate::{Element, Face, Kind, natural, quadrature, tri3};

pub static ELEMENT: Element = Element {
    kind: Kind::Wedge6,
    name: "wedge6",
    linear: Kind::Wedge6,
    dim: 3,
    nodes: 6,
    degree: 2,
    reference: &[
        [0.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, -1.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
    ],
    faces: &[
        face(Kind::Tri3, &[0, 2, 1]),
        face(Kind::Tri3, &[3, 4, 5]),
        face(Kind::Quad4, &[0, 1, 4, 3]),
        face(Kind::Quad4, &[1, 2, 5, 4]),
        face(Kind::Quad4, &[2, 0, 3, 5]),
    ],
    gmsh: 6,
    gmsh_order: natural(6),
    vtk: 13,
    vtk_order: &[0, 2, 1, 3, 5, 4],
    shape,
    gradient,
    stiffness_rule: &quadrature::WEDGE_6,
    mass_rule: &quadrature::WEDGE_6,
    contains: |xi, slack| (tri3::ELEMENT.contains)(xi, slack) && xi[2].abs() <= 1.0 + slack,
};

const fn face(kind: Kind, nodes: &'static [usize]) -> Face {
    Face { kind, nodes }
}

fn shape(xi: &[f64; 3], n: &mut [f64]) {
    let mut l = [0.0; 3];
    (tri3::ELEMENT.shape)(xi, &mut l);
    for a in 0..3 {
        n[a] = 0.5 * l[a] * (1.0 - xi[2]);
        n[a + 3] = 0.5 * l[a] * (1.0 + xi[2]);
    }
}

fn gradient(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
    let (mut l, mut dl) = ([0.0; 3], [[0.0; 3]; 3]);
    (tri3::ELEMENT.shape)(xi, &mut l);
    (tri3::ELEMENT.gradient)(xi, &mut dl);
    let (below, above) = (0.5 * (1.0 - xi[2]), 0.5 * (1.0 + xi[2]));
    for a in 0..3 {
        dn[a] = [dl[a][0] * below, dl[a][1] * below, -0.5 * l[a]];
        dn[a + 3] = [dl[a][0] * above, dl[a][1] * above, 0.5 * l[a]];
    }
}
