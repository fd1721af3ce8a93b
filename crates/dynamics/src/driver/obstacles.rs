//! The work of obstacles that move.

use super::Driver;
use crate::records::Pushed;

impl Driver {
    /// Work in J of the obstacles in the step: their forces, old and new with these weights by zone, times their way, and the power
    /// of their turn times the step. `pushed`: what [`Driver::pushed`] tells of each.
    pub(super) fn obstacle_work(
        &self,
        weights: &[[f64; 2]],
        pushed: &dyn Fn(usize) -> Pushed,
    ) -> f64 {
        let of = |contact: usize| {
            let weights = weights[self.attempt.system.zone_of(contact)];
            self.attempt
                .work_of_obstacle(contact, weights, pushed(contact))
        };
        let works = (0..self.attempt.system.contacts.len()).filter_map(of);
        self.attempt.contact_factor() * works.sum::<f64>()
    }
}
