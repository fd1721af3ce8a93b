//! The theta scheme in velocities.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Theta scheme with the velocity at the end of the step as unknown; the scheme of Moreau and Jean when joined to the
/// velocity law, or to the law of restitution:
///
/// `M (v₊ - v)/dt + f(u_θ) = p_ext + Nᵀ P`, `v_θ = (1 - θ) v + θ v₊`, `u_θ = u + θ dt v_θ`, `u₊ = u + dt v_θ`.
///
/// Energy identity: `ΔE = Δu · F - (θ - ½)(|Δv|²_M + |Δu|²_K)`. The acceleration reported is the mean of the step,
/// (v₊ - v)/dt.
///
/// A scheme in state space with mean values and a balanced damping α, `M Δv + dt f(ū + ½α Δu) = dt F` and
/// `Δu = dt (v̄ + ½α Δv)`, is this one with θ = (1 + α)/2.
///
/// Source: Ben Dhia et al. (2003), equation (7) and Remark 2; Moreau (1988), Jean (1999).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The theta scheme.")]
pub struct Theta {
    /// Weight of the end of the step: 1/2 conserves energy, 1 damps most.
    #[schemars(extend("minimum" = 0.5, "maximum" = 1.0))]
    pub theta: f64,
}

impl Default for Theta {
    fn default() -> Theta {
        Theta { theta: 0.5 }
    }
}

impl TimeScheme for Theta {
    fn name(&self) -> &'static str {
        "theta"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let theta = self.theta;
        let acceleration = Row {
            v: -1.0 / dt,
            x: 1.0 / dt,
            ..Row::default()
        };
        let displacement = Row {
            u: 1.0,
            v: (1.0 - theta) * dt,
            a: 0.0,
            x: theta * dt,
            ..Row::default()
        };
        let velocity = Row::UNKNOWN;
        StepMap {
            inertia: acceleration,
            force: Row {
                u: 1.0,
                v: theta * (1.0 - theta) * dt,
                a: 0.0,
                x: theta * theta * dt,
                ..Row::default()
            },
            force_fraction: Some(theta),
            displacement,
            velocity,
            acceleration,
            placed: Row::START,
            gap: displacement,
            rate: velocity,
            moves: dt,
            memory: Row::default(),
            contact: 1.0,
            impulse: Impulse::weights(0.0, 1.0),
            contact_impulse: Impulse::weights(0.0, 1.0),
        }
    }

    fn energy_identity(&self, _dt: f64) -> Option<EnergyIdentity> {
        let excess = self.theta - 0.5;
        Some(EnergyIdentity {
            new: 1.0,
            velocity: excess,
            displacement: excess,
            ..EnergyIdentity::default()
        })
    }

    fn keeps_acceleration(&self) -> bool {
        false
    }

    fn order(&self) -> u32 {
        if self.theta == 0.5 { 2 } else { 1 }
    }

    fn critical(&self) -> Option<f64> {
        None
    }

    fn usual() -> Vec<Theta> {
        vec![Theta { theta: 0.5 }, Theta { theta: 0.75 }]
    }
}
