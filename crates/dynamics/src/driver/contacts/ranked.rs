//! Contacts of explicit steps that several processes take together.

use std::sync::Arc;

use carom_contact::Search;

use super::Contacts;
use super::far::Far;
use crate::contact_sums::ContactSums;
use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Direct;
use crate::shared::{InReach, Own, Part, Shared};
use crate::step_map::StepMap;
use crate::update::Sums;

impl Contacts {
    /// How far the own points of each contact moved in the search, for the sums of all ranks.
    pub(crate) fn report_motions(&mut self, map: &StepMap) {
        for k in 0..self.sums.len() {
            let in_steps = self.paired_at(k).row(map) == map.displacement;
            let Own::Some(own) = self.active.own_of(k) else {
                continue;
            };
            self.sums[k].motion = match (in_steps, own.nodes.is_empty()) {
                (false, _) => f64::INFINITY,
                (true, true) => 0.0,
                (true, false) => self.search[k].motion(),
            };
        }
    }

    /// The points of the attempt are those in reach.
    pub(crate) fn look_to(&mut self, in_reach: &InReach) {
        self.active.look_to(in_reach);
    }

    /// Takes the sums, to add those of other ranks.
    pub(crate) fn take_sums(&mut self) -> Vec<ContactSums> {
        std::mem::take(&mut self.sums)
    }

    /// Keeps the sums of all ranks.
    pub(crate) fn keep_sums(&mut self, sums: Vec<ContactSums>) {
        self.sums = sums;
    }

    /// The most passes of any rank.
    pub(crate) fn set_passes(&mut self, passes: usize) {
        self.solver.passes = passes;
    }

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
