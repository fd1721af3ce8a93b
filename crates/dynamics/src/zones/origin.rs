//! Where zones that are not linear are linearised for H.
//!
//! H only steers the passes; what they end at does not depend on it. It is made anew, where the zones are, after a step
//! that took many passes: after a large rotation, or where a zone has yielded.

use serde::{Deserialize, Serialize};

use super::Zones;
use crate::driver::Driver;
use crate::error::Error;

/// Passes of a step after which H is made anew.
const MANY: usize = 8;

/// Where a zone was linearised; empty of a linear zone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Displacement, m.
    pub u: Vec<f64>,
    /// Histories of its materials.
    pub history: Vec<f64>,
}

impl Origin {
    /// The present state of a zone.
    pub(super) fn of(driver: &Driver) -> Origin {
        let mut bodies = driver.system().bodies.iter();
        match bodies.all(|body| body.is_linear()) {
            true => Origin::default(),
            false => Origin {
                u: driver.state().motion.u.clone(),
                history: driver.state().motion.history.clone(),
            },
        }
    }
}

impl Zones {
    /// Takes the present states as origins if the step just accepted took many passes and they are new.
    pub(super) fn judge_origins(&mut self) {
        if self.passes <= MANY {
            return;
        }
        let origins: Vec<Origin> = self.drivers.iter().map(Origin::of).collect();
        if origins != self.origins {
            self.start_from(origins);
        }
    }

    /// Makes these the origins of H from the next step on.
    pub(super) fn start_from(&mut self, origins: Vec<Origin>) {
        self.origins = origins;
        self.kept.clear();
        self.stale = true;
    }

    /// Makes H anew if its origins are not those it was made from.
    pub(super) fn renew_condensed(&mut self) -> Result<(), Error> {
        if std::mem::take(&mut self.stale) {
            self.factorise()?;
        }
        Ok(())
    }
}
