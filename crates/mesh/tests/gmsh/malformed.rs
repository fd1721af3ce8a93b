//! Text files that are wrong, each with its message: where, what was found, what was expected.

use carom_mesh::read::{ReadError, read};

use super::parse;

pub const V22: &str = "\
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
1 1 \"bar\"
0 2 \"end\"
$EndPhysicalNames
$Nodes
3
1 0 0 0
2 0.5 0 0
3 1 0 0
$EndNodes
$Elements
3
1 1 2 1 1 1 2
2 1 2 1 1 2 3
3 15 2 2 1 3
$EndElements
";

pub const V41: &str = "\
$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
1 1 \"bar\"
$EndPhysicalNames
$Entities
2 1 0 0
1 0 0 0 0
2 1 0 0 0
1 0 0 0 1 0 0 1 1 2 1 -2
$EndEntities
$Nodes
2 3 1 3
0 1 0 1
1
0 0 0
1 1 0 2
2
3
1 0 0
0.5 0 0
$EndNodes
$Elements
1 2 1 2
1 1 1 2
1 1 3
2 3 2
$EndElements
";

/// Asserts that the file does not parse, with this message behind the file's name.
pub fn refused(content: &[u8], message: &str) {
    let error = parse(content).unwrap_err().to_string();
    assert_eq!(error, format!("mesh.msh, {message}"));
}

/// Asserts that the text with its first `old` replaced is refused with this message.
pub fn edited(text: &str, old: &str, new: &str, message: &str) {
    assert!(text.contains(old), "{old:?} is not in the text");
    refused(text.replacen(old, new, 1).as_bytes(), message);
}

#[test]
fn the_unedited_texts_are_right() {
    parse(V22.as_bytes()).unwrap();
    parse(V41.as_bytes()).unwrap();
}

#[test]
fn a_file_that_is_not_there_or_of_another_kind_is_refused() {
    let missing = read("no/such/mesh.msh".as_ref()).unwrap_err();
    assert!(matches!(missing, ReadError::Unreadable { .. }));
    assert!(
        missing
            .to_string()
            .starts_with("cannot read no/such/mesh.msh: ")
    );
    let other = read("no/such/mesh.unv".as_ref()).unwrap_err().to_string();
    assert_eq!(
        other,
        "no/such/mesh.unv: found the extension \"unv\", expected one of: msh, inp, stl, vtu, med"
    );
}

#[test]
fn the_head_is_checked() {
    refused(
        b"",
        "line 1: found the end of the file, expected $MeshFormat",
    );
    refused(
        b"\n\n  \n",
        "line 3: found the end of the file, expected $MeshFormat",
    );
    refused(b"$NOD\n1\n", "line 1: found \"$NOD\", expected $MeshFormat");
    refused(
        b"\xff\xfe\n",
        "line 1: found \"\u{fffd}\u{fffd}\", expected $MeshFormat",
    );
    let accepted = "accepted: 2.2, 4.1 (gmsh -format msh41 writes the latter)";
    for version in ["1.0", "2", "4.0", "nan"] {
        let message = format!("line 2: MSH version {version} cannot be read; {accepted}");
        edited(V22, "2.2", version, &message);
    }
    edited(
        V22,
        "2.2 0",
        "2.2 2",
        "line 2: found 2, expected 0 for text or 1 for binary",
    );
    edited(
        V22,
        "0 8",
        "0 4",
        "line 2: real numbers of 4 bytes cannot be read; accepted: 8 bytes",
    );
    edited(
        V22,
        "0 8",
        "0",
        "line 2: found the end of the line, expected the size of a real number, 8",
    );
    edited(
        V22,
        "0 8",
        "0 8 9",
        "line 2: found \"9\", expected the end of the line",
    );
    edited(
        V22,
        "$EndMeshFormat",
        "$Nodes",
        "line 3: found \"$Nodes\", expected $EndMeshFormat",
    );
    let twice = format!("{V22}{V22}");
    let message = "line 31: found a second node with the tag 1, expected a tag not used before";
    refused(twice.as_bytes(), message);
}

