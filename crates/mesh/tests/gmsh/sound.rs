//! Files that are right.

use carom_elements::{Kind, MAX_NODES, map};
use carom_mesh::{ElementId, Group, Mesh, Surface, gather, read::read};

use super::writer::{ENCODINGS, write_22, write_41};
use super::{FORMATS, MESHES, bytes_of, fixture, parse};

fn load(mesh: &str) -> Mesh {
    read(&fixture(mesh, FORMATS[0])).unwrap()
}

/// Length, area or volume of a group: the sum of w |dx/dξ| over its elements and integration points.
fn extent(mesh: &Mesh, group: &Group) -> f64 {
    let mut sum = 0.0;
    for &id in &group.elements {
        let table = mesh.kind(id).table();
        let mut buffer = [[0.0; 3]; MAX_NODES];
        let x = gather(&mesh.nodes, mesh.element_nodes(id), &mut buffer);
        let mut dn = [[0.0; 3]; MAX_NODES];
        for (xi, w) in table.mass_rule.points.iter().zip(table.mass_rule.weights) {
            (table.gradient)(xi, &mut dn[..table.nodes]);
            sum += w * match table.dim {
                3 => map::jacobian(x, &dn[..table.nodes], 3).1,
                dim => map::measure(x, &dn[..table.nodes], dim).0,
            };
        }
    }
    sum
}

fn assert_close(value: f64, exact: f64, tolerance: f64) {
    assert!((value - exact).abs() <= tolerance, "{value} is not {exact}");
}

#[test]
fn the_four_formats_of_gmsh_give_one_mesh() {
    for mesh in MESHES {
        let first = load(mesh);
        for format in FORMATS {
            let mut other = read(&fixture(mesh, format)).unwrap();
            // Gmsh writes 16 digits in text.
            for (x, expected) in other
                .nodes
                .iter()
                .flatten()
                .zip(first.nodes.iter().flatten())
            {
                assert_close(*x, *expected, 1e-15);
            }
            other.nodes.clone_from(&first.nodes);
            assert_eq!(other, first, "{mesh}{format}");
        }
    }
}

#[test]
fn no_element_of_a_fixture_is_unfit() {
    for mesh in MESHES {
        let mesh = load(mesh);
        for group in mesh.groups.values().filter(|group| group.dim == mesh.dim) {
            assert_eq!(mesh.check(&group.elements), []);
        }
    }
}

#[test]
fn the_box_has_its_groups_and_measures() {
    let mesh = load("box");
    assert_eq!((mesh.dim, mesh.nodes.len()), (3, 18));
    let kinds: Vec<(Kind, usize)> = mesh.blocks.iter().map(|b| (b.kind, b.len())).collect();
    assert_eq!(
        kinds,
        [(Kind::Point1, 1), (Kind::Quad4, 8), (Kind::Hex8, 4)]
    );
    let names: Vec<&str> = mesh.groups.keys().map(String::as_str).collect();
    assert_eq!(
        names,
        [
            "2:77",
            "block",
            "block.bottom",
            "block.top",
            "corner",
            "shell"
        ]
    );
    // 1 x 0.5 x 0.25; Gmsh's extrusions are exact to round-off.
    for (name, exact) in [
        ("block", 0.125),
        ("block.bottom", 0.5),
        ("block.top", 0.5),
        ("shell", 1.0),
        ("2:77", 0.25),
    ] {
        assert_close(extent(&mesh, &mesh.groups[name]), exact, 1e-14);
    }
    assert_eq!(mesh.group_nodes(&mesh.groups["corner"]), [0]);
    assert_eq!(mesh.nodes[0], [0.0; 3]);
}

#[test]
fn an_element_in_two_groups_is_one_element() {
    let mesh = load("box");
    let [bottom, top, shell] =
        ["block.bottom", "block.top", "shell"].map(|name| &mesh.groups[name].elements);
    let mut both = [bottom.clone(), top.clone()].concat();
    both.sort();
    assert_eq!(&both, shell);
}

#[test]
fn the_facets_of_the_box_are_faces_of_its_cells() {
    let mesh = load("box");
    let top = Surface::new(
        &mesh,
        &mesh.groups["block.top"],
        &mesh.groups["block"].elements,
    )
    .unwrap();
    assert_close(top.node_areas(&mesh, |_| 1.0).iter().sum(), 0.5, 1e-14);
}

