//! A mesh as a file: nodes and elements under other numbers, places in another frame.

use std::fmt::Write;

use carom_elements::Kind;
use carom_mesh::Mesh;
use carom_testing::Random;

/// Writes a mesh in format 2.2 of Gmsh. Node `k` of the file is node `order[k]` of the mesh; elements are in the order of a seed where there
/// is one. Where `place` mirrors, elements turn round.
pub fn msh(
    mesh: &Mesh,
    order: &[u32],
    seed: Option<u64>,
    (place, mirrors): (&dyn Fn([f64; 3]) -> [f64; 3], bool),
) -> String {
    let mut number = vec![0; order.len()];
    for (new, &old) in (1..).zip(order) {
        number[old as usize] = new;
    }
    let elements = |id| {
        let kind = mesh.kind(id);
        let (row, nodes) = (kind.table(), mesh.element_nodes(id));
        // lines have a normal in the plane alone
        let turns = mirrors && (row.dim > 1 || mesh.dim == 2);
        let turned = turned(kind);
        let mut list = vec![0; nodes.len()];
        for (a, &at) in row.gmsh_order.iter().enumerate() {
            list[at] = number[nodes[if turns { turned[a] } else { a }] as usize];
        }
        let list: Vec<String> = list.iter().map(usize::to_string).collect();
        (row.gmsh, list.join(" "))
    };
    let mut lines = Vec::new();
    let mut names = String::new();
    for (group, (name, members)) in (1..).zip(&mesh.groups) {
        let _ = writeln!(names, "{} {group} \"{name}\"", members.dim);
        for &id in &members.elements {
            let (kind, nodes) = elements(id);
            lines.push(format!("{kind} 2 {group} {group} {nodes}"));
        }
    }
    if let Some(seed) = seed {
        shuffle(&mut Random(seed), &mut lines);
    }
    let mut text = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n{names}$EndPhysicalNames\n$Nodes\n{}\n",
        mesh.groups.len(),
        order.len()
    );
    for (new, &old) in (1..).zip(order) {
        let [x, y, z] = place(mesh.nodes[old as usize]);
        let _ = writeln!(text, "{new} {x:?} {y:?} {z:?}");
    }
    let _ = writeln!(text, "$EndNodes\n$Elements\n{}", lines.len());
    for (number, line) in (1..).zip(&lines) {
        let _ = writeln!(text, "{number} {line}");
    }
    text + "$EndElements\n"
}

/// An order of nodes from a seed.
pub fn order(nodes: usize, seed: u64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..nodes as u32).collect();
    shuffle(&mut Random(seed), &mut order);
    order
}

/// Where each node of an element goes when its first two axes change places, or when its one axis turns round: its normal then is on the other side.
fn turned(kind: Kind) -> Vec<usize> {
    let row = kind.table();
    let turned = |[x, y, z]: [f64; 3]| match row.dim {
        1 => [-x, y, z],
        _ => [y, x, z],
    };
    let at = |x: &[f64; 3]| row.reference.iter().position(|other| *other == turned(*x));
    row.reference.iter().map(|x| at(x).unwrap()).collect()
}

fn shuffle<T>(random: &mut Random, list: &mut [T]) {
    for i in (1..list.len()).rev() {
        let other = (random.between(0.0, 1.0) * (i + 1) as f64) as usize;
        list.swap(i, other.min(i));
    }
}
