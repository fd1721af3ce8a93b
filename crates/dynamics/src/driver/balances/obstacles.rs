//! The work of obstacles that move.

use super::Balances;
use crate::driver::attempt::Attempt;
use crate::driver::contacts::Contacts;

impl Balances {
    /// Writes the work of each obstacle in the step, J, of what was reported of the contacts.
    pub(crate) fn work_of_obstacles(&mut self, contacts: &Contacts, attempt: &Attempt) {
        let mut works = std::mem::take(&mut self.works.obstacles);
        works.clear();
        for (contact, of) in contacts.sums().iter().enumerate() {
            let impulse = &attempt.maps.all()[attempt.system.zone_of(contact)].contact_impulse;
            let weights = attempt.weights_as_told([impulse.old, impulse.new]);
            let work = attempt.work_of_obstacle(contact, weights, of.pushed);
            works.push(work.map_or(0.0, |work| attempt.contact_factor() * work));
        }
        self.works.obstacles = works;
    }
}
