//! Pieces that supports leave free in a static stage, and that contacts may hold: which they are, and what the iterations know of
//! them. [`crate::driver::approach`] has what is done about them.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use carom_contact::Target;

use super::joined::{Group, Joined};
use super::pieces::{Piece, Pieces};
use crate::error::Error;
use crate::system::System;

/// σ, unless the matrix asks for more.
const WEIGHT: f64 = 1e-6;

/// Factor by which σ grows where the matrix is not positive definite: a body under pressure has negative stiffness in turns.
pub(crate) const GROWTH: f64 = 8.0;

/// Largest σ.
pub(crate) const LARGEST: f64 = 1.0;

/// Pieces that float, and σ in the attempt under way.
pub(crate) struct Floating {
    pub(crate) pieces: Arc<Pieces>,
    pub(crate) weight: f64,
    /// Mean over its elements of the least distance of two nodes of one, m, piece by piece; infinite without elements.
    pub(crate) sizes: Vec<f64>,
    /// Loads along motions that nothing held an iteration ago; empty in the first.
    pub(crate) load: Vec<f64>,
    /// The same when contact with something else carried a piece last; empty if none did.
    pub(crate) carried: Vec<f64>,
    /// For how many iterations contact has carried a piece that is loaded along a motion with no contact on its way.
    pub(crate) tipping: usize,
    /// Size of that load in the first of them.
    pub(crate) tipped: f64,
}

impl Floating {
    /// The pieces.
    pub(crate) fn pieces(&self) -> &Arc<Pieces> {
        &self.pieces
    }

    /// The pieces of a static stage that supports leave free to move: parts, and where groups of nodes in a part move against each other with
    /// nothing but contacts against it, those groups.
    ///
    /// # Errors
    /// One that no contact with anything else could hold.
    pub(crate) fn new(system: &System) -> Result<Floating, Error> {
        let mut pieces = Vec::new();
        let stages = match system.nonlinear.preload {
            Some(_) => &system.parts[..],
            None => &[],
        };
        let carried = carried(system);
        for part in stages {
            let whole = Joined::whole((system, &carried), part);
            let free = whole.free();
            let apart = Joined::apart((system, &carried), part);
            // what the bodies of the part can do beyond moving together
            let against = match apart.groups.len() > 1 {
                true => apart.free(),
                false => Vec::new(),
            };
            if against.len() > free.len() {
                let alone = |group: &Group| !touches(system, &group.nodes);
                let mut motions = apart.motions(alone).into_iter();
                if let Some(groups) = motions.find(|all| all.iter().all(|&group| alone(group))) {
                    let is_moved =
                        |group: &&Group| groups.iter().any(|moved| std::ptr::eq(*moved, *group));
                    let mut named = against.iter();
                    let named = named.find(|(group, _)| is_moved(group)).or(against.first());
                    if let Some((group, motion)) = named {
                        return Err(free_motion(system, &group.nodes, motion));
                    }
                }
                pieces.extend(apart.loose().map(|group| group.nodes.clone()));
                continue;
            }
            let Some(&(group, motion)) = free.first() else {
                continue;
            };
            if !touches(system, &group.nodes) {
                return Err(free_motion(system, &group.nodes, motion));
            }
            pieces.extend(whole.groups.into_iter().map(|group| group.nodes));
        }
        let pieces = Pieces::new(system, pieces);
        Ok(Floating {
            sizes: sizes_of_elements(system, &pieces),
            pieces: Arc::new(pieces),
            weight: WEIGHT,
            load: Vec::new(),
            carried: Vec::new(),
            tipping: 0,
            tipped: 0.0,
        })
    }

    /// Begins an attempt at a step.
    pub(crate) fn begin(&mut self) {
        self.weight = WEIGHT;
        self.load.clear();
        self.carried.clear();
        (self.tipping, self.tipped) = (0, 0.0);
    }
}

/// The nodes that each node carries: those of rigid bodies.
pub(crate) fn carried(system: &System) -> BTreeMap<u32, Vec<u32>> {
    let mut carried: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for node in 0..system.x.len() as u32 {
        if let Some(carrier) = system.unknowns.carrier(node) {
            carried.entry(carrier.node).or_default().push(node);
        }
    }
    carried
}

/// Mean over the elements of each piece of the least distance of two nodes of one, m: how far normals and faces say what comes. A piece without
/// elements, as a point mass, has none that could mislead.
fn sizes_of_elements(system: &System, pieces: &Pieces) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0f64); pieces.len()];
    if pieces.is_empty() {
        return Vec::new();
    }
    for body in &system.bodies {
        body.each_element(&mut |nodes| {
            let unknown = |node: &u32| system.unknowns.of(*node).next();
            let of = |node: &u32| unknown(node).and_then(|first| pieces.of(first));
            let mut own: Vec<usize> = nodes.iter().filter_map(of).collect();
            own.sort_unstable();
            own.dedup();
            if nodes.len() < 2 || own.is_empty() {
                return;
            }
            let mut least = f64::INFINITY;
            for (k, &a) in nodes.iter().enumerate() {
                for &b in &nodes[..k] {
                    let [a, b] = [a, b].map(|node| &system.x[node as usize]);
                    least = least.min((0..3).map(|i| (a[i] - b[i]).powi(2)).sum());
                }
            }
            for piece in own {
                sums[piece].0 += least.sqrt();
                sums[piece].1 += 1.0;
            }
        });
    }
    let mean = |&(sum, count): &(f64, f64)| match count > 0.0 {
        true => sum / count,
        false => f64::INFINITY,
    };
    sums.iter().map(mean).collect()
}

fn free_motion(system: &System, nodes: &[u32], motion: &str) -> Error {
    let inside = |&(unknown, _): &(u32, f64)| {
        let node = system.unknowns.node(unknown as usize);
        nodes.binary_search(&node).is_ok()
    };
    let joins = |(_, rows): &&(String, Range<usize>)| {
        let mut terms = system.links.rows[rows.clone()].iter().flatten();
        terms.any(inside)
    };
    let joining = system.links.named.iter().filter(joins);
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

/// Name of the body at the first node of a piece.
pub(crate) fn body_of(system: &System, piece: &Piece) -> String {
    body_at(system, system.unknowns.node(piece.unknowns[0]))
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
