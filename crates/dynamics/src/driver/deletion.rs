//! Elements that are deleted at the end of a step.
//!
//! Their mass stays at their nodes, and their energy goes to a term of its own in the balance. The forces of the step just taken still
//! have theirs; those of the next do not. A contact at whose primary side they were has other faces from the next step on: a point whose face is
//! gone has no force any more, unless another face is opposite.

use carom_bodies::{Body, Placement};
use carom_contact::{Contact, Search};

use super::owners::{Attempt, Contacts};
use crate::error::Error;
use crate::system::System;

impl Attempt {
    /// Deletes the elements that have reached their limit in the attempt.
    ///
    /// # Errors
    /// An element without stress.
    pub(super) fn delete_elements(&mut self) -> Result<(), Error> {
        let (old, next) = (&self.state.motion, &mut self.next);
        let before = next.ledger.deleted;
        let bodies = self.system.bodies.iter().enumerate();
        for (number, body) in bodies.filter(|(_, body)| Body::has_deletion(body)) {
            let range = self.system.nonlinear.histories[number].clone();
            let at = Placement {
                u: &next.motion.u,
                v: &next.motion.v,
                from: None,
                frames: &old.frames,
                dt: self.dt,
                old: &old.history[range.clone()],
            };
            let deleted = body.delete(&at, &mut next.motion.history[range])?;
            if deleted.elements > 0 {
                next.ledger.delete(&deleted);
            }
        }
        if next.ledger.deleted > before {
            next.records.loose = loose(&self.system, &next.motion.history);
        }
        Ok(())
    }
}

impl Contacts {
    /// Brings the primary sides of contacts to the elements that are left in the state, a function of the state alone.
    pub(super) fn renew_targets(&mut self, attempt: &Attempt) {
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

/// Whether all elements at the node of each contact point are deleted. Nodes without any element, as those of point masses, are not meant.
fn loose(system: &System, histories: &[f64]) -> Vec<bool> {
    let mut had = vec![false; system.x.len()];
    let mut has = vec![false; system.x.len()];
    let mark = |marks: &mut Vec<bool>, nodes: &[u32]| {
        for &node in nodes {
            marks[node as usize] = true;
        }
    };
    for (number, body) in system.bodies.iter().enumerate() {
        let history = system.history(number, histories);
        body.each_element_left(history, &mut |nodes| mark(&mut has, nodes));
        if body.has_deletion() {
            body.each_element(&mut |nodes| mark(&mut had, nodes));
        }
    }
    let points = system.contacts.iter().flat_map(|contact| &contact.points);
    let is_loose = |node: usize| had[node] && !has[node];
    points
        .map(|point| is_loose(point.node() as usize))
        .collect()
}
