//! What pictures show of a mesh: cells and outer edges in the plane, outer faces of solids, axes of beams.

use std::collections::BTreeMap;

use carom_contact::Target;
use carom_dynamics::System;
use carom_pages::plot::{Frame, Patch};

/// Longest side of the box around the undeformed model, m.
pub fn size(system: &System) -> f64 {
    let side = |i: usize| {
        let values = system.x.iter().map(|x| x[i]);
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        high - low
    };
    (0..system.dim).map(side).fold(0.0, f64::max)
}

/// Gap of a place over the rigid obstacles of a plane model at a time in s, m: negative inside.
pub fn gap(system: &System, time: f64, place: [f64; 3]) -> f64 {
    let place = match system.axisymmetric {
        true => [place[0].abs(), place[1], place[2]],
        false => place,
    };
    let obstacles = system.contacts.iter();
    let obstacles = obstacles.filter_map(|contact| match &contact.target {
        Target::Rigid(obstacle) => Some(obstacle.at(time).distance(&place).gap),
        Target::Surface(_) => None,
    });
    obstacles.fold(f64::INFINITY, f64::min)
}

/// What is drawn of the mesh, in system numbers of the nodes.
pub struct Outlines {
    /// Nodes in turn around each patch, and its cell.
    patches: Vec<(Vec<u32>, usize)>,
    /// Outer edges of plane bodies, and cells that are lines.
    rims: Vec<Vec<u32>>,
}

impl Outlines {
    /// All cells and the outer edges of plane bodies, the cells of shells, the outer faces of solids, the axes of bars and beams, of what is `shown`: asked
    /// with the number of the body and that of the cell among the cells of all bodies.
    pub fn new(system: &System, shown: impl Fn(usize, usize) -> bool) -> Outlines {
        let mut outlines = Outlines {
            patches: Vec::new(),
            rims: Vec::new(),
        };
        let mut cell = 0;
        for (number, body) in system.bodies.iter().enumerate() {
            if body.as_discrete().is_some() {
                cell += body.cells().len();
                continue;
            }
            let shown = |cell| shown(number, cell);
            // the faces that only one cell of the body has
            let mut outer: BTreeMap<Vec<u32>, Option<(Vec<u32>, usize)>> = BTreeMap::new();
            for &element in body.cells() {
                if !shown(cell) {
                    cell += 1;
                    continue;
                }
                let nodes = system.mesh.element_nodes(element);
                let number = |local: &usize| system.number[nodes[*local] as usize];
                let table = system.mesh.kind(element).table();
                if table.dim == 1 {
                    let all: Vec<u32> = (0..nodes.len()).map(|local| number(&local)).collect();
                    outlines.rims.push(along(&all));
                    cell += 1;
                    continue;
                }
                let of_shell = table.dim == 2 && system.dim == 3;
                for face in table.faces.iter().filter(|_| !of_shell) {
                    let own: Vec<u32> = face.nodes.iter().map(number).collect();
                    let mut key = own.clone();
                    key.sort_unstable();
                    let around = match system.dim {
                        2 => along(&own),
                        _ => ring(face.kind.table().faces.iter().map(|f| f.nodes), &own),
                    };
                    let entry = outer.entry(key);
                    entry
                        .and_modify(|twice| *twice = None)
                        .or_insert(Some((around, cell)));
                }
                if table.dim == 2 {
                    let all: Vec<u32> = (0..nodes.len()).map(|local| number(&local)).collect();
                    let around = ring(table.faces.iter().map(|f| f.nodes), &all);
                    if of_shell {
                        // seen from both sides
                        let back = around.iter().rev().copied().collect();
                        outlines.patches.push((back, cell));
                    }
                    outlines.patches.push((around, cell));
                }
                cell += 1;
            }
            let outer = outer.into_values().flatten();
            match system.dim {
                2 => outlines.rims.extend(outer.map(|(rim, _)| rim)),
                // the ends of a line have no area to be seen
                _ => outlines
                    .patches
                    .extend(outer.filter(|(ring, _)| ring.len() > 2)),
            }
        }
        outlines
    }

    /// Whether there is nothing to draw at all.
    pub fn is_blank(&self) -> bool {
        self.patches.is_empty() && self.rims.is_empty()
    }

    /// The nodes that are drawn, ascending.
    pub fn nodes(&self) -> Vec<u32> {
        let patches = self.patches.iter().flat_map(|(nodes, _)| nodes);
        let mut nodes: Vec<u32> = patches.chain(self.rims.iter().flatten()).copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Nodes in turn around each cell or face with an area, and its cell among those of all bodies.
    pub fn patches(&self) -> impl Iterator<Item = (&[u32], usize)> {
        self.patches.iter().map(|(nodes, cell)| (&nodes[..], *cell))
    }

    /// Whether there are cells or faces with an area.
    pub(crate) fn has_patches(&self) -> bool {
        !self.patches.is_empty()
    }

    /// Adds what is at the places of the nodes (m) to a frame; of an axisymmetric model both halves of the section. `value`: of the nodes
    /// around a patch, and its cell.
    pub fn frame(
        &self,
        system: &System,
        place: &dyn Fn(&u32) -> [f64; 3],
        value: &dyn Fn(&[u32], usize) -> f64,
        mut frame: Frame,
    ) -> Frame {
        let patch = |(nodes, cell): &(Vec<u32>, usize)| Patch {
            points: nodes.iter().map(place).collect(),
            value: value(nodes, *cell),
        };
        frame.patches.extend(self.patches.iter().map(patch));
        let rims = self.rims.iter();
        frame
            .rims
            .extend(rims.map(|rim| rim.iter().map(place).collect()));
        if system.axisymmetric {
            mirror(&mut frame);
        }
        frame
    }
}

/// Adds the other half of a section through the axis.
fn mirror(frame: &mut Frame) {
    let other = |[r, z, y]: &[f64; 3]| [-r, *z, *y];
    let patches: Vec<Patch> = frame
        .patches
        .iter()
        .map(|patch| Patch {
            points: patch.points.iter().map(other).collect(),
            value: patch.value,
        })
        .collect();
    // edges on the axis are inside the body
    let on_axis = |rim: &Vec<[f64; 3]>| rim.iter().all(|x| x[0] == 0.0);
    frame.rims.retain(|rim| !on_axis(rim));
    let rims = frame.rims.iter().map(|rim| rim.iter().map(other).collect());
    let rims: Vec<Vec<[f64; 3]>> = rims.collect();
    let marks: Vec<[f64; 3]> = frame.marks.iter().map(other).collect();
    frame.patches.extend(patches);
    frame.rims.extend(rims);
    frame.marks.extend(marks);
}

/// An edge from end to end: its middle, which comes last in the list of its nodes, between the ends.
pub fn along(edge: &[u32]) -> Vec<u32> {
    match edge {
        [from, to, middle] => vec![*from, *middle, *to],
        _ => edge.to_vec(),
    }
}

/// The nodes around a cell or a face, with those in the middle of its edges.
pub fn ring<'a>(edges: impl Iterator<Item = &'a [usize]>, nodes: &[u32]) -> Vec<u32> {
    let mut ring = Vec::new();
    for edge in edges {
        // the end of an edge is the beginning of the next
        let inner = std::iter::once(edge[0]).chain(edge.get(2).copied());
        ring.extend(inner.map(|local| nodes[local]));
    }
    ring
}
