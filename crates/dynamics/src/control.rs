//! The size of the steps: fixed, or adapted to events.
//!
//! A step is tried, judged, and taken or dropped as a whole: a dropped one leaves nothing behind but a count. Sizes are
//! those of the ladder `largest / 2ᵏ`, so that few factors serve a whole run; only a step cut at a closing has a size of
//! its own.

use carom_system::{Adaptive, Closing};
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::landing::cut;

/// Attempts at one step after which a closing cuts it no more.
const CUTS: u32 = 10;

/// What takes adaptive steps: a driver, or the drivers of zones.
pub trait Attempts {
    /// The largest size up to `dt` (s) that is stable, s.
    ///
    /// # Errors
    /// There is none that may be taken.
    fn stable(&mut self, dt: f64) -> Result<f64, Error>;
    /// Computes the end of a step of size `dt` before one of size `next` (both s), which is not accepted.
    ///
    /// # Errors
    /// No solution.
    fn attempt(&mut self, dt: f64, next: f64) -> Result<(), Error>;
    /// When the first of the points in flight is at its lead of steps of size `planned` (s), after the start of the attempt, s;
    /// infinite where none is.
    fn first_cut(&self, rules: &Adaptive, planned: f64) -> f64;
    /// Whether the energy that the scheme balances, less the work from outside, exceeds its value at the start of the run by more
    /// than this fraction of the largest energy, at the end of the attempt.
    fn grows(&self, fraction: f64) -> bool;
    /// Looks at whether bodies go through each other in the attempt, which is the one that is taken unless it is dropped; whether a smaller step may
    /// keep them apart: a point passed what it faces without a force, or surfaces cross that a contact is between.
    fn passes(&mut self) -> bool;
    /// Gives back what an attempt that is dropped has changed.
    fn withdraw(&mut self);
    /// Number and time (s) of the state.
    fn instant(&self) -> (u64, f64);
}

/// Attempts at a step, from one of size `dt` (s) on, until one need not be dropped. `largest`: the step of the model, s;
/// `forced`: whether the first good one is dropped too, in tests. Returns what the control remembers of those dropped, and how
/// many attempts there were.
///
/// # Errors
/// An attempt of the smallest size that fails, or in which energy grows.
pub fn adapt(
    run: &mut dyn Attempts,
    (mut control, mut dt): (Control, f64),
    (rules, largest): (&Adaptive, f64),
    mut forced: bool,
) -> Result<(Control, u32), Error> {
    let taken = control.taken;
    let mut attempts = 0;
    loop {
        attempts += 1;
        dt = run.stable(dt)?;
        let outcome = run.attempt(dt, control.next(rules, largest));
        if outcome.as_ref().is_err_and(Error::is_of_any_step) {
            run.withdraw();
            return outcome.map(|()| (control, attempts));
        }
        let event = match &outcome {
            Err(_) => Some((Event::Failure, dt)),
            Ok(()) => {
                let cuts = rules.closing == Closing::Cut && attempts <= CUTS;
                let sizes = [dt, control.dt, taken];
                let cut = cuts.then(|| cut(rules, run.first_cut(rules, control.dt), sizes));
                match cut.flatten() {
                    Some(size) => Some((Event::Closing, size)),
                    // asked of each attempt: who looks takes note of it
                    None if run.passes() && 0.5 * dt >= rules.smallest => {
                        Some((Event::Passage, dt))
                    }
                    None => {
                        let grows = rules.growth.is_some_and(|fraction| run.grows(fraction));
                        grows.then_some((Event::Growth, dt))
                    }
                }
            }
        };
        let Some((event, size)) = event else {
            if std::mem::take(&mut forced) {
                run.withdraw();
                continue;
            }
            return Ok((control, attempts));
        };
        run.withdraw();
        let (step, time) = run.instant();
        let step = step + 1;
        tracing::debug!("step {step}: attempt with {dt:e} s rejected ({event:?})");
        let grown = Error::EnergyGrowth { step, time, dt };
        let smaller = control.drop(rules, event, size);
        dt = smaller.ok_or(outcome.err().unwrap_or(grown))?;
    }
}

