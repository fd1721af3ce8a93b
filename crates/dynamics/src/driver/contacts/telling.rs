//! Points that leave their contact to others, and do so for a whole attempt or not at all.
//!
//! Whether those opposite to a point are watched may depend on its force: it pushes them open, they no longer tell, and once it tells in their
//! place they are pushed shut again. A point that comes back after it has left does not leave again in the attempt.

use std::collections::BTreeMap;

use carom_contact::Point;

use crate::system::System;

/// What points have done in an attempt.
#[derive(Debug, Default)]
pub(super) struct Telling {
    /// By contact the points of nodes, by number in the contact, where points between them face something round.
    of_nodes: Vec<BTreeMap<u32, u32>>,
    /// Ascending.
    left: Vec<u32>,
    /// Ascending.
    back: Vec<u32>,
    /// Those that left in the last choice; ascending.
    gone: Vec<u32>,
}

impl Telling {
    /// Of a system, before any attempt.
    pub(super) fn of(system: &System) -> Telling {
        let of_nodes = |points: &[Point]| match points.iter().any(Point::faces_round) {
            true => {
                let points = points.iter().zip(0..);
                let nodes = points.filter(|(point, _)| !point.crosses());
                nodes.map(|(point, k)| (point.node(), k)).collect()
            }
            false => BTreeMap::new(),
        };
        let contacts = system.contacts.iter();
        Telling {
            of_nodes: contacts.map(|contact| of_nodes(&contact.points)).collect(),
            ..Telling::default()
        }
    }

    /// Whether a point between nodes of a contact leaves what is round to one of these that takes part.
    pub(super) fn leaves_to_nodes(
        &self,
        contact: usize,
        point: &Point,
        takes_part: impl Fn(usize) -> bool,
    ) -> bool {
        let of_nodes = &self.of_nodes[contact];
        let mut own = point.carriers();
        own.any(|(node, _)| {
            let point = of_nodes.get(&node);
            point.is_some_and(|&point| takes_part(point as usize))
        })
    }

    /// Begins an attempt.
    pub(super) fn begin(&mut self) {
        self.left.clear();
        self.back.clear();
        self.gone.clear();
    }

    /// Begins a choice of candidates.
    pub(super) fn begin_choice(&mut self) {
        self.gone.clear();
    }

    /// Whether a point leaves its contact to others, where it `may`.
    pub(super) fn leaves(&mut self, point: u32, may: bool) -> bool {
        let leaves = self.remember(point, may);
        if let (true, Err(place)) = (leaves, self.gone.binary_search(&point)) {
            self.gone.insert(place, point);
        }
        leaves
    }

    fn remember(&mut self, point: u32, may: bool) -> bool {
        match (may, self.left.binary_search(&point)) {
            (false, Err(_)) => false,
            (true, Err(place)) => {
                self.left.insert(place, point);
                true
            }
            (may, Ok(_)) => {
                let place = self.back.binary_search(&point);
                if let (false, Err(place)) = (may, place) {
                    self.back.insert(place, point);
                }
                may && place.is_err()
            }
        }
    }

    /// Whether a point has left its contact in the last choice.
    pub(super) fn has_left(&self, point: u32) -> bool {
        self.gone.binary_search(&point).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_that_comes_back_stays_for_the_attempt() {
        let mut telling = Telling::default();
        let mut told: Vec<bool> = Vec::new();
        for may in [false, true, true, false, true, false, true] {
            telling.begin_choice();
            told.push(!telling.leaves(3, may));
            assert_eq!(telling.has_left(3), told.last() == Some(&false));
        }
        assert_eq!(told, [true, false, false, true, true, true, true]);
        assert!(telling.leaves(4, true), "of others nothing is known");
        assert!(telling.has_left(4));
        telling.begin();
        assert!(telling.leaves(3, true));
    }
}
