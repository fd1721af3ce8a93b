//! The contact-stabilised Newmark scheme.

use carom_laws::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Trapezoid with implicit contact forces and a predictor that is projected on the admissible displacements. Two stages:
///
/// 1. `u* = u + dt v + w`, `M w = Nᵀ R`, `0 <= g(u*) ⟂ R >= 0`: the admissible displacement closest to the free one in the
///    norm of the mass;
/// 2. `u₊ = u* + dt²/2 a₊`, `v₊ = v + dt a₊`, `M a₊ + f((u + u₊)/2) = p_ext + Nᵀ P`, `0 <= g(u₊) ⟂ P >= 0`.
///
/// The projection enters the displacement only: a node that lies on the surface keeps the velocity with which it came,
/// and its force does not oscillate. Without contact this is the trapezoid. The acceleration reported is a₊, the mean of
/// the step; between the stages `a` of the step holds 2 w/dt².
///
/// Energy identity: `ΔE = Δu · (p_ext + Nᵀ P) - (2/dt²) R · g(u₊)`. Both terms of contact only take: P · g(u₊) = 0 and
/// g(u) >= 0, so P · Δg <= 0, and neither R nor g(u₊) is negative. So energy never grows in contact with a fixed normal.
/// Displacement law only.
///
/// Source: Deuflhard, Krause, Ertel, International Journal for Numerical Methods in Engineering 73 (2008) 1274, whose text
/// was not at hand: the stages are those of the later literature on the scheme, and the identity is derived here.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The contact-stabilised Newmark scheme.")]
pub struct ContactStabilised {}

impl TimeScheme for ContactStabilised {
    fn name(&self) -> &'static str {
        "contact-stabilised"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let velocity = Row {
            v: 1.0,
            x: dt,
            ..Row::default()
        };
        let displacement = Row {
            u: 1.0,
            v: dt,
            a: 0.5 * dt * dt,
            x: 0.5 * dt * dt,
            ..Row::default()
        };
        let acceleration = Row::UNKNOWN;
        StepMap {
            inertia: acceleration,
            force: Row {
                u: 1.0,
                v: 0.5 * dt,
                a: 0.25 * dt * dt,
                x: 0.25 * dt * dt,
                ..Row::default()
            },
            force_fraction: Some(0.5),
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
        Some(EnergyIdentity {
            new: 1.0,
            ..EnergyIdentity::default()
        })
    }

    fn keeps_acceleration(&self) -> bool {
        false
    }

    fn order(&self) -> u32 {
        2
    }

    fn critical(&self) -> Option<f64> {
        None
    }

    fn takes(&self, level: Level) -> bool {
        level == Level::Gap
    }

    fn projects_predictor(&self) -> bool {
        true
    }
}
