//! Newton's restitution: the velocity law with a rebound.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Capture, ContactLaw, CurveError, Defaults, End, Level, Local, Relation, Status};

/// Newton's restitution in Moreau's form: on closed points, `0 <= ġ₊ + e ġ_k ⟂ P >= 0` with ġ₊ at the END of the step
/// and ġ_k at its start, where they approach; where they part there, and for e = 0, it is the velocity law.
///
/// Dissipative with the theta scheme for θ <= 1/(1 + e). The coefficient belongs to
/// contact points: an elastic body has a rebound of its own besides, so that in bars only e = 0 gives the exact impact; e
/// is for bodies that are rigid at the time scale of the step.
///
/// Source: Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988), section on restitution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Restitution {
    /// e, from 0 to 1.
    pub coefficient: f64,
    /// Which configuration is tested for closure; the gap as target takes the rebound away again.
    pub capture: Capture,
}

impl Restitution {
    fn excess(&self, local: &Local) -> f64 {
        self.coefficient * local.rate.min(0.0) + self.capture.excess(local)
    }
}

/// The law as the case file gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "Newton's restitution.")]
pub struct GivenRestitution {
    /// Coefficient e: 0 is the velocity law, 1 the elastic rebound of rigid bodies.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub coefficient: f64,
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, otherwise `now`.
    pub capture: Option<Capture>,
}

impl GivenRestitution {
    /// The law with its defaults.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, defaults: &Defaults) -> Result<Restitution, CurveError> {
        Ok(Restitution {
            coefficient: self.coefficient,
            capture: self.capture.unwrap_or(defaults.capture),
        })
    }
}

impl ContactLaw for Restitution {
    fn name(&self) -> &'static str {
        "restitution"
    }

    fn level(&self) -> Level {
        Level::Rate
    }

    fn capture(&self) -> f64 {
        self.capture.ahead()
    }

    fn watches(&self, gap: f64, tolerance: f64) -> Option<bool> {
        self.capture.watches(gap, tolerance)
    }

    fn reach(&self, known: f64) -> Option<f64> {
        self.capture.reach(known)
    }

    fn relation(&self, _status: Status, local: &Local) -> Relation {
        Relation {
            offset: self.excess(local),
            ..Relation::RATE
        }
    }

    fn status(&self, now: Status, end: &End, local: &Local, _reversals: u32) -> Status {
        self.capture.status(now, end, local, self.excess(local))
    }

    fn clips(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_leaves_at_e_times_its_approach() {
        let law = Restitution {
            coefficient: 0.5,
            capture: Capture::Now,
        };
        let local = Local {
            rate: -4.0,
            dt: 1.0,
            ..Local::default()
        };
        let relation = law.relation(Status::Closed, &local);
        assert_eq!(relation.rate * 2.0 + relation.offset, 0.0);
        let end = |rate| End {
            gap_released: 0.0,
            gap: 0.0,
            rate,
            force: 0.0,
        };
        assert_eq!(
            law.status(Status::Open, &end(1.9), &local, 0),
            Status::Closed
        );
        assert_eq!(law.status(Status::Open, &end(2.1), &local, 0), Status::Open);
    }
}
