//! Internal forces of explicit steps with lumped mass.

use std::time::Instant;

use rayon::prelude::*;

use super::Parts;
use super::forces::{Bodies, add_up};
use crate::driver::attempt::Attempt;
use crate::driver::attempt::forces::UNKNOWNS;
use crate::driver::explicit::leapfrog::Direct;
use crate::driver::loads::damping_rate;
use crate::error::Error;
use crate::step_map::Known;

impl Parts {
    /// Begins the step; `clean`: whether it is known which blocks have contact forces.
    pub(crate) fn begin_explicit_pass(
        &mut self,
        attempt: &mut Attempt,
        direct: &mut Direct,
        clean: bool,
    ) {
        self.residuals.clear();
        self.residuals.push(0.0);
        (self.pace.age, self.pace.fresh) = (0, attempt.state.control.pace);
        direct.clear(
            clean,
            attempt.system.dim,
            &mut attempt.next.motion.contact_force,
        );
        if !clean {
            attempt.vectors.x.fill(0.0);
        }
    }

    /// Internal forces and histories of the end.
    pub(crate) fn forces_of_end(&mut self, attempt: &mut Attempt) -> Result<(), Error> {
        let begin = Instant::now();
        self.force_sweeps += 1;
        let motion = &mut attempt.next.motion;
        motion.internal_force.fill(0.0);
        let at = Bodies {
            u: &motion.u,
            v: &[],
            from: None,
            frames: &attempt.state.motion.frames,
            history: &attempt.state.motion.history,
        };
        let out = (&mut motion.history[..], &mut motion.internal_force[..]);
        let dt = attempt.dt;
        let own = (&mut self.scratch[..], &mut self.energies);
        add_up(&attempt.system, &at, |_| dt, out, own)?;
        attempt.phases.forces += begin.elapsed();
        Ok(())
    }

    /// Forces of damping, at the velocity that is known before the forces.
    pub(crate) fn damping_of_end(&mut self, attempt: &mut Attempt) {
        if !attempt.system.has_damping() {
            return;
        }
        let (row, start) = (
            damping_rate(attempt.maps.first()),
            Known::from(&attempt.state.motion),
        );
        let (unknowns, vectors) = (attempt.system.unknowns(), &mut attempt.vectors);
        for vector in [&mut vectors.rate, &mut vectors.damping, &mut vectors.work] {
            vector.resize(unknowns, 0.0);
        }
        let rates = vectors.rate.par_chunks_mut(UNKNOWNS).enumerate();
        rates.for_each(|(chunk, rates)| {
            let first = chunk * UNKNOWNS;
            row.known(start.within(first..first + rates.len()), rates);
        });
        self.evaluate_damping(attempt);
    }
}
