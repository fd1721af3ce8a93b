//! The penalty law: a given stiffness, with or without a damper.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ContactLaw, CurveError, Damped, Defaults, End, Level, Local, Relation, Status};

/// Penalty, `p = k max(0, -g₊)`, with a damper if one is given: the damped law, whose stiffness and damping here are
/// the user's and not the material's. Bodies penetrate by p/k.
///
/// Source: Wriggers, Computational Contact Mechanics (2006), chapter on penalty methods.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline)]
pub struct Penalty(
    /// k in Pa/m, damping in Pa s/m or zero, and what becomes of tension.
    pub Damped,
);

impl Penalty {
    /// The law as it is given.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, _defaults: &Defaults) -> Result<Penalty, CurveError> {
        Ok(*self)
    }
}

impl ContactLaw for Penalty {
    fn name(&self) -> &'static str {
        "penalty"
    }

    fn level(&self) -> Level {
        self.0.level()
    }

    fn capture(&self) -> f64 {
        self.0.capture()
    }

    fn watches(&self, gap: f64, tolerance: f64) -> Option<bool> {
        self.0.watches(gap, tolerance)
    }

    fn reach(&self, _known: f64) -> Option<f64> {
        Some(1.0)
    }

    fn relation(&self, status: Status, local: &Local) -> Relation {
        self.0.relation(status, local)
    }

    fn status(&self, now: Status, end: &End, local: &Local, reversals: u32) -> Status {
        self.0.status(now, end, local, reversals)
    }

    fn is_function(&self) -> bool {
        self.0.damping == 0.0
    }

    fn clips(&self) -> bool {
        self.0.clips()
    }
}
