//! Forces of the loads at the ends of the steps, their impulses and extrema.

use std::collections::BTreeMap;

use carom_dynamics::{State, StepReport, System, load_forces};
use serde::{Deserialize, Serialize};

use crate::summary::Load;

/// Forces of the loads now, and what was seen of them.
#[derive(Debug, Default)]
pub(crate) struct Loads {
    nodal: Vec<f64>,
    /// Total force of each load at the end of the last step, N.
    pub(crate) now: Vec<[f64; 3]>,
    /// By load.
    pub(crate) totals: Vec<LoadTotals>,
}

/// What was seen of a load.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct LoadTotals {
    peak: Load,
    /// At the end of the step before, N.
    last: [f64; 3],
}

impl Loads {
    /// Takes the forces at the end of a step; impulses are those of the dynamics, by the trapezoidal rule.
    pub(crate) fn push(&mut self, system: &System, state: &State, report: &StepReport) {
        if system.nonlinear.load_names.is_empty() {
            return;
        }
        let at = (report.time, &state.motion.u[..]);
        load_forces(system, at, &mut self.nodal, &mut self.now);
        self.totals.resize(self.now.len(), LoadTotals::default());
        let moves = report.step > system.static_steps();
        for (totals, now) in self.totals.iter_mut().zip(&self.now) {
            let LoadTotals { peak, last } = totals;
            for i in (0..3).filter(|_| moves) {
                peak.impulse[i] += 0.5 * report.dt * (last[i] + now[i]);
            }
            let magnitude = now.iter().map(|f| f * f).sum::<f64>().sqrt();
            if magnitude > peak.peak_force {
                (peak.peak_force, peak.force, peak.time) = (magnitude, *now, report.time);
            }
            *last = *now;
        }
    }

    /// Each load by its name.
    pub(crate) fn all(&self, system: &System) -> BTreeMap<String, Load> {
        let names = system.nonlinear.load_names.iter().cloned();
        let totals = self.totals.iter().map(|totals| totals.peak);
        names.zip(totals).collect()
    }
}
