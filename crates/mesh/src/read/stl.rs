//! Surfaces of triangles (`.stl`), as text or binary: rigid obstacles, mostly.
//!
//! Corners with the same coordinates, bit by bit, are one node, in the order in which they come. A triangle with two equal corners has no
//! area and is left out, as programs that write this format make such at the ends of round faces. Normals in the file are not
//! used: the order of the corners says which side is outside.
//!
//! **Groups.** A file of text has a group for each solid, by its name; solids without a name, and a binary file, are the group `surface`.
//!
//! The format has no unit. Reference: 3D Systems, StereoLithography Interface Specification (1989).

use std::collections::BTreeMap;
use std::path::Path;

use carom_elements::Kind;

use super::{Place, ReadError};
use crate::{Block, ElementId, Group, Mesh};

/// The group of what has no name.
const GROUP: &str = "surface";

/// Bytes before the first triangle of a binary file, and of one triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Reads the surface in the content of a file; `path` is only for messages.
///
/// # Errors
/// The first thing that is malformed, with its place; a coordinate that is not finite; no triangle.
pub fn parse(path: &Path, content: &[u8]) -> Result<Mesh, ReadError> {
    let malformed = |fault: Fault| ReadError::Malformed {
        path: path.to_owned(),
        place: fault.place,
        found: fault.found,
        expected: fault.expected.to_owned(),
    };
    let mut surface = Surface::default();
    // binary files may begin with the word of a text, texts never have the length of a binary file
    match triangles_of_binary(content) {
        Some(count) => surface.read_binary(content, count),
        None => surface.read_text(&String::from_utf8_lossy(content)),
    }
    .map_err(malformed)?;
    surface.mesh().ok_or_else(|| {
        malformed(Fault {
            place: Place::Line(1),
            found: "no triangle with an area".to_owned(),
            expected: "`solid NAME` with facets, or a binary file of 84 + 50 n bytes",
        })
    })
}

struct Fault {
    place: Place,
    found: String,
    expected: &'static str,
}

/// The number of triangles of a binary file, if the content has the length of one.
fn triangles_of_binary(content: &[u8]) -> Option<usize> {
    let count: [u8; 4] = content.get(80..HEAD)?.try_into().ok()?;
    let count = u32::from_le_bytes(count) as usize;
    (content.len() == HEAD + TRIANGLE * count).then_some(count)
}

/// What was read so far.
#[derive(Default)]
struct Surface {
    nodes: Vec<[f64; 3]>,
    numbers: BTreeMap<[u64; 3], u32>,
    corners: Vec<u32>,
    groups: BTreeMap<String, Vec<ElementId>>,
}

impl Surface {
    fn read_binary(&mut self, content: &[u8], count: usize) -> Result<(), Fault> {
        for k in 0..count {
            // a normal, three corners, two bytes of attributes
            let at = HEAD + TRIANGLE * k + 12;
            let number = |n: usize| {
                let mut bytes = [0; 4];
                bytes.copy_from_slice(&content[at + 4 * n..at + 4 * n + 4]);
                f64::from(f32::from_le_bytes(bytes))
            };
            let corners = [0, 1, 2].map(|c| [0, 1, 2].map(|i| number(3 * c + i)));
            self.add(GROUP, &corners).map_err(|found| Fault {
                place: Place::Byte(at),
                found,
                expected: "finite coordinates",
            })?;
        }
        Ok(())
    }

    fn read_text(&mut self, text: &str) -> Result<(), Fault> {
        let mut group = GROUP.to_owned();
        let (mut corners, mut begun) = (Vec::new(), false);
        for (number, line) in text.lines().enumerate() {
            let fault = |found: &str, expected| Fault {
                place: Place::Line(number + 1),
                found: format!("\"{}\"", found.chars().take(60).collect::<String>()),
                expected,
            };
            let mut words = line.split_whitespace();
            let first = words.next().unwrap_or_default().to_lowercase();
            match first.as_str() {
                "" | "outer" | "endloop" | "endsolid" => {}
                "solid" => {
                    begun = true;
                    let name = words.collect::<Vec<_>>().join(" ");
                    group = if name.is_empty() {
                        GROUP.to_owned()
                    } else {
                        name
                    };
                }
                _ if !begun => return Err(fault(line, "`solid NAME`")),
                "facet" => corners.clear(),
                "vertex" => {
                    let numbers = words.map(str::parse::<f64>);
                    let numbers = numbers.collect::<Result<Vec<f64>, _>>().ok();
                    let corner = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
                    corners.push(corner.ok_or_else(|| fault(line, "`vertex` with three numbers"))?);
                }
                "endfacet" => {
                    let three = <[[f64; 3]; 3]>::try_from(&corners[..]);
                    let three = three.map_err(|_| fault(line, "three vertices before it"))?;
                    self.add(&group, &three)
                        .map_err(|found| fault(&found, "finite coordinates"))?;
                }
                _ => return Err(fault(line, "`facet`, `vertex`, `endfacet` or `endsolid`")),
            }
        }
        Ok(())
    }

