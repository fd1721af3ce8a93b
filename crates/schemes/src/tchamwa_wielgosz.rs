//! The explicit scheme of Tchamwa and Wielgosz.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Explicit dissipative scheme with lumped mass:
///
/// `u₊ = u + dt v + φ dt² a`, `v₊ = v + dt a`, `M a₊ + f(u₊) = p_ext + Nᵀ P`.
///
/// φ >= 1; φ = 1 is the leapfrog, whose velocity belongs to the half step before. With Ω = ω dt the amplification has the
/// determinant `1 - (φ - 1) Ω²` and the trace `2 - φ Ω²`: the damping ratio is (φ - 1) Ω/2 at low frequencies, free
/// vibration ends at Ω = 2/φ, and the scheme is stable for `Ω <= 2/sqrt(2 φ - 1)`. Of first order. A law in the rate acts
/// on the next velocity, `v + dt a + dt a₊`, where the gap at u₊ is closed.
///
/// Before a step of another length `next` the law acts on `v + dt a + next a₊`.
///
/// Energy identity: `ΔE = Δu · F_k - (φ - ½) |Δv|²_M + ½ |Δu|²_K`, from `Δu = dt v̄ + (φ - ½) dt Δv` with v̄ the mean of v
/// and v₊, and `M Δv = dt (F_k - f_k)`. The two squares nearly cancel at low frequencies.
///
/// Source: Tchamwa, Conway, Wielgosz, ASME Recent Advances in Solids and Structures (1999); the paper's text was not at
/// hand, damping, limits and identity are derived here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme of Tchamwa and Wielgosz.")]
pub struct TchamwaWielgosz {
    /// Factor of dt² a in the displacement: 1 damps nothing; the damping ratio is (phi - 1) omega dt / 2, and the critical
    /// step 2 / (omega sqrt(2 phi - 1)).
    #[schemars(extend("minimum" = 1.0, "maximum" = 2.0))]
    pub phi: f64,
}

impl Default for TchamwaWielgosz {
    fn default() -> TchamwaWielgosz {
        TchamwaWielgosz { phi: 1.033 }
    }
}

impl TimeScheme for TchamwaWielgosz {
    fn name(&self) -> &'static str {
        "tchamwa-wielgosz"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        self.step_map_before(dt, dt)
    }

    fn step_map_before(&self, dt: f64, next: f64) -> StepMap {
        let displacement = Row {
            u: 1.0,
            v: dt,
            a: self.phi * dt * dt,
            ..Row::default()
        };
        let acceleration = Row::UNKNOWN;
        let velocity = Row {
            v: 1.0,
            a: dt,
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
                x: next,
                ..velocity
            },
            moves: next,
            memory: Row::default(),
            contact: 1.0,
            impulse: Impulse::weights(1.0, 0.0),
            contact_impulse: Impulse::weights(1.0, 0.0),
        }
    }

    fn energy_identity(&self, _dt: f64) -> Option<EnergyIdentity> {
        Some(EnergyIdentity {
            old: 1.0,
            velocity: self.phi - 0.5,
            displacement: -0.5,
            ..EnergyIdentity::default()
        })
    }

    fn keeps_acceleration(&self) -> bool {
        true
    }

    fn order(&self) -> u32 {
        1
    }

    fn critical(&self) -> Option<f64> {
        Some(2.0 / (2.0 * self.phi - 1.0).sqrt())
    }
}
