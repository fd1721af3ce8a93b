//! Where the numbers of a zone are in the model as one.

use std::ops::Range;

use carom_system::System;

/// Where the numbers of a zone are in the whole: its number and that of the whole.
pub(crate) struct Places {
    /// Unknowns.
    pub(crate) unknowns: Vec<(u32, u32)>,
    /// Those that no zone before it has.
    pub(crate) own: Vec<(u32, u32)>,
    /// Contact points.
    pub(crate) points: Vec<(u32, u32)>,
    /// Rotations of nodes.
    pub(crate) frames: Vec<(usize, usize)>,
    /// Histories of the bodies.
    pub(crate) histories: Vec<(Range<usize>, Range<usize>)>,
}

impl Places {
    /// `taken`: unknowns of the whole that a zone before this one has.
    pub(crate) fn new(
        zone: &System,
        (bodies, contacts): (&[usize], &[usize]),
        whole: &System,
        taken: &mut [bool],
    ) -> Places {
        let numbers = zone.mesh_node.iter().zip(0..);
        let unknowns: Vec<(u32, u32)> = numbers
            .flat_map(|(&node, own)| {
                let number = whole.number[node as usize];
                let [own, of_whole] = [zone.unknowns.of(own), whole.unknowns.of(number)];
                own.zip(of_whole).map(|(own, of)| (own as u32, of as u32))
            })
            .collect();
        let numbers = zone.mesh_node.iter().zip(0..);
        let frames = numbers.filter_map(|(&node, own)| {
            let of_whole = whole.unknowns.frame(whole.number[node as usize]);
            Some((zone.unknowns.frame(own)?, of_whole?))
        });
        let frames = frames.collect();
        let mut own = unknowns.clone();
        own.retain(|(_, to)| !std::mem::replace(&mut taken[*to as usize], true));
        let mut points = Vec::new();
        for (k, contact) in contacts.iter().enumerate() {
            let from = zone.points_of(k);
            let to = whole.points_of(*contact);
            points.extend(from.zip(to).map(|(from, to)| (from as u32, to as u32)));
        }
        let histories = [zone, whole].map(|system| &system.nonlinear.histories);
        let histories = bodies.iter().zip(histories[0]).map(|(&body, own)| {
            let of_whole = &histories[1][body];
            (own.clone(), of_whole.clone())
        });
        Places {
            frames,
            histories: histories.collect(),
            unknowns,
            own,
            points,
        }
    }
}