/// Why a step was dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A contact closes within it.
    Closing,
    /// Bodies went through each other.
    Passage,
    /// Energy grew.
    Growth,
    /// It had no solution.
    Failure,
}

/// What the step control remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Size that the next step is tried with, s.
    pub dt: f64,
    /// Size of the last step, s.
    pub taken: f64,
    /// Smallest and largest step so far, s, of the dynamics once a static stage is over; zero before the first.
    pub range: [f64; 2],
    /// Attempts dropped because a contact closed within the step.
    pub cut: u64,
    /// Attempts dropped because bodies went through each other.
    pub passed: u64,
    /// Attempts dropped because energy grew.
    pub grown: u64,
    /// Attempts dropped because they had no solution.
    pub failed: u64,
    /// Part of the critical step that an explicit step at finite strain may have, s; infinite before it is known.
    pub stable: f64,
    /// Fastest compression of a point with bulk viscosity in the last step, 1/s.
    pub(crate) compression: f64,
    /// Factor by which an iteration with a fresh factor between two states reduced the residual when it was last seen; zero
    /// before.
    pub(crate) pace: f64,
    /// Steps since the last event.
    quiet: u32,
    /// Step and time from which steps of the size `taken` are counted: the instants of equal steps are products, not sums.
    origin: (u64, f64),
}

impl Control {
    /// At the start.
    pub fn start(dt: f64) -> Control {
        Control {
            dt,
            taken: dt,
            stable: f64::INFINITY,
            ..Control::default()
        }
    }

    /// At the start of the dynamics after a static stage of `step` steps that ends at `time` (s).
    #[must_use]
    pub fn after_stage(dt: f64, step: u64, time: f64) -> Control {
        Control {
            origin: (step, time),
            ..Control::start(dt)
        }
    }

    /// The instant after one more step of this size from step `step` at `time`, s.
    pub fn instant(&self, step: u64, time: f64, dt: f64) -> f64 {
        let (first, start) = match dt == self.taken {
            true => self.origin,
            false => (step, time),
        };
        start + (step + 1 - first) as f64 * dt
    }

    /// Drops an attempt of size `dt`; returns the size of the next one (`cut`: where a closing falls, s), or `None` below
    /// the smallest.
    pub fn drop(&mut self, rules: &Adaptive, event: Event, dt: f64) -> Option<f64> {
        let next = match event {
            Event::Closing => {
                self.cut += 1;
                return Some(dt);
            }
            Event::Passage => {
                self.passed += 1;
                0.5 * dt
            }
            Event::Growth => {
                self.grown += 1;
                0.5 * dt
            }
            Event::Failure => {
                self.failed += 1;
                0.5 * dt
            }
        };
        self.quiet = 0;
        if next < rules.smallest {
            return None;
        }
        while self.dt > next && 0.5 * self.dt >= rules.smallest {
            self.dt *= 0.5;
        }
        Some(next)
    }

    /// The size planned for the step after one that has no event, s. `largest`: the step of the model.
    pub fn next(&self, rules: &Adaptive, largest: f64) -> f64 {
        match self.quiet + 1 >= rules.patience {
            true => (2.0 * self.dt).min(largest),
            false => self.dt,
        }
    }

    /// Takes a step of size `dt` from step `step` at `time`. `largest`: the step of the model.
    pub fn take(
        &mut self,
        rules: Option<&Adaptive>,
        (step, time, dt): (u64, f64, f64),
        largest: f64,
    ) {
        if dt != self.taken {
            self.origin = (step, time);
        }
        self.taken = dt;
        self.range = match self.range[1] == 0.0 {
            true => [dt; 2],
            false => [self.range[0].min(dt), self.range[1].max(dt)],
        };
        let Some(rules) = rules else { return };
        let next = self.next(rules, largest);
        self.quiet = match next == self.dt {
            true => self.quiet.saturating_add(1),
            false => 0,
        };
        self.dt = next;
    }
}
