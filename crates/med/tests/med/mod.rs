//! MED files that Gmsh 4.15.2 has written from the `.geo` files beside its own: `gmsh mixed.geo -3 -format med -o mixed.med`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use carom_med::{med, read};
use carom_mesh::Mesh;

use carom_testing::damage::damaged;

use crate::damage::is_consistent;

fn path(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../mesh/tests/fixtures");
    folder.join(name)
}

/// Places of the nodes of the elements of a group, element after element, sorted.
fn places(mesh: &Mesh, name: &str) -> Vec<Vec<[i64; 3]>> {
    let group = &mesh.groups[name];
    let rounded = |x: f64| (x * 1e9).round() as i64;
    let of = |&node: &u32| mesh.nodes[node as usize].map(rounded);
    let elements = group.elements.iter();
    let mut all: Vec<Vec<[i64; 3]>> = elements
        .map(|element| mesh.element_nodes(*element).iter().map(of).collect())
        .collect();
    all.sort();
    all
}

#[test]
fn cells_and_groups_are_those_of_the_files_of_gmsh() {
    for name in ["mixed", "second", "incomplete"] {
        let theirs = read(&path(&format!("{name}-41-bin.msh"))).unwrap();
        let ours = read(&path(&format!("{name}.med"))).unwrap();
        assert_eq!(ours.dim, theirs.dim, "{name}");
        let names = |mesh: &Mesh| mesh.groups.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&ours), names(&theirs));
        for group in ours.groups.keys() {
            // the same nodes in the same order: orientation and midside nodes too
            assert_eq!(
                places(&ours, group),
                places(&theirs, group),
                "{name} {group}"
            );
        }
    }
}

#[test]
fn what_is_no_med_file_is_told() {
    let parse = |bytes: Vec<u8>| {
        med::parse(Path::new("a.med"), bytes)
            .unwrap_err()
            .to_string()
    };
    let told = parse(b"no file of this sort".to_vec());
    assert!(told.starts_with("a.med, the file: found "), "{told}");
    let whole = std::fs::read(path("mixed.med")).unwrap();
    let told = parse(whole[..whole.len() / 2].to_vec());
    assert!(told.contains("expected a sound HDF5 file"), "{told}");
}

#[test]
fn damaged_files_give_an_error_or_a_consistent_mesh() {
    let mut state = 0x9e37_79b9_7f4a_7c15;
    let begin = Instant::now();
    let whole = std::fs::read(path("mixed.med")).unwrap();
    let parse = |content: Vec<u8>| med::parse(Path::new("a.med"), content);
    for length in (0..whole.len()).step_by(17) {
        if let Ok(mesh) = parse(whole[..length].to_vec()) {
            assert!(is_consistent(&mesh), "cut at {length}");
        }
    }
    for _ in 0..4000 {
        if let Ok(mesh) = parse(damaged(&whole, &mut state)) {
            assert!(is_consistent(&mesh), "{mesh:?}");
        }
    }
    assert!(
        begin.elapsed() < Duration::from_secs(20),
        "the reader hangs"
    );
}
