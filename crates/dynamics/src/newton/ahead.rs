//! Contacts that are paired where the step is predicted to lead.

use carom_contact::Contact;

use super::{Newton, Vectors};
use crate::driver::looks_ahead;
use crate::error::Error;
use crate::step_map::Row;

impl Newton {
    /// Whether a contact is paired where the step is predicted to lead.
    pub(super) fn looks_ahead(&self, contact: &Contact) -> bool {
        !self.between() && looks_ahead(&self.map, contact, &self.law(contact))
    }

    /// Moves the gaps of the points from `first` on, paired at the configuration in `place`, to another one.
    pub(super) fn move_gaps(&mut self, first: usize, to: &Row) {
        let Vectors { x, place, work, .. } = &mut self.vectors;
        to.whole(&self.state.motion, x, &[], work);
        for (way, from) in work.iter_mut().zip(place) {
            *way -= *from;
        }
        self.pairing.rows.move_from(first, work);
    }

    /// Predicts the displacement at the end of the step: an iteration with the forces of contacts and links of the step
    /// before.
    pub(super) fn look_ahead(&mut self) -> Result<(), Error> {
        if self
            .constant_key()
            .is_none_or(|key| !self.effective.stands(key))
        {
            self.renew()?;
        }
        (self.pace.age, self.pace.made) = (1, 0);
        let motion = &self.state.motion;
        let vectors = &mut self.vectors;
        for (i, r) in vectors.work.iter_mut().enumerate() {
            let link = |force: &[f64]| force.get(i).copied().unwrap_or(0.0);
            let change = link(&motion.link_force) - link(&self.link_force);
            *r = match self.system.fixed[i] {
                true => 0.0,
                false => vectors.residual[i] + self.map.contact * motion.contact_force[i] + change,
            };
        }
        self.free_motion();
        let vectors = &mut self.vectors;
        for (dx, x) in vectors.dx.iter_mut().zip(&vectors.x) {
            *dx += x;
        }
        vectors.ahead.resize(vectors.x.len(), 0.0);
        let end = &self.map.displacement;
        end.whole(&self.state.motion, &vectors.dx, &[], &mut vectors.ahead);
        Ok(())
    }
}
