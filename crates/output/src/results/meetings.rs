//! Bodies that no contact, link or shared node joins, and that have met all the same: told by their boxes at the start and at
//! the end of a run.

use std::collections::BTreeSet;

use carom_bodies::Body;
use carom_dynamics::{Motion, Order, System};

/// Part of a box by which two must overlap at the end.
const OVERLAP: f64 = 1e-3;

/// Box around the nodes of a body, m.
#[derive(Clone, Copy, Debug)]
struct Extent {
    low: [f64; 3],
    high: [f64; 3],
}

/// Pairs of bodies that nothing joins and whose boxes were apart at the start, and at the end overlap, or are on the other sides of each
/// other with no way around: the boxes overlap across the axis along which they have changed sides, at the start and at the end.
pub(crate) fn unjoined(system: &System, motion: &Motion) -> Vec<[usize; 2]> {
    let extents = |motion: Option<&Motion>| -> Vec<Option<Extent>> {
        let bodies = system.bodies.iter();
        bodies
            .map(|body| Extent::of(system, body, motion))
            .collect()
    };
    let (start, end) = (extents(None), extents(Some(motion)));
    let mut met = Vec::new();
    for one in 0..system.bodies.len() {
        for other in 0..one {
            let (Some(a), Some(b), Some(c), Some(d)) =
                (start[other], start[one], end[other], end[one])
            else {
                continue;
            };
            if have_met(system.dim, [&a, &b], [&c, &d]) && !are_joined(system, [other, one]) {
                met.push([other, one]);
            }
        }
    }
    met
}

impl Extent {
    /// Of a body with cells; none of discrete elements, which have no surface.
    fn of(system: &System, body: &Body, motion: Option<&Motion>) -> Option<Extent> {
        if body.as_discrete().is_some() {
            return None;
        }
        let mut extent: Option<Extent> = None;
        let nodes: BTreeSet<u32> = body
            .cells()
            .iter()
            .flat_map(|cell| system.mesh.element_nodes(*cell))
            .copied()
            .collect();
        for node in nodes {
            let number = system.number[node as usize];
            let mut place = system.mesh.nodes[node as usize];
            if let Some(motion) = motion.filter(|_| number != u32::MAX) {
                let moved = system.of_node(number, motion, Order::Displacement);
                place = [0, 1, 2].map(|i| place[i] + moved[i]);
            }
            let own = extent.get_or_insert(Extent {
                low: place,
                high: place,
            });
            for i in 0..3 {
                own.low[i] = own.low[i].min(place[i]);
                own.high[i] = own.high[i].max(place[i]);
            }
        }
        extent
    }

    /// How far two boxes overlap along an axis, m; negative where they are apart.
    fn overlap(&self, other: &Extent, axis: usize) -> f64 {
        self.high[axis].min(other.high[axis]) - self.low[axis].max(other.low[axis])
    }

    /// Whether this box is below the other along an axis.
    fn is_below(&self, other: &Extent, axis: usize) -> bool {
        self.low[axis] + self.high[axis] < other.low[axis] + other.high[axis]
    }

    fn size(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }
}

/// Whether two boxes that were apart overlap, or have changed sides.
fn have_met(dim: usize, start: [&Extent; 2], end: [&Extent; 2]) -> bool {
    let apart = |boxes: &[&Extent; 2], axis: usize| boxes[0].overlap(boxes[1], axis) < 0.0;
    let Some(axis) = (0..dim).find(|&axis| apart(&start, axis)) else {
        return false;
    };
    let across = (0..dim).filter(|&other| other != axis);
    let mut across = across.map(|other| !apart(&start, other) && !apart(&end, other));
    let overlaps = |axis: usize| {
        let least = OVERLAP * end[0].size(axis).min(end[1].size(axis));
        end[0].overlap(end[1], axis) > least
    };
    let changed = start[0].is_below(start[1], axis) != end[0].is_below(end[1], axis);
    (0..dim).all(overlaps) || changed && apart(&end, axis) && across.all(|both| both)
}

/// Whether a contact, a link or a shared node joins two bodies.
fn are_joined(system: &System, pair: [usize; 2]) -> bool {
    let parts = pair.map(|body| system.part_of_body[body]);
    let linked = |row: &Vec<(u32, f64)>| {
        let has = |part: usize| row.iter().any(|(i, _)| system.part_of(*i as usize) == part);
        has(parts[0]) && has(parts[1])
    };
    let mut contacts = system.contacts.iter();
    parts[0] == parts[1]
        || contacts.any(|contact| pair.iter().all(|body| contact.bodies.contains(body)))
        || system.links.rows.iter().any(linked)
}
