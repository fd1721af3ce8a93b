//! Where zones that are not linear are linearised for H.
//!
//! H only steers the passes; what they end at does not depend on it. It is made anew, where the zones are, after a step
//! that took many passes: after a large rotation, or where a zone has yielded.

use crate::zones::Zones;
use carom_dynamics::linearised::Origin;

/// Passes of a step after which H is made anew.
const MANY: usize = 8;

impl Zones {
    /// Takes the present states as origins if the step just accepted took many passes and they are new.
    pub(crate) fn judge_origins(&mut self) {
        if self.response.passes <= MANY {
            return;
        }
        let origins: Vec<Origin> = self.drivers.iter().map(Origin::of).collect();
        if origins != self.response.origins {
            self.start_from(origins);
        }
    }

    /// Makes these the origins of H from the next step on.
    pub(crate) fn start_from(&mut self, origins: Vec<Origin>) {
        self.response.origins = origins;
        self.response.stale = true;
    }
}
