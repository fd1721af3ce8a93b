//! Largest forces of springs and dashpots, as the forces of storeys are.

use std::collections::BTreeMap;

use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

use crate::summary::Discrete;

/// The largest so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct DiscretePeaks {
    peaks: BTreeMap<String, Discrete>,
}

impl DiscretePeaks {
    pub(crate) fn push(&mut self, system: &System, state: &State) {
        let motion = &state.motion;
        for element in system.bodies.iter().filter_map(|body| body.as_discrete()) {
            for direction in 0..element.told_directions() {
                let [force, extent] = element.response(direction, [&motion.u, &motion.v]);
                if !self.peaks.contains_key(element.name()) {
                    let fresh = Discrete {
                        kind: element.kind_name().to_owned(),
                        ..Discrete::default()
                    };
                    self.peaks.insert(element.name().to_owned(), fresh);
                }
                let Some(peak) = self.peaks.get_mut(element.name()) else {
                    continue;
                };
                if force.abs() > peak.peak_force {
                    (peak.peak_force, peak.time) = (force.abs(), state.time);
                }
                peak.extent = peak.extent.max(extent.abs());
            }
        }
    }

    pub(crate) fn all(&self) -> BTreeMap<String, Discrete> {
        self.peaks.clone()
    }
}
