//! `[time]`: how long, in which steps, by which scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::quantity::Duration;

/// The time to simulate and how.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Time {
    /// Time at the end; the beginning is 0.
    pub end: Duration,
    /// Time step.
    pub step: Step,
    /// Time scheme.
    pub scheme: Scheme,
}

/// The time step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Step {
    /// A fixed time step.
    Fixed(Duration),
    /// A time step from the mesh.
    FromMesh(StepRule),
}

/// A time step from the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StepRule {
    /// This fraction of the least time in which a wave crosses an element.
    Courant(#[schemars(extend("exclusiveMinimum" = 0.0))] f64),
    /// This fraction of the critical step of an explicit scheme, which comes from the eigenvalues of the elements.
    Critical(#[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))] f64),
}

/// A time scheme. Any contact law may be named with it; a pair that makes no sense is refused with the reason.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    /// Newmark's scheme in displacement.
    Newmark(Newmark),
    /// The theta scheme in velocity (Moreau, Jean).
    Theta(Theta),
    /// Central difference, explicit; lumped mass.
    CentralDifference(CentralDifference),
}

/// Newmark's scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Newmark {
    /// Weight of the end acceleration in the displacement.
    #[serde(default = "quarter")]
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub beta: f64,
    /// Weight of the end acceleration in the velocity. Stable at any step for gamma >= 1/2 and 2 beta >= gamma.
    #[serde(default = "half")]
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub gamma: f64,
}

/// The theta scheme.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Theta {
    /// Weight of the end of the step: 1/2 conserves energy, 1 damps most.
    #[serde(default = "half")]
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub theta: f64,
}

/// Central difference: nothing to give.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CentralDifference {}

fn quarter() -> f64 {
    0.25
}

fn half() -> f64 {
    0.5
}
