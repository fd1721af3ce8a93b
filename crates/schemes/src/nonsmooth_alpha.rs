//! The nonsmooth generalised-alpha scheme.

use carom_laws::Level;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::generalised_alpha::Averaged;
use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Generalised-alpha for the smooth motion, contact impulses apart. With w = M⁻¹ Nᵀ I the jump of the velocity by the impulses
/// I = dt P of the step, and α_m, α_f, β, γ of ρ∞ as in [`GeneralisedAlpha`](crate::GeneralisedAlpha):
///
/// `M ((1 - α_m) a₊ + α_m a) + f((1 - α_f) u₊ + α_f u) = p_ext`,
///
/// `u₊ = u + dt v + dt² ((½ - β) a + β a₊) + dt/2 w`, `v₊ = v + dt ((1 - γ) a + γ a₊) + w`,
///
/// with the velocity law, or that of restitution, on v₊. Contact forces enter no acceleration, so that nothing of an impact
/// comes back in the next steps through the memory of a; internal forces answer to w at once, through u₊. The velocity is
/// of first order at an impact, of second order elsewhere. In a body that is rigid in a step, w first moves the nodes in contact
/// alone, and the rest follows while a vibration decays like (-ρ∞)ᵏ: at ρ∞ = 0.8 restitution comes out up to 0.04 beside e. With
/// ρ∞ = 1 the scheme is [`Theta`](crate::Theta) with θ = ½, and e is exact.
///
/// The unknown is y = a₊ + c/(2β) with c = w/dt, which leaves `u₊ = u + dt v + dt² ((½ - β) a + β y)` and
/// `M ((1 - α_m) y + α_m a) + f = p_ext + (1 - α_m)/(2β) Nᵀ P`, `v₊ = v + dt ((1 - γ) a + γ y) + dt (1 - γ/(2β)) c`: the
/// interface problem sums the compliances of the step and of the mass. Lumped mass, since c needs M⁻¹; laws in the rate
/// only. The acceleration reported is a₊, the smooth one.
///
/// Energy identity: that of generalised-alpha and, with b = β - γ/2, one term of the impulses,
/// `Δ(E + b dt²/2 |a|²_M) = Δu · (p_ext + Nᵀ P) - ε b dt² |Δa|²_M - (½ - α_f) Δu · (M Δa + Δf) - b dt² Δa · Nᵀ P`.
/// Proof: c enters u₊ and the mean velocity alike, so that `dt (v + v₊)/2 = Δu - b dt² Δa` as without contact; times
/// `M Δv = dt M (ā + ε Δa) + dt Nᵀ P`, and the smooth balance.
///
/// Source: Chen, Acary, Virlez, Brüls, International Journal for Numerical Methods in Engineering 96 (2013) 487, whose
/// text was not at hand: the formulas are those of the later literature on the scheme (Acary, INRIA report 8602, 2014), and
/// the form with y and the identity are derived here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The nonsmooth generalised-alpha scheme.")]
pub struct NonsmoothAlpha {
    /// Spectral radius at infinite frequency of the smooth motion: 1 damps nothing, 0 most.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub rho_inf: f64,
}

impl Default for NonsmoothAlpha {
    fn default() -> NonsmoothAlpha {
        NonsmoothAlpha { rho_inf: 0.8 }
    }
}

impl TimeScheme for NonsmoothAlpha {
    fn name(&self) -> &'static str {
        "nonsmooth-alpha"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let family = Averaged::of_radius(self.rho_inf);
        let (beta, gamma) = (family.beta(), family.gamma());
        let smooth = family.step_map(dt);
        let velocity = Row {
            c: dt * (1.0 - 0.5 * gamma / beta),
            ..smooth.velocity
        };
        StepMap {
            velocity,
            acceleration: Row {
                x: 1.0,
                c: -0.5 / beta,
                ..Row::default()
            },
            rate: velocity,
            contact: 0.5 * (1.0 - family.inertia) / beta,
            contact_impulse: Impulse::weights(0.0, 1.0),
            ..smooth
        }
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        let family = Averaged::of_radius(self.rho_inf);
        Some(EnergyIdentity {
            contact: (family.beta() - 0.5 * family.gamma()) * dt * dt,
            ..family.energy_identity(dt)
        })
    }

    fn keeps_acceleration(&self) -> bool {
        true
    }

    fn order(&self) -> u32 {
        2
    }

    fn critical(&self) -> Option<f64> {
        None
    }

    fn needs_lumped_mass(&self) -> bool {
        true
    }

    fn takes(&self, level: Level) -> bool {
        level == Level::Rate
    }
}
