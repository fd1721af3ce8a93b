//! The solve of an iteration, which is begun without contact forces and ended with them.

use std::time::Instant;

use super::owners::{Attempt, Links, Parts};
use crate::error::Error;

impl Parts {
    /// Adds to the forces in `work` what the jump of the supports gives.
    pub(super) fn load_jump(&mut self, attempt: &mut Attempt) {
        let vectors = &mut attempt.vectors;
        self.effective.load_of(&vectors.jump, &mut vectors.place);
        for (i, (r, k)) in vectors.work.iter_mut().zip(&vectors.place).enumerate() {
            *r = if attempt.system.fixed[i] { 0.0 } else { *r - k };
        }
    }

    /// Whether all solves since the last begin have ended.
    ///
    /// # Errors
    /// Iterations that did not.
    pub(super) fn solves_ended(&mut self, attempt: &Attempt) -> Result<(), Error> {
        let operators = self.effective.both();
        match operators.and_then(|(operators, _)| operators.failure()) {
            None => Ok(()),
            Some((unknown, cause)) => Err(attempt.not_solved(unknown, cause)),
        }
    }

    /// Leaves the solve with the forces in `work` to the problem of contacts.
    pub(super) fn leave_solve(&mut self, attempt: &mut Attempt) {
        if let Some((operators, _)) = self.effective.both() {
            let vectors = &mut attempt.vectors;
            operators.leave(&vectors.work, &mut vectors.half, &mut vectors.left);
        }
    }

    /// The motion of the iteration from the begun solve with all forces in it.
    pub(super) fn end_iteration(&mut self, attempt: &mut Attempt) {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.end(&mut attempt.vectors.half, &mut attempt.vectors.dx);
        }
        if attempt.vectors.jumps {
            for (dx, jump) in attempt.vectors.dx.iter_mut().zip(&attempt.vectors.jump) {
                *dx += jump;
            }
        }
        attempt.phases.sweeps += begin.elapsed();
    }
}

impl Links {
    /// The first half of the solve with the forces in `work`.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(super) fn begin_solve(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
    ) -> Result<(), Error> {
        let begin = Instant::now();
        if let Some((operators, _)) = parts.effective.both() {
            operators.begin(&attempt.vectors.work, &mut attempt.vectors.half);
        }
        attempt.vectors.left.clear();
        self.hold_links(parts, attempt);
        attempt.phases.sweeps += begin.elapsed();
        parts.solves_ended(attempt)
    }

    /// The motion `dx` that the forces in `work` and the jump of the supports give.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(super) fn free_motion(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
    ) -> Result<(), Error> {
        if attempt.jumps() {
            parts.load_jump(attempt);
        }
        self.begin_solve(parts, attempt)?;
        parts.end_iteration(attempt);
        Ok(())
    }
}
