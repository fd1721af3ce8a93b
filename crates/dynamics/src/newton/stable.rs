//! Explicit steps at finite strain: elements that shorten take the critical step down as they deform.

use super::Newton;
use crate::error::Error;

/// Part of the critical step that is taken, for what elements shorten until they are looked at again.
const PART: f64 = 0.9;

/// Parts of steps from one look at the elements to the next, which costs several of them.
const EVERY: u64 = 16;

impl Newton {
    /// How many times a step of `dt` (s) is halved for its parts to be below the critical step, which is looked at anew
    /// after every so many parts; what was found is kept in the state.
    ///
    /// # Errors
    /// A critical step below the smallest part, an element without tangent.
    pub(super) fn stable_level(&mut self, dt: f64) -> Result<u32, Error> {
        let system = &*self.system;
        let explicit = system.scheme.get().step_map(dt).force.x == 0.0;
        if !explicit || self.is_static() || system.bodies.iter().all(|body| body.is_linear()) {
            return Ok(0);
        }
        let halvings = system.nonlinear.iteration.halvings;
        let level = |largest: f64| (0..=halvings).find(|&level| dt <= largest * 2f64.powi(level as i32));
        let found = level(self.state.control.dt).unwrap_or(halvings);
        if self.state.step.is_multiple_of((EVERY >> found).max(1)) {
            let critical = system.critical_step_at(&self.state.motion)?;
            self.state.control.dt = (PART * critical).min(system.dt);
        }
        level(self.state.control.dt).ok_or_else(|| Error::Shortened {
            step: self.state.step + 1,
            time: self.state.time,
            dt: dt / 2f64.powi(halvings as i32),
            critical: self.state.control.dt / PART,
        })
    }
}
