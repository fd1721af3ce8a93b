//! The scheme of Hilber, Hughes and Taylor.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::generalised_alpha::Averaged;
use crate::step_map::StepMap;
use crate::{EnergyIdentity, TimeScheme};

/// Scheme of Hilber, Hughes and Taylor (HHT-α) with the acceleration at the end of the step as unknown:
///
/// `M a₊ + f((1 + α) u₊ - α u) = p_ext + Nᵀ P`, u₊ and v₊ as Newmark's with `γ = ½ - α`, `β = (1 - α)²/4`.
///
/// α is in [-⅓, 0], as in the paper; others count it positive, from 0 to ⅓. Zero is the trapezoid, -⅓ dissipates most. The
/// contact force is that of the end of the step, whole. Stable at any step and of second order without contact.
///
/// Energy identity of [`GeneralisedAlpha`](crate::GeneralisedAlpha) with α_m = 0 and α_f = -α.
///
/// Source: Hilber, Hughes, Taylor, Earthquake Engineering and Structural Dynamics 5 (1977) 283; the paper's text was not
/// at hand.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme of Hilber, Hughes and Taylor.")]
pub struct Hht {
    /// Internal forces are evaluated at (1 + alpha) u+ - alpha u: 0 damps nothing, -1/3 most. Some authors define alpha
    /// with the opposite sign.
    #[schemars(extend("minimum" = -1.0 / 3.0, "maximum" = 0.0))]
    pub alpha: f64,
}

impl Default for Hht {
    fn default() -> Hht {
        Hht { alpha: -0.1 }
    }
}

impl Hht {
    fn family(&self) -> Averaged {
        Averaged {
            inertia: 0.0,
            force: -self.alpha,
        }
    }
}

impl TimeScheme for Hht {
    fn name(&self) -> &'static str {
        "hht"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        self.family().step_map(dt)
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        Some(self.family().energy_identity(dt))
    }

    fn keeps_acceleration(&self) -> bool {
        true
    }

    fn order(&self) -> u32 {
        2
    }

    fn critical(&self) -> Option<f64> {
        None
    }
}
