//! Files of a few lines.

use std::path::Path;

use carom_elements::Kind;
use carom_testing::damage::damaged;

use super::parse;
use crate::{Mesh, Surface};

/// Two hexahedra along x, as Abaqus writes them, with a comment, a line that goes on, sets and surfaces.
const BLOCK: &str = "*Heading
** two cells
*Node, nset=Nall
1, 0., 0., 0.
2, 1., 0., 0.
3, 2., 0., 0.
4, 0., 1., 0.
5, 1., 1., 0.
6, 2., 1.
17, 0., 0., 1.
18, 1., 0., 1.D0
19, 2., 0., 1.
20, 0., 1., 1.
21, 1., 1., 1.
22, 2., 1., 1.
*Element, type=C3D8R,
 elset=Block
10, 1, 2, 5, 4, 17,
 18, 21, 20
11, 2, 3, 6, 5, 18, 19, 22, 21
*Nset, nset=block, generate
1, 6, 1
*Nset, nset=corner
17, Block
*Elset, elset=First
10,
*Surface, name=Bottom, type=ELEMENT
Block, S1
*Surface, name=End
11, S4
*Surface, name=both
FIRST, S1
11, s4
*Material, name=steel
*Density
7800.,
";

fn read(text: &str) -> Result<Mesh, String> {
    parse(Path::new("part.inp"), text.as_bytes()).map_err(|error| error.to_string())
}

#[test]
fn cells_sets_and_surfaces_are_those_of_the_file() {
    let mesh = read(BLOCK).unwrap();
    assert_eq!((mesh.dim, mesh.nodes.len()), (3, 12));
    let size = |name: &str| (mesh.groups[name].dim, mesh.groups[name].elements.len());
    assert_eq!(size("Block"), (3, 2));
    assert_eq!(size("First"), (3, 1));
    assert_eq!(size("block.nodes"), (0, 6));
    assert_eq!(size("corner"), (0, 7));
    assert_eq!(size("Nall"), (0, 12));
    assert_eq!(size("Bottom"), (2, 2));
    assert_eq!(size("both"), (2, 2));
    let cells = &mesh.groups["Block"].elements;
    assert!(mesh.check(cells).is_empty());
    for (name, area, middle) in [
        ("Bottom", 2.0, [1.0, 0.5, 0.0]),
        ("End", 1.0, [2.0, 0.5, 0.5]),
    ] {
        let surface = Surface::new(&mesh, &mesh.groups[name], cells).unwrap();
        let places = surface.nodes.iter().map(|node| mesh.nodes[*node as usize]);
        let count = places.len() as f64;
        let mean = places.fold([0.0; 3], |m, x| [0, 1, 2].map(|i| m[i] + x[i] / count));
        assert_eq!(mean, middle, "{name}");
        assert_eq!(surface.faces.len() as f64, area, "{name}");
    }
    // a face that two surfaces have is one facet
    let facets = mesh
        .blocks
        .iter()
        .find(|block| block.kind == Kind::Quad4)
        .unwrap();
    assert_eq!(facets.len(), 3);
}

