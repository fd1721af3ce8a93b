//! Which nodes of which zones move together across borders, and which do not move.

use std::collections::{BTreeMap, BTreeSet};

use carom_arlequin::{Error, Rows, trace};
use carom_dynamics::{ModelBody, ModelLink};
use carom_mesh::{ElementId, Mesh};
use carom_zones::mortar_rows;

use super::context::Context;
use super::held::Held;
use super::joints::Joint;
use super::plan::Plan;
use super::problems::{Problems, plural};
use super::{lookup, unfit};
use crate::error::Problem;

/// Largest distance of nodes at the same place, as a part of the size of the mesh.
const COINCIDENT: f64 = 1e-9;

/// A node of a zone.
type ZoneNode = (usize, u32);

/// A leader of each node, among those tied to it.
type Tied = BTreeMap<ZoneNode, ZoneNode>;

fn leader(tied: &Tied, mut node: ZoneNode) -> ZoneNode {
    while let Some(&leader) = tied.get(&node)
        && leader != node
    {
        node = leader;
    }
    node
}

fn tie(tied: &mut Tied, one: ZoneNode, other: ZoneNode) {
    let (one, other) = (leader(tied, one), leader(tied, other));
    if one != other {
        tied.insert(one.max(other), one.min(other));
    }
}

/// The nodes of the bodies, and which of them are tied so far.
pub(super) struct Ties<'a> {
    mesh: &'a Mesh,
    bodies: &'a [ModelBody],
    /// Zone of each body.
    zones: Vec<usize>,
    /// Nodes of each body.
    nodes: Vec<Vec<u32>>,
    tied: Tied,
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
            tied: Tied::new(),
        }
    }

    /// The rows that tie two bodies at all nodes at the same place; of two beams the rotations too.
    pub(super) fn rows(&self, inner: usize, outer: usize) -> Result<Rows, Error> {
        let tolerance = (COINCIDENT * self.mesh.size()).max(self.mesh.rounding());
        let rows = trace(self.mesh, &self.nodes[inner], &self.nodes[outer], tolerance)?;
        let bends = |body: usize| self.bodies[body].spec.kinematics.rotations().is_some();
        Ok(match bends(inner) && bends(outer) {
            true => rows.with_rotations(self.mesh.dim as u32),
            false => rows,
        })
    }

    /// Drops rows between nodes that are tied already, and ties the others; returns those dropped.
    pub(super) fn join(&mut self, bodies: [usize; 2], rows: &mut Rows) -> Vec<(u32, u32)> {
        let [inner, outer] = self.zones_of(bodies);
        let mut known = BTreeSet::new();
        let mut pairs = Vec::new();
        for row in &rows.rows {
            let (Some(one), Some(other)) = (row.inner.first(), row.outer.first()) else {
                continue;
            };
            let ends = [(inner, one.node), (outer, other.node)];
            if leader(&self.tied, ends[0]) == leader(&self.tied, ends[1]) {
                known.insert((row.node, row.component));
            } else {
                pairs.push(ends);
            }
        }
        for [one, other] in pairs {
            tie(&mut self.tied, one, other);
        }
        rows.drop(|node, component| known.contains(&(node, component)))
    }

    fn zones_of(&self, bodies: [usize; 2]) -> [usize; 2] {
        bodies.map(|body| self.zones[body])
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
                        && leader(&self.tied, (zones[0], node))
                            != leader(&self.tied, (zones[1], node))
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
}

/// The rows between nodes at the same place, without those that are tied already.
fn nodes_tied(joint: &Joint, ties: &mut Ties, problems: &mut Problems) -> Option<Rows> {
    let [inner, outer] = joint.bodies;
    let mut rows = match ties.rows(inner, outer) {
        Ok(rows) => rows,
        Err(error) => {
            let problem = Problem::new(&joint.path, error.to_string());
            return problems.refuse(problem.accepted([
                "two bodies with nodes at the same places",
                "surfaces = [...], whose nodes need not match",
            ]));
        }
    };
    let known = ties.join([inner, outer], &mut rows);
    let what = "removed: other interfaces tie them already";
    unfit::name_rows(joint, &known, what, problems);
    Some(rows)
}

/// The rows between two surfaces whose nodes need not match.
fn mortar(
    joint: &Joint,
    names: &[String; 2],
    ties: &mut Ties,
    problems: &mut Problems,
) -> Option<Rows> {
    let path = format!("{}.surfaces", joint.path);
    let (mesh, [inner, outer]) = (joint.mesh, joint.bodies.map(|body| &ties.bodies[body].spec));
    let mut surface = |k: usize, cells: &[ElementId]| {
        lookup::surface(mesh, cells, &format!("{path}[{k}]"), &names[k], problems)
    };
    let (one, other) = (surface(0, &inner.cells), surface(1, &outer.cells));
    let surfaces = [one?, other?];
    let kinematics = inner.kinematics;
    let rows = mortar_rows(mesh, &surfaces[0], &surfaces[1], |x| {
        kinematics.surface_factor(x)
    });
    if rows.rows.is_empty() {
        let message = "these surfaces are nowhere opposite to each other";
        let problem = Problem::new(path, message).found(names.join(" and "));
        return problems.refuse(problem.accepted(["two surfaces that face each other"]));
    }
    // their rows hold the nodes that they share together in the mean
    let [inner, outer] = ties.zones_of(joint.bodies);
    let [one, other] = &surfaces;
    for &node in one.nodes.iter().filter(|&node| other.nodes.contains(node)) {
        tie(&mut ties.tied, (inner, node), (outer, node));
    }
    Some(rows)
}

/// The links of the borders where zones are tied.
pub(super) fn borders(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    held: &Held,
    problems: &mut Problems,
) -> Vec<ModelLink> {
    let mut links = Vec::new();
    let mut ties = Ties::new(mesh, bodies, context.plan);
    for (name, given) in context.case.interface.iter() {
        let path = format!("interface.{name}");
        let names = [&given.inner[..], &given.outer];
        let Some(bodies) = lookup::bodies(context.case, &path, names, problems) else {
            continue;
        };
        let joint = Joint {
            context,
            mesh,
            held,
            name,
            path,
            bodies,
        };
        let found = match &given.surfaces {
            Some(surfaces) => mortar(&joint, surfaces, &mut ties, problems),
            None => nodes_tied(&joint, &mut ties, problems),
        };
        let Some(mut rows) = found else { continue };
        unfit::drop_held(&joint, &mut rows, problems);
        links.extend(joint.link(rows));
    }
    for ([one, other], nodes) in ties.loose() {
        let count = plural(nodes.len(), "node");
        let message = format!(
            "the bodies `{one}` and `{other}` share {count} and are in two zones, which nothing ties"
        );
        let accepted = format!("[interface.<name>] with inner = \"{one}\", outer = \"{other}\"");
        problems.push(Problem::new("zone", message).accepted([accepted]));
    }
    links
}