#[test]
fn sections_are_closed_and_known() {
    edited(
        V22,
        "$EndNodes\n",
        "",
        "line 14: found \"$Elements\", expected $EndNodes",
    );
    let cut = V22.split("$EndElements").next().unwrap();
    refused(
        cut.as_bytes(),
        "line 19: found the end of the file, expected $EndElements",
    );
    edited(
        V22,
        "$Nodes",
        "Nodes",
        "line 9: found \"Nodes\", expected the mark of a section, such as $Nodes",
    );
    edited(
        V22,
        "$Elements",
        "$Element",
        "line 20: found the end of the file, expected $EndElement",
    );
    edited(
        V22,
        "$Nodes",
        "$End",
        "line 9: found \"$End\", expected the mark of a section, such as $Nodes",
    );
    let accepted = "accepted: $Nodes (write the file with Mesh.SaveParametric = 0)";
    let message = format!("line 9: the section $ParametricNodes cannot be read; {accepted}");
    edited(V22, "$Nodes", "$ParametricNodes", &message);
    let accepted = "accepted: a whole mesh (write the file before partitioning, or unpartition it)";
    for name in ["PartitionedEntities", "GhostElements"] {
        let message =
            format!("line 8: the section ${name} of a partitioned mesh cannot be read; {accepted}");
        edited(V41, "$Entities", &format!("${name}"), &message);
    }
}

#[test]
fn a_file_without_nodes_or_elements_is_refused() {
    let head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    refused(
        head.as_bytes(),
        "line 3: found no node, expected at least one in a section $Nodes",
    );
    let none = format!("{head}$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n0\n$EndElements\n");
    let message = "line 10: found no element, expected at least one in a section $Elements (where a file has \
                   physical groups, Gmsh writes only their elements)";
    refused(none.as_bytes(), message);
}

#[test]
fn names_are_checked() {
    let name = "a name in double quotes (physical name 1 of 2)";
    edited(
        V22,
        "\"bar\"",
        "bar",
        &format!("line 6: found \"bar\", expected {name}"),
    );
    edited(
        V22,
        "\"bar\"",
        "\"bar",
        &format!("line 6: found a name without the closing quote, expected {name}"),
    );
    edited(
        V22,
        "\"bar\"",
        "\"\"",
        &format!("line 6: found an empty name, expected {name}"),
    );
    edited(
        V22,
        "1 1 \"bar\"",
        "4 1 \"bar\"",
        "line 6: found 4, expected the dimension of a physical group, 0 to 3 (physical name 1 of 2)",
    );
    edited(
        V22,
        "2\n1 1 \"",
        "3\n1 1 \"",
        "line 8: found \"$EndPhysicalNames\", expected the dimension of a physical group, 0 to 3 (physical name 3 of 3)",
    );
    edited(
        V22,
        "2\n1 1 \"",
        "1\n1 1 \"",
        "line 7: found \"0\", expected $EndPhysicalNames",
    );
    edited(
        V22,
        "\"end\"",
        "\"bar\"",
        "line 6: found a second group called \"bar\", expected distinct names, over all dimensions",
    );
    edited(
        V22,
        "0 2 \"end\"",
        "1 1 \"end\"",
        "line 7: found the name \"end\" for a group called \"bar\" before, expected one name for each dimension and tag (physical name 2 of 2)",
    );
    let mut bytes = V22.as_bytes().to_vec();
    bytes[V22.find("bar").unwrap()] = 0xe9;
    refused(
        &bytes,
        &format!("line 6: found \"\u{fffd}ar\", which is not UTF-8, expected {name}"),
    );
}

