//! Which nodes of a body a reduction must retain.

use std::collections::BTreeSet;

use carom_system::{Model, ModelTarget};

/// Nodes of the mesh of a body that something else than supports acts on, and of the nodes `given`: those of contacts, links, constraints,
/// other bodies, discrete elements, loads and motions; ascending.
pub(crate) fn retained(model: &Model, body: usize, given: &[u32]) -> Vec<u32> {
    let nodes_of = |cells: &[carom_mesh::ElementId]| -> BTreeSet<u32> {
        let nodes = cells
            .iter()
            .flat_map(|&cell| model.mesh.element_nodes(cell));
        nodes.copied().collect()
    };
    let own = nodes_of(&model.bodies[body].spec.cells);
    let mut used: BTreeSet<u32> = given.iter().copied().collect();
    for (other, given) in model.bodies.iter().enumerate() {
        if other != body {
            used.extend(nodes_of(&given.spec.cells));
        }
    }
    for some in &model.discrete {
        used.extend(nodes_of(&some.spec.cells));
    }
    for contact in &model.contacts {
        used.extend(&contact.secondary.nodes);
        if let ModelTarget::Surface(surface) = &contact.primary {
            used.extend(&surface.nodes);
        }
    }
    let rows = model.links.iter().flat_map(|link| &link.rows);
    used.extend(rows.flat_map(|row| row.inner.iter().chain(&row.outer).map(|term| term.node)));
    let rows = model
        .constraints
        .iter()
        .flat_map(|constraint| &constraint.rows);
    used.extend(rows.flatten().map(|(node, ..)| *node));
    let nonlinear = &model.nonlinear;
    used.extend(nonlinear.loads.iter().flat_map(|load| &load.surface.nodes));
    used.extend(nonlinear.nodal.iter().flat_map(|load| &load.nodes));
    used.extend(nonlinear.motions.iter().flat_map(|motion| &motion.nodes));
    used.extend(nonlinear.turns.iter().map(|turn| turn.node));
    own.intersection(&used).copied().collect()
}
