//! Parts that supports leave free in a static stage, and that contacts may hold: which they are, and what the iterations know of
//! them. [`super::approach`] has what is done about them.

use std::ops::Range;
use std::sync::Arc;

use carom_contact::Target;

use super::joined::Joined;
use crate::error::Error;
use crate::system::System;

/// σ, unless the matrix asks for more.
pub(super) const WEIGHT: f64 = 1e-6;

/// Factor by which σ grows where the matrix is not positive definite: a body under pressure has negative stiffness in turns.
pub(super) const GROWTH: f64 = 8.0;

/// Largest σ.
pub(super) const LARGEST: f64 = 1.0;

/// Parts that float, and σ in the attempt under way.
pub(super) struct Floating {
    /// Their unknowns, ascending.
    pub(super) parts: Arc<[Range<usize>]>,
    pub(super) weight: f64,
    /// Mean over its elements of the least distance of two nodes of one, m, part by part.
    pub(super) sizes: Vec<f64>,
    /// Loads along motions that nothing held an iteration ago; empty in the first.
    pub(super) load: Vec<f64>,
    /// The same when contact with something else carried a part last; empty if none did.
    pub(super) carried: Vec<f64>,
    /// For how many iterations contact has carried a part that is loaded along a motion with no contact on its way.
    pub(super) tipping: usize,
    /// Size of that load in the first of them.
    pub(super) tipped: f64,
}

impl Floating {
    /// The parts of a static stage that supports leave free to move.
    ///
    /// # Errors
    /// One that no contact with anything else could hold.
    pub(super) fn new(system: &System) -> Result<Floating, Error> {
        let mut parts = Vec::new();
        let stages = match system.nonlinear.preload {
            Some(_) => &system.parts[..],
            None => &[],
        };
        for part in stages {
            let whole = Joined::whole(system, part);
            let free = whole.free();
            let apart = Joined::apart(system, part);
            // what the bodies of the part can do beyond moving together
            if apart.groups.len() > 1 {
                let against = apart.free();
                let loose = against
                    .iter()
                    .find(|(group, _)| !touches(system, &group.nodes));
                if let Some(&(group, motion)) = loose.filter(|_| against.len() > free.len()) {
                    return Err(free_motion(system, &group.nodes, motion));
                }
            }
            let Some(&(group, motion)) = free.first() else {
                continue;
            };
            if !touches(system, &group.nodes) {
                return Err(free_motion(system, &group.nodes, motion));
            }
            parts.push(part.clone());
        }
        let sizes = parts.iter().map(|part| size_of_elements(system, part));
        Ok(Floating {
            sizes: sizes.collect(),
            parts: parts.into(),
            weight: WEIGHT,
            load: Vec::new(),
            carried: Vec::new(),
            tipping: 0,
            tipped: 0.0,
        })
    }

    /// Begins an attempt at a step.
    pub(super) fn begin(&mut self) {
        self.weight = WEIGHT;
        self.load.clear();
        self.carried.clear();
        (self.tipping, self.tipped) = (0, 0.0);
    }
}

/// Mean over the elements of a part of the least distance of two nodes of one, m.
fn size_of_elements(system: &System, part: &Range<usize>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0f64);
    for body in &system.bodies {
        body.each_element(&mut |nodes| {
            if nodes.len() < 2
                || !nodes
                    .iter()
                    .any(|&node| part.contains(&system.unknowns.first(node)))
            {
                return;
            }
            let mut least = f64::INFINITY;
            for (k, &a) in nodes.iter().enumerate() {
                for &b in &nodes[..k] {
                    let [a, b] = [a, b].map(|node| &system.x[node as usize]);
                    least = least.min((0..3).map(|i| (a[i] - b[i]).powi(2)).sum());
                }
            }
            sum += least.sqrt();
            count += 1.0;
        });
    }
    sum / count.max(1.0)
}

fn free_motion(system: &System, nodes: &[u32], motion: &str) -> Error {
    let inside = |&(unknown, _): &(u32, f64)| {
        let node = system.unknowns.node(unknown as usize);
        nodes.binary_search(&node).is_ok()
    };
    let joins = |(_, rows): &&(String, Range<usize>)| {
        let mut terms = system.link_rows[rows.clone()].iter().flatten();
        terms.any(inside)
    };
    let joining = system.links.iter().filter(joins);
    Error::FreeMotion {
        body: body_at(system, nodes[0]),
        motion: motion.to_string(),
        constraints: joining.map(|(name, _)| name.clone()).collect(),
    }
}

/// Whether a contact has some of these nodes, ascending, on one side and something else on the other.
fn touches(system: &System, nodes: &[u32]) -> bool {
    let inside = |node: u32| nodes.binary_search(&node).is_ok();
    system.contacts.iter().any(|contact| {
        let nodes = contact.points.iter().flat_map(|point| point.carriers());
        let own: Vec<bool> = nodes.map(|(node, _)| inside(node)).collect();
        let (some, others) = (own.contains(&true), own.contains(&false));
        match &contact.target {
            Target::Rigid(_) => some,
            Target::Surface(faces) => {
                let opposite = faces.iter().flat_map(|face| face.corners());
                let opposite: Vec<bool> = opposite.map(|&node| inside(node)).collect();
                some && opposite.contains(&false) || others && opposite.contains(&true)
            }
        }
    })
}

/// Name of the body at the first node of a part.
pub(super) fn body_of(system: &System, part: &Range<usize>) -> String {
    body_at(system, system.unknowns.node(part.start))
}

/// Name of a body with a node.
fn body_at(system: &System, first: u32) -> String {
    let bodies = system.bodies.iter().zip(&system.body_masses);
    let mut owners = bodies.filter(|(body, masses)| {
        // the amplitudes of a reduced body are at a node of their own
        let amplitudes = body.as_reduced().and_then(|body| body.nodes().last());
        amplitudes == Some(&first) || masses.iter().any(|(node, _)| *node == first)
    });
    let owner = owners.next().map_or(&system.bodies[0], |(body, _)| body);
    owner.name().to_string()
}
