//! `[load]`: what pulls and presses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Acceleration, Delay, SignedStress, Vector};

/// A load: gravity on every body, or a pressure or traction on a surface. In a static stage gravity and loads without
/// an amplitude grow linearly from zero to their value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [
        { "required": ["acceleration"] },
        { "required": ["pressure"] },
        { "required": ["traction"] },
    ],
    "dependentRequired" = { "pressure": ["on"], "traction": ["on"], "amplitude": ["on"] },
    "not" = { "required": ["acceleration", "on"] },
))]
pub struct Load {
    /// Acceleration of gravity, on every body.
    pub acceleration: Option<Vector<Acceleration>>,
    /// Group of the surface on which a pressure or traction acts.
    pub on: Option<String>,
    /// Pressure normal to the deformed surface, positive towards the body.
    pub pressure: Option<SignedStress>,
    /// Force per undeformed area, in a fixed direction.
    pub traction: Option<Vector<SignedStress>>,
    /// Factor as a function of time: linear between the given points, constant before the first and after the last.
    /// Default: 1.
    #[schemars(extend("minItems" = 1))]
    pub amplitude: Option<Vec<AmplitudePoint>>,
}

/// A point of a factor as a function of time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct AmplitudePoint {
    /// Time.
    pub time: Delay,
    /// Factor at that time.
    pub factor: f64,
}
