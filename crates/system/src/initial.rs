//! Contacts that penetrate at the start: refused, offset, or their nodes moved before bodies are built.

use carom_algebra::unknowns::Unknowns;
use carom_contact::{Contact, Frames, Initial, Integration, Places, Sight, Target};

use crate::contacts::numbered;
use crate::error::Error;
use crate::model::Model;
use crate::system::System;

/// The most passes over all contacts that are to be freed of penetrations.
const PASSES: usize = 10;

impl Model {
    /// Moves the secondary nodes of contacts with [`Initial::Remove`] onto what they penetrate, in the initial
    /// displacement, by changing the mesh.
    ///
    /// A node moves by -g along the normal, onto its closest point; where several contacts move a node passes are repeated.
    /// Interior nodes stay: a move longer than an element turns it inside out, which the check of the mesh tells.
    ///
    /// # Errors
    /// [`Error::Penetration`] if some are left after ten passes.
    pub(crate) fn remove_penetrations(&mut self) -> Result<(), Error> {
        let slack = slack(self);
        for pass in 0..PASSES {
            let mut free = true;
            for contact in &self.contacts {
                if contact.initial != Initial::Remove {
                    continue;
                }
                let mut contact = contact.clone();
                contact.integration = Integration::Node;
                let number: Vec<u32> = (0..self.mesh.nodes.len() as u32).collect();
                let numbered = numbered(&contact, self, &number, &self.mesh.nodes);
                let unknowns = Unknowns::translations(self.mesh.dim, self.mesh.nodes.len());
                let u = self.displacement(&unknowns);
                let places = Places {
                    unknowns: &unknowns,
                    time: 0.0,
                    x: &self.mesh.nodes,
                    u: &u,
                    frames: Frames::default(),
                };
                let found = numbered.penetrations(&places, slack);
                free &= found.is_empty();
                if pass + 1 == PASSES {
                    check(&numbered, &places, &number, slack)?;
                }
                for found in found {
                    let x = &mut self.mesh.nodes[found.node as usize];
                    for (x, n) in x.iter_mut().zip(found.normal) {
                        *x += found.depth * n;
                    }
                }
            }
            if free {
                break;
            }
        }
        Ok(())
    }

    /// Initial displacement of the nodes of the mesh, m.
    fn displacement(&self, unknowns: &Unknowns) -> Vec<f64> {
        let mut u = vec![0.0; unknowns.len()];
        for body in &self.bodies {
            for &cell in &body.spec.cells {
                for &node in self.mesh.element_nodes(cell) {
                    for (unknown, given) in unknowns.of(node).zip(body.displacement) {
                        u[unknown] = given;
                    }
                }
            }
        }
        for some in &self.discrete {
            let Some(displacement) = some.displacement else {
                continue;
            };
            let cells = some.spec.cells.iter();
            for &node in cells.flat_map(|&cell| self.mesh.element_nodes(cell)) {
                for (unknown, given) in unknowns.of(node).zip(displacement) {
                    u[unknown] = given;
                }
            }
        }
        u
    }
}

impl System {
    /// Nodes of a contact whose surface faces itself that lie inside cells of their bodies, in the reference position, by the
    /// numbers of the mesh. The gap of such a contact cannot tell: an overlap looks like a thin part.
    pub fn self_penetrations(&self, contact: usize) -> Vec<u32> {
        let Target::Surface(target) = &self.contacts[contact].target else {
            return Vec::new();
        };
        let pair = &self.contacts[contact];
        let own = &pair.secondary_faces;
        if pair.looks_both_ways() || !Sight::is_needed(own, target) {
            return Vec::new();
        }
        let numbers = own.iter().flat_map(|face| face.corners());
        let mut nodes: Vec<u32> = numbers.map(|&n| self.mesh_node[n as usize]).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let cells: Vec<_> = self
            .bodies
            .iter()
            .flat_map(|body| body.cells())
            .copied()
            .collect();
        let inside = self.mesh.nodes_inside(&nodes, &cells);
        inside.into_iter().map(|(node, _)| node).collect()
    }
}

/// Depth that is no penetration yet, m: the rounding of a mesh of this size in this place.
pub(crate) fn slack(model: &Model) -> f64 {
    (1e-9 * model.length()).max(model.mesh.rounding())
}

/// Refuses penetrations, or takes them as gaps of zero, as each contact asks. `slack`: of [`slack`], m; `mesh_node`: mesh
/// node of each system node.
///
/// # Errors
/// [`Error::Penetration`] for a contact with [`Initial::Refuse`] that penetrates.
pub(crate) fn settle(
    contacts: &mut [Contact],
    ways: impl Iterator<Item = Initial>,
    places: &Places,
    (mesh_node, slack): (&[u32], f64),
) -> Result<(), Error> {
    for (contact, way) in contacts.iter_mut().zip(ways) {
        match way {
            Initial::Keep => {}
            Initial::Touch | Initial::Remove => contact.offset_touching(places, slack),
            Initial::Refuse => {
                check(contact, places, mesh_node, slack)?;
                contact.offset_touching(places, slack);
            }
            Initial::Offset => contact.offset_penetrations(places, slack),
            Initial::Further(distance) => contact.offset_by(distance),
            Initial::Gap(gap) => {
                let at_rest = vec![0.0; places.u.len()];
                let reference = Places {
                    u: &at_rest,
                    ..*places
                };
                contact.offset_to(&reference, gap);
            }
        }
    }
    Ok(())
}

fn check(contact: &Contact, places: &Places, mesh_node: &[u32], slack: f64) -> Result<(), Error> {
    let found = contact.penetrations(places, slack);
    let deepest = found.iter().max_by(|a, b| a.depth.total_cmp(&b.depth));
    match deepest {
        None => Ok(()),
        Some(deepest) => Err(Error::Penetration {
            contact: contact.name.clone(),
            points: found.len(),
            node: mesh_node[deepest.node as usize],
            depth: deepest.depth,
        }),
    }
}
