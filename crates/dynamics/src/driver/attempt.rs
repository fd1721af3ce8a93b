//! One attempt at a step: the stages of the scheme before it, the step, the stages after it, balance and records.

use std::time::Instant;

use super::Driver;
use crate::costs::Phases;
use crate::error::Error;
use crate::report::Notices;

impl Driver {
    /// Computes the next state from the state, a step of `dt` further, of an explicit scheme before one of the size `next`
    /// (both s).
    pub(super) fn attempt(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        self.notices = Notices::default();
        let outcome = self.attempt_to_the_end(dt, next);
        self.unless_interrupted(outcome)
    }

    fn attempt_to_the_end(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        (self.failed, self.failed_friction) = (None, None);
        self.effective.return_to_iterations();
        self.renew_targets();
        self.hide_followed();
        self.size(dt, next);
        self.begin_stage()?;
        let outcome = self.attempt_after_jump(Driver::take_stages);
        self.forget_predictor();
        outcome?;
        self.check_viscosity(dt)?;
        self.delete_elements()?;
        if self.is_known_finite() {
            return Ok(());
        }
        self.check_finite_on_ranks()
    }

    pub(super) fn take_stages(&mut self) -> Result<(), Error> {
        if self.is_direct() {
            return self.step_directly();
        }
        self.leave_direct();
        self.vectors.make_room(&self.state.motion);
        if !self.prepared {
            self.project_predictor()?;
        }
        self.solve_on_the_clock()?;
        let (solved, forces) = (Instant::now(), self.phases.forces);
        self.advance()?;
        self.balance();
        self.project()?;
        self.restore();
        self.record();
        self.record_links();
        let forces = self.phases.forces - forces;
        self.phases.balance += solved.elapsed().saturating_sub(forces);
        Ok(())
    }

    /// Solves, and counts as contact the time that is not counted elsewhere; that of attempts that fail too.
    fn solve_on_the_clock(&mut self) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.phases);
        let solved = self.solve();
        self.count_contact(begin, before);
        solved
    }

    /// Counts as contact the time since `begin` that has not been added to the phases `before` elsewhere.
    pub(super) fn count_contact(&mut self, begin: Instant, before: Phases) {
        let counted = |phases: &Phases| {
            phases.factorisation + phases.forces + phases.sweeps + phases.friction
        };
        let counted = counted(&self.phases) - counted(&before);
        self.phases.contact += begin.elapsed().saturating_sub(counted);
    }

    /// Runs an attempt from the velocity after the jump of the supports; the state keeps the one before it.
    fn attempt_after_jump(
        &mut self,
        attempt: impl FnOnce(&mut Driver) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if !self.find_jump()? {
            return attempt(self);
        }
        self.jump.exchange(&mut self.state.motion.v);
        let outcome = attempt(self);
        self.jump.exchange(&mut self.state.motion.v);
        outcome
    }

    /// Computes the jump of the supports at the start of the step; tells whether there is one.
    fn find_jump(&mut self) -> Result<bool, Error> {
        if self.maps.is_static() || self.system.nonlinear.follows.is_empty() {
            self.jump.clear();
            return Ok(false);
        }
        let span = [self.state.time, self.dt];
        self.jump.find(&self.system, &self.state.motion, span)
    }
}
