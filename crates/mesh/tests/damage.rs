//! What must hold of a mesh that is read from a damaged file.

use carom_mesh::Mesh;

/// Whether every number of a mesh is one of something that it has.
pub fn is_consistent(mesh: &Mesh) -> bool {
    let nodes = mesh.nodes.len() as u32;
    let finite = mesh.nodes.iter().flatten().all(|x| x.is_finite());
    let whole =
        |block: &carom_mesh::Block| block.nodes.len() == block.len() * block.kind.table().nodes;
    let known = mesh
        .blocks
        .iter()
        .all(|block| block.nodes.iter().all(|&node| node < nodes) && whole(block));
    let groups = mesh.groups.values().all(|group| {
        group.elements.iter().all(|id| {
            let block = &mesh.blocks[id.block as usize];
            block.kind.table().dim == group.dim && (id.index as usize) < block.len()
        })
    });
    finite && known && groups
}
