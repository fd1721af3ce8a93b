//! When checkpoints are due: by simulated time, by wall time.

use std::time::{Duration, Instant as Clock};

use crate::results::settings::Checkpoints;

/// A run may spend this part of its wall time on checkpoints: one that takes longer is followed by a longer pause.
const SHARE: u32 = 100;

/// When the next checkpoint is due.
#[derive(Debug)]
pub(super) struct Due {
    /// When the last one was written, and how long at least until the next.
    last: Clock,
    pause: Duration,
    /// Simulated time of the last state seen, s.
    seen: f64,
    /// Step of the last one.
    step: Option<u64>,
}

impl Due {
    /// From a simulated time on, s.
    pub(super) fn from(seen: f64) -> Due {
        Due {
            last: Clock::now(),
            pause: Duration::ZERO,
            seen,
            step: None,
        }
    }

    /// Whether one is due at a simulated time (s) after a step, and takes note of the time; `dt`: the step of the model, s.
    pub(super) fn take(&mut self, settings: &Checkpoints, time: f64, dt: f64) -> bool {
        let due = self.is_due(settings, time, dt);
        self.seen = time;
        due
    }

    /// Whether one is due.
    pub(super) fn is_due(&self, settings: &Checkpoints, time: f64, dt: f64) -> bool {
        // instants are sums of steps: a millionth of one is rounding
        let number = |time: f64, every: f64| ((time + 1e-6 * dt) / every).floor();
        let crossed = |every: f64| number(time, every) > number(self.seen, every);
        let by_time = settings.every.is_some_and(crossed);
        let over = |wall: Duration| self.last.elapsed() >= wall.max(self.pause);
        let by_wall = settings.wall.is_some_and(over);
        by_time || by_wall
    }

    /// Whether the last one is of this step.
    pub(super) fn is_of(&self, step: u64) -> bool {
        self.step == Some(step)
    }

    /// One of this step was written in this time.
    pub(super) fn written(&mut self, step: u64, spent: Duration) {
        self.last = Clock::now();
        self.pause = SHARE * spent;
        self.step = Some(step);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(every: Option<f64>, wall: Option<u64>) -> Checkpoints {
        Checkpoints {
            every,
            wall: wall.map(Duration::from_secs),
            keep: 2,
            origin: String::new(),
        }
    }

    #[test]
    fn one_is_due_at_the_first_instant_at_or_after_each_multiple() {
        let mut due = Due::from(0.0);
        let settings = settings(Some(1.0), None);
        let taken = |k: u32| due.take(&settings, 0.3 * f64::from(k), 0.3);
        let taken: Vec<bool> = (0..11).map(taken).collect();
        let steps: Vec<usize> = (0..11).filter(|k| taken[*k]).collect();
        assert_eq!(steps, [4, 7, 10], "1.2, 2.1 and 3.0");
    }

    #[test]
    fn one_that_took_long_is_followed_by_a_pause() {
        let mut due = Due::from(0.0);
        let settings = settings(None, Some(0));
        assert!(due.take(&settings, 1.0, 1.0));
        due.written(1, Duration::from_secs(3600));
        assert!(!due.take(&settings, 2.0, 1.0));
        assert!(due.is_of(1) && !due.is_of(2));
    }
}
