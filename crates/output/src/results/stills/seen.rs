//! What pictures show of the mesh, and what is therefore kept of a state: nodes and cells of the surface, of lines and of contacts.

use std::collections::BTreeSet;

use carom_dynamics::System;

use crate::results::outlines::Outlines;

/// Nodes and cells whose motion and fields are kept: those of the surface, or all where elements may be deleted, which lays bare what is
/// inside.
#[derive(Debug)]
pub(crate) struct Seen {
    /// Numbers in the system, ascending.
    pub(crate) nodes: Vec<u32>,
    /// Numbers among the cells of all bodies, ascending.
    pub(crate) cells: Vec<u32>,
    /// Body of each cell of all bodies.
    pub(crate) body_of_cell: Vec<u32>,
}

impl Seen {
    /// Of a system.
    pub(crate) fn new(system: &System) -> Seen {
        let bodies = system.bodies.iter().enumerate();
        let body_of_cell: Vec<u32> = bodies
            .flat_map(|(number, body)| body.cells().iter().map(move |_| number as u32))
            .collect();
        let all = system.bodies.iter().any(|body| body.has_deletion());
        let outlines = Outlines::new(system, |_, _| true);
        let mut nodes: BTreeSet<u32> = outlines.nodes().into_iter().collect();
        let mut cells: BTreeSet<u32> = outlines.patches().map(|(_, cell)| cell as u32).collect();
        let elements = system.bodies.iter().flat_map(|body| body.cells());
        for (cell, element) in elements.enumerate() {
            if all || system.mesh.kind(*element).table().dim < 2 {
                let own = system.mesh.element_nodes(*element).iter();
                nodes.extend(own.map(|node| system.number[*node as usize]));
                cells.insert(cell as u32);
            }
        }
        let points = system.contacts.iter().flat_map(|contact| &contact.points);
        nodes.extend(points.flat_map(|point| point.carriers().map(|(node, _)| node)));
        nodes.remove(&u32::MAX);
        Seen {
            nodes: nodes.into_iter().collect(),
            cells: cells.into_iter().collect(),
            body_of_cell,
        }
    }

    /// Place of a node in `nodes`.
    pub(crate) fn node(&self, node: u32) -> Option<usize> {
        self.nodes.binary_search(&node).ok()
    }

    /// Place of a cell in `cells`.
    pub(crate) fn cell(&self, cell: usize) -> Option<usize> {
        self.cells.binary_search(&(cell as u32)).ok()
    }
}
