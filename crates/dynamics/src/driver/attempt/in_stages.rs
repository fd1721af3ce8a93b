//! Stages of an attempt, of schemes of several.

use super::Attempt;
use crate::scheme::Durations;

impl Attempt {
    /// Stages of the step from the present state: a static step has one.
    pub(crate) fn stages(&self) -> usize {
        match self.is_static() {
            true => 1,
            false => self.stage.count(),
        }
    }

    /// How long the force of a contact gives its impulse; nothing in a static step, in which forces give none.
    pub(crate) fn durations(&self, contact: usize) -> Durations {
        if self.maps.is_static() {
            return Durations::default();
        }
        match self.stage.is_one_of_several() {
            true => Durations::of_stage(self.system.scheme.get(), self.stage.number, self.stage.of),
            false => Durations::of_step(self.dt, &self.map_of(contact).contact_impulse),
        }
    }
}
