//! Shells whose middle surface is beside their nodes: contacts act at half the thickness around nodes of the middle, which the nodes of the
//! shells carry.

use std::collections::BTreeMap;

use carom_algebra::tensor::Vec3;
use carom_bodies::{Kinematics, plates};
use carom_mesh::{ElementId, Face, Surface};

use crate::error::Error;
use crate::model::{Model, ModelTarget};

/// Nodes of a middle that are closer than this part of the offset are one.
const SAME: f64 = 1e-9;

/// A node that another one carries, both of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Carried {
    pub(crate) node: u32,
    pub(crate) by: u32,
}

/// Moves the surfaces of contacts around shells with an offset to their middles; adds the nodes of these to the mesh.
///
/// # Errors
/// A body of cells that no shell can be built on.
pub(crate) fn add_middles(model: &mut Model) -> Result<Vec<Carried>, Error> {
    let mut carried = Vec::new();
    for body in 0..model.bodies.len() {
        let spec = &model.bodies[body].spec;
        let Kinematics::Shell(section) = spec.kinematics else {
            continue;
        };
        let mut of_cell = BTreeMap::new();
        if section.offset == 0.0 || !surfaces(model).any(|own| touches(own, &spec.cells)) {
            continue;
        }
        let plates = plates(&model.mesh, spec, &section)?;
        let mut of_node: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (&cell, plate) in spec.cells.iter().zip(&plates) {
            let corners: Vec<u32> = model.mesh.element_nodes(cell).to_vec();
            for (&by, x) in corners.iter().zip(&plate.x) {
                let known = of_node.entry(by).or_default();
                let is_there = |&&node: &&u32| {
                    let way = Vec3::from(model.mesh.nodes[node as usize]) - Vec3::from(*x);
                    way.norm() < SAME * section.offset.abs()
                };
                let node = known.iter().find(is_there).copied();
                let node = node.unwrap_or_else(|| {
                    let node = model.mesh.nodes.len() as u32;
                    model.mesh.nodes.push(*x);
                    known.push(node);
                    carried.push(Carried { node, by });
                    node
                });
                of_cell.insert((cell, by), node);
            }
        }
        for contact in &mut model.contacts {
            shift(&mut contact.secondary, &of_cell);
            if let ModelTarget::Surface(surface) = &mut contact.primary {
                shift(surface, &of_cell);
            }
        }
    }
    Ok(carried)
}

/// The surfaces of all contacts.
fn surfaces(model: &Model) -> impl Iterator<Item = &Surface> {
    model.contacts.iter().flat_map(|contact| {
        let primary = match &contact.primary {
            ModelTarget::Surface(surface) => Some(surface),
            ModelTarget::Rigid(_) => None,
        };
        [Some(&contact.secondary), primary].into_iter().flatten()
    })
}

fn touches(surface: &Surface, cells: &[ElementId]) -> bool {
    let mut faces = surface.faces.iter().filter(|face| is_middle(face));
    faces.any(|face| cells.binary_search(&face.parent).is_ok())
}

/// Whether it is a cell of a shell with the surface around it.
fn is_middle(face: &Face) -> bool {
    face.is_round() && face.kind.table().dim == 2
}

/// Gives the faces around shells the nodes of their middles.
fn shift(surface: &mut Surface, middle: &BTreeMap<(ElementId, u32), u32>) {
    let mut moved = false;
    for face in surface.faces.iter_mut().filter(|face| is_middle(face)) {
        let count = face.corners().len();
        for node in &mut face.nodes[..count] {
            if let Some(&other) = middle.get(&(face.parent, *node)) {
                (*node, moved) = (other, true);
            }
        }
    }
    if moved {
        let nodes = surface.faces.iter().flat_map(|face| face.corners());
        surface.nodes = nodes.copied().collect();
        surface.nodes.sort_unstable();
        surface.nodes.dedup();
    }
}
