//! Central differences with lumped mass.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Central differences, written at whole steps:
///
/// `u₊ = u + dt v + dt²/2 a`, `M a₊ + f(u₊) = p_ext + Nᵀ P`, `v₊ = v + dt/2 (a + a₊)`.
///
/// With `v_{k+1/2} = v + dt/2 a` this is the leapfrog `u₊ = u + dt v_{k+1/2}`, `M (v_{k+3/2} - v_{k+1/2}) = dt (p_ext - f(u₊)) + Nᵀ dt P`,
/// and a law in the rate acts on `v_{k+3/2} = v + dt/2 a + dt a₊` where the gap at u₊ is closed (CD-Lagrange).
/// Before a step of another length `next` the velocity of the half step to come is `v + dt/2 a + (dt + next)/2 a₊`.
/// Stable for dt < 2/ω. Energy identity as Newmark's with β = 0, γ = ½: the scheme conserves E - dt²/8 |a|²_M.
///
/// Source: Fekak, Brun, Gravouil, Depale, Computational Mechanics 60 (2017), the CD-Lagrange scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "Central difference.")]
pub struct CentralDifference {}

impl TimeScheme for CentralDifference {
    fn name(&self) -> &'static str {
        "central-difference"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        self.step_map_before(dt, dt)
    }

    fn step_map_before(&self, dt: f64, next: f64) -> StepMap {
        let displacement = Row {
            u: 1.0,
            v: dt,
            a: 0.5 * dt * dt,
            x: 0.0,
            ..Row::default()
        };
        let acceleration = Row::UNKNOWN;
        let velocity = Row {
            u: 0.0,
            v: 1.0,
            a: 0.5 * dt,
            x: 0.5 * dt,
            ..Row::default()
        };
        StepMap {
            inertia: acceleration,
            force: displacement,
            force_fraction: Some(1.0),
            displacement,
            velocity,
            acceleration,
            placed: displacement,
            gap: displacement,
            rate: Row {
                x: 0.5 * (dt + next),
                ..velocity
            },
            moves: next,
            memory: Row::default(),
            contact: 1.0,
            impulse: Impulse::weights(0.5, 0.5),
            contact_impulse: Impulse::weights(0.5, 0.5),
        }
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        Some(EnergyIdentity {
            inertia: -0.125 * dt * dt,
            old: 0.5,
            new: 0.5,
            ..EnergyIdentity::default()
        })
    }

    fn keeps_acceleration(&self) -> bool {
        true
    }

    fn order(&self) -> u32 {
        2
    }

    fn critical(&self) -> Option<f64> {
        Some(2.0)
    }
}
