//! When a driver would end its step: where points in flight are at their lead ([`crate::landing`]).

use super::Driver;
use super::owners::{Attempt, Contacts, Stages};
use crate::landing::{arrival, flies, lead};
use crate::system::{Adaptive, Maps};

impl Driver {
    /// When the first of the points in flight is at its lead of steps of size `planned`, after the start of the attempt just
    /// made, s; infinite where none is. `largest`: the largest step that the rules allow, s.
    pub fn first_cut(&self, (rules, largest): (&Adaptive, f64), planned: f64) -> f64 {
        let maps = Maps::new(&self.attempt.system, planned, planned);
        let interface = &self.attempt.state.interface;
        let mut first = f64::INFINITY;
        for point in 0..self.attempt.system.points() {
            let (gap, flight) = (interface.gap[point], interface.flight[point]);
            let number = self.attempt.system.contact_of(point);
            let tolerance = self.attempt.system.contacts[number].tolerance;
            if flies((gap, flight), tolerance, (rules, largest)) {
                let law = self.attempt.system.contacts[number].law.get();
                let zone = self.attempt.system.zone_of(number);
                let way = [
                    gap,
                    self.contacts.rate_at_start(&self.attempt, point),
                    self.stages.free_gap(&self.contacts, &self.attempt, point),
                ];
                let arrival = arrival(way, self.attempt.dt, tolerance);
                let cut = arrival - lead(&maps.all()[zone], planned, law);
                if cut >= rules.smallest {
                    first = first.min(cut);
                }
            }
        }
        first
    }
}

impl Stages {
    /// Gap of a point at the end of the step without its forces, m.
    pub(super) fn free_gap(&self, contacts: &Contacts, attempt: &Attempt, point: usize) -> f64 {
        if let Some(gap) = self.predictor.gap(point) {
            return gap;
        }
        match contacts.candidates.binary_search(&(point as u32)) {
            Ok(k) => contacts.free_gaps[k],
            Err(_) => attempt.next.interface.gap[point],
        }
    }
}
