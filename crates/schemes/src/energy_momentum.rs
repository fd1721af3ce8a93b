//! Energy and momentum conserved, for large transformations.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Row, StepMap};
use crate::{EnergyIdentity, Theta, TimeScheme};

/// The energy-momentum scheme: the mid-point rule with the algorithmic stress of Gonzalez' discrete gradient,
///
/// `M (v₊ - v)/dt + f(u, u₊) = p_ext + N_mᵀ P`, `u₊ - u = dt (v + v₊)/2`, `f(u, u₊) · (u₊ - u) = U(u₊) - U(u)`.
///
/// N_m, with foot and normal, is that of the mid-configuration (u + u₊)/2, so that contact forces keep linear and angular
/// momentum to round-off. Contact conserves energy in the mean: a law in the rate holds for N_m (v + v₊)/2, and
/// `P · N_m (u₊ - u) = 0`. The gap follows from its rates, and the force alternates from step to step: its mean is the
/// answer, not its peak.
///
/// On a linear system it is [`LaursenChawla`](crate::LaursenChawla). The acceleration reported is the mean of the step.
///
/// Source: Simo, Tarnow, Zeitschrift für angewandte Mathematik und Physik 43 (1992) 757; Gonzalez, Computer Methods in
/// Applied Mechanics and Engineering 190 (2000) 1763; contact after Laursen, Chawla, International Journal for Numerical
/// Methods in Engineering 40 (1997) 863. Their texts were not at hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The energy-momentum scheme.")]
pub struct EnergyMomentum {}

const MID_POINT: Theta = Theta { theta: 0.5 };

impl TimeScheme for EnergyMomentum {
    fn name(&self) -> &'static str {
        "energy-momentum"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let map = MID_POINT.step_map(dt);
        StepMap {
            // the algorithmic stress belongs to the whole step
            force: map.displacement,
            rate: Row {
                v: 0.5,
                x: 0.5,
                ..Row::default()
            },
            ..map
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

    fn is_between(&self) -> bool {
        true
    }
}
