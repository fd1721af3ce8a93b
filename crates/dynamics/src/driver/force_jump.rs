//! Forces from outside that change at once at the present instant, and stand from there on: those of contacts between zones.
//!
//! A scheme whose state keeps an acceleration in balance with the forces, `M a + f = F`, takes a force P that stands over m steps h from
//! rest on as `(1 - γ) P₀ + γ P` in the first of them, P₀ the force before, and so gives it the impulse `m h P + (1 - γ) h (P₀ - P)`. With
//! the force the acceleration jumps too,
//!
//! `a⁺ = a⁻ + M⁻¹ ΔF`.
//!
//! In each step that follows the part of the acceleration that the force gives by itself is then c = M⁻¹ F at both ends, and stands: the impulse
//! is h F whatever the scheme weighs, its share of the way h² F/2 (φ h² F in the scheme of Tchamwa and Wielgosz). Displacements, velocities and
//! the energy do not jump; the term in |a|²_M of the energy that a scheme balances does, which the ledger counts as taken by the scheme.

use std::sync::Arc;

use carom_algebra::reduce::dot;

use super::Driver;
use super::owners::Attempt;
use crate::error::Error;
use crate::operator::Operators;
use crate::resultant::Resultant;
use crate::scheme::Scheme;
use crate::step_map::Impulse;
use crate::system::System;

/// Whether a force that stands over steps of a scheme begins with a jump of the acceleration; otherwise the balance of each step is that of
/// its mean force, and nothing of it remains.
fn jumps(scheme: Scheme) -> bool {
    scheme.get().step_map(1.0).impulse != Impulse::weights(0.0, 1.0)
}

impl Driver {
    /// Whether forces that stand begin with a jump of the acceleration.
    pub fn jumps(&self) -> bool {
        jumps(self.attempt.system.scheme)
    }

    /// Adds `change` (N, by unknown) to the force of links at the present instant, and to the acceleration what it gives.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub fn jump_link_force(&mut self, change: &[f64]) -> Result<(), Error> {
        self.parts.prepared = false;
        let mut jump = std::mem::take(&mut self.links.jump);
        let solved = jump.solve(&self.attempt.system, change);
        if solved.is_ok() {
            self.attempt.take_jump(change, &jump);
        }
        self.links.jump = jump;
        solved
    }
}

impl Attempt {
    /// Adds forces (N) and what they give to the state.
    fn take_jump(&mut self, change: &[f64], jump: &ForceJump) {
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

/// What forces that jump give: buffers by unknown, and the mass once they have.
#[derive(Default)]
pub(super) struct ForceJump {
    mass: Option<Operators>,
    /// Those on what is not held, N, and the solve with them.
    free: Vec<f64>,
    half: Vec<f64>,
    /// Accelerations, m/s².
    pub(super) given: Vec<f64>,
    /// Inertia, and what supports take, N.
    inertia: Vec<f64>,
    reaction: Vec<f64>,
}

impl ForceJump {
    /// M⁻¹ of forces (N) on what is not held, inertia, reactions.
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(super) fn solve(&mut self, system: &System, forces: &[f64]) -> Result<(), Error> {
        let mass = match &mut self.mass {
            Some(mass) => mass,
            none => none.insert(Operators::new(system, 1.0, 0.0, "mass matrix")?),
        };
        let buffers = [&mut self.half, &mut self.given, &mut self.inertia];
        for buffer in buffers {
            buffer.resize(forces.len(), 0.0);
        }
        let held = || forces.iter().zip(&system.fixed);
        self.free.clear();
        let free = held().map(|(force, fixed)| if *fixed { 0.0 } else { *force });
        self.free.extend(free);
        mass.begin(&self.free, &mut self.half);
        mass.end(&mut self.half, &mut self.given);
        system.mass.multiply(&self.given, &mut self.inertia);
        self.reaction.clear();
        let held = held().zip(&self.inertia);
        let held = held.map(|((force, fixed), inertia)| match fixed {
            true => inertia - force,
            false => 0.0,
        });
        self.reaction.extend(held);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::jumps;
    use crate::scheme::{EnergyMomentum, Scheme};
    use crate::step_map::Row;

    /// With c at the start and x = c at the end a force M c is in balance, and changes the velocity by dt c; the acceleration has no other memory,
    /// and what contacts of the zone give by themselves is not in it.
    #[test]
    fn an_acceleration_that_stands_is_in_balance_with_its_force_under_every_scheme() {
        let dt = 0.3;
        let mut schemes = Scheme::registered();
        schemes.push(Scheme::EnergyMomentum(EnergyMomentum {}));
        let (all, mut with_jump) = (schemes.len(), 0);
        // zones that step apart do not take stages
        schemes.retain(|scheme| scheme.get().stages().len() == 1);
        for scheme in schemes.into_iter().filter(|scheme| jumps(*scheme)) {
            with_jump += 1;
            let map = scheme.get().step_map(dt);
            assert!(scheme.get().keeps_acceleration(), "{scheme:?}");
            let of_forces = Row {
                c: 0.0,
                ..map.acceleration
            };
            assert_eq!(of_forces, Row::UNKNOWN, "{scheme:?}");
            assert!(!map.has_memory(), "{scheme:?}");
            let balance = map.inertia.a + map.inertia.x - 1.0;
            let velocity = map.velocity.a + map.velocity.x - dt;
            assert!(balance.abs() < 1e-15, "{scheme:?}: {balance}");
            assert!(velocity.abs() < 1e-15, "{scheme:?}: {velocity}");
        }
        assert!(0 < with_jump && with_jump < all, "{with_jump} of {all}");
    }
}
