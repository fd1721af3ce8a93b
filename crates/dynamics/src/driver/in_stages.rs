//! A step of a scheme of several stages: each stage is solved as a step of its own, from the end of the one before.
//!
//! Contact forces of a stage are reported with its end. An attempt that is dropped leaves the state with which the step began.

use super::Driver;
use crate::error::Error;
use crate::report::Notices;

impl Driver {
    /// Computes the end of a step of `dt` from the state, of an explicit scheme before one of the size `next` (both s), in all stages of the
    /// scheme. The last of them leaves the state at its start; [`Driver::withdraw_stages`] gives that of the step back.
    pub(super) fn attempt(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        let stages = self.attempt.stages();
        self.attempt.stage.of = dt;
        if stages == 1 {
            self.attempt.stage.number = 0;
            return self.attempt_stage(dt, next);
        }
        self.origin = None;
        self.early.clear();
        let outcome = self.attempt_stages(stages);
        if outcome.is_err() {
            self.withdraw_stages();
        }
        outcome
    }

    fn attempt_stages(&mut self, stages: usize) -> Result<(), Error> {
        let (step, control) = (self.attempt.state.step, self.attempt.control());
        let mut notices = Notices::default();
        for number in 0..stages {
            self.attempt.stage.number = number;
            let length = self.attempt.stage.length();
            self.attempt_stage(length, length)?;
            notices.join(&self.attempt.notices);
            if number + 1 == stages {
                break;
            }
            self.note_arrivals(length);
            let to = self.attempt.state.time + length;
            self.report.add_part(to, self.attempt.durations(0).force);
            let state = &self.attempt.state;
            self.origin.get_or_insert_with(|| Box::new(state.clone()));
            self.swap_states();
            let state = &mut self.attempt.state;
            (state.step, state.time, state.control) = (step, to, control);
        }
        self.attempt.notices = notices;
        Ok(())
    }

    /// Notes the points in flight that close in a stage of this length (s), which the end of the step does not show.
    fn note_arrivals(&mut self, length: f64) {
        let Some(rules) = self.attempt.system.adaptive else {
            return;
        };
        let begun = self.attempt.stage.begun();
        let all = self.arrivals((&rules, self.attempt.system.dt), begun);
        let closed = all.into_iter().filter(|(_, at)| *at <= begun + length);
        self.early.extend(closed);
    }

    /// Makes the state that with which the step began, where stages of it are over, and forgets what these have reported.
    pub(super) fn withdraw_stages(&mut self) {
        if let Some(origin) = self.origin.take() {
            let start = origin.time;
            self.report.samples.retain(|part| part.time <= start);
            self.attempt.state = *origin;
            self.leave_direct();
        }
    }
}
