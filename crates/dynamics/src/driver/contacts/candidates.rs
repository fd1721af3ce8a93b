//! Which points may carry a force in an iteration.

use carom_contact::law::Status;

use super::Contacts;
use super::deletion::as_narrowed;
use crate::coulomb::Slip;
use crate::driver::attempt::Attempt;
use crate::driver::paired::approaches;
use crate::driver::parts::Parts;

impl Contacts {
    /// Gap of a candidate at the end of the step without any contact force, m; of an adaptive step.
    pub(crate) fn free_gap(&self, point: usize) -> Option<f64> {
        let place = self.candidates.binary_search(&(point as u32));
        place.ok().map(|place| self.free_gaps[place])
    }

    /// Tells that no point may carry a force.
    pub(crate) fn forget_candidates(&mut self) {
        self.candidates.clear();
    }

    /// Whether a point may leave its contact to those opposite to it that are watched: forces of both would hardly move anything apart.
    fn may_leave(&self, attempt: &Attempt, point: u32) -> bool {
        let (system, chosen) = (&attempt.system, &attempt.next.interface.watched);
        let number = system.contact_of(point as usize);
        let contact = as_narrowed(&self.narrowed, system, number);
        let first = system.contacts[number].range.start;
        let takes_part = |other: usize| chosen[first + other];
        let own = &contact.points[point as usize - first];
        if own.faces_round() {
            return self.telling.leaves_to_nodes(number, own, takes_part);
        }
        contact.leaves_it((&self.pairing, first), point as usize - first, takes_part)
    }

    /// Leaves out candidates, from a place of them on, that leave their contact to others.
    fn leave_to_others(&mut self, attempt: &Attempt, from: usize) {
        let mut kept = from;
        for place in from..self.candidates.len() {
            let point = self.candidates[place];
            let may_leave = self.may_leave(attempt, point);
            if !self.telling.leaves(point, may_leave) {
                self.candidates[kept] = point;
                kept += 1;
            }
        }
        self.candidates.truncate(kept);
    }

    /// Makes the candidates those at some places, to be told of.
    pub(super) fn keep_places(&mut self, places: &[u32]) {
        let points = places.iter().map(|&place| self.candidates[place as usize]);
        self.candidates = points.collect();
        self.candidate_data = self.candidate_data.at(places);
    }

    /// Notes the candidate whose tension did not settle, if there is one, in place of that of the iteration before.
    pub(super) fn note_clipped(&self, attempt: &mut Attempt, candidate: Option<usize>) {
        attempt.notices.clipped.count = 0;
        if let Some(candidate) = candidate {
            let place = attempt.name(self.candidates[candidate] as usize);
            attempt.notices.clipped.add(|| place);
        }
    }

    /// Warns that statuses of contact points went in circles from this candidate on.
    pub(super) fn warn_of_circle(&self, attempt: &Attempt, candidate: usize) {
        let name = attempt.name(self.candidates[candidate] as usize);
        tracing::warn!(
            "step {}: contact statuses cycle at {name}; they now change one at a time",
            attempt.state.step + 1
        );
    }

    /// No contact force at all.
    pub(crate) fn release(&mut self, attempt: &mut Attempt) {
        self.note_clipped(attempt, None);
        for point in self.active.within(0..attempt.system.points()) {
            attempt.next.interface.release(point);
            if let Some(slip) = self.slips.get_mut(point) {
                *slip = Slip::Open;
            }
        }
        self.take_weak(attempt);
    }

    /// Points that may carry a force. Some laws say so before the forces; of others, those are taken that carried one or that
    /// close at the x of the iteration or at twice the rate at the start, and the rest is looked at after the solve.
    pub(crate) fn choose_candidates(&mut self, parts: &Parts, attempt: &mut Attempt) {
        self.candidates.clear();
        let active = std::mem::take(&mut self.active);
        for point in active.within(0..attempt.system.points()) {
            let chosen = match self.told(attempt, point) {
                Some(told) => told,
                None => {
                    attempt.next.interface.status[point] != Status::Open
                        || self.approaches(parts, attempt, point)
                }
            };
            attempt.next.interface.watched[point] = chosen;
            if chosen {
                self.candidates.push(point as u32);
            }
        }
        self.active = active;
        self.telling.begin_choice();
        self.leave_to_others(attempt, 0);
    }

    pub(crate) fn approaches(&self, parts: &Parts, attempt: &Attempt, point: usize) -> bool {
        let tolerance = attempt.system.tolerance_at(point);
        match self.is_affine(parts) {
            true => {
                let gap = self.pairing.rows.gap(point);
                approaches(
                    (gap, self.rate_at_start(attempt, point)),
                    attempt.dt,
                    tolerance,
                )
            }
            false => self.now(attempt, point, true).0 <= tolerance,
        }
    }

    /// Adds the points that were no candidates and whose law asks for a force; whether there are any.
    pub(crate) fn add_missed(&mut self, parts: &Parts, attempt: &mut Attempt) -> bool {
        let before = self.candidates.len();
        let active = std::mem::take(&mut self.active);
        for point in active.within(0..attempt.system.points()) {
            let known = self.candidates[..before].binary_search(&(point as u32));
            if known.is_ok() || self.told(attempt, point).is_some() {
                continue;
            }
            let step = self.pairing.rows.product(point, &attempt.vectors.dx);
            let (gap, rate) = self.now(attempt, point, false);
            let [closing, approach] = attempt.added(point, step);
            let ahead = (gap + closing, rate + approach);
            let (gap, rate) = self.weakly(attempt, point, ahead);
            if self.asks(parts, attempt, point, gap, rate) {
                self.candidates.push(point as u32);
                attempt.next.interface.watched[point] = true;
            }
        }
        self.active = active;
        self.leave_to_others(attempt, before);
        self.candidates.sort_unstable();
        self.candidates.len() > before
    }
}