/// Faces have the numbers of the Elements Guide: where the outward normal points, by the middle of the face.
#[test]
fn faces_have_the_numbers_of_the_format() {
    let cube = [
        [0, 0, 0],
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [0, 0, 1],
        [1, 0, 1],
        [1, 1, 1],
        [0, 1, 1],
    ];
    let mut nodes = "*NODE\n".to_owned();
    for (number, [x, y, z]) in (1..).zip(cube) {
        nodes += &format!("{number},{x},{y},{z}\n");
    }
    let solids: [(&str, &str, &[[i32; 6]]); 3] = [
        // six times the middle of each face
        (
            "C3D8",
            "1,2,3,4,5,6,7,8",
            &[
                [3, 3, 0, 0, 0, 0],
                [3, 3, 6, 0, 0, 0],
                [3, 0, 3, 0, 0, 0],
                [6, 3, 3, 0, 0, 0],
                [3, 6, 3, 0, 0, 0],
                [0, 3, 3, 0, 0, 0],
            ],
        ),
        (
            "C3D4",
            "1,2,4,5",
            &[
                [2, 2, 0, 0, 0, 0],
                [2, 0, 2, 0, 0, 0],
                [2, 2, 2, 0, 0, 0],
                [0, 2, 2, 0, 0, 0],
            ],
        ),
        (
            "C3D6",
            "1,2,4,5,6,8",
            &[
                [2, 2, 0, 0, 0, 0],
                [2, 2, 6, 0, 0, 0],
                [3, 0, 3, 0, 0, 0],
                [3, 3, 3, 0, 0, 0],
                [0, 3, 3, 0, 0, 0],
            ],
        ),
    ];
    for (name, cell, middles) in solids {
        for (number, middle) in (1..).zip(middles) {
            let text = format!(
                "{nodes}*ELEMENT, TYPE={name}, ELSET=E\n1,{cell}\n*SURFACE, NAME=F\n1, S{number}\n"
            );
            let mesh = read(&text).unwrap();
            let facet = mesh.element_nodes(mesh.groups["F"].elements[0]);
            let count = facet.len() as f64;
            let mean = facet.iter().fold([0.0; 3], |m, node| {
                [0, 1, 2].map(|i| m[i] + 6.0 * mesh.nodes[*node as usize][i] / count)
            });
            for i in 0..3 {
                assert!(
                    (mean[i] - f64::from(middle[i])).abs() < 1e-12,
                    "{name} S{number}: {mean:?}"
                );
            }
        }
    }
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let changed = |from: &str, to: &str| read(&BLOCK.replace(from, to)).unwrap_err();
    for (from, to, message) in [
        (
            "11, 2, 3, 6,",
            "11, 2, 3, 7,",
            "part.inp, line 20: found \"7\", expected the number of a node given before",
        ),
        (
            "type=C3D8R",
            "type=GAPUNI",
            "part.inp, line 16: the element type GAPUNI cannot be read",
        ),
        (
            "2, 1., 0., 0.",
            "1, 1., 0., 0.",
            "part.inp, line 5: found a second node with the number 1",
        ),
        (
            "1., 0., 1.D0",
            "1., 0., one",
            "part.inp, line 11: found \"one\", expected a coordinate",
        ),
        (
            "1., 0., 1.D0",
            "1., 0., inf",
            "part.inp, line 11: found \"inf\", expected a finite coordinate",
        ),
        (
            "11, S4",
            "11, S7",
            "part.inp, line 30: found \"S7\", expected the label of a face of hex8: S1 to S6",
        ),
        (
            "Block, S1",
            "Blok, S1",
            "part.inp, line 28: found \"Blok\", expected the number of an element",
        ),
        ("1, 6, 1", "6, 1, 1", "part.inp, line 22: found 6 to 1 by 1"),
        (
            "*Heading",
            "*Include, input=x.inp",
            "part.inp, line 1: *INCLUDE cannot be read",
        ),
        (
            "18, 21, 20\n",
            "18, 21\n",
            "part.inp, line 18: found 8 numbers, expected a number and the 8 nodes",
        ),
        (
            "*Heading",
            "1, 2",
            "part.inp, line 1: found \"1, 2\", expected a keyword",
        ),
    ] {
        {
            let found = changed(from, to);
            assert!(found.starts_with(message), "{found}");
        }
    }
    let empty = read("*Heading\n").unwrap_err();
    assert!(empty.contains("no node"), "{empty}");
}

/// No panic and no endless memory, whatever bytes change.
#[test]
fn damaged_files_are_refused_or_read() {
    let (mut state, mut refused) = (7, 0);
    for _ in 0..20_000 {
        let damaged = damaged(BLOCK.as_bytes(), &mut state);
        refused += usize::from(parse(Path::new("part.inp"), &damaged).is_err());
    }
    assert!((1000..20_000).contains(&refused), "{refused}");
}
