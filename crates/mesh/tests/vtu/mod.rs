//! Files that another program has written: meshio 5, from the meshes beside them in Gmsh's format.

use std::path::Path;
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use carom_mesh::{Mesh, read};

use carom_testing::damage::damaged;

use crate::damage::is_consistent;

fn fixture(name: &str) -> Mesh {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    read::read(&folder.join(name)).unwrap()
}

#[test]
fn another_program_writes_the_cells_of_gmsh_as_text_in_base64_and_compressed() {
    for name in ["mixed", "second"] {
        let theirs = fixture(&format!("{name}-22.msh"));
        for format in ["ascii", "plain", "zlib"] {
            let ours = fixture(&format!("{name}-{format}.vtu"));
            assert_eq!(ours.dim, theirs.dim);
            assert_eq!(ours.nodes.len(), theirs.nodes.len());
            // twelve digits of text
            for (a, b) in ours.nodes.iter().zip(&theirs.nodes) {
                assert!((0..3).all(|i| (a[i] - b[i]).abs() < 1e-11), "{a:?} {b:?}");
            }
            assert_eq!(ours.blocks.len(), theirs.blocks.len());
            for block in &ours.blocks {
                let same = theirs.blocks.iter().find(|other| other.kind == block.kind);
                assert_eq!(Some(block), same, "{name} {format}");
            }
            // the physical groups of the file are numbers there
            let members = |mesh: &Mesh, of: &dyn Fn(&str) -> bool| -> usize {
                let groups = mesh.groups.iter().filter(|(name, _)| of(name));
                groups.map(|(_, group)| group.elements.len()).sum()
            };
            let physical = members(&ours, &|name| name.starts_with("gmsh:physical."));
            let elements: usize = ours
                .blocks
                .iter()
                .map(|block| block.nodes.len() / block.kind.table().nodes)
                .sum();
            assert!(
                physical > 0 && physical <= elements,
                "{name} {format} {physical}"
            );
        }
    }
}

#[test]
fn what_is_cut_off_damaged_or_of_another_sort_is_told() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let text = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    let (ascii, zlib) = (text("mixed-ascii.vtu"), text("mixed-zlib.vtu"));
    let parse = |text: &str| read::vtu::parse(Path::new("a.vtu"), text.as_bytes());
    for (text, told) in [
        (
            ascii.replace("UnstructuredGrid\" version", "PolyData\" version"),
            "type \"PolyData\"",
        ),
        (
            ascii.replace("LittleEndian", "BigEndian"),
            "byte_order \"BigEndian\"",
        ),
        (
            ascii.replace("NumberOfPoints=\"30\"", "NumberOfPoints=\"31\""),
            "90 numbers for 31 points",
        ),
        (
            ascii.replace("NumberOfCells=\"33\"", "NumberOfCells=\"32\""),
            "33 numbers",
        ),
        (ascii.replacen("1.00000000000e+00", "nan", 1), "NaN"),
        (
            ascii.replace("Name=\"offsets\"", "Name=\"ends\""),
            "Cells without offsets",
        ),
        (
            zlib.replace("vtkZLibDataCompressor", "vtkLZ4DataCompressor"),
            "compressor",
        ),
        (zlib[..zlib.len() / 2].to_owned(), "expected"),
        ("hello".to_owned(), "no Piece"),
    ] {
        let error = parse(&text).map(|_| ()).unwrap_err().to_string();
        assert!(error.contains(told), "{told}: {error}");
    }
}

/// Two points whose compressed coordinates say that they have 2 GiB: nothing of them is expanded.
#[test]
fn a_compressed_array_that_is_longer_than_its_points_is_refused_by_its_head() {
    let words: [u64; 4] = [1, 1 << 31, 0, 11];
    let head: Vec<u8> = words.into_iter().flat_map(u64::to_le_bytes).collect();
    // a block of 2 GiB of zeros would have two million bytes; the first of them
    let block = [
        0x78, 0xda, 0xed, 0xc1, 0x01, 0x01, 0x00, 0x00, 0x00, 0x80, 0x90,
    ];
    let data = STANDARD.encode(head) + &STANDARD.encode(block);
    let text = format!(
        r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">
<UnstructuredGrid><Piece NumberOfPoints="2" NumberOfCells="1"><Points>
<DataArray type="Float64" NumberOfComponents="3" format="binary">{data}</DataArray>
</Points></Piece></UnstructuredGrid></VTKFile>"#
    );
    let error = read::vtu::parse(Path::new("a.vtu"), text.as_bytes()).unwrap_err();
    let told = "a compressed array of 2147483648 bytes in place of 48 at most";
    assert!(error.to_string().contains(told), "{error}");
}

#[test]
fn damaged_files_give_an_error_or_a_consistent_mesh() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut state = 0x9e37_79b9_7f4a_7c15;
    let begin = Instant::now();
    for name in ["mixed-ascii.vtu", "mixed-plain.vtu", "mixed-zlib.vtu"] {
        let whole = std::fs::read(folder.join(name)).unwrap();
        let parse = |content: &[u8]| read::vtu::parse(Path::new(name), content);
        for length in (0..whole.len()).step_by(7) {
            if let Ok(mesh) = parse(&whole[..length]) {
                assert!(is_consistent(&mesh), "{name} cut at {length}");
            }
        }
        for _ in 0..2000 {
            let content = damaged(&whole, &mut state);
            if let Ok(mesh) = parse(&content) {
                assert!(is_consistent(&mesh), "{mesh:?}");
            }
        }
    }
    assert!(begin.elapsed() < Duration::from_secs(20), "a reader hangs");
}
