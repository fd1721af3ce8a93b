//! Bodies that look joined and are not: pieces that share no node, and thin bodies that end in a solid.

use std::collections::{BTreeMap, BTreeSet};

use carom_dynamics::{
    ModelBody, ModelConstraint, ModelContact, ModelDiscrete, ModelLink, ModelTarget,
};
use carom_mesh::{Mesh, Parts};

use super::context::Context;
use super::joints::is_thin;
use super::problems::{Problems, place};

/// What joins pieces of bodies beside common nodes.
pub(super) struct Joining<'a> {
    pub(super) contacts: &'a [ModelContact],
    pub(super) constraints: &'a [ModelConstraint],
    pub(super) links: &'a [ModelLink],
    pub(super) discrete: &'a [ModelDiscrete],
}

impl Joining<'_> {
    /// The parts of the bodies, those that are joined as one.
    fn parts(&self, mesh: &Mesh, bodies: &[ModelBody]) -> Parts {
        let solids = bodies.iter().flat_map(|body| &body.spec.cells);
        let discrete = self.discrete.iter().flat_map(|some| &some.spec.cells);
        let mut parts = Parts::new(mesh, solids.chain(discrete).copied());
        for contact in self.contacts {
            let mut nodes = contact.secondary.nodes.clone();
            if let ModelTarget::Surface(primary) = &contact.primary {
                nodes.extend(&primary.nodes);
                parts.join(&nodes);
            }
        }
        for row in self.constraints.iter().flat_map(|all| &all.rows) {
            let nodes: Vec<u32> = row.iter().map(|(node, ..)| *node).collect();
            parts.join(&nodes);
        }
        for row in self.links.iter().flat_map(|link| &link.rows) {
            let terms = row.inner.iter().chain(&row.outer);
            let nodes: Vec<u32> = terms.map(|term| term.node).collect();
            parts.join(&nodes);
        }
        parts
    }
}

/// Warns of bodies in pieces that nothing joins, neither another body nor a contact, a tie or a spring, and names the closest nodes of
/// two of them.
pub(super) fn check(mesh: &Mesh, bodies: &[ModelBody], joining: &Joining, problems: &mut Problems) {
    let parts = joining.parts(mesh, bodies);
    for body in bodies {
        let pieces = pieces_of(mesh, body, &parts);
        let Some(largest) = pieces.iter().rev().max_by_key(|piece| piece.len()) else {
            continue;
        };
        let others = pieces.iter().filter(|piece| piece[0] != largest[0]);
        let others: Vec<u32> = others.flatten().copied().collect();
        let Some(([one, other], distance)) = mesh.closest_nodes(largest, &others) else {
            continue;
        };
        let at = place(mesh.nodes[one as usize]);
        let merge = match distance <= 1e-6 * mesh.size() {
            true => "they are the same place: merge the nodes of the mesh",
            false => "merge the nodes of the mesh, or make each piece a body of its own",
        };
        problems.doubt(format!(
            "body `{}` is in {} pieces that share no node and separate without resistance; the closest nodes of two of them, {one} at {at} and {other}, are {distance:.4e} m apart; {merge}",
            body.spec.name,
            pieces.len(),
        ));
    }
}

/// Warns of beams and shells that lie in a solid to which nothing joins them: no overlap, no transition, no common node.
pub(super) fn unglued(
    context: &Context,
    mesh: &Mesh,
    bodies: &[ModelBody],
    problems: &mut Problems,
) {
    let nodes = |body: &ModelBody| {
        let cells = body.spec.cells.iter();
        let nodes = cells.flat_map(|&cell| mesh.element_nodes(cell)).copied();
        nodes.collect::<BTreeSet<u32>>()
    };
    let ends = context.case.transition.iter();
    let ends = ends.filter_map(|(_, given)| mesh.groups.get(given.end.as_ref()?));
    let ends: Vec<u32> = ends.flat_map(|group| mesh.group_nodes(group)).collect();
    for thin in bodies.iter().filter(|body| is_thin(body)) {
        let own = nodes(thin);
        if ends.iter().any(|end| own.contains(end)) {
            continue;
        }
        for solid in bodies.iter().filter(|body| fills(mesh, body)) {
            let names = [&thin.spec.name, &solid.spec.name];
            let mut glued = context.case.arlequin.iter();
            let glued = glued.any(|(_, given)| {
                names
                    .iter()
                    .all(|name| **name == given.inner || **name == given.outer)
            });
            if glued || !own.is_disjoint(&nodes(solid)) {
                continue;
            }
            let all: Vec<u32> = own.iter().copied().collect();
            let within = mesh.nodes_within(&all, &solid.spec.cells);
            let Some((first, _)) = within.first().filter(|_| within.len() > 1) else {
                continue;
            };
            let at = place(mesh.nodes[*first as usize]);
            problems.doubt(format!(
                "{} nodes of body `{}`, the first at {at}, lie in the solid `{}`, and nothing joins the two: [arlequin.<name>] glues them over a volume, [transition.<name>] an end to a face",
                within.len(),
                names[0],
                names[1],
            ));
        }
    }
}

/// Whether the cells of a body fill the space of the mesh.
fn fills(mesh: &Mesh, body: &ModelBody) -> bool {
    let cell = body.spec.cells.first();
    !is_thin(body) && cell.is_some_and(|&cell| mesh.kind(cell).table().dim == mesh.dim)
}

/// Nodes of a body by the part that they are in, ascending.
fn pieces_of(mesh: &Mesh, body: &ModelBody, parts: &Parts) -> Vec<Vec<u32>> {
    let mut pieces: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let cells = body.spec.cells.iter();
    for &node in cells.flat_map(|&cell| mesh.element_nodes(cell)) {
        if let Some(part) = parts.of(node) {
            pieces.entry(part).or_default().push(node);
        }
    }
    let mut pieces: Vec<Vec<u32>> = pieces.into_values().collect();
    for piece in &mut pieces {
        piece.sort_unstable();
        piece.dedup();
    }
    pieces
}
