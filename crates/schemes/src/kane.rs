//! The scheme of Kane, Repetto, Ortiz and Marsden.

use carom_laws::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, Newmark, TimeScheme};

/// Newmark's scheme with contact forces fully implicit. With a the acceleration from internal forces and loads alone,
/// `M a + f(u) = p_ext`, and c = M⁻¹ Nᵀ P:
///
/// `u₊ = u + dt v + dt² ((½ - β) a + β a₊) + dt²/2 c`, `v₊ = v + dt ((1 - γ) a + γ a₊) + dt c`, displacement law on u₊.
///
/// The unknown is y = a₊ + c/(2β): then `u₊ = u + dt v + dt² ((½ - β) a + β y)` and `M y + f(u₊) = p_ext + Nᵀ P/(2β)`.
/// Lumped mass, since c needs M⁻¹; displacement law only, since P is what keeps u₊. β > 0. The acceleration reported is a₊.
///
/// Energy identity with b = β - γ/2:
/// `Δ(E + b dt²/2 |a|²_M) = Δu · (p_ext + Nᵀ P) - (γ - ½)(|Δu|²_K + b dt² |Δa|²_M) - b dt² Δa · Nᵀ P`,
/// by Newmark's proof, since c enters Δu and the mean velocity alike. For γ = 2β contact only takes energy, P Δg <= 0
/// where it closes, and none while it stays.
///
/// Source: Kane, Repetto, Ortiz, Marsden, Computer Methods in Applied Mechanics and Engineering 180 (1999) 1, whose text
/// was not at hand; the identity is derived here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme of Kane, Repetto, Ortiz and Marsden.")]
pub struct Kane {
    /// Weight of the end acceleration in the displacement, as in Newmark's scheme.
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub beta: f64,
    /// Weight of the end acceleration in the velocity, as in Newmark's scheme.
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub gamma: f64,
}

impl Default for Kane {
    fn default() -> Kane {
        Kane {
            beta: 0.25,
            gamma: 0.5,
        }
    }
}

impl TimeScheme for Kane {
    fn name(&self) -> &'static str {
        "kane"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let (beta, gamma) = (self.beta, self.gamma);
        let newmark = Newmark { beta, gamma }.step_map(dt);
        let velocity = Row {
            c: dt * (1.0 - 0.5 * gamma / beta),
            ..newmark.velocity
        };
        StepMap {
            velocity,
            rate: velocity,
            acceleration: Row {
                c: -0.5 / beta,
                ..newmark.acceleration
            },
            contact: 0.5 / beta,
            contact_impulse: Impulse::weights(0.0, 1.0),
            ..newmark
        }
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        let b = self.beta - 0.5 * self.gamma;
        let excess = self.gamma - 0.5;
        Some(EnergyIdentity {
            inertia: 0.5 * b * dt * dt,
            new: 1.0,
            displacement: excess,
            acceleration: excess * b * dt * dt,
            contact: b * dt * dt,
            ..EnergyIdentity::default()
        })
    }

    /// Links act as loads do, as in Newmark's scheme.
    fn link_work(&self, _dt: f64) -> [f64; 2] {
        [1.0 - self.gamma, self.gamma]
    }

    fn keeps_acceleration(&self) -> bool {
        true
    }

    fn order(&self) -> u32 {
        if self.gamma == 0.5 { 2 } else { 1 }
    }

    fn critical(&self) -> Option<f64> {
        None
    }

    fn needs_lumped_mass(&self) -> bool {
        true
    }

    fn takes(&self, level: Level) -> bool {
        level == Level::Gap
    }
}