#[test]
fn the_plane_mesh_mixes_triangles_and_quadrangles() {
    let mesh = load("plane");
    assert_eq!((mesh.dim, mesh.nodes.len()), (2, 15));
    let kinds: Vec<(Kind, usize)> = mesh.blocks.iter().map(|b| (b.kind, b.len())).collect();
    assert_eq!(kinds, [(Kind::Bar2, 6), (Kind::Tri3, 8), (Kind::Quad4, 4)]);
    for (name, exact) in [
        ("triangles", 1.0),
        ("2:9", 1.0),
        ("bottom side", 1.0),
        ("Würfel", 2.0),
    ] {
        assert_close(extent(&mesh, &mesh.groups[name]), exact, 1e-14);
    }
}

#[test]
fn coincident_nodes_of_two_bars_stay_two() {
    let mesh = load("line");
    assert_eq!((mesh.dim, mesh.nodes.len()), (1, 10));
    for bar in ["striker", "target"] {
        assert_close(extent(&mesh, &mesh.groups[bar]), 1.0, 1e-14);
        let face = &mesh.groups[&format!("{bar}.contact")];
        let surface = Surface::new(&mesh, face, &mesh.groups[bar].elements).unwrap();
        assert_eq!(
            surface.faces[0].axis[0],
            if bar == "striker" { 1.0 } else { -1.0 }
        );
        assert_eq!(mesh.nodes[surface.nodes[0] as usize], [0.0; 3]);
    }
}

/// Both versions in the three encodings, with node tags in reverse and with holes, and nodes with parameters.
#[test]
fn what_a_writer_writes_is_read_back() {
    for name in MESHES {
        let mesh = load(name);
        let tag = |node: u32| 1000 - 7 * u64::from(node);
        for encoding in ENCODINGS {
            assert_eq!(
                parse(&write_22(&mesh, encoding, tag)).unwrap(),
                mesh,
                "{name} {encoding:?}"
            );
            assert_eq!(
                parse(&write_41(&mesh, encoding, tag)).unwrap(),
                mesh,
                "{name} {encoding:?}"
            );
        }
    }
}

/// The kinds of a mesh and their numbers.
fn kinds(mesh: &Mesh) -> Vec<(Kind, usize)> {
    let kinds = mesh.blocks.iter().map(|b| (b.kind, b.len()));
    kinds.collect()
}

#[test]
fn elements_of_second_order_have_their_nodes_where_the_corners_put_them() {
    let complete = load("second");
    assert_eq!(
        kinds(&complete),
        [
            (Kind::Bar3, 1),
            (Kind::Tri6, 4),
            (Kind::Quad9, 1),
            (Kind::Tet10, 24),
            (Kind::Hex27, 2)
        ]
    );
    let incomplete = load("incomplete");
    assert_eq!(
        kinds(&incomplete),
        [
            (Kind::Tri6, 6),
            (Kind::Quad8, 1),
            (Kind::Hex20, 2),
            (Kind::Wedge15, 6)
        ]
    );
    for mesh in [complete, incomplete] {
        for id in
            mesh.blocks.iter().zip(0..).flat_map(|(b, block)| {
                (0..b.len() as u32).map(move |index| ElementId { block, index })
            })
        {
            let table = mesh.kind(id).table();
            let linear = table.linear.table();
            let mut buffer = [[0.0; 3]; MAX_NODES];
            let x = gather(&mesh.nodes, mesh.element_nodes(id), &mut buffer);
            let mut n = vec![0.0; linear.nodes];
            for (x_a, xi) in x.iter().zip(table.reference) {
                (linear.shape)(xi, &mut n);
                let place = map::point(&x[..linear.nodes], &n);
                // The edges of the ring bend: the sagitta of an arc of 30° with a radius of 2.
                let bend = if table.kind == Kind::Wedge15 || table.kind == Kind::Tri6 {
                    0.07
                } else {
                    1e-12
                };
                (0..3).for_each(|i| assert_close(x_a[i], place[i], bend));
            }
        }
    }
}

