//! The compliance in velocity: a one-sided damper on closed points.

use carom_quantities::SurfaceDamping;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Capture, ContactLaw, CurveError, Defaults, End, Level, Local, Relation, Status};

/// Compliance in velocity: on closed points, `p = C_n max(0, -ġ₊)` for the rate at the END of the step; the velocity
/// law is its limit for C_n → ∞. One-sided, since a damper that also pulls glues. Where the gap opens at the start of the step,
/// ġ₊ has (1 - θ)/θ ġ beside it, as with the velocity law.
///
/// With φ = C_n/(C_n + Z), Z = ρc/2 for two equal bars and ρc for one on a wall, the force is φ times that of the rigid
/// contact, and the contact absorbs 2 φ (1 - φ), on a wall 4 φ (1 - φ), of the striker's energy: 1 % at C_n = 100 ρc and
/// 400 ρc.
///
/// Source: Ben Dhia, Zammali, Voldoire, Lamarche (2003), Remark 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Compliance {
    /// C_n in Pa s/m.
    pub damping: f64,
    /// Which configuration is tested for closure.
    pub capture: Capture,
}

/// The law as the case file gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "A compliance in velocity.", extend("oneOf" = [{ "required": ["damping"] }, { "required": ["damping-factor"] }]))]
pub struct GivenCompliance {
    /// Damping per area C.
    pub damping: Option<SurfaceDamping>,
    /// C relative to the impedance per area of the softer side, in place of `damping`.
    #[schemars(extend("minimum" = 0.0))]
    pub damping_factor: Option<f64>,
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, otherwise `now`.
    pub capture: Option<Capture>,
}

impl GivenCompliance {
    /// The law with its defaults.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, defaults: &Defaults) -> Result<Compliance, CurveError> {
        let from_factor = self.damping_factor.unwrap_or(0.0) * defaults.softer.impedance;
        Ok(Compliance {
            damping: self.damping.map_or(from_factor, |damping| damping.0),
            capture: self.capture.unwrap_or(defaults.capture),
        })
    }
}

impl ContactLaw for Compliance {
    fn name(&self) -> &'static str {
        "compliance"
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

    fn needs_free_gap(&self) -> bool {
        self.capture == Capture::Free
    }

    fn relation(&self, _status: Status, local: &Local) -> Relation {
        let damping = self.damping * local.area;
        Relation {
            gap: 0.0,
            rate: damping,
            compliance: 1.0,
            offset: damping * self.capture.excess(local),
        }
    }

    fn status(&self, now: Status, end: &End, local: &Local, _reversals: u32) -> Status {
        let excess = self.capture.excess(local);
        self.capture.status(now, end, local, excess)
    }

    fn is_function(&self) -> bool {
        true
    }

    fn clips(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn force_is_the_damper_times_the_approach_and_never_pulls() {
        let law = Compliance {
            damping: 4.0,
            capture: Capture::Now,
        };
        let local = Local {
            area: 0.5,
            dt: 1.0,
            ..Local::default()
        };
        // 2 ġ₊ + P = 0
        let expected = Relation {
            gap: 0.0,
            rate: 2.0,
            compliance: 1.0,
            offset: 0.0,
        };
        assert_eq!(law.relation(Status::Closed, &local), expected);
        let end = |rate, force| End {
            gap_released: 0.0,
            gap: 0.0,
            rate,
            force,
        };
        let status = |now, end| law.status(now, &end, &local, 0);
        assert_eq!(status(Status::Open, end(-1.0, 0.0)), Status::Closed);
        assert_eq!(status(Status::Closed, end(-1.0, 2.0)), Status::Closed);
        assert_eq!(status(Status::Closed, end(1.0, -2.0)), Status::Open);
        assert_eq!(status(Status::Open, end(1.0, 0.0)), Status::Open);
    }
}
