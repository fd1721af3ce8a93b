//! The hybrid displacement law: exact Signorini conditions in the gap.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ContactLaw, CurveError, Defaults, End, Level, Local, Relation, Status};

/// Hybrid displacement law, `p = S_g (p - r g)` with S_g = 1 where `p - r g > 0`: the gap at the end of the step is
/// zero where the force is compressive, and positive where there is none. Not a penalty; the result does not depend
/// on r, which is why r appears nowhere: in a closed point g₊ = 0, so the sign is that of P, in an open one P = 0, so
/// it is that of -g₊. The sign is strict, else points released at rest stick.
///
/// Source: Ben Dhia, Zammali, Voldoire, Lamarche (2003), equations (2)-(4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "Exact non-penetration.")]
pub struct Displacement {
    /// Whether velocity and acceleration are projected on the admissible ones, `N v₊ >= 0` and `N a₊ >= 0`, at the end
    /// of a step in which points close: the cure for the oscillation under Newmark's scheme. The law itself is the
    /// same; the driver projects.
    #[serde(default)]
    #[schemars(
        description = "Whether velocity and acceleration of closed points are projected at the end of a step in which points close. This removes the oscillation of the force under Newmark's scheme; other schemes refuse it."
    )]
    pub projection: bool,
}

impl Displacement {
    /// The law as it is given.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, _defaults: &Defaults) -> Result<Displacement, CurveError> {
        Ok(*self)
    }
}

impl ContactLaw for Displacement {
    fn name(&self) -> &'static str {
        "displacement"
    }

    fn level(&self) -> Level {
        Level::Gap
    }

    fn capture(&self) -> f64 {
        0.0
    }

    fn watches(&self, _gap: f64, _tolerance: f64) -> Option<bool> {
        None
    }

    fn relation(&self, _status: Status, _local: &Local) -> Relation {
        Relation::GAP
    }

    fn status(&self, now: Status, end: &End, _local: &Local, _reversals: u32) -> Status {
        let closed = match now {
            Status::Open => end.gap < 0.0,
            Status::Closed | Status::Corner | Status::Piece(_) => end.force > 0.0,
        };
        if closed { Status::Closed } else { Status::Open }
    }

    fn projects(&self) -> bool {
        self.projection
    }

    fn has_weak_form(&self) -> bool {
        !self.projection
    }

    fn clips(&self) -> bool {
        false
    }
}
