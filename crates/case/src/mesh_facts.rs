//! What can be said of the mesh of a case: quality of its cells, walls of one cell, nodes that are not merged.

use std::collections::BTreeMap;

use carom_dynamics::System;
use carom_mesh::{ElementId, Mesh};
use carom_output::{BodyQuality, qualities};

use crate::facts::Fact;
use crate::lower::Built;
use crate::offenders::Offenders;

/// Scaled Jacobian below which a cell is worth a look. The library Verdict accepts 0.2 to 0.5 and more, by the kind of the cell.
const POOR: f64 = 0.2;

/// Distance of two nodes over the extent of their body up to which they are at the same place.
const SAME: f64 = 1e-9;

/// Facts on the meshes of the bodies, and the cells that are worth a look.
pub fn mesh_facts(built: &Built) -> (Vec<Fact>, Vec<Offenders>) {
    let system = &built.system;
    let (values, bodies) = qualities(system);
    let cells = system.bodies.iter().flat_map(|body| body.cells());
    let poor: Vec<ElementId> = cells
        .zip(values)
        .filter(|(_, quality)| *quality < POOR)
        .map(|(cell, _)| *cell)
        .collect();
    let mut facts: Vec<Fact> = bodies.iter().map(quality_fact).collect();
    let mut offenders = Vec::new();
    if !poor.is_empty() {
        let value = format!("{} cells have a scaled Jacobian below {POOR}", poor.len());
        facts.push(fact("poor cells", value));
        offenders.push(Offenders::new("poor-cells".to_owned(), &system.mesh, &poor));
    }
    for body in &system.bodies {
        let thin = alone_through_thickness(&system.mesh, body.cells());
        if thin > 0 {
            let value = format!(
                "{thin} of {} cells are alone through the thickness: bending needs three linear cells or more, quadratic cells, or a shell",
                body.cells().len()
            );
            facts.push(fact(&format!("walls of {}", body.name()), value));
        }
        if let Some((count, x)) = unmerged(system, body.cells()) {
            let value = format!(
                "{count} nodes are at the place of another node, the first at ({}): the cells there are not joined",
                x[..system.dim]
                    .iter()
                    .map(|x| format!("{x:.6e}"))
                    .collect::<Vec<_>>()
                    .join(", ")
            );
            facts.push(fact(&format!("nodes of {}", body.name()), value));
        }
    }
    (facts, offenders)
}

fn fact(name: &str, value: String) -> Fact {
    Fact {
        name: name.to_owned(),
        value,
    }
}

fn quality_fact(of: &BodyQuality) -> Fact {
    let value = format!(
        "scaled Jacobian {:.3} at least ({}), {:.3} in the mean; longest over shortest edge {:.1}",
        of.least, of.worst, of.mean, of.edges
    );
    fact(&format!("cells of {}", of.body), value)
}

/// Cells with two faces on the surface of the body that share no node; faces of two nodes in the plane.
fn alone_through_thickness(mesh: &Mesh, cells: &[ElementId]) -> usize {
    let mut faces: BTreeMap<Vec<u32>, (usize, usize)> = BTreeMap::new();
    let dim = cells.iter().map(|cell| mesh.kind(*cell).table().dim).max();
    if dim.is_none_or(|dim| dim < 2 || dim < mesh.dim) {
        return 0;
    }
    for (number, cell) in cells.iter().enumerate() {
        let nodes = mesh.element_nodes(*cell);
        for face in mesh.kind(*cell).table().faces {
            let mut key: Vec<u32> = face.nodes.iter().map(|n| nodes[*n]).collect();
            key.sort_unstable();
            let entry = faces.entry(key).or_insert((number, 0));
            entry.1 += 1;
        }
    }
    let mut outer: BTreeMap<usize, Vec<&Vec<u32>>> = BTreeMap::new();
    for (nodes, (cell, count)) in &faces {
        if *count == 1 {
            outer.entry(*cell).or_default().push(nodes);
        }
    }
    let apart = |one: &[u32], other: &[u32]| one.iter().all(|node| !other.contains(node));
    let is_alone = |faces: &&Vec<&Vec<u32>>| {
        let mut pairs = faces.iter().enumerate();
        pairs.any(|(k, one)| faces[..k].iter().any(|other| apart(one, other)))
    };
    outer.values().filter(is_alone).count()
}

/// How many nodes of the cells are at the place of another one, and the place of the first of them.
fn unmerged(system: &System, cells: &[ElementId]) -> Option<(usize, [f64; 3])> {
    let mesh = &system.mesh;
    let mut nodes: Vec<u32> = cells
        .iter()
        .flat_map(|cell| mesh.element_nodes(*cell).iter().copied())
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    let place = |node: u32| mesh.nodes[node as usize];
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for node in &nodes {
        for i in 0..3 {
            low[i] = low[i].min(place(*node)[i]);
            high[i] = high[i].max(place(*node)[i]);
        }
    }
    let extent = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
    let same = SAME * extent;
    // of a grid of twice the distance the cells around a place have all that are near
    let cube = |x: [f64; 3]| x.map(|x| (x / (2.0 * same).max(f64::MIN_POSITIVE)).floor() as i64);
    let mut grid: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let (mut count, mut first) = (0, None);
    for node in nodes {
        let x = place(node);
        let own = cube(x);
        let around = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        let near = around.into_iter().any(|step| {
            let key = [0, 1, 2].map(|i| own[i].saturating_add(step[i]));
            let others = grid.get(&key);
            others.is_some_and(|others| {
                others.iter().any(|other| {
                    let y = place(*other);
                    (0..3).map(|i| (x[i] - y[i]).powi(2)).sum::<f64>() <= same * same
                })
            })
        });
        if near {
            count += 1;
            first.get_or_insert(x);
        }
        grid.entry(own).or_default().push(node);
    }
    first.map(|x| (count, x))
}
