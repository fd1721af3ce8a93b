//! Matrices of the parts.

use std::sync::Arc;
use std::time::Instant;

use super::Parts;
use crate::driver::attempt::Attempt;
use crate::error::Error;

impl Parts {
    /// Takes the matrices of the attempt: those of linear parts are ready with it.
    pub(crate) fn take_matrices(&mut self, attempt: &mut Attempt) -> Result<(), Error> {
        if self.effective.stands(&attempt.maps) {
            return Ok(());
        }
        let begin = Instant::now();
        let system = Arc::clone(&attempt.system);
        let iterated = (0..system.parts.len()).map(|part| self.is_iterated(attempt, part));
        let iterated = iterated.collect();
        let between = attempt.between();
        let taken = self
            .effective
            .take(&system, &attempt.maps, iterated, between);
        attempt.phases.factorisation += begin.elapsed();
        taken
    }

    /// Whether the matrix of a part changes within a step.
    fn is_iterated(&self, attempt: &Attempt, part: usize) -> bool {
        let system = &*attempt.system;
        if attempt.maps.of(system.parts[part].start).force.x == 0.0 {
            return false;
        }
        let mut bodies = (0..system.bodies.len()).filter(|&k| system.part_of_body[k] == part);
        let own = &system.parts[part];
        let mut pieces = self.floating.pieces.iter();
        let floats = self.floats(attempt) && pieces.any(|piece| own.contains(&piece.unknowns[0]));
        let changes = |k: usize| !system.bodies[k].is_linear() || system.nonlinear.has_follower(k);
        floats || bodies.any(changes)
    }
}
