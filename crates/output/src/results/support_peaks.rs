//! Largest forces of supports.

use carom_dynamics::StepReport;
use serde::{Deserialize, Serialize};

/// Largest forces of the named supports, N, and when, s.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct SupportPeaks {
    pub(crate) peaks: Vec<[f64; 2]>,
}

impl SupportPeaks {
    /// Whether this can be gone on with where there are so many supports.
    pub(crate) fn is_of(&self, supports: usize) -> bool {
        [0, supports].contains(&self.peaks.len())
    }

    /// Takes the forces of a step.
    pub(crate) fn push(&mut self, report: &StepReport) {
        self.peaks
            .resize(report.supports.len().max(self.peaks.len()), [0.0; 2]);
        for (peak, support) in self.peaks.iter_mut().zip(&report.supports) {
            let magnitude = support.linear.iter().map(|f| f * f).sum::<f64>().sqrt();
            if magnitude > peak[0] {
                *peak = [magnitude, report.time];
            }
        }
    }
}
