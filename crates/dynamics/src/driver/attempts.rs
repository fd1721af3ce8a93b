//! One attempt at a step: the stages of the scheme before it, the step, the stages after it, balance and records.

use std::time::Instant;

use super::Driver;
use crate::error::Error;
use crate::report::Notices;

impl Driver {
    /// Computes the next state from the state, a step or a stage of it of `dt` further, of an explicit scheme before one of the size `next`
    /// (both s).
    pub(super) fn attempt_stage(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        self.attempt.notices = Notices::default();
        let outcome = self.attempt_to_the_end(dt, next);
        self.attempt.unless_interrupted(outcome)
    }

    fn attempt_to_the_end(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        self.contacts.begin_attempt();
        self.parts.return_to_iterations();
        self.contacts.renew_targets(&self.attempt);
        self.attempt.hide_followed();
        self.contacts.size(&mut self.attempt, dt, next);
        self.begin_stage()?;
        let outcome = self.attempt_after_jump(Driver::solve_step);
        self.stages.forget_predictor(&mut self.attempt);
        outcome?;
        self.parts.check_viscosity(&self.attempt, dt)?;
        self.attempt.delete_elements()?;
        if self.is_known_finite() {
            return Ok(());
        }
        self.check_finite_on_ranks()
    }

    pub(super) fn solve_step(&mut self) -> Result<(), Error> {
        if self.is_direct() {
            return self.explicit_step();
        }
        self.leave_direct();
        self.attempt.vectors.make_room(&self.attempt.state.motion);
        if !self.parts.is_prepared() {
            self.stages
                .project_predictor(&mut self.contacts, &mut self.attempt)?;
        }
        self.solve_on_the_clock()?;
        let (solved, forces) = (Instant::now(), self.attempt.phases.forces);
        self.advance()?;
        self.balance();
        self.project()?;
        self.restore();
        self.record();
        self.record_links();
        let forces = self.attempt.phases.forces - forces;
        self.attempt.phases.balance += solved.elapsed().saturating_sub(forces);
        Ok(())
    }

    /// Solves, and counts as contact the time that is not counted elsewhere; that of attempts that fail too.
    fn solve_on_the_clock(&mut self) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.attempt.phases);
        let solved = self.solve();
        self.attempt.count_contact(begin, before);
        solved
    }

    /// Runs an attempt from the velocity after the jump of the supports; the state keeps the one before it.
    fn attempt_after_jump(
        &mut self,
        attempt: impl FnOnce(&mut Driver) -> Result<(), Error>,
    ) -> Result<(), Error> {
        if !self.balances.find_jump(&self.attempt)? {
            return attempt(self);
        }
        self.balances.exchange_jump(&mut self.attempt.state.motion);
        let outcome = attempt(self);
        self.balances.exchange_jump(&mut self.attempt.state.motion);
        outcome
    }
}
