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

use super::Driver;
use crate::error::Error;
use crate::scheme::Scheme;
use crate::step_map::Impulse;

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
        self.parts.set_prepared(false);
        let jump = self.links.solve_jump(&self.attempt.system, change)?;
        self.attempt.take_jump(change, jump);
        Ok(())
    }
}
