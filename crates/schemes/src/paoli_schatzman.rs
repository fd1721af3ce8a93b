//! The two-step scheme of Paoli and Schatzman.

use carom_laws::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Two-step scheme with the mean velocity of the step as unknown:
///
/// `M (u₊ - 2u + u₋)/dt² + f((u₊ + 2u + u₋)/4) = p_ext + Nᵀ P`, with the displacement law on `(u₊ + e u₋)/(1 + e)`.
///
/// The state keeps `v = (u - u₋)/dt`, so that `u₊ = u + dt v₊` and internal forces act at u + dt (v₊ - v)/4. It starts from
/// u₋ = u - dt v. Without contact this is the trapezoid in u, stable at any step; the velocity belongs to the half step
/// before, and counts as of first order.
///
/// e is the restitution of a body that is rigid in a step. It shows after the second step of the impact: with s the approach
/// and ηs dt the gap, η < (1 - e)/(1 + e), a point mass first gets `v₊ = -(e + (1 + e) η) s`, then penetrates by
/// e (1 + η) s dt, and leaves with `v₊ = e s`; for larger η it comes in one step later. With e > 0 the displacement law
/// only, since a law in the rate would not feel e.
///
/// Energy identity with ū = (u + u₋)/2: `Δ(½|v|²_M + U(ū)) = Δū · F`, whatever e. With e = 0 a contact that stays closed does
/// no work, one that closes takes the kinetic energy of what it stops.
///
/// Source: Paoli, Schatzman, SIAM Journal on Numerical Analysis 40 (2002) 702, whose text was not at hand; internal
/// forces as weighted by the project's table of bars.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme of Paoli and Schatzman.")]
pub struct PaoliSchatzman {
    /// Restitution e of bodies that are rigid during a step; the displacement law applies to (u+ + e u-)/(1 + e). A
    /// value above 0 requires the displacement law.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub restitution: f64,
}

impl Default for PaoliSchatzman {
    fn default() -> PaoliSchatzman {
        PaoliSchatzman { restitution: 0.0 }
    }
}

impl TimeScheme for PaoliSchatzman {
    fn name(&self) -> &'static str {
        "paoli-schatzman"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let acceleration = Row {
            v: -1.0 / dt,
            x: 1.0 / dt,
            ..Row::default()
        };
        let velocity = Row::UNKNOWN;
        let end = 1.0 / (1.0 + self.restitution);
        StepMap {
            inertia: acceleration,
            force: Row {
                u: 1.0,
                v: -0.25 * dt,
                x: 0.25 * dt,
                ..Row::default()
            },
            force_fraction: None,
            displacement: Row {
                u: 1.0,
                x: dt,
                ..Row::default()
            },
            velocity,
            acceleration,
            placed: Row::START,
            gap: Row {
                u: 1.0,
                v: -self.restitution * end * dt,
                x: end * dt,
                ..Row::default()
            },
            rate: velocity,
            moves: dt,
            memory: Row::default(),
            contact: 1.0,
            impulse: Impulse::weights(0.0, 1.0),
            contact_impulse: Impulse::weights(0.0, 1.0),
        }
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        Some(EnergyIdentity {
            lag: 0.5 * dt,
            new: 1.0,
            ..EnergyIdentity::default()
        })
    }

    fn keeps_acceleration(&self) -> bool {
        false
    }

    fn order(&self) -> u32 {
        1
    }

    fn critical(&self) -> Option<f64> {
        None
    }

    fn takes(&self, level: Level) -> bool {
        level == Level::Gap || self.restitution == 0.0
    }

    fn usual() -> Vec<PaoliSchatzman> {
        vec![
            PaoliSchatzman { restitution: 0.0 },
            PaoliSchatzman { restitution: 0.5 },
        ]
    }
}
