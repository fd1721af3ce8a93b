//! The velocity law: complementarity of force and gap rate on closed points.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Capture, ContactLaw, CurveError, Defaults, End, Level, Local, Relation, Status};

/// How the closed field (7.d) of the paper is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(
    description = "Which gaps switch the velocity condition on.",
    rename = "Sign"
)]
pub enum Reading {
    /// S_d = 1 where the gap is closed: the meaning.
    #[default]
    #[schemars(description = "Closed gaps.")]
    Closed,
    /// S_d = 1 where the gap is open or just touching, as the equation is printed. Bodies then pass through each
    /// other: a negative control for the laboratory, not for use. Only for captures that test a known configuration.
    #[schemars(
        description = "Open gaps, as in the printed equation (7.d): bodies pass through each other. For comparison only."
    )]
    AsPrinted,
}

/// Velocity law: on closed points, `0 <= ġ₊ ⟂ P >= 0` for the rate at the END of the step, i.e.
/// `P = S_d S_v (P - r_v ġ₊)` with S_v = 1 where `P - r_v ġ₊ > 0`. As with the displacement law nothing depends on r_v.
/// Where the gap opens at the START of the step, `0 <= ġ₊ + (1 - θ)/θ ġ ⟂ P >= 0`: contact then does no positive work, whatever
/// its rows.
/// With the gap as target, `0 <= ġ₊ + g_k/dt ⟂ P >= 0` in all points.
///
/// Source: Ben Dhia, Zammali, Voldoire, Lamarche (2003), equation (7).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Velocity {
    /// Which configuration is tested for closure.
    pub capture: Capture,
    /// How closure is read.
    pub reading: Reading,
}

/// The law as the case file gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "Impenetrability in velocity.")]
pub struct GivenVelocity {
    /// The gap that decides whether a point is closed. Default: `half` for theta = 1/2, otherwise `now`.
    pub capture: Option<Capture>,
    /// Gaps at which the condition applies.
    #[serde(default, rename = "sign")]
    pub reading: Reading,
}

impl GivenVelocity {
    /// The law with its defaults.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, defaults: &Defaults) -> Result<Velocity, CurveError> {
        Ok(Velocity {
            capture: self.capture.unwrap_or(defaults.capture),
            reading: self.reading,
        })
    }
}

impl ContactLaw for Velocity {
    fn name(&self) -> &'static str {
        "velocity"
    }

    fn level(&self) -> Level {
        Level::Rate
    }

    fn capture(&self) -> f64 {
        self.capture.ahead()
    }

    fn watches(&self, gap: f64, tolerance: f64) -> Option<bool> {
        match self.reading {
            Reading::Closed => self.capture.watches(gap, tolerance),
            Reading::AsPrinted => self.capture.watches(-gap, tolerance),
        }
    }

    fn reach(&self, known: f64) -> Option<f64> {
        self.capture.reach(known)
    }

    fn needs_free_gap(&self) -> bool {
        self.capture == Capture::Free
    }

    fn relation(&self, _status: Status, local: &Local) -> Relation {
        Relation {
            offset: self.capture.excess(local),
            ..Relation::RATE
        }
    }

    fn status(&self, now: Status, end: &End, local: &Local, _reversals: u32) -> Status {
        let excess = self.capture.excess(local);
        self.capture.status(now, end, local, excess)
    }

    fn has_weak_form(&self) -> bool {
        true
    }

    fn clips(&self) -> bool {
        false
    }
}
