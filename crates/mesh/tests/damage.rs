//! Files with some bytes overwritten.

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

/// A pseudo-random number below `n` (xorshift, Marsaglia 2003).
pub fn draw(state: &mut u64, n: usize) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state % n as u64) as usize
}

/// A content with one to three bytes overwritten.
pub fn damaged(content: &[u8], state: &mut u64) -> Vec<u8> {
    let mut content = content.to_vec();
    for _ in 0..=draw(state, 3) {
        let place = draw(state, content.len());
        content[place] = match draw(state, 3) {
            0 => content[place] ^ (1 << draw(state, 8)),
            1 => draw(state, 256) as u8,
            _ => b"0123456789-.e \n$"[draw(state, 16)],
        };
    }
    content
}
