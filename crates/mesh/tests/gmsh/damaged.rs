//! Files cut and overwritten anywhere: an error or a sound mesh, never a panic.

use carom_mesh::Mesh;

use super::{FORMATS, MESHES, bytes_of, parse};

/// Whether every number of a mesh is one of something that it has.
fn is_consistent(mesh: &Mesh) -> bool {
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
fn draw(state: &mut u64, n: usize) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state % n as u64) as usize
}

#[test]
fn a_file_cut_at_any_byte_is_refused() {
    for (mesh, format) in MESHES[..4]
        .iter()
        .flat_map(|mesh| FORMATS.map(|format| (mesh, format)))
    {
        let content = bytes_of(mesh, format);
        let end = content.trim_ascii_end().len();
        for length in 0..end {
            let error = parse(&content[..length]);
            assert!(error.is_err(), "{mesh}{format} cut at {length}");
        }
        parse(&content[..end]).unwrap();
    }
}

#[test]
fn overwritten_bytes_give_an_error_or_a_consistent_mesh() {
    let mut state = 0x2545_f491_4f6c_dd1d;
    for (mesh, format) in MESHES[..4]
        .iter()
        .flat_map(|mesh| FORMATS.map(|format| (mesh, format)))
    {
        let content = bytes_of(mesh, format);
        for _ in 0..5000 {
            let mut content = content.clone();
            for _ in 0..=draw(&mut state, 3) {
                let place = draw(&mut state, content.len());
                content[place] = match draw(&mut state, 3) {
                    0 => content[place] ^ (1 << draw(&mut state, 8)),
                    1 => draw(&mut state, 256) as u8,
                    _ => b"0123456789-.e \n$"[draw(&mut state, 16)],
                };
            }
            if let Ok(mesh) = parse(&content) {
                assert!(is_consistent(&mesh), "{mesh:?}");
            }
        }
    }
}

#[test]
fn lines_lost_or_doubled_give_an_error_or_a_consistent_mesh() {
    for (mesh, format) in MESHES[..4]
        .iter()
        .flat_map(|mesh| ["-22", "-41"].map(|format| (mesh, format)))
    {
        let content = bytes_of(mesh, format);
        let lines: Vec<&[u8]> = content.split_inclusive(|&byte| byte == b'\n').collect();
        for i in 0..lines.len() {
            let lost = [&lines[..i], &lines[i + 1..]].concat().concat();
            let doubled = [&lines[..=i], &lines[i..]].concat().concat();
            for content in [lost, doubled] {
                if let Ok(mesh) = parse(&content) {
                    assert!(is_consistent(&mesh), "{mesh:?}");
                }
            }
        }
    }
}
