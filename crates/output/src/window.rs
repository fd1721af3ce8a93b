//! The peak of a mean over a window of time.
//!
//! Where the exact force jumps, the largest force of a single step does not converge with the mesh: it keeps the
//! overshoot of the dispersed front. The largest mean over a fixed time converges. Both are given, side by side.

/// Largest mean of a step-wise constant quantity over a window of whole steps, step by step.
///
/// max over k of (1/m) Σ q_j, j = k - m + 1 .. k, with the quantity zero before the first step. It keeps the last m
/// values, whatever the length of the run.
#[derive(Clone, Debug)]
pub struct PeakOfMean {
    recent: Vec<f64>,
    next: usize,
    sum: f64,
    peak: f64,
    since: f64,
}

impl PeakOfMean {
    /// A window of so many steps (at least one).
    pub fn new(steps: usize) -> PeakOfMean {
        PeakOfMean {
            recent: vec![0.0; steps.max(1)],
            next: 0,
            sum: 0.0,
            peak: 0.0,
            since: 0.0,
        }
    }

    /// Number of steps of the window.
    pub fn steps(&self) -> usize {
        self.recent.len()
    }

    /// Adds the value of a step.
    pub fn push(&mut self, value: f64) {
        self.sum += value - self.recent[self.next];
        self.recent[self.next] = value;
        self.next += 1;
        if self.next == self.recent.len() {
            // A running sum gathers rounding: it is renewed once per window.
            self.next = 0;
            self.sum = self.recent.iter().sum();
        }
        let mean = self.sum / self.recent.len() as f64;
        self.peak = self.peak.max(mean);
        self.since = self.since.max(mean);
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
