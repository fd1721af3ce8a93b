//! Elements that are deleted at the end of a step.
//!
//! Their mass stays at their nodes, and their energy goes to a term of its own in the balance. The forces of the step just taken still
//! have theirs; those of the next do not.

use carom_bodies::{Body, Placement};

use super::Driver;
use crate::error::Error;

impl Driver {
    /// Deletes the elements that have reached their limit in the attempt.
    ///
    /// # Errors
    /// An element without stress.
    pub(super) fn delete_elements(&mut self) -> Result<(), Error> {
        let (old, next) = (&self.state.motion, &mut self.next);
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
        Ok(())
    }
}
