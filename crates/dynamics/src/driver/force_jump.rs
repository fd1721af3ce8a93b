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
use super::owners::Links;
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
        let system = Arc::clone(&self.attempt.system);
        let given = self.links.accelerations(&system, change)?;
        let inertia_of_scheme = self.attempt.identity_of_ledger().inertia;
        let state = &mut self.attempt.state;
        let mut inertia = vec![0.0; given.len()];
        system.mass.multiply(&given, &mut inertia);
        // Δ|a|²_M = (2 a + Δa) · M Δa
        let square = 2.0 * dot(&state.motion.a, &inertia) + dot(&given, &inertia);
        add(&mut state.motion.a, &given);
        add(&mut state.motion.link_force, change);
        let unknowns = 0..change.len();
        let held = |i: usize| match system.fixed[i] {
            true => inertia[i] - change[i],
            false => 0.0,
        };
        let reaction: Vec<f64> = unknowns.map(held).collect();
        let forces = &mut state.forces;
        add(&mut forces.link, change);
        add(&mut forces.inertia, &inertia);
        add(&mut forces.reaction, &reaction);
        let motion = &state.motion;
        let resultant = |force: &[f64]| match system.is_nonlinear() {
            true => Resultant::at(&system, (&motion.frames, &[&motion.u]), force),
            false => Resultant::of(&system, force),
        };
        let outside = [resultant(change), resultant(&reaction)];
        state.ledger.jump_force(outside, inertia_of_scheme * square);
        let outside = |i: usize| change[i] + reaction[i];
        state.exchange.jump_force(&system, outside);
        Ok(())
    }
}

/// Adds to a vector where it is kept.
fn add(kept: &mut [f64], change: &[f64]) {
    kept.iter_mut().zip(change).for_each(|(k, more)| *k += more);
}

impl Links {
    /// M⁻¹ of forces (N) on what is not held, m/s².
    ///
    /// # Errors
    /// A mass that is not positive definite.
    pub(super) fn accelerations(
        &mut self,
        system: &System,
        forces: &[f64],
    ) -> Result<Vec<f64>, Error> {
        let mass = match &mut self.mass {
            Some(mass) => mass,
            none => none.insert(Operators::new(system, 1.0, 0.0, "mass matrix")?),
        };
        let of = forces.iter().zip(&system.fixed);
        let free: Vec<f64> = of
            .map(|(force, fixed)| if *fixed { 0.0 } else { *force })
            .collect();
        let (mut half, mut given) = (vec![0.0; free.len()], vec![0.0; free.len()]);
        mass.begin(&free, &mut half);
        mass.end(&mut half, &mut given);
        Ok(given)
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
