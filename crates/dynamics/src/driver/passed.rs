//! Points that have passed what they face in a step.

use super::deletion::as_narrowed;
use super::owners::{Attempt, Contacts};
use crate::shared::Own;

impl Contacts {
    /// How many points of a contact have passed what they face in the step, are not seen behind it and have no force.
    pub(super) fn passed(&self, attempt: &Attempt, number: usize) -> u64 {
        let (system, depth) = (&*attempt.system, self.passage.depths[number]);
        // both sides move
        if depth == f64::INFINITY || 2.0 * self.passage.ways[number] <= depth {
            return 0;
        }
        let contact = as_narrowed(&self.narrowed, system, number);
        let (old, new) = (&attempt.state.motion, &attempt.next.motion);
        let ways = [
            system.places(attempt.state.time, &old.u, &old.frames),
            system.places(attempt.state.time + attempt.dt, &new.u, &new.frames),
        ];
        let ways = [&ways[0], &ways[1]];
        let first = system.contacts[number].range.start;
        let forces = [
            &attempt.state.interface.force,
            &attempt.next.interface.force,
        ];
        let closed = |k: usize| forces.iter().any(|force| force[first + k] != 0.0);
        let passed = match self.active.own_of(number) {
            Own::All if 2.0 * contact.way(ways) <= depth => 0,
            Own::All => contact.passed(ways, 0..contact.points.len(), closed),
            // those that others share are paired with the ends of steps, which tells the way
            Own::Some(_) if self.passage.ways[number] == f64::INFINITY => 0,
            Own::Some(part) => {
                let points = part.points.iter().map(|&point| point as usize);
                contact.passed(ways, points, closed)
            }
        };
        passed as u64
    }
}
