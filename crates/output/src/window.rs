//! The peak of a mean over a window of time.
//!
//! Where the exact force jumps, the largest force of a single step does not converge with the mesh: it keeps the
//! overshoot of the dispersed front. The largest mean over a fixed time converges. Both are given, side by side.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Largest mean of a step-wise constant quantity over a window of time, taken at the end of each step.
///
/// max over k of (1/T) ∫ q dt over (t_k - T, t_k), with the quantity zero before the first step. It keeps the steps of
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
