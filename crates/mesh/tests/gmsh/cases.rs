//! The meshes of `cases/`: files that Gmsh wrote for the examples, with the `.geo` beside them.

use std::path::{Path, PathBuf};

use carom_mesh::{Mesh, Surface, read::read};

/// Every MSH file in a folder of `cases/`, by name.
fn meshes() -> Vec<PathBuf> {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let entries = |folder: &Path| {
        let entries = std::fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().path())
    };
    let folders = entries(&cases).filter(|path| path.is_dir());
    let mut files: Vec<_> = folders
        .flat_map(|folder| entries(&folder).collect::<Vec<_>>())
        .filter(|path| path.extension().is_some_and(|ending| ending == "msh"))
        .collect();
    files.sort();
    files
}

fn load(name: &str) -> Mesh {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    read(&cases.join(name)).unwrap()
}

/// The least and the largest coordinate of a group in the direction `i`.
fn range(mesh: &Mesh, group: &str, i: usize) -> (f64, f64) {
    let nodes = mesh.group_nodes(&mesh.groups[group]);
    let x = nodes.iter().map(|&node| mesh.nodes[node as usize][i]);
    (
        x.clone().fold(f64::MAX, f64::min),
        x.fold(f64::MIN, f64::max),
    )
}

/// Distance of the nearest nodes of two groups.
fn nearest(mesh: &Mesh, first: &str, second: &str) -> f64 {
    let nodes = |group: &str| {
        let nodes = mesh.group_nodes(&mesh.groups[group]);
        nodes.into_iter().map(|node| mesh.nodes[node as usize])
    };
    let squares = nodes(first).flat_map(|a| {
        nodes(second).map(move |b| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>())
    });
    squares.fold(f64::MAX, f64::min).sqrt()
}

#[test]
fn every_mesh_has_sound_cells_and_surfaces_that_bound_the_body_of_their_name() {
    let files = meshes();
    assert!(!files.is_empty());
    for file in files {
        let mesh = read(&file).unwrap();
        for (name, group) in &mesh.groups {
            assert!(
                !group.elements.is_empty(),
                "{}: {name} is empty",
                file.display()
            );
            assert_eq!(
                mesh.check(&group.elements),
                [],
                "{}: {name}",
                file.display()
            );
            let body = name.split('.').next().unwrap();
            let Some(body) = mesh.groups.get(body) else {
                continue;
            };
            if group.dim + 1 == body.dim {
                let surface = Surface::new(&mesh, group, &body.elements);
                assert!(surface.is_ok(), "{}: {name}: {surface:?}", file.display());
            }
        }
    }
}

#[test]
fn every_mesh_has_beside_it_the_script_that_says_how_it_was_made() {
    for file in meshes() {
        let name = file.file_name().unwrap().to_string_lossy().into_owned();
        let beside = std::fs::read_dir(file.parent().unwrap()).unwrap();
        let scripts = beside
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|ending| ending == "geo"));
        let naming = scripts.filter(|script| {
            let text = std::fs::read_to_string(script).unwrap();
            text.lines()
                .any(|line| line.starts_with("//") && line.contains(&name))
        });
        assert_eq!(naming.count(), 1, "{}", file.display());
    }
}

#[test]
fn hertz_bodies_touch_in_the_origin_and_their_equators_are_a_diameter_apart() {
    for name in [
        "hertz/spheres-coarse.msh",
        "hertz/spheres.msh",
        "hertz/spheres-fine.msh",
        "hertz/spheres-wide.msh",
        "hertz-cylinder/two-cylinders.msh",
    ] {
        let mesh = load(name);
        // Points of the script, not computed by the mesher: exact.
        assert_eq!(range(&mesh, "upper.contact", 1).0, 0.0, "{name}");
        assert_eq!(range(&mesh, "lower.contact", 1).1, 0.0, "{name}");
        assert_eq!(range(&mesh, "upper.equator", 1), (50.0, 50.0), "{name}");
        assert_eq!(range(&mesh, "lower.equator", 1), (-50.0, -50.0), "{name}");
    }
}

#[test]
fn axes_are_exactly_at_radius_zero_and_no_cell_of_an_axisymmetric_mesh_is_beyond() {
    for (name, axis, body) in [
        ("hertz/spheres-fine.msh", "lower.axis", "lower"),
        ("hertz/spheres-whole.msh", "upper.axis", "upper"),
        ("taylor-bar/bar-plane.msh", "bar.axis", "bar"),
    ] {
        let mesh = load(name);
        assert_eq!(range(&mesh, axis, 0), (0.0, 0.0), "{name}");
        assert_eq!(range(&mesh, body, 0).0, 0.0, "{name}");
    }
}

#[test]
fn colliding_bodies_start_apart_by_the_gap_that_their_script_states() {
    // Nodes may lie on either side of the nearest points: the distance of nodes is at most an element longer.
    for (name, first, second, gap, element) in [
        (
            "rings/rings.msh",
            "ring1.outer",
            "ring2.outer",
            0.0616,
            0.066,
        ),
        (
            "rings/rings-coarse.msh",
            "ring1.outer",
            "ring2.outer",
            0.0616,
            0.2,
        ),
        ("tori/tori.msh", "torus1.outer", "torus2.outer", 6.4, 13.1),
        (
            "tori/tori-coarse.msh",
            "torus1.outer",
            "torus2.outer",
            6.4,
            26.2,
        ),
        (
            "tori/tori-fine.msh",
            "torus1.outer",
            "torus2.outer",
            6.4,
            9.9,
        ),
    ] {
        let distance = nearest(&load(name), first, second);
        assert!(
            distance >= gap && distance <= gap + element,
            "{name}: {distance}"
        );
    }
}
