//! What the contact problem of an iteration is given: what the laws of its candidates know.

use carom_contact::Rows;

use super::owners::{Attempt, Contacts, Parts};
use crate::interface::Candidate;
use crate::step_map::StepMap;

impl Contacts {
    /// What the law of a candidate knows. `free`: N x of the motion of the iteration without contact forces.
    pub(super) fn candidate(&self, attempt: &Attempt, point: usize, free: f64) -> Candidate {
        let contact = attempt.system.point(point).0;
        let (gap, rate) = self.now(attempt, point, false);
        let [closing, approach] = attempt.added(point, free);
        Candidate {
            law: *attempt.law(contact),
            local: self.local(attempt, point, gap + closing),
            rate_free: rate + approach,
            status: attempt.next.interface.status[point],
            faces_itself: contact.faces_itself(),
            instant: attempt.factors(attempt.system.contact_of(point)),
        }
    }

    /// Gap of a point at the end of the step without contact forces, m.
    pub(super) fn gap_at_the_end(&self, attempt: &Attempt, point: usize, free: f64) -> f64 {
        let number = attempt.system.contact_of(point);
        let paired = self.paired_at(number);
        let ahead = |map: &StepMap| map.displacement.since(&paired.row(map));
        let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
        let rows = &self.pairing.rows;
        let motion = &attempt.state.motion;
        let way = attempt.maps.on((rows, point), ahead, motion, xc);
        rows.gap(point) + way + attempt.map_of(number).displacement.x * free
    }

    /// What the laws of the candidates know; of adaptive steps their gaps without contact forces too. `tangents`: how many rows of
    /// tangents follow that of each point in the stacked rows; none where the points have rows of their own.
    pub(super) fn describe_candidates(
        &mut self,
        parts: &Parts,
        attempt: &Attempt,
        tangents: Option<u32>,
    ) {
        let mut data = std::mem::take(&mut self.candidate_data);
        data.clear();
        self.free_gaps.clear();
        for k in 0..self.candidates.len() {
            let point = self.candidates[k];
            let last = attempt.next.interface.force[point as usize];
            let free = match tangents {
                Some(tangents) => {
                    parts.free_along(attempt, point * (1 + tangents), &self.stacked, last)
                }
                None => parts.free_along(attempt, point, &self.pairing.rows, last),
            };
            data.push(self.candidate(attempt, point as usize, free));
            if attempt.system.adaptive.is_some() {
                let gap = self.gap_at_the_end(attempt, point as usize, free);
                self.free_gaps.push(gap);
            }
        }
        self.candidate_data = data;
    }
}

impl Parts {
    /// N x of the motion of the iteration without contact forces, of the row of that number in `rows`.
    ///
    /// `last`: the force of the row an iteration ago, N. What is added to the response of points on a rigid body, so that they share their force, is about
    /// that one in a static stage, where nothing but their iterations holds the body and its response is large: at the end nothing of it is left over.
    pub(super) fn free_along(&self, attempt: &Attempt, number: u32, rows: &Rows, last: f64) -> f64 {
        let mut free = self.effective.free(number, &attempt.vectors.half);
        if self.floats(attempt) {
            free -= self.effective.softened(number) * last;
        }
        match attempt.jumps() {
            true => free + rows.product(number as usize, &attempt.vectors.jump),
            false => free,
        }
    }
}

impl Attempt {
    /// Factors of x in gap and rate that the law of a contact constrains, over those of the problem: of the first map.
    pub(super) fn factors(&self, contact: usize) -> [f64; 2] {
        let (map, [gap, rate]) = (self.map_of(contact), self.constrained(contact).1);
        if self.maps.only().is_some() {
            return [gap, rate];
        }
        let first = self.maps.first();
        let over = |own: f64, first: f64| if first == 0.0 { 1.0 } else { own / first };
        [
            gap * over(map.gap.x, first.gap.x),
            rate * over(map.rate.x, first.rate.x),
        ]
    }
}
