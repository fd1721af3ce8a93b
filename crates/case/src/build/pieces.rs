//! Bodies whose cells share no node: a mesh that was not merged, most of the time.

use std::collections::BTreeMap;

use carom_dynamics::ModelBody;
use carom_mesh::{Mesh, Parts};

use super::Builder;

impl Builder<'_> {
    /// Warns of bodies in pieces that nothing joins, not even another body, and names the closest nodes of two of them.
    pub(super) fn pieces(&mut self, mesh: &Mesh, bodies: &[ModelBody]) {
        let cells = bodies.iter().flat_map(|body| &body.spec.cells);
        let parts = Parts::new(mesh, cells.copied());
        for body in bodies {
            let pieces = pieces_of(mesh, body, &parts);
            let Some(largest) = pieces.iter().rev().max_by_key(|piece| piece.len()) else {
                continue;
            };
            let others = pieces.iter().filter(|piece| piece[0] != largest[0]);
            let others: Vec<u32> = others.flatten().copied().collect();
            let Some(([one, other], distance)) = mesh.closest_nodes(largest, &others) else {
                continue;
            };
            let x = mesh.nodes[one as usize];
            let merge = match distance <= 1e-6 * mesh.size() {
                true => "they are the same place: merge the nodes of the mesh",
                false => "merge the nodes of the mesh, or make each piece a body of its own",
            };
            self.warnings.push(format!(
                "body `{}` is in {} pieces that share no node and separate without resistance; the closest nodes of two of them, {one} at ({:.6}, {:.6}, {:.6}) m and {other}, are {distance:.4e} m apart; {merge}",
                body.spec.name,
                pieces.len(),
                x[0],
                x[1],
                x[2]
            ));
        }
    }
}

/// Nodes of a body by the part that they are in, ascending.
fn pieces_of(mesh: &Mesh, body: &ModelBody, parts: &Parts) -> Vec<Vec<u32>> {
    let mut pieces: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let cells = body.spec.cells.iter();
    for &node in cells.flat_map(|&cell| mesh.element_nodes(cell)) {
        if let Some(part) = parts.of(node) {
            pieces.entry(part).or_default().push(node);
        }
    }
    let mut pieces: Vec<Vec<u32>> = pieces.into_values().collect();
    for piece in &mut pieces {
        piece.sort_unstable();
        piece.dedup();
    }
    pieces
}
