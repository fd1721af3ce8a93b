//! The energy-conserving contact of Laursen and Chawla.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Row, StepMap};
use crate::{EnergyIdentity, Theta, TimeScheme};

/// Mid-point rule with contact on the mean rate of the step (persistency in the mean):
///
/// `M (v₊ - v)/dt + f((u + u₊)/2) = p_ext + Nᵀ P`, `u₊ = u + dt (v + v₊)/2`, and in points closed at the start
/// `0 <= (g₊ - g)/dt ⟂ P >= 0`.
///
/// That is [`Theta`] with θ = ½ and its rate at mid-step, for the velocity law. Contact does no work at all: energy is
/// exact, also in the impact, and the force is useless. A point that closes at the speed w leaves the step at the speed
/// -w or stays with an alternating one: on two bars the error of the force is more than its size, with a change of
/// status every few steps. With the displacement law this is the trapezoid.
///
/// Energy identity: `ΔE = Δu · F`.
///
/// Source: Laursen, Chawla, International Journal for Numerical Methods in Engineering 40 (1997) 863, whose text was not
/// at hand; for small displacements, where their discrete gap rate is (g₊ - g)/dt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme of Laursen and Chawla.")]
pub struct LaursenChawla {}

const MID_POINT: Theta = Theta { theta: 0.5 };

impl TimeScheme for LaursenChawla {
    fn name(&self) -> &'static str {
        "laursen-chawla"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        StepMap {
            rate: Row {
                v: 0.5,
                x: 0.5,
                ..Row::default()
            },
            ..MID_POINT.step_map(dt)
        }
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
}
