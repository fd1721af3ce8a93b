//! A step as the caller sees it: attempts until one is taken or none is left.
//!
//! An adaptive step is cut where a contact closes, and halved where energy grows or no solution is found. A step of fixed
//! size that finds no solution is taken in halves of halves.

use std::sync::Arc;

use carom_algebra::Interrupt;

use super::Driver;
use crate::certificate::Certificate;
use crate::control::{Attempts, Control, adapt};
use crate::costs::Costs;
use crate::error::Error;
use crate::march::{FailedProblem, Going, Scope, Stepper};
use crate::report::{Notices, StepReport};
use crate::state::State;
use crate::system::{Adaptive, System};

/// Halvings of a step in which bodies go through each other, where more than of one without a solution: a part is so short then that bodies at any
/// speed that a mesh resolves come closer by a small part of an element.
const DEEPEST: u32 = 12;

impl Driver {
    /// Takes one step. With an adaptive step, attempts in which a contact closes, energy grows, or no solution is found are
    /// dropped, and a smaller one is tried. Another step is taken whole, or in halves of halves where it finds no equilibrium, where bodies go
    /// through each other, and of an explicit scheme where elements have become too small for it; a step that is a fraction of the critical one is shorter then.
    ///
    /// # Errors
    /// A contact problem without solution, no equilibrium, a motion that is not finite, or energy that grows, with steps that are fixed
    /// or the smallest. The state is then the one before the step.
    pub fn step(&mut self) -> Result<(), Error> {
        self.report.attempts = 0;
        self.report.samples.clear();
        self.report.notices = Notices::default();
        self.look_from_here();
        match self.attempt.system.adaptive.is_some() && !self.attempt.is_static() {
            true => self.adapted_step(),
            false => self.step_in_parts(),
        }
    }

    fn adapted_step(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let Some(rules) = &system.adaptive else {
            return Ok(());
        };
        self.renew_stable(self.attempt.state.control.dt)?;
        let control = self.attempt.control();
        let first = self.unplanned.take().unwrap_or(control.dt);
        let forced = self.is_forced();
        let (step, time) = (self.attempt.state.step, self.attempt.state.time);
        let (mut control, attempts) = adapt(self, (control, first), (rules, system.dt), forced)?;
        self.report.attempts = attempts;
        self.report.notices.join(&self.attempt.notices);
        let size = self.attempt.stage.of;
        self.attempt.next.step = step + 1;
        self.attempt.next.time = self.attempt.state.control.instant(step, time, size);
        control.take(Some(rules), (step, time, size), system.dt);
        if self.attempt.stages() > 1 {
            self.add_last_part(self.attempt.next.time);
            self.report.join_parts();
        }
        self.accept(control, size);
        Ok(())
    }

