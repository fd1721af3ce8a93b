//! Coulomb's law of friction.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::law::FrictionLaw;

/// Coulomb: one coefficient μ of sticking and sliding.
///
/// Source: C. A. Coulomb, Théorie des machines simples (1785).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline)]
pub struct Coulomb(
    /// μ, zero or more.
    #[schemars(extend("minimum" = 0.0))]
    pub f64,
);

impl FrictionLaw for Coulomb {
    fn name(&self) -> &'static str {
        "coulomb"
    }

    #[inline]
    fn sticks(&self) -> f64 {
        self.0
    }

    fn slides(&self, _rate: f64) -> f64 {
        self.0
    }
}
