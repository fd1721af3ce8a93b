//! `[load]`: what pulls and presses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{Acceleration, Delay, SignedForce, SignedMoment, SignedStress, Vector};

/// A load: gravity or a base acceleration on every body, a pressure or traction on a surface, a force or moment at nodes. In a
/// static stage gravity and loads without an amplitude grow linearly from zero to their value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend(
    "oneOf" = [
        { "required": ["acceleration"] },
        { "required": ["base-acceleration"] },
        { "required": ["pressure"] },
        { "required": ["traction"] },
        { "required": ["force"] },
        { "required": ["moment"] },
    ],
    "dependentRequired" = {
        "pressure": ["on"], "traction": ["on"], "force": ["on"], "moment": ["on"], "amplitude": ["on"],
    },
))]
pub struct Load {
    /// Acceleration of gravity, on every body.
    pub acceleration: Option<Vector<Acceleration>>,
    /// Acceleration of the ground, by names of signals. The run is then relative to the ground: supports, obstacles and
    /// `"ground"` move with it, displacements, velocities and accelerations are those relative to it, and every mass m feels the
    /// inertia force -m a.
    pub base_acceleration: Option<BaseAcceleration>,
    /// Group of the surface on which a pressure or traction acts, or of the nodes of a force or moment.
    pub on: Option<String>,
    /// Pressure normal to the deformed surface, positive towards the body.
    pub pressure: Option<SignedStress>,
    /// Force per undeformed area, in a fixed direction.
    pub traction: Option<Vector<SignedStress>>,
    /// Force on each node, in a fixed direction.
    pub force: Option<Vector<SignedForce>>,
    /// Moment on each node, about x, y and z: of nodes with small rotations.
    pub moment: Option<Vector<SignedMoment>>,
    /// Factor as a function of time: the name of a signal; or points, linear between them, constant before the first and after
    /// the last. Default: 1.
    pub amplitude: Option<AmplitudeCourse>,
}

/// Acceleration of the ground by direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("anyOf" = [{ "required": ["x"] }, { "required": ["y"] }, { "required": ["z"] }]))]
pub struct BaseAcceleration {
    /// Signal of the acceleration along the first axis. Default: none.
    pub x: Option<String>,
    /// Signal of the acceleration along the second axis. Default: none.
    pub y: Option<String>,
    /// Signal of the acceleration along the third axis. Default: none.
    pub z: Option<String>,
}

/// A factor as a function of time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum AmplitudeCourse {
    /// By the name of a signal.
    Signal(String),
    /// By points.
    #[schemars(extend("minItems" = 1))]
    Points(Vec<AmplitudePoint>),
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
