//! How each contact is paired in a step of the size at hand: what is the same in all iterations and steps of that size.

use carom_contact::Sliding;
use carom_contact::law::Level;

use super::Driver;
use super::paired::{Manner, Paired};

impl Driver {
    /// The manners of the contacts, after the size of the step or its stage has changed.
    pub(super) fn renew_manners(&mut self) {
        let manner = |number: usize| {
            let paired = self.configuration(number);
            let contact = &self.system.contacts[number];
            let sides = std::iter::once(contact.secondary_body).chain(contact.primary_body);
            let maps = sides.map(|body| &self.maps.all()[self.system.zone_of_body[body]]);
            Manner {
                paired,
                turning: maps.fold(0.0, |most, map| f64::max(most, paired.row(map).x)),
            }
        };
        let manners = (0..self.system.contacts.len()).map(manner).collect();
        self.manners = manners;
        self.by_rate = self.slides_by_rate();
        self.turns = self.manners.iter().any(|manner| manner.turning != 0.0);
    }

    /// The configuration in which a contact is paired: of a law in the gap the one that it constrains, of a law in the rate
    /// the captured one, which is known; of a scheme between two states their middle. With small sliding gaps are linear in
    /// the displacement, and are those of a configuration that is known.
    fn configuration(&self, number: usize) -> Paired {
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
