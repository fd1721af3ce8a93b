//! Sizes of cells: what a Courant number and a contact stiffness refer to.

use carom_elements::{Kind, MAX_NODES, map};
use carom_mesh::{ElementId, Mesh};

/// Length (m), area (m²) or volume (m³) of a cell or facet with these node positions; 1 for a point.
fn measure(kind: Kind, x: &[[f64; 3]]) -> f64 {
    let element = kind.table();
    if element.dim == 0 {
        return 1.0;
    }
    let mut dn = [[0.0; 3]; MAX_NODES];
    let dn = &mut dn[..element.nodes];
    let rule = element.mass_rule;
    let points = rule.points.iter().zip(rule.weights);
    points
        .map(|(xi, weight)| {
            (element.gradient)(xi, dn);
            let factor = if element.dim == 3 {
                map::jacobian(x, dn, 3).1
            } else {
                map::measure(x, dn, element.dim).0
            };
            weight * factor
        })
        .sum()
}

/// Size of a cell normal to one of its faces, in m: f V / A with f = 1 for bars, quadrilaterals and hexahedra, the
/// dimension for simplices, whose altitude it is. Over the sides of a wedge f = 2, the distance of the opposite edge, over
/// its triangles 1; over the base of a pyramid 3, its altitude, over its sides 3/2, the distance of the opposite edge of a
/// parallelogram. Quadratic kinds as the linear ones on their corners. `face`: nodes of the face.
pub fn height(mesh: &Mesh, cell: ElementId, face: Kind, face_nodes: &[u32]) -> f64 {
    let kind = mesh.kind(cell);
    let gather = |nodes: &[u32]| {
        nodes
            .iter()
            .map(|&node| mesh.nodes[node as usize])
            .collect::<Vec<_>>()
    };
    let factor = match kind.table().linear {
        Kind::Tri3 | Kind::Tet4 => kind.table().dim as f64,
        Kind::Wedge6 if face.table().linear == Kind::Quad4 => 2.0,
        Kind::Pyramid5 if face.table().linear == Kind::Quad4 => 3.0,
        Kind::Pyramid5 => 1.5,
        _ => 1.0,
    };
    factor * measure(kind, &gather(mesh.element_nodes(cell))) / measure(face, &gather(face_nodes))
}

/// Smallest size of a cell over its faces, in m.
pub fn smallest(mesh: &Mesh, cell: ElementId) -> f64 {
    let nodes = mesh.element_nodes(cell);
    let faces = mesh.kind(cell).table().faces.iter();
    let heights = faces.map(|face| {
        let face_nodes: Vec<u32> = face.nodes.iter().map(|&a| nodes[a]).collect();
        height(mesh, cell, face.kind, &face_nodes)
    });
    heights.fold(f64::INFINITY, f64::min)
}