    fn step_in_parts(&mut self) -> Result<(), Error> {
        let (taken, first) = (self.attempt.state.step, self.attempt.state.time);
        let planned = self.unplanned.take();
        self.renew_stable(planned.unwrap_or(self.attempt.state.control.taken))?;
        let size = self.size_of_step(planned)?;
        let end = self.attempt.end_of_step(size);
        let whole = self.stable_level(end - first)?;
        let mut control = self.attempt.control();
        let (mut done, mut level) = (0u64, whole);
        // a cause that an attempt has named says more than the end of the last one
        let mut unheld: Option<Error> = None;
        let mut indefinite = false;
        // kept only by a step that goes in parts
        let mut start: Option<State> = None;
        let most = self.attempt.most_halvings();
        let (mut cuts, mut was_cut) = (true, false);
        // of linear models the matrices stand, and the schemes may count on equal steps
        let deepest = if most > 0 { most.max(DEEPEST) } else { 0 };
        let parts = 1u64 << deepest;
        let mut forced = self.is_forced();
        while done < parts {
            let part = parts >> level;
            let to = first + (end - first) * ((done + part) as f64 / parts as f64);
            self.report.attempts += 1;
            let dt = size * (part as f64 / parts as f64);
            match self.attempt(dt, dt) {
                Ok(()) if std::mem::take(&mut forced) => self.withdraw_stages(),
                Ok(()) if self.crosses(to) && cuts && level < deepest => {
                    let step = taken + 1;
                    tracing::debug!("step {step}: bodies went through each other; halved");
                    self.withdraw_stages();
                    control.passed += 1;
                    level += 1;
                    was_cut = true;
                }
                Ok(()) => {
                    self.report.notices.join(&self.attempt.notices);
                    done += part;
                    if (part < parts || self.attempt.stages() > 1) && !self.attempt.is_static() {
                        self.add_last_part(to);
                    }
                    if done < parts {
                        let before = self.origin.take();
                        let state = &self.attempt.state;
                        start.get_or_insert_with(|| {
                            before.map_or_else(|| state.clone(), |state| *state)
                        });
                        self.swap_states();
                        self.attempt.state.time = to;
                        self.certify();
                        // parts of a step are of the same stage
                        (self.attempt.state.step, self.attempt.state.control) = (taken, control);
                    }
                    while level > whole
                        && done.is_multiple_of(2 * part)
                        && done.is_multiple_of(parts >> (level - 1))
                    {
                        level -= 1;
                    }
                }
                Err(error) if was_cut && level >= most && !error.is_of_any_step() => {
                    tracing::debug!("step {}: {error} in a part; not cut", taken + 1);
                    if let Some(start) = start.take() {
                        self.attempt.state = start;
                        self.leave_direct();
                        self.uncertify();
                    }
                    self.report.samples.clear();
                    (done, level, cuts, was_cut) = (0, whole, false, false);
                }
                Err(error) if level < most && !error.is_of_any_step() => {
                    tracing::debug!("step {}: {error}; halved", taken + 1);
                    indefinite |= is_indefinite(&error);
                    if matches!(error, Error::Unheld { .. }) {
                        unheld.get_or_insert(error);
                    }
                    control.failed += 1;
                    level += 1;
                }
                Err(error) => {
                    if let Some(start) = start {
                        self.attempt.state = start;
                        self.leave_direct();
                        self.uncertify();
                    }
                    if error.is_of_any_step() {
                        return Err(error);
                    }
                    indefinite |= is_indefinite(&error);
                    let error = unheld.unwrap_or(error);
                    return Err(
                        match indefinite
                            && self.attempt.is_static()
                            && !self.parts.floats(&self.attempt)
                        {
                            true => Error::Unstable {
                                cause: Box::new(error),
                            },
                            false => error,
                        },
                    );
                }
            }
        }
        control.take(None, (taken, first, size), self.attempt.system.dt);
        self.attempt.next.step = taken + 1;
        self.attempt.next.time = end;
        control.pace = self.parts.pace().fresh;
        self.report.join_parts();
        self.accept(control, size);
        Ok(())
    }

    /// Reports what the contacts did in the part of a step, or the last stage of it, that ends at `to` (s).
    fn add_last_part(&mut self, to: f64) {
        let dt = match self.attempt.stages() > 1 {
            true => self.attempt.durations(0).force,
            false => self.attempt.dt,
        };
        self.report.add_part(to, dt);
    }

    /// Makes the attempt, a step of `size` (s), the state.
    pub(super) fn accept(&mut self, control: Control, size: f64) {
        self.origin = None;
        self.attempt.next.control = control;
        self.attempt.next.control.compression = self.parts.stored().compression;
        self.parts.set_prepared(false);
        self.swap_states();
        self.certify();
        self.attempt.show_followed(size);
        self.tell(size);
    }

    /// The system of the dynamics, in a static stage too.
    fn whole(&self) -> Arc<System> {
        Arc::clone(self.released.as_ref().unwrap_or(&self.attempt.system))
    }

    /// Has the steps from the state on looked at, if they are not, and those before it were.
    pub(super) fn look_from_here(&mut self) {
        let is_whole = !self.is_zone && !self.ranks.are_several();
        if is_whole && self.certificate.is_none() {
            self.certificate = Certificate::of(&self.whole(), &self.attempt.state);
        }
    }

    /// Looks at whether bodies go through each other in the attempt, which ends at `to` (s), in a way that a smaller step may keep them from. Ranks take
    /// the step all the same: each knows of its own points alone.
    fn crosses(&mut self, to: f64) -> bool {
        if self.ranks.are_several() {
            return false;
        }
        let (system, state) = (self.whole(), &self.attempt.state);
        let start = self.origin.as_deref().unwrap_or(state);
        let next = &mut self.attempt.next;
        let crosses = self.certificate.as_mut().is_some_and(|certificate| {
            let mut told = next.crossings.take().unwrap_or_default();
            let from = (start.crossings.as_ref(), start.time);
            let crosses = certificate.look_at(&system, from, (to, next), &mut told);
            next.crossings = Some(told);
            crosses
        });
        let passed = self.contacts.sums().iter().map(|of| of.passed);
        crosses || passed.sum::<u64>() > 0
    }

