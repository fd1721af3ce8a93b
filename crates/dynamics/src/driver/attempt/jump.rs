//! Forces from other zones that jump, in the states of an attempt.

use std::sync::Arc;

use carom_algebra::reduce::dot;

use super::Attempt;
use crate::driver::links::force_jump::ForceJump;
use crate::resultant::Resultant;

impl Attempt {
    /// Adds forces (N) and what they give to the state.
    pub(crate) fn take_jump(&mut self, change: &[f64], jump: &ForceJump) {
        let system = Arc::clone(&self.system);
        let inertia_of_scheme = self.identity_of_ledger().inertia;
        let ForceJump {
            given,
            inertia,
            reaction,
            ..
        } = jump;
        let state = &mut self.state;
        // Δ|a|²_M = (2 a + Δa) · M Δa
        let square = 2.0 * dot(&state.motion.a, inertia) + dot(given, inertia);
        add(&mut state.motion.a, given);
        add(&mut state.motion.link_force, change);
        let forces = &mut state.forces;
        add(&mut forces.link, change);
        add(&mut forces.inertia, inertia);
        add(&mut forces.reaction, reaction);
        let motion = &state.motion;
        let resultant = |force: &[f64]| match system.is_nonlinear() {
            true => Resultant::at(&system, (&motion.frames, &[&motion.u]), force),
            false => Resultant::of(&system, force),
        };
        let outside = [resultant(change), resultant(reaction)];
        state.ledger.jump_force(outside, inertia_of_scheme * square);
        let outside = |i: usize| change[i] + reaction[i];
        state.exchange.jump_force(&system, outside);
    }
}

/// Adds to a vector where it is kept.
fn add(kept: &mut [f64], change: &[f64]) {
    kept.iter_mut().zip(change).for_each(|(k, more)| *k += more);
}
