//! Bodies that turn by any angle.

use carom_bodies::Rotations;
use carom_dynamics::ModelBody;
use carom_mesh::Mesh;

/// What rows of small angles accept.
pub(super) const SMALL_TURNS: [&str; 2] = [
    "beams and shells with rotations = \"small\"",
    "solids of a material at small strain",
];

/// A body that turns by any angle and has one of these nodes (sorted): of beams or shells with finite rotations, or at finite strain.
pub(super) fn any_angle<'a>(
    mesh: &Mesh,
    bodies: &'a [ModelBody],
    nodes: &[u32],
) -> Option<&'a ModelBody> {
    let finite = |body: &&ModelBody| {
        let rotations = body.spec.kinematics.rotations();
        rotations == Some(Rotations::Finite) || body.spec.material.finite().is_some()
    };
    let has = |body: &&ModelBody| {
        let mut cells = body.spec.cells.iter();
        cells.any(|&cell| {
            let mut own = mesh.element_nodes(cell).iter();
            own.any(|node| nodes.binary_search(node).is_ok())
        })
    };
    bodies.iter().filter(finite).find(has)
}
