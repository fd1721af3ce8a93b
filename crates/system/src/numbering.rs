//! The order of the nodes of a system.

use std::ops::Range;

use carom_mesh::Parts;
use carom_ranks::partition;

use crate::mid_surfaces::Carried;
use crate::model::Model;

/// Nodes of a box, about.
const NODES: usize = 1024;

/// The numbers of the nodes of a system.
pub(crate) struct Numbering {
    /// System numbers of the mesh nodes; `u32::MAX` where no body uses one.
    pub(crate) number: Vec<u32>,
    /// Mesh nodes of the system numbers.
    pub(crate) mesh_node: Vec<u32>,
    /// Nodes of the connected parts.
    pub(crate) parts: Vec<Range<usize>>,
}

impl Numbering {
    /// Leaves out all nodes of the mesh but some. The others stay in their order.
    pub(crate) fn keep(&mut self, has: &[bool]) {
        let kept = |node: &u32| has[*node as usize];
        for part in &mut self.parts {
            let before = |end: usize| {
                self.mesh_node[..end]
                    .iter()
                    .filter(|node| kept(node))
                    .count()
            };
            *part = before(part.start)..before(part.end);
        }
        self.mesh_node.retain(kept);
        self.mesh_node.shrink_to_fit();
        self.number.fill(u32::MAX);
        for (&node, number) in self.mesh_node.iter().zip(0..) {
            self.number[node as usize] = number;
        }
    }
}

/// `centres`: nodes of the rigid bodies.
pub(crate) fn numbering(model: &Model, centres: &[Option<u32>], carried: &[Carried]) -> Numbering {
    let count = model.mesh.nodes.len();
    let cells = model.bodies.iter().flat_map(|body| &body.spec.cells);
    let discrete = model.discrete.iter().flat_map(|some| &some.spec.cells);
    let mut joined = Parts::new(&model.mesh, cells.chain(discrete).copied());
    // a body of several pieces is in one part: its tangents and the momentum that its contacts give it are those of a body
    for body in &model.bodies {
        let cells = body.spec.cells.iter();
        let nodes: Vec<u32> = cells
            .map(|&cell| model.mesh.element_nodes(cell)[0])
            .collect();
        joined.join(&nodes);
    }
    if model.nonlinear.preload.is_some() && !model.mixes_schemes() {
        // a static stage has no mass that would hold what only constraints hold, and takes their rows into the matrix of the part
        for row in model.constraints.iter().flat_map(|some| &some.rows) {
            let nodes: Vec<u32> = row.iter().map(|(node, ..)| *node).collect();
            joined.join(&nodes);
        }
        for row in model.links.iter().flat_map(|some| &some.rows) {
            let terms = row.inner.iter().chain(&row.outer);
            let nodes: Vec<u32> = terms.map(|term| term.node).collect();
            joined.join(&nodes);
        }
    }
    // parts come in the order of their first node, which leads
    let mut nodes: Vec<(u32, u32)> = (0..count as u32)
        .filter_map(|node| Some((joined.of(node)?, node)))
        .collect();
    for (body, centre) in model.bodies.iter().zip(centres) {
        let first = body.spec.cells.first();
        let first = first.map(|&cell| model.mesh.element_nodes(cell)[0]);
        if let Some(centre) = *centre {
            let leader = first.and_then(|node| joined.of(node)).unwrap_or(centre);
            nodes.push((leader, centre));
        }
    }
    let with = |own: &Carried| Some((joined.of(own.by)?, own.node));
    nodes.extend(carried.iter().filter_map(with));
    let boxes = boxes(model);
    nodes.sort_unstable_by_key(|&(leader, node)| (leader, boxes.get(node as usize).copied(), node));
    let mut number = vec![u32::MAX; count];
    let mut parts: Vec<Range<usize>> = Vec::new();
    for (system, &(leader, node)) in nodes.iter().enumerate() {
        number[node as usize] = system as u32;
        match parts.last_mut() {
            Some(part) if nodes[part.start].0 == leader => part.end = system + 1,
            _ => parts.push(system..system + 1),
        }
    }
    Numbering {
        number,
        mesh_node: nodes.into_iter().map(|(_, node)| node).collect(),
        parts,
    }
}

/// The box of each node of an explicit system with many: steps walk over the nodes, and what is near in space is then near in memory, on
/// one processor and where several processes share the elements. None where a matrix is factored, whose order is chosen for that.
fn boxes(model: &Model) -> Vec<u32> {
    let nodes = &model.mesh.nodes;
    let mut bodies = 0..model.bodies.len();
    let is_explicit = bodies.all(|body| model.scheme_of(body).get().is_explicit());
    let boxes = (nodes.len() / NODES).next_power_of_two();
    if !is_explicit || boxes < 2 {
        return Vec::new();
    }
    partition(nodes, &vec![1.0; nodes.len()], boxes)
}
