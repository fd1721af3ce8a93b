//! Contacts whose primary sides have lost cells.

use carom_contact::{Contact, Search};

use super::Contacts;
use crate::driver::attempt::Attempt;
use crate::system::System;

impl Contacts {
    /// Brings the primary sides of contacts to the elements that are left in the state, a function of the state alone.
    pub(crate) fn renew_targets(&mut self, attempt: &Attempt) {
        let deleted = attempt.state.ledger.deleted;
        if self.narrowed_for == deleted {
            return;
        }
        self.narrowed_for = deleted;
        let system = &*attempt.system;
        self.narrowed.resize(system.contacts.len(), None);
        for (number, contact) in system.contacts.iter().enumerate() {
            let faces = system.faces_left(number, &attempt.state.motion.history);
            self.narrowed[number] = faces.map(|faces| contact.with_faces(faces, &system.x));
            if self.narrowed[number].is_some() {
                self.search[number] = Search::default();
            }
        }
    }
}

/// A contact as the deletion of elements has left it.
pub(super) fn as_narrowed<'a>(
    narrowed: &'a [Option<Contact>],
    system: &'a System,
    number: usize,
) -> &'a Contact {
    let left = narrowed.get(number).and_then(Option::as_ref);
    left.unwrap_or(&system.contacts[number])
}
