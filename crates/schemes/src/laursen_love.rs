//! The energy-conserving scheme with admissible displacements of Laursen and Love.

use carom_laws::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::StepMap;
use crate::{EnergyIdentity, Theta, TimeScheme};

/// Mid-point rule with the displacement law at the end of the step, then a discrete jump of the velocity that makes up for the
/// work of the contact. Two stages:
///
/// 1. `M (v* - v)/dt + f((u + u₊)/2) = p_ext + Nᵀ P`, `u₊ = u + dt (v + v*)/2`, `0 <= g(u₊) ⟂ P >= 0`;
/// 2. `v₊ = v* + M⁻¹ Nᵀ I` with an impulse I_i >= 0 in every point i that has closed in the step, such that
///    `I_i N_i (v* + v₊)/2 = -P_i N_i Δu`.
///
/// So displacements are admissible, and each point gives back in the second stage what it took in the first. There is exactly
/// one such I: with w = -P N Δu > 0 and D = N M⁻¹ Nᵀ the conditions divided by I_i, `N_i v* + ½ (D I)_i = w_i/I_i`, say that I
/// is where the strictly convex `I · N v* + ¼ I · D I - Σ w_i ln I_i` is least. For one point that is the root of a
/// quadratic equation, `I = (sqrt(r² + 2 D w) - r)/D` with r = N v*, after which `N v₊ = sqrt(r² + 2 D w)`: the point
/// leaves, a point mass with the speed of its approach. Points that stay closed do no work and get no jump.
///
/// Energy identity, both stages together: `ΔE = Δu · p_ext`. The price is a force of no use: a node that closes bounces
/// off elastically, so that contact flutters. Displacement law only.
///
/// Source: Laursen, Love, International Journal for Numerical Methods in Engineering 53 (2002) 245, whose text was
/// not at hand. Later literature says of it: admissible displacements, and an update of the velocity after the step that
/// makes conservation exact in each point. The equations of the update, its uniqueness and the identity are derived here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme of Laursen and Love.")]
pub struct LaursenLove {}

const MID_POINT: Theta = Theta { theta: 0.5 };

impl TimeScheme for LaursenLove {
    fn name(&self) -> &'static str {
        "laursen-love"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        MID_POINT.step_map(dt)
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        MID_POINT.energy_identity(dt)
    }

    fn keeps_acceleration(&self) -> bool {
        false
    }

    fn order(&self) -> u32 {
        MID_POINT.order()
    }

    fn critical(&self) -> Option<f64> {
        None
    }

    fn restores_contact_work(&self) -> bool {
        true
    }

    fn takes(&self, level: Level) -> bool {
        level == Level::Gap
    }
}
