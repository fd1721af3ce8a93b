//! The mesh of a model as a file, for what generated parts cannot do: other numbers of nodes and elements, blocks of two bodies, bodies of several blocks.

use std::fmt::Write;
use std::path::PathBuf;

use carom_testing::Random;

use super::model::{Block, Change};

/// How the file differs from the generated parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Meshed {
    /// Nodes and elements have other numbers.
    Renumbered,
    /// Each block is two bodies, which share the nodes between them.
    Split,
    /// All blocks are one body.
    Joined,
}

/// Mesh file of format 2.2 of Gmsh. Groups of cells: `b0`, and `b0r` of the right half where blocks are split; of sides `b0.bottom` and `b0.top`.
pub fn msh(blocks: &[Block], change: &Change, meshed: Meshed) -> String {
    let (mut nodes, mut elements) = (Vec::new(), Vec::new());
    let mut names = Vec::new();
    for (k, block) in blocks.iter().enumerate() {
        let first = nodes.len();
        let [nx, ny] = block.elements;
        let at = |i: usize, j: usize| first + j * (nx + 1) + i;
        for j in 0..=ny {
            for i in 0..=nx {
                let part = |axis: usize, i: usize, n: usize| {
                    block.origin[axis] + block.size[axis] * i as f64 / n as f64
                };
                nodes.push(change.place([part(0, i, nx), part(1, j, ny)]));
            }
        }
        let of = |side: &str| format!("b{k}{side}");
        let own = [of(""), of("r"), of(".bottom"), of(".top")];
        let own = [(2, &own[0]), (2, &own[1]), (1, &own[2]), (1, &own[3])];
        names.extend(own.map(|(dim, name)| (dim, name.clone())));
        let number = |group: usize| 4 * k + group + 1;
        for j in 0..ny {
            for i in 0..nx {
                let region = match meshed {
                    Meshed::Split if 2 * i >= nx => number(1),
                    Meshed::Joined => 1,
                    _ => number(0),
                };
                let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let mut corners = corners.to_vec();
                if change.mirrored {
                    corners.reverse();
                }
                elements.push((3, region, corners));
            }
        }
        for i in 0..nx {
            for (group, j) in [(2, 0), (3, ny)] {
                elements.push((1, number(group), vec![at(i, j), at(i + 1, j)]));
            }
        }
    }
    let mut places: Vec<usize> = (0..nodes.len()).collect();
    if meshed == Meshed::Renumbered {
        let mut random = Random(nodes.len() as u64);
        shuffle(&mut random, &mut places);
        shuffle(&mut random, &mut elements);
    }
    let mut text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n".to_owned();
    let used = |number: usize| elements.iter().any(|(_, group, _)| *group == number);
    let names = (1..).zip(&names).filter(|(number, _)| used(*number));
    let names: Vec<String> = names
        .map(|(number, (dim, name))| format!("{dim} {number} \"{name}\""))
        .collect();
    let _ = writeln!(
        text,
        "{}\n{}\n$EndPhysicalNames",
        names.len(),
        names.join("\n")
    );
    let _ = writeln!(text, "$Nodes\n{}", nodes.len());
    for (number, place) in (1..).zip(&places) {
        let [x, y] = nodes[*place];
        let _ = writeln!(text, "{number} {x:?} {y:?} 0");
    }
    let mut number_of = vec![0; places.len()];
    for (number, place) in (1..).zip(&places) {
        number_of[*place] = number;
    }
    let _ = writeln!(text, "$EndNodes\n$Elements\n{}", elements.len());
    for (number, (kind, group, corners)) in (1..).zip(&elements) {
        let corners: Vec<String> = corners
            .iter()
            .map(|&node| number_of[node].to_string())
            .collect();
        let _ = writeln!(
            text,
            "{number} {kind} 2 {group} {group} {}",
            corners.join(" ")
        );
    }
    text + "$EndElements\n"
}

/// Writes it.
pub fn write(folder: &tempfile::TempDir, text: &str) -> PathBuf {
    let path = folder.path().join("model.msh");
    std::fs::write(&path, text).unwrap();
    path
}

fn shuffle<T>(random: &mut Random, list: &mut [T]) {
    for i in (1..list.len()).rev() {
        let other = (random.between(0.0, 1.0) * (i + 1) as f64) as usize;
        list.swap(i, other.min(i));
    }
}
