//! Whether the elements resolve the patch in which bodies touch.

use carom_bodies::Body;
use carom_contact::{Integration, Point};
use carom_dynamics::System;
use carom_pages::form::Form;

use super::resolution::LESSER;
use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Nodes of a patch that is two elements wide, in the plane and in space (there of a quarter of it, cut along two planes of
/// symmetry). A patch of one node has no radius: what indents then is a force at a node, whose compliance is that of the element
/// (1/(E h) in space, by the logarithm of h in the plane) in place of that of the patch, so that the peak goes with the mesh.
const NODES: [f64; 2] = [3.0, 4.0];

/// A contact with as many as it needs has one.
const BOUNDS: Bounds = Bounds::Look(1.0);

/// The contact whose largest force has the fewest points, of those with a tenth of the largest force around their bodies.
pub(super) fn of_contacts(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let records = &evidence.last.records.contacts;
    let judged = (0..records.len()).filter(|&k| {
        let force = records[k].peak_force;
        let least = LESSER * evidence.largest_beside(k, |other| records[other].peak_force);
        // a corner or an edge has no patch whatever the elements
        let is_sharp = records[k].peak_sharp == records[k].peak_closed;
        force > 0.0 && force >= least && !is_sharp && indents(system, k)
    });
    let ratios = judged.map(|k| {
        let contact = &system.contacts[k];
        let nodes = nodes(system, k);
        let closed = match contact.integration {
            Integration::Node | Integration::Mortar { .. } => records[k].peak_closed as f64,
            Integration::Points | Integration::Weak { .. } => {
                nodes * records[k].peak_closed as f64 / contact.points.len() as f64
            }
        };
        // a surface with fewer nodes has no more to close
        let needed = NODES[usize::from(system.dim == 3)].min(nodes);
        (&*contact.name, needed / closed)
    });
    let Some((name, value)) = worst(ratios) else {
        return Finding::Absent;
    };
    let mut contacts = system.contacts.iter();
    let k = contacts
        .position(|contact| contact.name == name)
        .unwrap_or_default();
    Finding::Line(Line::new(
        "points-closed",
        (
            &format!(
                "nodes across two elements, relative to those of contact `{name}` that its largest force was shared by ({} of {} points had a force)",
                records[k].peak_closed,
                system.contacts[k].points.len()
            ),
            value,
            Form::Number,
        ),
        BOUNDS,
        "use smaller elements where the bodies touch, or judge by impulses and energies: the peak of so few points is that of the elements",
    ))
}

/// Whether the force of a contact depends on how its sides indent each other, over a patch that grows with the force.
///
/// Others have points by nature: a stop or a Hertz point has the stiffness that it was given; bars and beams have no surface, and a plate bends
/// by a finite way under a force at a point, so that shells need no patch; discrete bodies are points, and rigid ones do not
/// indent each other; reduced bodies carry forces at the nodes that the case names.
fn indents(system: &System, contact: usize) -> bool {
    let is_given = system.contacts[contact].law.get().is_of_the_whole();
    let bodies = || {
        system.contacts[contact]
            .bodies
            .iter()
            .map(|&k| &system.bodies[k])
    };
    let is_continuum = |body: &Body| {
        let solid = body.as_solid();
        solid.is_some_and(|solid| solid.kinematics().dim() > 1)
    };
    let has_patch = |body: &Body| is_continuum(body) || body.as_rigid().is_some();
    !is_given && bodies().any(is_continuum) && bodies().all(has_patch)
}

/// Nodes of the surface that carries the points of a contact, of both that with fewer.
fn nodes(system: &System, contact: usize) -> f64 {
    let pair = &system.contacts[contact];
    let count = match pair.integration {
        Integration::Node | Integration::Mortar { .. } => {
            let nodes = pair.points.iter().filter(|point| !point.crosses());
            let (other, own): (Vec<&Point>, Vec<&Point>) =
                nodes.partition(|point| point.is_on_primary());
            match other.len() {
                0 => own.len(),
                others => others.min(own.len()),
            }
        }
        Integration::Points | Integration::Weak { .. } => {
            let faces = system.contacts[contact].secondary_faces.iter();
            let mut nodes: Vec<u32> = faces.flat_map(|face| face.corners()).copied().collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes.len()
        }
    };
    count as f64
}
