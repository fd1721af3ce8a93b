//! The peak of a mean over a window of time.
//!
//! Where the exact force jumps, the largest force of a single step does not converge with the mesh: it keeps the
//! overshoot of the dispersed front. The largest mean over a fixed time converges. Both are given, side by side.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Largest mean of a step-wise constant quantity over all windows of a time T.
///
/// max over t of (1/T) ∫ q dt over (t - T, t), with the quantity zero before the first step. The mean is largest where the
/// window ends or begins at the border of two steps, so it does not depend on where the borders are. It keeps the steps of
/// the last T, whatever the length of the run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PeakOfMean {
    window: f64,
    /// Length (s) and value of the steps that reach into the window.
    recent: VecDeque<(f64, f64)>,
    span: f64,
    integral: f64,
    /// Steps since the sums were renewed.
    age: usize,
    mean: f64,
    peak: f64,
    since: f64,
}

impl PeakOfMean {
    /// A window of this length, s.
    pub fn new(window: f64) -> PeakOfMean {
        PeakOfMean {
            window,
            recent: VecDeque::new(),
            span: 0.0,
            integral: 0.0,
            age: 0,
            mean: 0.0,
            peak: 0.0,
            since: 0.0,
        }
    }

    /// Adds a step of length `dt` (s) and its value.
    pub fn push(&mut self, dt: f64, value: f64) {
        self.recent.push_back((dt, value));
        self.span += dt;
        self.integral += dt * value;
        self.age += 1;
        // a step that reaches into the window by rounding alone lies outside
        let slack = 1e-9 * self.window;
        while let Some(&(first, old)) = self.recent.front()
            && self.span - first >= self.window - slack
        {
            self.recent.pop_front();
            self.span -= first;
            self.integral -= first * old;
            // the window that begins with the step that is now the first
            let beyond = (self.span - self.window).max(0.0);
            self.take_mean((self.integral - beyond * value) / self.window);
        }
        if self.age > self.recent.len() {
            // running sums gather rounding: they are renewed once per window
            self.age = 0;
            self.span = self.recent.iter().map(|(dt, _)| dt).sum();
            self.integral = self.recent.iter().map(|(dt, value)| dt * value).sum();
        }
        let outside = (self.span - self.window).max(0.0);
        let before = self
            .recent
            .front()
            .map_or(0.0, |(_, value)| outside * value);
        let mean = (self.integral - before) / self.window;
        self.mean = mean;
        self.take_mean(mean);
    }

    fn take_mean(&mut self, mean: f64) {
        self.peak = self.peak.max(mean);
        self.since = self.since.max(mean);
    }

    /// Mean over the window that ends with the last step.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Largest mean so far; zero if none was positive.
    pub fn peak(&self) -> f64 {
        self.peak
    }

    /// Largest mean over the windows that ended since the last call.
    pub fn take(&mut self) -> f64 {
        std::mem::take(&mut self.since)
    }
}

#[cfg(test)]
mod tests {
    use super::PeakOfMean;

    /// Peak of the mean over 1 s of a pulse of 3 N that lasts 0.6 s from 1.3 s on, in steps of `dt`.
    fn of_pulse(dt: f64) -> f64 {
        let mut mean = PeakOfMean::new(1.0);
        for k in 0..(4.0 / dt).round() as usize {
            let time = (k as f64 + 0.5) * dt;
            mean.push(dt, if (1.3..1.9).contains(&time) { 3.0 } else { 0.0 });
        }
        mean.peak()
    }

    #[test]
    fn the_window_is_the_same_whatever_the_step() {
        // 0.6 s of 3 N in a window of 1 s; each step divides the borders of the pulse
        for dt in [0.1, 0.05, 0.02, 0.01] {
            assert!((of_pulse(dt) - 1.8).abs() < 1e-9, "{dt}");
        }
    }

    #[test]
    fn a_window_that_begins_with_a_step_counts_too() {
        // 2 N for 0.75 s, 1 N for 0.75 s: the best window of 1 s begins with the first
        let mut mean = PeakOfMean::new(1.0);
        mean.push(0.75, 0.0);
        mean.push(0.75, 2.0);
        mean.push(0.75, 1.0);
        assert!((mean.peak() - 1.75).abs() < 1e-12, "{}", mean.peak());
    }

    #[test]
    fn a_step_longer_than_the_window_has_its_own_value_as_mean() {
        let mut mean = PeakOfMean::new(0.1);
        for value in [0.0, 5.0, 1.0] {
            mean.push(1.0, value);
        }
        assert!((mean.peak() - 5.0).abs() < 1e-12);
    }
}
