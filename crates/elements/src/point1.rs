//! One point: N_1 = 1. The face of a bar.

use crate::{Element, Kind, natural, quadrature};

pub static ELEMENT: Element = Element {
    kind: Kind::Point1,
    name: "point1",
    linear: Kind::Point1,
    dim: 0,
    nodes: 1,
    degree: 0,
    reference: &[[0.0; 3]],
    faces: &[],
    gmsh: 15,
    gmsh_order: natural(1),
    vtk: 1,
    vtk_order: natural(1),
    shape: |_, n| n[0] = 1.0,
    gradient: |_, dn| dn[0] = [0.0; 3],
    stiffness_rule: &quadrature::POINT,
    mass_rule: &quadrature::POINT,
    contains: |_, _| true,
};
