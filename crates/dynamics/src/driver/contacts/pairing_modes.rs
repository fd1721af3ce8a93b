//! How each contact is paired in a step of the size at hand: what is the same in all iterations and steps of that size.

use carom_contact::Sliding;
use carom_contact::law::Level;

use super::Contacts;
use crate::driver::attempt::Attempt;
use crate::driver::paired::{Paired, PairingMode};

impl Contacts {
    /// The pairing modes of the contacts, after the size of the step or its stage has changed.
    pub(super) fn renew_pairing_modes(&mut self, attempt: &Attempt) {
        let mode = |number: usize| {
            let paired = attempt.configuration(number);
            let contact = &attempt.system.contacts[number];
            let sides = std::iter::once(contact.secondary_body).chain(contact.primary_body);
            let maps = sides.map(|body| &attempt.maps.all()[attempt.system.zone_of_body[body]]);
            PairingMode {
                paired,
                turning: maps.fold(0.0, |most, map| f64::max(most, paired.row(map).x)),
            }
        };
        let pairing_modes = (0..attempt.system.contacts.len()).map(mode).collect();
        self.pairing_modes = pairing_modes;
        self.by_rate = attempt.slides_by_rate();
        self.turns = self.pairing_modes.iter().any(|mode| mode.turning != 0.0);
    }
}

impl Attempt {
    /// The configuration in which a contact is paired: of a law in the gap the one that it constrains, of a law in the rate
    /// the captured one, which is known; of a scheme between two states their middle. With small sliding gaps are linear in
    /// the displacement, and are those of a configuration that is known.
    pub(crate) fn configuration(&self, number: usize) -> Paired {
        let contact = &self.system.contacts[number];
        let law = self.law(contact).get();
        let captured = Paired::Captured(law.capture());
        let dynamic = !self.maps.is_static();
        if contact.sliding == Sliding::Small || dynamic && !self.system.pairs_anew(number) {
            return captured;
        }
        if self.between() {
            return Paired::Middle;
        }
        match law.level() {
            Level::Rate => captured,
            Level::Gap => Paired::Gap,
            Level::GapAndRate => Paired::Compliant,
        }
    }
}
