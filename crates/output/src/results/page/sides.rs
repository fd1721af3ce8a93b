//! Surfaces of the model that the page can show by themselves: those of contacts, and groups of the mesh.

use std::collections::BTreeSet;

use carom_dynamics::System;
use carom_elements::Kind;
use carom_pages::page::block::Block;
use carom_pages::page::schema::{Group, Side, Sides};

use crate::results::page::chosen::Chosen;
use crate::results::page::obstacles::around;
use crate::results::page::surface::Surface;
use crate::results::stills::Seen;

/// Most groups of the mesh in a page.
const GROUPS: usize = 60;

/// Triangles and lines while they are gathered, each once.
#[derive(Default)]
struct Drawn {
    triangles: BTreeSet<[u32; 3]>,
    lines: BTreeSet<[u32; 2]>,
}

impl Drawn {
    /// Adds a face by its nodes in the system, if all of them are in the page.
    fn add_face(&mut self, (seen, chosen): (&Seen, &Chosen), kind: Kind, nodes: &[u32]) {
        let ring = around(kind, nodes);
        let ring = ring
            .iter()
            .map(|node| chosen.find(seen.node(*node)? as u32));
        let Some(ring) = ring.collect::<Option<Vec<u32>>>() else {
            return;
        };
        match kind.table().dim {
            2 => {
                let corners = (2..ring.len()).map(|k| [ring[0], ring[k - 1], ring[k]]);
                self.triangles.extend(corners);
            }
            _ => self
                .lines
                .extend(ring.windows(2).map(|pair| [pair[0], pair[1]])),
        }
    }

    fn side(&self, block: &mut Block) -> Side {
        let has_area = |t: &&[u32; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
        let has_length = |l: &&[u32; 2]| l[0] != l[1];
        let triangles = self.triangles.iter().filter(has_area);
        let lines = self.lines.iter().filter(has_length);
        Side {
            triangles: block.indices(triangles.flatten().copied()),
            lines: block.indices(lines.flatten().copied()),
        }
    }
}

/// Both surfaces of each contact.
pub(super) fn contacts(system: &System, of: (&Seen, &Chosen), block: &mut Block) -> Vec<Sides> {
    let mut side = |faces: &[carom_mesh::Face]| {
        let mut drawn = Drawn::default();
        for face in faces {
            drawn.add_face(of, face.kind, face.corners());
        }
        drawn.side(block)
    };
    let both = system.contacts.iter().map(|contact| Sides {
        name: contact.name.clone(),
        secondary: side(&contact.secondary_faces),
        primary: side(contact.primary_faces()),
    });
    both.collect()
}

/// The groups of the mesh of which something is drawn: of cells their part of the surface, of faces and lines these.
pub(super) fn groups(
    (system, surface): (&System, &Surface),
    of: (&Seen, &Chosen),
    block: &mut Block,
) -> Vec<Group> {
    let (seen, chosen) = of;
    let elements = system.bodies.iter().flat_map(|body| body.cells());
    let elements: Vec<_> = elements.copied().collect();
    let mut groups = Vec::new();
    for (name, group) in &system.mesh.groups {
        let mut drawn = Drawn::default();
        if group.dim == system.dim && system.dim > 1 {
            let own: BTreeSet<_> = group.elements.iter().collect();
            let is_in = |cell: u32| own.contains(&elements[seen.cells[cell as usize] as usize]);
            let cells = surface.triangles.iter().zip(&surface.cells);
            let inside = cells.filter(|(_, cell)| is_in(**cell));
            let numbers = inside.map(|(corners, _)| corners.map(|node| chosen.node(node)));
            drawn.triangles.extend(numbers);
        } else if group.dim > 0 {
            for element in &group.elements {
                let nodes = system.mesh.element_nodes(*element).iter();
                let nodes: Vec<u32> = nodes.map(|node| system.number[*node as usize]).collect();
                drawn.add_face(of, system.mesh.kind(*element), &nodes);
            }
        }
        let is_drawn = !(drawn.triangles.is_empty() && drawn.lines.is_empty());
        if is_drawn && groups.len() < GROUPS {
            let side = drawn.side(block);
            groups.push(Group {
                name: name.clone(),
                triangles: side.triangles,
                lines: side.lines,
            });
        }
    }
    groups
}
