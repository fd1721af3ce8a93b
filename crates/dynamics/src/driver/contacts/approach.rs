//! How far loose pieces are from the contacts that may hold them.

use carom_contact::Target;

use super::Contacts;
use crate::driver::attempt::Attempt;
use crate::driver::parts::Parts;
use crate::driver::parts::rigid::{INDEPENDENT, Rigid, norm};

impl Contacts {
    /// Multiple of a rigid motion at which the first of the open points closes; none where none comes closer.
    pub(crate) fn way_to_contact(
        &self,
        attempt: &Attempt,
        rigid: &Rigid,
        c: &[f64],
    ) -> Option<f64> {
        let mut way: Option<f64> = None;
        for point in 0..attempt.system.points() {
            if attempt.next.interface.force[point] != 0.0
                || self.pairing.rows.gap(point).is_infinite()
            {
                continue;
            }
            let row = rigid.contact_row(&self.pairing.rows, point);
            let rate: f64 = row.iter().zip(c).map(|(n, c)| n * c).sum();
            if rate < -INDEPENDENT * norm(&row) * norm(c) {
                let until = self.now(attempt, point, true).0.max(0.0) / -rate;
                way = Some(way.map_or(until, |way| way.min(until)));
            }
        }
        way
    }

    /// Whether contact carries a piece that has gone on, for as many iterations as may be taken, along a motion with no contact on
    /// its way, and its load has not become less than half.
    pub(crate) fn tips(&self, parts: &mut Parts, attempt: &Attempt, rigid: &Rigid) -> bool {
        let load = norm(&parts.floating().load);
        let carried = parts.floating().load == parts.floating().carried && load > parts.left_over();
        if !carried {
            return false;
        }
        let free = self
            .way_to_contact(attempt, rigid, &parts.floating().load)
            .is_none();
        let floating = parts.floating_mut();
        if !free || load < 0.5 * floating.tipped {
            (floating.tipping, floating.tipped) = (0, 0.0);
            return false;
        }
        if floating.tipping == 0 {
            floating.tipped = load;
        }
        floating.tipping += 1;
        floating.tipping >= attempt.system.nonlinear.iteration.passes
    }

    /// Pieces that hang together by contact forces with something that does not float.
    pub(crate) fn grounded(&self, parts: &Parts, attempt: &Attempt) -> Vec<usize> {
        let pieces = parts.floating().pieces();
        let count = pieces.len();
        // one set more: all that does not float
        let mut set: Vec<usize> = (0..=count).collect();
        for point in attempt.carrying() {
            let (contact, _) = attempt.system.point(point);
            let (unknowns, _) = self.pairing.rows.row(point);
            let touched = unknowns
                .iter()
                .map(|&i| pieces.of(i as usize).unwrap_or(count));
            let mut touched: Vec<usize> = touched.collect();
            if matches!(contact.target, Target::Rigid(_)) {
                touched.push(count);
            }
            for pair in touched.windows(2) {
                let [from, to] = [pair[0], pair[1]].map(|piece| set[piece]);
                for set in set.iter_mut().filter(|set| **set == from) {
                    *set = to;
                }
            }
        }
        (0..count)
            .filter(|&piece| set[piece] == set[count])
            .collect()
    }
}
