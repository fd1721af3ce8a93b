//! The iterations of one attempt at a step.
//!
//! Where all is linear in the unknown, one iteration is all: free motion, interface problem, correction.

use super::Driver;
use super::parts::solve::WITHIN;
use super::residual::Standing;
use crate::error::Error;

/// Residual before and after an iteration beyond which the motion of the iteration is halved.
const GROWTH: f64 = 4.0;

/// Halvings of the motion of one iteration.
const SHORTENINGS: u32 = 5;

/// Imbalance over that one iteration ago up to which the iteration was a gain.
const GAIN: f64 = 0.5;

/// Largest number of iterations of a step in which parts move on along motions that nothing holds, over that of others.
const MOVES: usize = 10;

/// Imbalance over what may be rounding from which on iterations are mixed: below, their changes are noise.
const NOISY: f64 = 10.0;

impl Driver {
    /// Finds x and the contact forces of the step.
    ///
    /// # Errors
    /// No equilibrium, an element or a matrix that fails.
    pub(super) fn solve(&mut self) -> Result<(), Error> {
        match self.solve_from_guesses() {
            Err(error)
                if !self.attempt.interrupt.is_set()
                    && self.parts.leaves_iterations(&self.attempt) =>
            {
                tracing::debug!(
                    "step {}: {error}; once more with factors",
                    self.attempt.state.step + 1
                );
                self.attempt.notices.factored.add(|| error.to_string());
                self.solve_from_guesses()
            }
            other => other,
        }
    }

    fn solve_from_guesses(&mut self) -> Result<(), Error> {
        let solved = self.iterate(false);
        match solved {
            // elements inside out: once more from another guess
            Err(Error::Body(_) | Error::OnRank { .. })
                if !self.attempt.maps.is_static() && !self.contacts.is_affine(&self.parts) =>
            {
                self.iterate(true)
            }
            other => other,
        }
    }

    /// The iterations from the motion of no acceleration, or from the rigid one.
    fn iterate(&mut self, rigidly: bool) -> Result<(), Error> {
        self.begin_iterations(rigidly)?;
        if self.contacts.is_affine(&self.parts) {
            return self.solve_at_once();
        }
        let passes = self.attempt.system.nonlinear.iteration.passes;
        let (mut limit, most) = (passes, MOVES * passes);
        let mut standing = self.standing();
        let (mut pass, mut before) = (0, None);
        while pass < limit {
            if self.attempt.interrupt.is_set() {
                return Err(Error::Interrupted);
            }
            let jumps = self.attempt.jumps();
            self.parts.note_residual(standing.imbalance);
            if pass > 0 && !jumps && self.is_solved(&standing, before) {
                return self
                    .contacts
                    .check_held(&self.parts, &mut self.attempt, pass);
            }
            if self.parts.floats(&self.attempt) && !jumps && self.approach(standing.scale)? {
                self.parts.forget_mixing();
                standing = self.standing();
            }
            if self
                .contacts
                .wants_factor(&mut self.parts, &self.attempt, pass)
            {
                self.renew()?;
                self.parts.pace_mut().begin(0, pass);
            }
            self.parts.pace_mut().age += 1;
            self.parts.keep_forces(&self.attempt.next.interface);
            self.solve_interface()?;
            // a motion that contacts hardly hold is far above the noise of the forces
            // what is mixed of a motion would be mixed of the multipliers too
            if self.contacts.refines(&self.parts, &self.attempt) {
                self.refine()?;
            }
            let mixes = !jumps && !self.attempt.has_links();
            if mixes
                && (self.parts.floats(&self.attempt)
                    || standing.imbalance > NOISY * standing.rounding)
            {
                self.contacts.mix(&mut self.parts, &mut self.attempt);
            }
            if self.parts.floats(&self.attempt) && !jumps && self.restrain() {
                // the part has moved on: iterations begin anew
                limit = most.min(pass + passes);
            }
            before = Some(standing.excess);
            standing = self.go(&standing, jumps)?;
            pass += 1;
        }
        if self.is_solved(&standing, before) {
            return self
                .contacts
                .check_held(&self.parts, &mut self.attempt, limit);
        }
        Err(self.unbalanced(limit, standing.force))
    }

