//! Contacts of explicit steps that several processes take together.

use std::sync::Arc;

use carom_contact::Search;

use super::Contacts;
use super::far::Far;
use crate::contact_sums::ContactSums;
use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Direct;
use crate::shared::{Own, Part, Shared};
use crate::update::Sums;

impl Contacts {
    /// Takes the contact points that this rank has now.
    pub(crate) fn take_homes(
        &mut self,
        attempt: &Attempt,
        shared: &mut Shared,
        direct: &mut Direct,
    ) {
        let system = Arc::clone(&attempt.system);
        let own = shared.own_points(&system);
        self.narrowed.resize(system.contacts.len(), None);
        for (number, own) in own.iter().enumerate() {
            if own == self.active.own_of(number) {
                continue;
            }
            self.search[number] = Search::default();
            if let Own::Some(Part {
                faces: Some(faces), ..
            }) = own
            {
                let contact = &system.contacts[number];
                self.narrowed[number] = Some(contact.with_some_faces(faces));
            }
        }
        self.far = Far::of(&system, |contact| own[contact] == Own::All);
        self.active.keep_own(&system, own);
        direct.blocks = shared.blocks(&system);
        direct.sums = vec![Sums::default(); direct.blocks.len()];
        self.forget_step(direct);
    }

    /// Leaves out gaps beyond what counts in a step with the motion of all nodes, and tells what is recorded of contacts of which no point was
    /// looked at.
    pub(crate) fn know_gaps(&self, attempt: &mut Attempt, contacts: &mut [ContactSums]) {
        let interface = &mut attempt.next.interface;
        for (k, of) in contacts.iter_mut().enumerate() {
            let reach = attempt.system.contacts[k].reach(of.motion, self.active.reaches[k]);
            if of.report.gap > reach {
                of.report.gap = f64::INFINITY;
            }
            for point in self.active.within(attempt.system.points_of(k)) {
                if interface.gap[point] > reach {
                    (interface.gap[point], interface.rate[point]) = (f64::INFINITY, 0.0);
                }
            }
            if !of.near {
                of.passing = attempt.state.records.contacts[k].passing;
            }
        }
    }
}
