//! What bodies of explicit schemes have beside: bulk viscosity, mass scaling, deletion of cells.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use carom_quantities::Duration;

/// Bulk viscosity: a pressure against fast changes of volume. It spreads shock fronts over some cells and damps the fastest vibrations.
/// For materials at finite strain and explicit schemes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct BulkViscosity {
    /// Factor of the part linear in the rate.
    #[serde(default = "linear")]
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub linear: f64,
    /// Factor of the size of the cell in the part quadratic in the rate, which acts in compression.
    #[serde(default = "quadratic")]
    #[schemars(extend("minimum" = 0.0, "maximum" = 10.0))]
    pub quadratic: f64,
}

fn linear() -> f64 {
    0.06
}

fn quadratic() -> f64 {
    1.2
}

/// Deletion of cells: a cell whose material has flowed too far has no force any more. Its mass stays at its nodes, its energy is a term of
/// its own in the balance. For materials with plastic strain and explicit schemes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Deletion {
    /// Mean equivalent plastic strain over the integration points of a cell at which it is deleted.
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 100.0))]
    pub plastic_strain: f64,
}

/// Mass scaling: mass added to cells so that explicit steps may be larger. Gravity acts on it, momentum and kinetic energy count it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MassScaling {
    /// All cells have so many times their mass.
    Factor(#[schemars(extend("minimum" = 1.0, "maximum" = 1e6))] f64),
    /// Cells with a smaller critical step have as much mass as a step of this size needs, with a margin of 15 %.
    Step(Duration),
}
