//! Which nodes of which zones move together across borders.

use std::collections::BTreeMap;

use carom_arlequin::{Error, Rows, trace};
use carom_dynamics::ModelBody;
use carom_mesh::Mesh;

use super::zones::Plan;

/// Largest distance of nodes at the same place, as a part of the size of the mesh.
const COINCIDENT: f64 = 1e-9;

/// The nodes of the bodies, and which of them are tied so far.
pub(super) struct Ties<'a> {
    mesh: &'a Mesh,
    bodies: &'a [ModelBody],
    /// Zone of each body.
    zones: Vec<usize>,
    /// Nodes of each body.
    nodes: Vec<Vec<u32>>,
    /// A leader of each zone's node, among those tied to it.
    leader: BTreeMap<(usize, u32), (usize, u32)>,
}

impl<'a> Ties<'a> {
    pub(super) fn new(mesh: &'a Mesh, bodies: &'a [ModelBody], plan: &Plan) -> Ties<'a> {
        let nodes = |body: &ModelBody| {
            let cells = body.spec.cells.iter();
            let mut nodes: Vec<u32> = cells
                .flat_map(|&cell| mesh.element_nodes(cell))
                .copied()
                .collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes
        };
        Ties {
            mesh,
            bodies,
            zones: (0..bodies.len())
                .map(|body| plan.zone_of(body).unwrap_or(0))
                .collect(),
            nodes: bodies.iter().map(nodes).collect(),
            leader: BTreeMap::new(),
        }
    }

    /// The rows that tie two bodies at all nodes at the same place.
    pub(super) fn rows(&self, inner: usize, outer: usize) -> Result<Rows, Error> {
        let tolerance = COINCIDENT * self.mesh.size();
        trace(self.mesh, &self.nodes[inner], &self.nodes[outer], tolerance)
    }

    /// Drops rows between nodes that are tied already, and ties the others; returns those dropped.
    pub(super) fn join(&mut self, bodies: [usize; 2], rows: &mut Rows) -> Vec<(u32, u32)> {
        let [inner, outer] = bodies.map(|body| self.zones[body]);
        let mut known = Vec::new();
        let mut pairs = Vec::new();
        for row in &rows.rows {
            let (Some(one), Some(other)) = (row.inner.first(), row.outer.first()) else {
                continue;
            };
            let ends = [(inner, one.node), (outer, other.node)];
            if self.find(ends[0]) == self.find(ends[1]) {
                known.push((row.node, row.component));
            } else {
                pairs.push(ends);
            }
        }
        for [one, other] in pairs {
            let (one, other) = (self.find(one), self.find(other));
            self.leader.insert(one.max(other), one.min(other));
        }
        rows.drop(|node, component| known.contains(&(node, component)))
    }

    /// Pairs of bodies, by name, in different zones with nodes in common that are not tied, and these nodes.
    pub(super) fn loose(&self) -> Vec<([&'a str; 2], Vec<u32>)> {
        let mut loose = Vec::new();
        for one in 0..self.bodies.len() {
            for other in one + 1..self.bodies.len() {
                if self.zones[one] == self.zones[other] {
                    continue;
                }
                let zones = [self.zones[one], self.zones[other]];
                let parted = |&node: &u32| {
                    self.nodes[other].binary_search(&node).is_ok()
                        && self.find((zones[0], node)) != self.find((zones[1], node))
                };
                let nodes: Vec<u32> = self.nodes[one].iter().copied().filter(parted).collect();
                if !nodes.is_empty() {
                    let name = |body: usize| self.bodies[body].spec.name.as_str();
                    loose.push(([name(one), name(other)], nodes));
                }
            }
        }
        loose
    }

    fn find(&self, mut node: (usize, u32)) -> (usize, u32) {
        while let Some(&leader) = self.leader.get(&node)
            && leader != node
        {
            node = leader;
        }
        node
    }
}
