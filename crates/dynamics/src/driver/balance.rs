//! The end of a step: its motion, and the balance of a step whose forces are not all linear.
//!
//! The balance of forces of the step, times the way Δu, is the balance of energy: what inertia takes beyond the change of
//! the kinetic energy, and internal forces beyond what is stored and dissipated by the material, is the scheme's share, of
//! no fixed sign. The residual is the work of what the iterations left unbalanced.

use std::sync::Arc;

use super::Driver;
use crate::error::Error;
use crate::step_map::StepMap;

impl Driver {
    /// Writes the motion at the end of the step, its internal forces and histories.
    pub(super) fn advance(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let old = &self.attempt.state.motion;
        let new = &mut self.attempt.next.motion;
        let (x, push) = (&self.attempt.vectors.x, &self.attempt.vectors.push);
        self.attempt
            .maps
            .whole(|map| map.displacement, old, [x, push], &mut new.u);
        self.attempt
            .maps
            .whole(|map| map.velocity, old, [x, push], &mut new.v);
        self.attempt
            .maps
            .whole(|map| map.acceleration, old, [x, push], &mut new.a);
        new.frames.clone_from(&old.frames);
        if self.attempt.maps.all().iter().any(StepMap::has_memory) {
            self.attempt
                .maps
                .whole(|map| map.memory, old, [x, push], &mut new.memory);
        }
        for i in system.massless.iter().map(|&unknown| unknown as usize) {
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.attempt.dt, 0.0);
        }
        if !system.nonlinear.follows.is_empty() {
            self.attempt.follow_motions();
        }
        if self.attempt.maps.is_static() {
            self.attempt.next.motion.v.fill(0.0);
            self.attempt.next.motion.a.fill(0.0);
            self.attempt.next.motion.memory.fill(0.0);
        }
        self.contacts
            .end_forces(&mut self.parts, &mut self.attempt)?;
        let new = &mut self.attempt.next.motion;
        new.internal_force
            .copy_from_slice(&self.attempt.vectors.internal);
        new.history.copy_from_slice(&self.attempt.vectors.history);
        new.contact_force
            .copy_from_slice(&self.attempt.vectors.contact);
        new.link_force.clear();
        new.link_force.extend_from_slice(self.links.force());
        self.attempt.keep_bolts();
        self.contacts.end_interface(&mut self.attempt);
        self.contacts.crush(&mut self.attempt);
        Ok(())
    }

    /// Energy and momentum of the step.
    pub(super) fn balance(&mut self) {
        match self.attempt.system.is_nonlinear() {
            true => self.balance_by_works(),
            false => self.balance_by_identity(),
        }
    }
}
