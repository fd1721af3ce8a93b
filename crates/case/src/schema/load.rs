//! `[load]`: what pulls and presses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::{
    Acceleration, Delay, Frequency, Length, SignedForce, SignedMoment, SignedStress, Vector,
};

use super::obstacle::NormalVector;

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
        { "required": ["random"] },
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
    /// Random force along a line of nodes, as of a flow.
    pub random: Option<RandomForce>,
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

/// A Gaussian random force per length of a line of cells or per area of a surface, from time 0 to the end of the run. Its value at
/// two places correlates as exp(-d/L), with d their distance along the line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct RandomForce {
    /// Direction of the force, of any length except zero.
    pub direction: NormalVector,
    /// Direction of the line, of any length except zero.
    pub along: NormalVector,
    /// One-sided spectral density by ascending frequency: straight between the points, zero outside.
    #[schemars(extend("minItems" = 2))]
    pub spectrum: Vec<DensityPoint>,
    /// Correlation length L.
    pub correlation_length: Length,
    /// Seed of the random numbers.
    #[serde(default = "one")]
    pub seed: u32,
}

fn one() -> u32 {
    1
}

/// A point of a spectral density.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct DensityPoint {
    /// Frequency.
    pub frequency: Frequency,
    /// Square of the force per length or area over the frequency, (N/m)²/Hz or Pa²/Hz.
    #[schemars(range(min = 0.0))]
    pub density: f64,
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
