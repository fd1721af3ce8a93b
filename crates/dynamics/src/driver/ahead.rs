//! Contacts that are paired where the step is predicted to lead.

use super::candidates::looks_ahead;
use super::{Driver, Vectors};
use crate::error::Error;
use crate::step_map::Row;

impl Driver {
    /// Whether a contact is paired where the step is predicted to lead.
    pub(super) fn looks_ahead(&self, contact: usize) -> bool {
        let contact = &self.system.contacts[contact];
        !self.between() && looks_ahead(&self.map, contact, &self.law(contact))
    }

    /// Moves the gaps of the points from `first` on, paired at the configuration in `place`, to another one.
    pub(super) fn move_gaps(&mut self, first: usize, to: &Row) {
        let Vectors {
            x,
            push,
            place,
            work,
            ..
        } = &mut self.vectors;
        to.whole(&self.state.motion, x, push, work);
        for (way, from) in work.iter_mut().zip(place) {
            *way -= *from;
        }
        self.pairing.rows.move_from(first, work);
    }

    /// Predicts the displacement at the end of the step: an iteration with the forces of contacts and links of the step
    /// before.
    pub(super) fn look_ahead(&mut self) -> Result<(), Error> {
        self.renew()?;
        (self.pace.age, self.pace.made) = (1, 0);
        let motion = &self.state.motion;
        let vectors = &mut self.vectors;
        let residual = match self.link_force.is_empty() {
            true => &vectors.residual,
            false => &vectors.unlinked,
        };
        for (i, r) in vectors.work.iter_mut().enumerate() {
            let link = motion.link_force.get(i).unwrap_or(&0.0);
            *r = match self.system.fixed[i] {
                true => 0.0,
                false => residual[i] + self.map.contact * motion.contact_force[i] + link,
            };
        }
        self.free_motion();
        let vectors = &mut self.vectors;
        for (dx, x) in vectors.dx.iter_mut().zip(&vectors.x) {
            *dx += x;
        }
        vectors.ahead.resize(vectors.x.len(), 0.0);
        let end = &self.map.displacement;
        end.whole(
            &self.state.motion,
            &vectors.dx,
            &vectors.push,
            &mut vectors.ahead,
        );
        Ok(())
    }
}
