//! The solve of an iteration, which the parts begin without contact forces and end with them.

use std::time::Instant;

use carom_contact::Rows;

use super::Parts;
use crate::driver::attempt::Attempt;
use crate::error::Error;

impl Parts {
    /// Adds to the forces in `work` what the jump of the supports gives.
    pub(crate) fn load_jump(&mut self, attempt: &mut Attempt) {
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
    pub(crate) fn solves_ended(&mut self, attempt: &Attempt) -> Result<(), Error> {
        let operators = self.effective.both();
        match operators.and_then(|(operators, _)| operators.failure()) {
            None => Ok(()),
            Some((unknown, cause)) => Err(attempt.not_solved(unknown, cause)),
        }
    }

    /// Leaves the solve with the forces in `work` to the problem of contacts.
    pub(crate) fn leave_solve(&mut self, attempt: &mut Attempt) {
        if let Some((operators, _)) = self.effective.both() {
            let vectors = &mut attempt.vectors;
            operators.leave(&vectors.work, &mut vectors.half, &mut vectors.left);
        }
    }

    /// The motion of the iteration from the begun solve with all forces in it.
    pub(crate) fn end_iteration(&mut self, attempt: &mut Attempt) {
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

    /// N x of the motion of the iteration without contact forces, of the row of that number in `rows`.
    ///
    /// `last`: the force of the row an iteration ago, N. What is added to the response of points on a rigid body, so that they share their force, is about
    /// that one in a static stage, where nothing but their iterations holds the body and its response is large: at the end nothing of it is left over.
    pub(crate) fn free_along(&self, attempt: &Attempt, number: u32, rows: &Rows, last: f64) -> f64 {
        let mut free = self.effective.free(number, &attempt.vectors.half);
        if self.floats(attempt) {
            free -= self.effective.softened(number) * last;
        }
        match attempt.jumps() {
            true => free + rows.product(number as usize, &attempt.vectors.jump),
            false => free,
        }
    }
}
