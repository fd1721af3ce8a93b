//! Newmark's family.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Newmark's scheme with the acceleration at the end of the step as unknown:
///
/// `u₊ = u + dt v + dt² ((½ - β) a + β a₊)`, `v₊ = v + dt ((1 - γ) a + γ a₊)`, balance at the end of the step.
///
/// β > 0 here; β = 0, γ = ½ is [`CentralDifference`](crate::CentralDifference), which takes the contact rate half a step
/// later. Unconditionally stable without contact for 2β >= γ >= ½. The paper's sets are (¼, ½), (½, ½), (0.49, 0.9).
/// Chaudhary and Bathe (1986) join Newmark's scheme to multipliers for the displacement law at the end of the step; their
/// text was not at hand, so that their β and γ, believed to be the second set, could not be verified.
///
/// Energy identity with b = β - γ/2: `Δ(E + b dt²/2 |a|²_M) = Δu · ((1 - γ) F_k + γ F_{k+1}) - (γ - ½)(|Δu|²_K + b dt² |Δa|²_M)`.
///
/// Source: Newmark (1959); Ben Dhia et al. (2003), equation (5), whose (α, β) are our (β, γ).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "Newmark's scheme.")]
pub struct Newmark {
    /// Weight of the end acceleration in the displacement.
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub beta: f64,
    /// Weight of the end acceleration in the velocity. Stable at any step for gamma >= 1/2 and 2 beta >= gamma.
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub gamma: f64,
}

impl Default for Newmark {
    fn default() -> Newmark {
        Newmark {
            beta: 0.25,
            gamma: 0.5,
        }
    }
}

impl TimeScheme for Newmark {
    fn name(&self) -> &'static str {
        "newmark"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let (beta, gamma) = (self.beta, self.gamma);
        let displacement = Row {
            u: 1.0,
            v: dt,
            a: dt * dt * (0.5 - beta),
            x: dt * dt * beta,
            ..Row::default()
        };
        let velocity = Row {
            u: 0.0,
            v: 1.0,
            a: dt * (1.0 - gamma),
            x: dt * gamma,
            ..Row::default()
        };
        let acceleration = Row::UNKNOWN;
        StepMap {
            inertia: acceleration,
            force: displacement,
            force_fraction: Some(1.0),
            displacement,
            velocity,
            acceleration,
            placed: Row::START,
            gap: displacement,
            rate: velocity,
            moves: dt,
            memory: Row::default(),
            contact: 1.0,
            impulse: Impulse::weights(1.0 - gamma, gamma),
            contact_impulse: Impulse::weights(1.0 - gamma, gamma),
        }
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        let b = self.beta - 0.5 * self.gamma;
        let excess = self.gamma - 0.5;
        Some(EnergyIdentity {
            inertia: 0.5 * b * dt * dt,
            old: 1.0 - self.gamma,
            new: self.gamma,
            displacement: excess,
            acceleration: excess * b * dt * dt,
            ..EnergyIdentity::default()
        })
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

    fn usual() -> Vec<Newmark> {
        vec![
            Newmark {
                beta: 0.25,
                gamma: 0.5,
            },
            Newmark {
                beta: 0.49,
                gamma: 0.9,
            },
        ]
    }
}