    /// Has the certificate go on from the state, an attempt that it has looked at.
    fn certify(&mut self) {
        let system = self.whole();
        if let Some(certificate) = &mut self.certificate {
            certificate.accept();
            certificate.start_from(&system, &self.attempt.state);
        }
    }

    /// Has it go on from a state before that.
    fn uncertify(&mut self) {
        let system = self.whole();
        if let Some(certificate) = &mut self.certificate {
            certificate.go_back(&system, &self.attempt.state);
        }
    }

    /// Size of the next step, s: the same bits for equal steps, so that a constant matrix is.
    ///
    /// # Errors
    /// A critical step below the smallest part.
    fn size_of_step(&self, planned: Option<f64>) -> Result<f64, Error> {
        match self.attempt.system.nonlinear.preload {
            Some(preload) if self.attempt.is_static() => Ok(preload.end / preload.steps as f64),
            _ => planned.map_or_else(|| self.followed_step(), Ok),
        }
    }

    /// Sets the size that the next step is tried with, s, for tests: what an event after the last step would do.
    pub fn force_size(&mut self, dt: f64) {
        self.unplanned = Some(dt);
    }

    /// Tries every `every`-th step once more after dropping its first attempt, which must change no bit of the results: for
    /// tests.
    pub fn force_rejections(&mut self, every: u64) {
        self.forced = Some(every);
    }

    fn is_forced(&self) -> bool {
        let next = self.attempt.state.step + 1;
        self.forced.is_some_and(|every| next.is_multiple_of(every))
    }
}

/// Whether a matrix was not positive definite.
fn is_indefinite(error: &Error) -> bool {
    use carom_algebra::Error::NotPositiveDefinite;
    matches!(
        error,
        Error::Factor {
            cause: NotPositiveDefinite { .. },
            ..
        }
    )
}

impl Attempts for Driver {
    fn stable(&mut self, dt: f64) -> Result<f64, Error> {
        let level = self.stable_level(dt)?;
        Ok(match level > 0 {
            true => dt / (1u64 << level) as f64,
            false => dt,
        })
    }

    fn attempt(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        Driver::attempt(self, dt, next)
    }

    fn first_cut(&self, rules: &Adaptive, planned: f64) -> f64 {
        Driver::first_cut(self, (rules, self.attempt.system.dt), planned)
    }

    fn grows(&self, fraction: f64) -> bool {
        let ledger = &self.attempt.next.ledger;
        ledger.free_energy() > fraction * ledger.largest_energy
    }

    fn passes(&mut self) -> bool {
        let state = &self.attempt.state;
        let start = self.origin.as_deref().unwrap_or(state).time;
        let size = self.attempt.stage.of;
        self.crosses(state.control.instant(state.step, start, size))
    }

    /// An attempt of one stage leaves nothing behind.
    fn withdraw(&mut self) {
        self.withdraw_stages();
    }

    fn instant(&self) -> (u64, f64) {
        (self.attempt.state.step, self.attempt.state.time)
    }
}

impl Stepper for Driver {
    fn step(&mut self) -> Result<(), Error> {
        self.step()
    }

    fn system(&self) -> &System {
        self.system()
    }

    fn state(&self) -> &State {
        self.state()
    }

    fn report(&self) -> &StepReport {
        self.report()
    }

    fn saved(&self) -> Result<Vec<u8>, Error> {
        self.state().to_bytes()
    }

    fn costs(&self) -> Costs {
        self.costs()
    }

    fn certificate(&self) -> Option<&Certificate> {
        self.certificate.as_ref()
    }

    fn failed_problem(&self) -> Option<FailedProblem<'_>> {
        self.contacts.failed_problem()
    }

    fn agree(&mut self, own: Going) -> Going {
        self.agree_on_ranks(own)
    }

    fn bring(&mut self, scope: Scope) {
        self.bring_on_ranks(scope);
    }

    fn heed(&mut self, interrupt: &Interrupt) {
        self.heed(interrupt);
    }
}
