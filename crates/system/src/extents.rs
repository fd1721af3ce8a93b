//! How large bodies are.

use carom_bodies::{Body, smallest_size};
use carom_mesh::{Bounds, ElementId, Surface};

use crate::made::Made;
use crate::model::{ModelContact, ModelTarget};

/// Lumped masses of the nodes of a body: system number, kg.
pub(crate) type NodeMasses = Vec<(u32, f64)>;

/// Diagonal of the box around the largest of the connected pieces that a body has a part in, m, by body: pieces of several bodies that share nodes deform as one, and
/// waves run through all of them; pieces of one body that share none know nothing of each other. Of discrete elements, which join nothing, it is the box around
/// their nodes with mass. `x`: reference places by system number, m.
pub(crate) fn diagonals((bodies, masses): (&[Body], &[NodeMasses]), x: &[[f64; 3]]) -> Vec<f64> {
    let mut leaders: Vec<u32> = (0..x.len() as u32).collect();
    let deformable = || bodies.iter().filter(|body| body.as_discrete().is_none());
    for body in deformable() {
        body.each_element(&mut |nodes| {
            for &node in nodes {
                let [one, other] = [nodes[0], node].map(|node| leader(&mut leaders, node));
                leaders[one.max(other) as usize] = one.min(other);
            }
        });
    }
    let mut boxes = vec![Bounds::EMPTY; x.len()];
    for body in deformable() {
        body.each_element(&mut |nodes| {
            let around = &mut boxes[leader(&mut leaders, nodes[0]) as usize];
            for &node in nodes {
                *around = around.union(&Bounds::of(&[x[node as usize]]));
            }
        });
    }
    let size = |around: &Bounds| Some(around.diagonal()).filter(|size| size.is_finite());
    let of = |(body, own): (&Body, &NodeMasses)| match body.as_discrete() {
        Some(_) => {
            let places = own.iter().map(|(node, _)| Bounds::of(&[x[*node as usize]]));
            let around = places.fold(Bounds::EMPTY, |around, place| around.union(&place));
            size(&around).unwrap_or(0.0)
        }
        None => {
            let mut largest = 0.0;
            body.each_element(&mut |nodes| {
                let own = size(&boxes[leader(&mut leaders, nodes[0]) as usize]);
                largest = f64::max(largest, own.unwrap_or(0.0));
            });
            largest
        }
    };
    bodies.iter().zip(masses).map(of).collect()
}

/// Time that a wave needs to pass over the smallest element at a side of a contact, of its slower side, s: elements elsewhere in its bodies say nothing of what closes there.
/// Where a side has no faces, it is that of the bodies that are `touching`.
pub(crate) fn passage(contact: &ModelContact, of: &Made, touching: &[usize]) -> f64 {
    let of_side = |side: &Surface| {
        let of_face = |parent: ElementId| {
            let speed = of.bodies[*of.owners.get(&parent)?].wave_speed()?;
            Some(smallest_size(&of.model.mesh, parent) / speed)
        };
        let faces = side.faces.iter().filter_map(|face| of_face(face.parent));
        faces.reduce(f64::min)
    };
    let primary = match &contact.primary {
        ModelTarget::Surface(primary) => of_side(primary),
        ModelTarget::Rigid(_) => None,
    };
    let sides = [of_side(&contact.secondary), primary];
    let of_sides = sides.into_iter().flatten().reduce(f64::max);
    of_sides.unwrap_or_else(|| {
        let own = touching.iter().map(|&body| of.bodies[body].passage());
        own.fold(0.0, f64::max)
    })
}

/// The first node of the piece of a node.
fn leader(leaders: &mut [u32], node: u32) -> u32 {
    let mut first = node;
    while leaders[first as usize] != first {
        first = leaders[first as usize];
    }
    let mut node = node;
    while leaders[node as usize] != first {
        node = std::mem::replace(&mut leaders[node as usize], first);
    }
    first
}
