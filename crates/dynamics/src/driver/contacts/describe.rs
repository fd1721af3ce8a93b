//! What the contact problem of an iteration is given: what the laws of its candidates know.

use carom_contact::law::Local;
use carom_contact::{Pairing, Rows};
use carom_nonsmooth::{ContactPoint, PointForces};

use super::Contacts;
use crate::coulomb::Tangential;
use crate::driver::attempt::Attempt;
use crate::interface::Candidate;
use crate::step_map::{Row, StepMap};

/// The rows of points of this width: normals alone, or each with its tangents.
pub(super) fn rows_of<'a>(width: u32, pairing: &'a Pairing, stacked: &'a Rows) -> &'a Rows {
    match width {
        1 => &pairing.rows,
        _ => stacked,
    }
}

impl Contacts {
    /// A contact point before the forces of the iteration: the one description that all problems of a step are made of.
    fn contact_point(&self, attempt: &Attempt, point: usize) -> ContactPoint {
        let (contact, place) = attempt.system.point(point);
        let carrier = &contact.points[place];
        let interface = &attempt.next.interface;
        let map = attempt.map_of(attempt.system.contact_of(point));
        ContactPoint {
            law: *attempt.law(contact),
            area: carrier.area,
            share: carrier.share,
            tolerance: attempt.system.tolerance_at(point),
            faces_itself: contact.has_both_sides(),
            crush: attempt.state.interface.crush[point],
            gap: match attempt.between() {
                // S_d looks at the start of the step
                true => attempt.state.interface.gap[point],
                false => self.pairing.rows.gap(point),
            },
            rate: self.rate_at_start(attempt, point),
            rebound: self.rebound_of(attempt, point),
            in_way: map.start_in_way(),
            dt: attempt.moves(point),
            last: PointForces {
                normal: interface.force[point],
                tangential: interface.friction.get(point).copied().unwrap_or_default(),
                status: interface.status[point],
                slip: self.slips.get(point).copied().unwrap_or_default(),
            },
        }
    }

    /// What the law of a point may know before the forces. `gap_free`: its gap without them, m.
    pub(super) fn local(&self, attempt: &Attempt, point: usize, gap_free: f64) -> Local {
        self.contact_point(attempt, point).local(gap_free)
    }

    /// Rows of a candidate in the problem: its normal, and with friction its tangents.
    pub(crate) fn width(&self, attempt: &Attempt) -> u32 {
        match self.rubs(attempt) {
            true => 1 + attempt.system.tangents() as u32,
            false => 1,
        }
    }

    /// The rows of points of this width.
    pub(crate) fn rows(&self, width: u32) -> &Rows {
        rows_of(width, &self.pairing, &self.stacked)
    }

    /// What the laws of the candidates know, and what friction adds; of adaptive steps their gaps without contact forces too.
    ///
    /// `width`: rows of a point; `free`: N x of the motion of the iteration without contact forces, by the number of the row.
    pub(crate) fn describe_candidates(
        &mut self,
        attempt: &Attempt,
        width: u32,
        free: impl Fn(&Contacts, u32) -> f64,
    ) {
        let mut data = std::mem::take(&mut self.candidate_data);
        data.clear();
        self.free_gaps.clear();
        for k in 0..self.candidates.len() {
            let (number, point) = (self.candidates[k], self.candidates[k] as usize);
            let described = self.contact_point(attempt, point);
            let along = free(self, number * width);
            data.normal
                .push(self.candidate(attempt, point, (&described, along)));
            if width > 1 {
                let along = |tangent: u32| free(self, number * width + 1 + tangent);
                let tangential = self.tangential(attempt, point, (&described, along));
                data.friction.push(tangential);
            }
            if attempt.system.adaptive.is_some() {
                let gap = self.gap_at_the_end(attempt, point, along);
                self.free_gaps.push(gap);
            }
        }
        self.candidate_data = data;
    }

    /// What the law of a candidate knows. `free`: N x of the motion of the iteration without contact forces.
    fn candidate(
        &self,
        attempt: &Attempt,
        point: usize,
        (described, free): (&ContactPoint, f64),
    ) -> Candidate {
        let (gap, rate) = self.now(attempt, point, false);
        let [closing, approach] = attempt.added(point, free);
        let instant = attempt.factors(attempt.system.contact_of(point));
        described.candidate([gap + closing, rate + approach], instant)
    }

    /// What friction adds to a candidate. `free`: T x of the motion of the iteration without contact forces, by the tangent.
    fn tangential(
        &self,
        attempt: &Attempt,
        point: usize,
        (described, free): (&ContactPoint, impl Fn(u32) -> f64),
    ) -> Tangential {
        let (row, time) = self.sliding(attempt);
        // what the forces of the iteration give by themselves is in the matrix
        let without = move |map: &StepMap| Row { c: 0.0, ..row(map) };
        let number = attempt.system.contact_of(point);
        let factor = row(attempt.map_of(number)).x;
        let mut q = [0.0; 2];
        for (k, q) in q.iter_mut().enumerate().take(attempt.system.tangents()) {
            *q = self.slid(attempt, point, k, (without, time)) + factor * free(k as u32);
        }
        let friction = &attempt.system.contacts[number].friction;
        described.tangential(friction, self.sliding_speed(attempt, point), q)
    }

    /// Gap of a point at the end of the step without contact forces, m.
    fn gap_at_the_end(&self, attempt: &Attempt, point: usize, free: f64) -> f64 {
        let number = attempt.system.contact_of(point);
        let paired = self.paired_at(number);
        let ahead = |map: &StepMap| map.displacement.since(&paired.row(map));
        let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
        let rows = &self.pairing.rows;
        let motion = &attempt.state.motion;
        let way = attempt.maps.on((rows, point), ahead, motion, xc);
        rows.gap(point) + way + attempt.map_of(number).displacement.x * free
    }
}