#[test]
fn nodes_are_checked() {
    edited(
        V22,
        "3\n1 0 0 0",
        "-3\n1 0 0 0",
        "line 10: found \"-3\", expected the number of nodes",
    );
    edited(
        V22,
        "3\n1 0 0 0",
        "three\n1 0 0 0",
        "line 10: found \"three\", expected the number of nodes",
    );
    edited(
        V22,
        "3\n1 0 0 0",
        "4\n1 0 0 0",
        "line 14: found \"$EndNodes\", expected a node tag (node 4 of 4)",
    );
    edited(
        V22,
        "3\n1 0 0 0",
        "2\n1 0 0 0",
        "line 13: found \"3\", expected $EndNodes",
    );
    edited(
        V22,
        "3\n1 0 0 0",
        "18446744073709551615\n1 0 0 0",
        "line 10: found the count 18446744073709551615, expected at most 13, which is what the rest of the file can hold",
    );
    edited(
        V22,
        "2 0.5 0 0",
        "2 0.5 0",
        "line 12: found the end of the line, expected a finite coordinate (node 2 of 3)",
    );
    edited(
        V22,
        "2 0.5 0 0",
        "2 0.5 0 0 0",
        "line 12: found \"0\", expected the end of the line (node 2 of 3)",
    );
    edited(
        V22,
        "2 0.5 0 0",
        "2 0,5 0 0",
        "line 12: found \"0,5\", expected a finite coordinate (node 2 of 3)",
    );
    edited(
        V22,
        "0.5",
        "nan",
        "line 12: found NaN, expected a finite coordinate (node 2 of 3)",
    );
    edited(
        V22,
        "0.5",
        "-1e999",
        "line 12: found -inf, expected a finite coordinate (node 2 of 3)",
    );
    edited(
        V22,
        "2 0.5",
        "-2 0.5",
        "line 12: found -2, expected a node tag (node 2 of 3)",
    );
    edited(
        V22,
        "2 0.5",
        "3 0.5",
        "line 13: found a second node with the tag 3, expected a tag not used before",
    );
    let long = "9".repeat(60);
    let message = format!(
        "line 12: found \"{}...\", expected a node tag (node 2 of 3)",
        &long[..40]
    );
    edited(V22, "2 0.5", &format!("{long} 0.5"), &message);
}

#[test]
fn elements_are_checked() {
    edited(
        V22,
        "1 2\n2 1",
        "1 7\n2 1",
        "line 17: found node tag 7, expected the tag of a node defined before, in $Nodes (element 1 of 3)",
    );
    edited(
        V22,
        "1 2\n2 1",
        "1\n2 1",
        "line 17: found the end of the line, expected a node tag (element 1 of 3)",
    );
    edited(
        V22,
        "1 2\n2 1",
        "1 2 3\n2 1",
        "line 17: found \"3\", expected the end of the line (element 1 of 3)",
    );
    edited(
        V22,
        "1 2\n2 1",
        "1 x\n2 1",
        "line 17: found \"x\", expected a node tag (element 1 of 3)",
    );
    edited(
        V22,
        "1 1 2 1 1 1 2",
        "1 1 -2 1 1 1 2",
        "line 17: found -2, expected the number of tags of an element (element 1 of 3)",
    );
    edited(
        V22,
        "1 1 2 1 1 1 2",
        "1 1 200 1 1 1 2",
        "line 17: found the count 200, expected at most 25, which is what the rest of the file can hold (element 1 of 3)",
    );
    edited(
        V22,
        "3\n1 1 2",
        "4\n1 1 2",
        "line 20: found \"$EndElements\", expected an element number (element 4 of 4)",
    );
    edited(
        V22,
        "3\n1 1 2",
        "2\n1 1 2",
        "line 19: found \"3\", expected $EndElements",
    );
    let nodes = &V22[V22.find("$Nodes").unwrap()..V22.find("$Elements").unwrap()];
    edited(
        V22,
        nodes,
        "",
        "line 11: found node tag 1, expected the tag of a node defined before, in $Nodes (element 1 of 3)",
    );
}

#[test]
fn other_elements_are_refused_by_name() {
    let accepted = "15 (point1), 1 (bar2), 8 (bar3), 2 (tri3), 9 (tri6), 3 (quad4), 16 (quad8), 10 (quad9), \
                    4 (tet4), 11 (tet10), 5 (hex8), 17 (hex20), 12 (hex27), 6 (wedge6), 18 (wedge15), \
                    7 (pyramid5)";
    for (number, name) in [
        (26, "element type 26 (4-node third order line)"),
        (29, "element type 29 (20-node third order tetrahedron)"),
        (13, "element type 13 (18-node second order prism)"),
        (140, "element type 140"),
    ] {
        let message = format!("line 17: {name} cannot be read; accepted: {accepted}");
        edited(
            V22,
            "1 1 2 1 1 1 2",
            &format!("1 {number} 2 1 1 1 2"),
            &message,
        );
        let message = format!("line 27: {name} cannot be read; accepted: {accepted}");
        edited(
            V41,
            "1 1 1 2\n1 1 3",
            &format!("1 1 {number} 2\n1 1 3"),
            &message,
        );
    }
}
