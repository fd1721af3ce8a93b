//! Beams and shells that share nodes with solids: hinges are refused unless they are meant.

use carom_case::{Input, build, parse};

/// The messages of a case with this mesh in the format of Gmsh: nodes, and cells as `kind, body, nodes`.
fn messages(nodes: &[[f64; 3]], cells: &[(u32, u32, &[usize])], case: &str) -> Vec<String> {
    let mut mesh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n2 1 \"k\"\n1 2 \"b\"\n0 3 \"foot\"\n3 4 \"solid\"\n$EndPhysicalNames\n$Nodes\n"
        .replace("2 1 \"k\"", if cells.iter().any(|cell| cell.0 == 5) { "2 1 \"s\"" } else { "2 1 \"k\"" });
    mesh += &format!("{}\n", nodes.len());
    for (k, [x, y, z]) in nodes.iter().enumerate() {
        mesh += &format!("{} {x} {y} {z}\n", k + 1);
    }
    mesh += &format!("$EndNodes\n$Elements\n{}\n", cells.len());
    for (k, (kind, body, nodes)) in cells.iter().enumerate() {
        let nodes: Vec<String> = nodes.iter().map(usize::to_string).collect();
        mesh += &format!("{} {kind} 2 {body} {body} {}\n", k + 1, nodes.join(" "));
    }
    mesh += "$EndElements\n";
    let text = format!(
        r#"
carom = 1
mesh.file = "mesh.msh"
material.m = {{ density = 1000.0, elastic = {{ young = 1e8, poisson = 0.3 }} }}
{case}
time = {{ end = 0.1, step = 1e-4, scheme.newmark = {{}} }}
"#
    );
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    std::fs::write(&file, text).unwrap();
    std::fs::write(folder.path().join("mesh.msh"), mesh).unwrap();
    let input = Input::read(&file, &[]).unwrap();
    let (case, locator) = parse(&input).unwrap();
    match build(&case, &locator, &input) {
        Ok(_) => Vec::new(),
        Err(problems) => problems
            .iter()
            .map(|problem| format!("{problem:?}"))
            .collect(),
    }
}

/// Two squares side by side, and a beam from the middle node of the upper side, or along that side first.
fn beam(along: bool, more: &str) -> Vec<String> {
    let nodes = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [1.0, 1.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 2.0, 0.0],
        [1.0, 3.0, 0.0],
    ];
    let mut cells: Vec<(u32, u32, &[usize])> = vec![
        (3, 1, &[1, 2, 5, 4]),
        (3, 1, &[2, 3, 6, 5]),
        (1, 2, &[5, 7]),
        (1, 2, &[7, 8]),
        (15, 3, &[5]),
    ];
    if along {
        cells.push((1, 2, &[4, 5]));
    }
    let case = format!(
        r#"
body.k = {{ region = "k", material = "m", section.plane-strain.thickness = 1.0 }}
body.b = {{ region = "b", material = "m", section.beam.shape.circle.diameter = 0.1{more}
"#
    );
    messages(&nodes, &cells, &case)
}

#[test]
fn a_beam_that_ends_on_a_node_of_a_solid_is_refused_unless_a_hinge_is_meant() {
    let told = beam(false, " }");
    let [message] = &told[..] else {
        panic!("{told:?}");
    };
    for word in [
        "solid `k`",
        "node 4 at (1.0",
        "transition",
        "hinged-to",
        "body.b.region",
    ] {
        assert!(message.contains(word), "{word}: {message}");
    }
    assert_eq!(beam(false, ", hinged-to = [\"k\"] }"), Vec::<String>::new());
    // a support holds the rotation
    let held = " }\nsupport.foot = { on = \"foot\", fix = [\"rz\"] }";
    assert_eq!(beam(false, held), Vec::<String>::new());
    // it lies on the solid with another cell
    assert_eq!(beam(true, " }"), Vec::<String>::new());
    let told = beam(true, ", hinged-to = [\"k\"] }");
    assert!(told.len() == 1 && told[0].contains("no hinge"), "{told:?}");
}

/// A cube, and a shell that stands on an edge of its top, or goes on from a cell that lies on it; or a beam on it.
fn on_cube(shell: bool, lies: bool, more: &str) -> Vec<String> {
    let nodes = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
        [0.0, 1.0, 1.0],
        [1.0, 0.0, 2.0],
        [1.0, 1.0, 2.0],
        [2.0, 1.0, 1.0],
    ];
    let mut cells: Vec<(u32, u32, &[usize])> = vec![(5, 4, &[1, 2, 3, 4, 5, 6, 7, 8])];
    let thin = match shell {
        true => {
            cells.push((3, 1, &[6, 7, 10, 9]));
            if lies {
                cells.push((3, 1, &[5, 8, 7, 6]));
            }
            "body.s = { region = \"s\", material = \"m\", section.shell.thickness = 0.01"
        }
        false => {
            cells.push((1, 2, &[7, 11]));
            if lies {
                cells.push((1, 2, &[8, 7]));
            }
            "body.s = { region = \"b\", material = \"m\", section.beam.shape.circle.diameter = 0.1"
        }
    };
    let case = format!("body.k = {{ region = \"solid\", material = \"m\" }}\n{thin}{more} }}");
    messages(&nodes, &cells, &case)
}

#[test]
fn a_shell_turns_about_an_edge_that_it_shares_and_not_about_a_face() {
    let told = on_cube(true, false, "");
    let [message] = &told[..] else {
        panic!("{told:?}");
    };
    for word in ["about (0.000, 1.000, 0.000)", "and 1 more", "solid `k`"] {
        assert!(message.contains(word), "{word}: {message}");
    }
    assert!(on_cube(true, false, ", hinged-to = [\"k\"]").is_empty());
    assert!(on_cube(true, true, "").is_empty());
}

#[test]
fn in_space_a_beam_along_a_line_of_a_solid_still_turns_about_that_line() {
    assert_eq!(on_cube(false, false, "").len(), 1);
    assert_eq!(on_cube(false, true, "").len(), 1);
    assert!(on_cube(false, true, ", hinged-to = [\"k\"]").is_empty());
}
