//! `[probe]`, `[output]` and `[reference]`: what is written and what it is compared with.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::quantity::Duration;

/// A history of the mean motion of a group, at every step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Probe {
    /// Group whose nodes are followed.
    pub on: String,
    /// What is written.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub record: Vec<Motion>,
}

/// What a probe writes.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Motion {
    /// Displacement, m.
    Displacement,
    /// Velocity, m/s.
    Velocity,
    /// Acceleration, m/s².
    Acceleration,
}

/// What a run leaves beside its histories, which are always written, at every step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Output {
    /// Fields for ParaView. Default: none.
    pub fields: Option<Fields>,
}

/// Fields on the whole mesh. Contact surfaces get their gap, pressure and sign fields in any case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Fields {
    /// Time between two of them.
    pub every: Duration,
    /// What is written.
    #[schemars(extend("minItems" = 1, "uniqueItems" = true))]
    pub record: Vec<Field>,
}

/// A field.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Field {
    /// Displacement of the nodes, m.
    Displacement,
    /// Velocity of the nodes, m/s.
    Velocity,
    /// Acceleration of the nodes, m/s².
    Acceleration,
    /// Stress of the cells, Pa.
    Stress,
}

/// An exact solution, drawn under the result; its distance from the result is in the verdict. Bodies, sizes and speeds are those of the
/// case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// Two bars that meet end on.
    TwoBars(BarReference),
    /// A bar against a rigid wall.
    BarOnWall(BarReference),
}

/// A solution for bars.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BarReference {
    /// Whether the sides of the bars may move.
    #[serde(default)]
    pub sides: Sides,
}

/// Whether the sides of a bar may move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sides {
    /// They are free: waves at sqrt(E / rho).
    #[default]
    Free,
    /// They are blocked: waves at the speed of confined compression.
    Blocked,
}