#[test]
fn cells_of_second_order_wedges_and_pyramids_have_their_volumes_and_faces() {
    let second = load("second");
    let incomplete = load("incomplete");
    let mixed = load("mixed");
    let block: Vec<Kind> = mixed.groups["block"]
        .elements
        .iter()
        .map(|&id| mixed.kind(id))
        .collect();
    for kind in [Kind::Hex8, Kind::Pyramid5, Kind::Tet4] {
        assert!(block.contains(&kind), "{kind:?}");
    }
    let ring = 0.75 * std::f64::consts::PI;
    // Quadratic arcs of 30° follow the circle to 1e-4.
    for (mesh, cells, volume, area, tolerance) in [
        (&second, "tets", 1.0, 1.0, 1e-12),
        (&second, "hexes", 0.25, 0.5, 1e-12),
        (&incomplete, "hexes", 0.25, 0.5, 1e-12),
        (&incomplete, "wedges", 0.5 * ring, ring, 1e-3),
        (&mixed, "block", 2.0, 1.0, 1e-12),
        (&mixed, "wedges", 1.0, 1.0, 1e-12),
    ] {
        assert_close(extent(mesh, &mesh.groups[cells]), volume, tolerance);
        let facets = &mesh.groups[&format!("{cells}.bottom")];
        let surface = Surface::new(mesh, facets, &mesh.groups[cells].elements).unwrap();
        assert_close(
            surface.node_areas(mesh, |_| 1.0).iter().sum(),
            area,
            tolerance,
        );
        for face in &surface.faces {
            let mut buffer = [[0.0; 3]; MAX_NODES];
            let x = gather(&mesh.nodes, face.corners(), &mut buffer);
            let mut dn = vec![[0.0; 3]; x.len()];
            (face.kind.table().gradient)(&[0.2, 0.3, 0.0], &mut dn);
            let (_, normal) = map::measure(x, &dn, 2);
            assert_close(normal[2], -1.0, 1e-12);
        }
    }
}

#[test]
fn every_kind_is_read_from_every_format() {
    let mut mesh = Mesh::new(3);
    for (kind, place) in Kind::ALL.into_iter().zip(0..) {
        let first = mesh.nodes.len() as u32;
        let offset = 3.0 * f64::from(place);
        let nodes = kind.table().reference.iter();
        mesh.nodes
            .extend(nodes.map(|x| [x[0] + offset, x[1], x[2]]));
        let nodes: Vec<u32> = (first..mesh.nodes.len() as u32).collect();
        let id = mesh.push(kind, &nodes);
        let group = Group::new(kind.table().dim, vec![id]);
        mesh.groups.insert(kind.table().name.to_owned(), group);
    }
    for encoding in ENCODINGS {
        let tag = |node: u32| 5 + u64::from(node);
        assert_eq!(parse(&write_22(&mesh, encoding, tag)).unwrap(), mesh);
        assert_eq!(parse(&write_41(&mesh, encoding, tag)).unwrap(), mesh);
    }
}

fn bar(y: &str, z: &str) -> String {
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 {y} {z}\n2 1 {y} {z}\n$EndNodes\n\
         $Elements\n1\n1 1 2 -3 1 1 2\n$EndElements\n"
    )
}

#[test]
fn the_dimension_is_the_last_direction_with_a_coordinate_that_is_not_zero() {
    let dim = |y: &str, z: &str| parse(bar(y, z).as_bytes()).unwrap().dim;
    assert_eq!(
        [dim("0", "0"), dim("0.5", "0"), dim("0", "1"), dim("1", "1")],
        [1, 2, 3, 3]
    );
}

#[test]
fn round_off_beyond_the_dimension_becomes_zero() {
    let mesh = parse(bar("1e-17", "-2e-16").as_bytes()).unwrap();
    assert_eq!(
        (mesh.dim, &mesh.nodes[..]),
        (1, &[[0.0; 3], [1.0, 0.0, 0.0]][..])
    );
}

#[test]
fn a_group_without_name_is_called_by_dimension_and_tag_without_sign() {
    let mesh = parse(bar("0", "0").as_bytes()).unwrap();
    assert_eq!(mesh.groups.keys().collect::<Vec<_>>(), ["1:3"]);
}

