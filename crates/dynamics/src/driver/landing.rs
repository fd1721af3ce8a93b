//! When a driver would end its step: where points in flight are at their lead ([`crate::landing`]).

use super::Driver;
use crate::landing::{arrival, flies, lead};
use crate::system::{Adaptive, Maps};

impl Driver {
    /// When the first of the points in flight is at its lead of steps of size `planned`, after the start of the attempt just
    /// made, s; infinite where none is. `largest`: the largest step that the rules allow, s.
    pub fn first_cut(&self, (rules, largest): (&Adaptive, f64), planned: f64) -> f64 {
        let system = &*self.attempt.system;
        let maps = Maps::new(system, planned, planned);
        let length = self.attempt.stage.first_length(planned);
        let cut = |&(point, arrival): &(usize, f64)| {
            let number = system.contact_of(point);
            let law = system.contacts[number].law.get();
            arrival - lead(&maps.all()[system.zone_of(number)], length, law)
        };
        let last = self.arrivals((rules, largest), self.attempt.stage.begun());
        let cuts = self.early.iter().chain(&last).map(cut);
        cuts.filter(|cut| *cut >= rules.smallest)
            .fold(f64::INFINITY, f64::min)
    }

    /// When the points in flight close, after the start of the attempt at the step, s, of which the stage just computed began `begun` (s) later.
    pub(super) fn arrivals(
        &self,
        (rules, largest): (&Adaptive, f64),
        begun: f64,
    ) -> Vec<(usize, f64)> {
        let system = &*self.attempt.system;
        let interface = &self.attempt.state.interface;
        let mut arrivals = Vec::new();
        for point in 0..system.points() {
            let (gap, flight) = (interface.gap[point], interface.flight[point]);
            let tolerance = system.contacts[system.contact_of(point)].tolerance;
            if flies((gap, flight), tolerance, (rules, largest)) {
                let way = [
                    gap,
                    self.contacts.rate_at_start(&self.attempt, point),
                    self.stages.free_gap(&self.contacts, &self.attempt, point),
                ];
                let arrival = arrival(way, self.attempt.dt, tolerance);
                arrivals.push((point, begun + arrival));
            }
        }
        arrivals
    }
}
