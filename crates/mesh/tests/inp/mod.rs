//! Files that another program has written: meshio 5, from the meshes beside them in Gmsh's format.

use std::path::{Path, PathBuf};

use carom_elements::Kind;
use carom_mesh::{Mesh, read};

fn fixture(name: &str) -> Mesh {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let path: PathBuf = folder.join(name);
    read::read(&path).unwrap()
}

#[test]
fn another_program_writes_the_cells_of_gmsh() {
    let mut kinds = Vec::new();
    for name in ["mixed", "second"] {
        let [ours, theirs] = ["inp", "msh"].map(|format| match format {
            "inp" => fixture(&format!("{name}.inp")),
            _ => fixture(&format!("{name}-22.msh")),
        });
        assert_eq!(ours.dim, theirs.dim);
        // sixteen digits of text
        for (a, b) in ours.nodes.iter().zip(&theirs.nodes) {
            assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-14), "{a:?} {b:?}");
        }
        assert_eq!(ours.nodes.len(), theirs.nodes.len());
        for block in &ours.blocks {
            let same = theirs.blocks.iter().find(|other| other.kind == block.kind);
            assert_eq!(Some(block), same, "{name}");
            kinds.push(block.kind);
        }
    }
    kinds.sort_unstable();
    let all = [
        Kind::Tri3,
        Kind::Tri6,
        Kind::Quad4,
        Kind::Tet4,
        Kind::Tet10,
        Kind::Hex8,
        Kind::Wedge6,
    ];
    assert_eq!(kinds, all);
}