#[test]
fn a_mesh_without_groups_keeps_its_elements() {
    let text = bar("0", "0").replace("1 1 2 -3 1 1 2", "1 1 0 1 2");
    let mesh = parse(text.as_bytes()).unwrap();
    assert!(mesh.groups.is_empty());
    assert_eq!(mesh.blocks[0].nodes, [0, 1]);
    let text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2 1 2\n1 1 0 2\n1\n2\n0 0 0\n1 0 0\n$EndNodes\n\
                $Elements\n1 1 1 1\n1 1 1 1\n1 1 2\n$EndElements\n";
    assert_eq!(parse(text.as_bytes()).unwrap(), mesh);
}

#[test]
fn a_named_group_without_elements_is_an_empty_group() {
    let names = "$EndMeshFormat\n$PhysicalNames\n1\n2 8 \"nothing here\"\n$EndPhysicalNames\n";
    let mesh = parse(bar("0", "0").replace("$EndMeshFormat\n", names).as_bytes()).unwrap();
    assert_eq!(mesh.groups["nothing here"], Group::new(2, vec![]));
}

#[test]
fn sections_may_repeat_and_unknown_ones_are_skipped() {
    let more = "$NodeData\n1\n\"u\"\n0\n0\n$EndNodeData\n$NodeData\n$EndNodeData\n$Nodes\n1\n9 2 0 0\n$EndNodes\n\
                $Elements\n1\n7 1 2 3 1 2 9\n$EndElements\n$Comments\n$Nodes\nnot read\n$EndComments\n";
    let mesh = parse((bar("0", "0") + more).as_bytes()).unwrap();
    assert_eq!(mesh.nodes, [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
    assert_eq!(mesh.blocks[0].nodes, [0, 1, 1, 2]);
    assert_eq!(mesh.groups["1:3"].elements.len(), 2);
}

/// Gmsh's `view.write` with `append` does so.
#[test]
fn a_view_may_be_appended_with_a_format_of_its_own() {
    for format in FORMATS {
        let mut content = bytes_of("box", format);
        let first_section = content.windows(14).position(|it| it == b"$PhysicalNames");
        content.extend_from_within(..first_section.unwrap());
        content.extend_from_slice(b"$NodeData\n\0\xff$EndNodeData\n");
        assert_eq!(parse(&content).unwrap(), load("box"), "{format}");
    }
}

#[test]
fn line_ends_of_windows_blank_lines_and_indents_change_nothing() {
    let text = bar("0", "0");
    let mesh = parse(text.as_bytes()).unwrap();
    for other in [
        text.replace('\n', "\r\n"),
        text.replace('\n', "  \n\n"),
        text.replace('\n', "\n\t"),
    ] {
        assert_eq!(parse(other.as_bytes()).unwrap(), mesh, "{other:?}");
    }
}

/// The mesh of `cases/sdnl111`: two beams with 400 cells each (40 in the coarse one) and a gap of 1e-5 m.
#[test]
fn the_two_beams_are_as_their_case_says() {
    for (file, n) in [("two-beams.msh", 400), ("two-beams-coarse.msh", 40)] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/sdnl111/");
        let mesh = read((folder.to_owned() + file).as_ref()).unwrap();
        assert_eq!((mesh.dim, mesh.nodes.len()), (3, 8 * (n + 1)));
        for (cells, faces) in [
            (
                "striker",
                [("striker.contact", -1e-5), ("striker.far", -1.00001)],
            ),
            ("target", [("target.contact", 0.0), ("target.clamped", 1.0)]),
        ] {
            let cells = &mesh.groups[cells];
            assert_eq!(cells.elements.len(), n);
            assert_eq!(mesh.check(&cells.elements), []);
            assert_close(extent(&mesh, cells), 4e-4, 1e-16);
            for (name, x) in faces {
                let face = Surface::new(&mesh, &mesh.groups[name], &cells.elements).unwrap();
                assert_close(face.node_areas(&mesh, |_| 1.0).iter().sum(), 4e-4, 1e-18);
                for node in face.nodes {
                    assert_eq!(mesh.nodes[node as usize][0], x);
                }
            }
        }
    }
}