    /// First guess, residual and pairing of the attempt.
    pub(super) fn begin_iterations(&mut self, rigidly: bool) -> Result<(), Error> {
        self.parts.begin_iterations(self.attempt.state.control.pace);
        self.parts.take_matrices(&mut self.attempt)?;
        self.links.begin_links(&self.attempt);
        self.attempt.predict();
        if rigidly {
            self.attempt.predict_rigidly();
        }
        let interface = &mut self.attempt.next.interface;
        interface.follow(&self.attempt.state.interface);
        self.contacts.guess_slips(&mut self.attempt);
        self.contacts.take_weak(&self.attempt);
        if self.parts.is_prepared() {
            self.links.add_link_force(&mut self.attempt);
            return Ok(());
        }
        self.evaluate(true)?;
        self.attempt.vectors.ahead.clear();
        self.contacts.begin_search(&self.attempt);
        self.contacts.begin_far(&self.attempt);
        self.contacts.forget_closings();
        self.contacts.pair(&mut self.attempt, true);
        if (0..self.attempt.system.contacts.len()).any(|k| self.attempt.looks_ahead(k)) {
            self.look_ahead()?;
            self.contacts.pair(&mut self.attempt, true);
        }
        self.contacts.find_closings(&mut self.attempt);
        Ok(())
    }

    /// The one iteration of a step that is linear in the unknown.
    fn solve_at_once(&mut self) -> Result<(), Error> {
        self.parts.note_residual(0.0);
        self.solve_interface()?;
        let vectors = &mut self.attempt.vectors;
        for (x, dx) in vectors.x.iter_mut().zip(&vectors.dx) {
            *x += dx;
        }
        self.links.move_links(&self.attempt, 1.0);
        self.stages.spread(&self.contacts, &mut self.attempt);
        let norm = match self.attempt.system.is_nonlinear() {
            true => {
                self.links.scale_of_forces(&mut self.parts, &self.attempt)
                    * self.attempt.system.nonlinear.iteration.tolerance
            }
            false => 0.0,
        };
        self.parts.leave_over(norm);
        Ok(())
    }

    /// Whether iterations may end. `before`: the excess one iteration ago. Within what rounding leaves they end where they
    /// gain no more, not where they get there: what is left would be of one sign step after step, and add up. Not so under the
    /// forces of links, whose passes need answers that are smooth in them.
    fn is_solved(&self, standing: &Standing, before: Option<f64>) -> bool {
        let gains = before.is_none_or(|before| standing.excess < GAIN * before);
        let gains = gains && self.links.force().is_empty();
        // the last iteration of those that converge quadratically is long: points that stick would slip by its square
        let most = if self.contacts.refines(&self.parts, &self.attempt) {
            WITHIN
        } else {
            1.0
        };
        (standing.excess <= 1.0 || standing.is_rounding && !gains) && standing.defect <= most
    }

    /// Goes the way of the iteration, or as much of it as does not make things much worse.
    fn go(&mut self, before: &Standing, jumps: bool) -> Result<Standing, Error> {
        self.attempt
            .vectors
            .before
            .copy_from_slice(&self.attempt.vectors.x);
        let mut share = 1.0;
        let (mut last, mut gains) = (None, false);
        for shortening in 0..=SHORTENINGS {
            let vectors = &mut self.attempt.vectors;
            for (i, x) in vectors.x.iter_mut().enumerate() {
                *x = vectors.before[i] + share * vectors.dx[i];
            }
            if self.parts.floats(&self.attempt) {
                self.parts.turn(&mut self.attempt, share);
            }
            self.links.move_links(&self.attempt, share);
            match self.evaluate(false) {
                Ok(()) => {
                    self.contacts.pair(&mut self.attempt, false);
                    let standing = self.standing();
                    let grows = standing.imbalance > GROWTH * before.imbalance.max(1e-6);
                    if jumps || !grows || self.contacts.is_affine(&self.parts) {
                        (last, gains) = (Some(Ok(standing)), true);
                        break;
                    }
                    last = Some(Ok(standing));
                }
                Err(error) => last = Some(Err(error)),
            }
            if shortening < SHORTENINGS {
                share *= 0.5;
                self.parts.halve_forces(&mut self.attempt.next.interface);
                self.contacts.take_weak(&self.attempt);
            }
        }
        if jumps {
            self.attempt.shorten_jump(1.0 - share);
        }
        match last {
            Some(Ok(standing)) => {
                if !gains {
                    let place = self.attempt.place_of_imbalance();
                    self.attempt.notices.worse.add(|| place);
                }
                // a part that rolls far in one iteration deforms until the next: what is known of the way it rolls is as
                // good as before
                if share < 1.0 {
                    self.parts.forget_mixing();
                } else if standing.imbalance > before.imbalance && !self.parts.floats(&self.attempt)
                {
                    self.parts.keep_last_mixed();
                }
                Ok(standing)
            }
            Some(outcome) => outcome,
            None => Err(self.contacts.no_equilibrium(&self.parts, &self.attempt, 0)),
        }
    }
}
