//! Cells that no shell can be on.

use std::collections::BTreeMap;

use carom_algebra::tensor::Vec3;
use carom_elements::Kind;
use carom_mesh::{ElementId, Mesh};

/// Part of the largest edge by which a node may lie beside the plane of the others.
const WARPED: f64 = 0.3;

/// What is wrong with a cell of which [`against`] tells.
pub(super) const AGAINST: &str =
    "has its normal against that of its neighbour; orient all cells of a shell alike";

/// A cell that no shell can be on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellDefect {
    /// The cell.
    pub cell: ElementId,
    /// What is wrong with it.
    pub why: &'static str,
}

/// All cells that no shell can be on: without area, not convex, too warped; where there is none, those whose normals are against those of most of their neighbours.
/// Cells of several bodies are neighbours where they share an edge. Cells of other kinds are not looked at.
pub fn shell_defects(mesh: &Mesh, cells: &[ElementId]) -> Vec<ShellDefect> {
    let takes = |cell: &ElementId| matches!(mesh.kind(*cell), Kind::Tri3 | Kind::Quad4);
    let cells: Vec<ElementId> = cells.iter().copied().filter(takes).collect();
    let shape = cells.iter().filter_map(|&cell| {
        let why = of_shape(mesh, cell)?;
        Some(ShellDefect { cell, why })
    });
    let found: Vec<ShellDefect> = shape.collect();
    if !found.is_empty() {
        return found;
    }
    let against = against(mesh, &cells).into_iter();
    let defect = |cell| ShellDefect { cell, why: AGAINST };
    against.map(defect).collect()
}

fn place(mesh: &Mesh, nodes: &[u32], a: usize) -> Vec3 {
    Vec3::from(mesh.nodes[nodes[a % nodes.len()] as usize])
}

/// Product of both edges at a corner, m².
pub(super) fn corner(mesh: &Mesh, nodes: &[u32], a: usize) -> Vec3 {
    let x = |a: usize| place(mesh, nodes, a);
    (x(a + 1) - x(a)).cross(&(x(a + nodes.len() - 1) - x(a)))
}

/// Length of the longest edge or diagonal.
pub(super) fn longest(x: &[Vec3]) -> f64 {
    let pairs = (0..x.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    pairs.map(|(a, b)| (x[a] - x[b]).norm()).fold(0.0, f64::max)
}

/// What is wrong with the shape of a cell.
pub(super) fn of_shape(mesh: &Mesh, cell: ElementId) -> Option<&'static str> {
    let nodes = mesh.element_nodes(cell);
    let (count, mut whole) = (nodes.len(), Vec3::zeros());
    let x = |a: usize| place(mesh, nodes, a);
    let size = longest(&(0..count).map(x).collect::<Vec<_>>());
    (0..count).for_each(|a| whole += corner(mesh, nodes, a));
    let whole = whole / count as f64;
    if whole.norm() <= 1e-9 * size * size {
        return Some("has no area, or crosses itself");
    }
    let (flat, across) = (whole.norm(), whole.normalize());
    if (0..count).any(|a| corner(mesh, nodes, a).dot(&across) <= 1e-3 * flat) {
        return Some("is not convex: an angle of it is 180° or more");
    }
    let beside = (x(0) - x(1) + x(2) - x(count - 1)).dot(&across).abs();
    if count == 4 && beside > WARPED * size {
        return Some("is warped: its nodes lie too far beside a plane; divide it into triangles");
    }
    None
}

/// Cells whose normals are against those of most cells that are connected with them. Neighbours agree where they run along their common edge in opposite
/// directions; more than two cells at an edge have no common side.
pub(super) fn against(mesh: &Mesh, cells: &[ElementId]) -> Vec<ElementId> {
    let mut edges: BTreeMap<[u32; 2], Vec<(usize, bool)>> = BTreeMap::new();
    for (number, &cell) in cells.iter().enumerate() {
        let nodes = mesh.element_nodes(cell);
        for (a, &from) in nodes.iter().enumerate() {
            let to = nodes[(a + 1) % nodes.len()];
            let edge = edges.entry([from.min(to), from.max(to)]).or_default();
            edge.push((number, from < to));
        }
    }
    let mut neighbours: Vec<Vec<(usize, bool)>> = vec![Vec::new(); cells.len()];
    for edge in edges.values() {
        if let [(first, forward), (second, other)] = edge[..] {
            neighbours[first].push((second, forward != other));
            neighbours[second].push((first, forward != other));
        }
    }
    let mut side: Vec<Option<bool>> = vec![None; cells.len()];
    let mut found = Vec::new();
    for start in 0..cells.len() {
        if side[start].is_some() {
            continue;
        }
        side[start] = Some(true);
        let (mut piece, mut next) = (vec![start], 0);
        while next < piece.len() {
            let own = piece[next];
            next += 1;
            for &(other, agrees) in &neighbours[own] {
                let expected = side[own] == Some(agrees);
                match side[other] {
                    None => {
                        side[other] = Some(expected);
                        piece.push(other);
                    }
                    // a surface with one side only
                    Some(known) if known != expected => found.push(cells[own.max(other)]),
                    Some(_) => {}
                }
            }
        }
        let turned = piece
            .iter()
            .filter(|&&cell| side[cell] == Some(false))
            .count();
        let fewer = Some(2 * turned > piece.len());
        found.extend(
            piece
                .iter()
                .filter(|&&own| side[own] == fewer)
                .map(|&own| cells[own]),
        );
    }
    found.sort_unstable_by_key(|cell| (cell.block, cell.index));
    found.dedup();
    found
}