    /// Adds a triangle, if it has three different corners; or says what is not finite.
    fn add(&mut self, group: &str, corners: &[[f64; 3]; 3]) -> Result<(), String> {
        if let Some(corner) = corners.iter().find(|x| x.iter().any(|x| !x.is_finite())) {
            return Err(format!("{corner:?}"));
        }
        let [a, b, c] = corners.map(|corner| self.node(corner));
        if a != b && b != c && c != a {
            let index = (self.corners.len() / 3) as u32;
            self.corners.extend([a, b, c]);
            let group = self.groups.entry(group.to_owned()).or_default();
            group.push(ElementId { block: 0, index });
        }
        Ok(())
    }

    fn node(&mut self, x: [f64; 3]) -> u32 {
        // -0 is 0
        let key = x.map(|x| (x + 0.0).to_bits());
        let next = self.nodes.len() as u32;
        let number = *self.numbers.entry(key).or_insert(next);
        if number == next {
            self.nodes.push(x);
        }
        number
    }

    fn mesh(self) -> Option<Mesh> {
        if self.corners.is_empty() {
            return None;
        }
        let groups = self.groups.into_iter();
        Some(Mesh {
            dim: 3,
            nodes: self.nodes,
            blocks: vec![Block {
                kind: Kind::Tri3,
                nodes: self.corners,
            }],
            groups: groups
                .map(|(name, elements)| (name, Group::new(2, elements)))
                .collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use carom_testing::damage::damaged;

    use super::*;

    /// The corners of a tetrahedron's faces, outward.
    const FACES: [[[f32; 3]; 3]; 4] = [
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    ];

    fn text(names: [&str; 2]) -> String {
        let mut text = String::new();
        for (name, faces) in names.iter().zip(FACES.chunks(2)) {
            text += &format!("solid {name}\n");
            for face in faces {
                text += "  facet normal 0 0 0\n    outer loop\n";
                for [x, y, z] in face {
                    text += &format!("      vertex {x:e} {y} {z}\n");
                }
                text += "    endloop\n  endfacet\n";
            }
            text += &format!("endsolid {name}\n");
        }
        text
    }

    fn binary(head: &str) -> Vec<u8> {
        let mut bytes = head.as_bytes().to_vec();
        bytes.resize(80, b' ');
        bytes.extend(4_u32.to_le_bytes());
        for face in FACES {
            bytes.extend([0; 12]);
            let numbers = face.iter().flatten();
            bytes.extend(numbers.flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn read(content: &[u8]) -> Result<Mesh, ReadError> {
        parse(Path::new("a.stl"), content)
    }

    /// Volume by the divergence theorem: Σ x · n dA / 3.
    fn volume(mesh: &Mesh) -> f64 {
        let of = |corners: &[u32]| {
            let [a, b, c] = [0, 1, 2].map(|k| mesh.nodes[corners[k] as usize]);
            let cross = [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                b[j] * c[k] - b[k] * c[j]
            });
            (0..3).map(|i| a[i] * cross[i]).sum::<f64>() / 6.0
        };
        mesh.blocks[0].nodes.chunks_exact(3).map(of).sum()
    }

    #[test]
    fn text_and_binary_give_the_same_closed_surface() {
        let text = read(text(["lower part", ""]).as_bytes()).unwrap();
        // a binary file whose head begins as a text
        let binary = read(&binary("solid by a program")).unwrap();
        for mesh in [&text, &binary] {
            assert_eq!(mesh.nodes.len(), 4);
            assert!((volume(mesh) - 1.0 / 6.0).abs() < 1e-15);
        }
        assert_eq!(text.blocks, binary.blocks);
        let names: Vec<&String> = text.groups.keys().collect();
        assert_eq!(names, ["lower part", "surface"]);
        assert_eq!(binary.groups["surface"].elements.len(), 4);
    }

    #[test]
    fn a_triangle_without_area_is_left_out_and_what_is_wrong_is_told_with_its_line() {
        let flat = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 0 -0\nendloop\nendfacet\nendsolid\n";
        let sound = text(["a", "b"]);
        assert_eq!(
            read((sound.clone() + flat).as_bytes()).unwrap().blocks[0]
                .nodes
                .len(),
            12
        );
        for (content, told) in [
            (flat.to_owned(), "no triangle with an area"),
            (sound.replace("vertex 1e0 0 0", "vertex 1e0 0"), "line 6"),
            (
                sound.replace("vertex 1e0 0 0", "vertex nan 0 0"),
                "expected finite coordinates",
            ),
            ("hello".to_owned(), "line 1"),
            (String::new(), "no triangle"),
            (
                "solid a\nvertex 0 0 0\nendfacet".to_owned(),
                "three vertices before it",
            ),
        ] {
            let error = read(content.as_bytes())
                .map(|_| ())
                .unwrap_err()
                .to_string();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn damaged_files_are_refused_or_have_triangles_of_their_nodes() {
        let (mut state, mut refused) = (3, 0);
        for content in [text(["lower part", ""]).into_bytes(), binary("head")] {
            for _ in 0..10_000 {
                match read(&damaged(&content, &mut state)) {
                    Err(_) => refused += 1,
                    Ok(mesh) => {
                        let nodes = mesh.nodes.len() as u32;
                        assert!(mesh.nodes.iter().flatten().all(|x| x.is_finite()));
                        assert!(mesh.blocks[0].nodes.iter().all(|node| *node < nodes));
                    }
                }
            }
        }
        assert!((1000..20_000).contains(&refused), "{refused}");
    }
}
