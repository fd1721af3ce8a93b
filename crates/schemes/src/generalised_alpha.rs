//! The generalised-alpha scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Generalised-alpha scheme with the acceleration at the end of the step as unknown. With ρ∞ the spectral radius at
/// infinite frequency, 1 for no dissipation and 0 for the most:
///
/// `α_m = (2ρ∞ - 1)/(ρ∞ + 1)`, `α_f = ρ∞/(ρ∞ + 1)`, `γ = ½ - α_m + α_f`, `β = (1 - α_m + α_f)²/4`,
///
/// `M ((1 - α_m) a₊ + α_m a) + f((1 - α_f) u₊ + α_f u) = p_ext + Nᵀ P`, u₊ and v₊ as Newmark's.
///
/// The contact force is that of the end of the step, whole, and has no memory: an impact would otherwise come back in
/// the next balance. Stable at any step and of second order without contact.
///
/// Energy identity with b = β - γ/2 and ε = α_f - α_m:
/// `Δ(E + b dt²/2 |a|²_M) = Δu · F - ε b dt² |Δa|²_M - (½ - α_f) Δu · (M Δa + Δf)`.
/// Proof: Newmark's kinematics give `ΔT + b dt²/2 Δ|a|²_M = Δu · M (ā + ε Δa) - ε b dt² |Δa|²_M` with ā the mean of a and
/// a₊; the balance is `M (ā + (½ - α_m) Δa) = F - f̄ - (½ - α_f) Δf`. The last term has no sign in a step.
///
/// Source: Chung, Hulbert, Journal of Applied Mechanics 60 (1993) 371; the energy of such schemes is the subject of
/// Krenk (2006) and of Acary, INRIA report 8602 (2014). Of the papers only the abstracts were at hand; the identity is
/// derived here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The generalised-alpha scheme.")]
pub struct GeneralisedAlpha {
    /// Spectral radius at infinite frequency: 1 damps nothing, 0 most.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub rho_inf: f64,
}

impl Default for GeneralisedAlpha {
    fn default() -> GeneralisedAlpha {
        GeneralisedAlpha { rho_inf: 0.8 }
    }
}

impl TimeScheme for GeneralisedAlpha {
    fn name(&self) -> &'static str {
        "generalised-alpha"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        Averaged::of_radius(self.rho_inf).step_map(dt)
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        Some(Averaged::of_radius(self.rho_inf).energy_identity(dt))
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
}

/// What generalised-alpha, smooth or not, and HHT have in common: a balance between the instants, and β and γ for second order and the
/// most dissipation at high frequencies.
pub(crate) struct Averaged {
    /// α_m: weight of the acceleration at the start.
    pub(crate) inertia: f64,
    /// α_f: weight of the displacement at the start.
    pub(crate) force: f64,
}

impl Averaged {
    /// The weights of generalised-alpha.
    pub(crate) fn of_radius(rho: f64) -> Averaged {
        Averaged {
            inertia: (2.0 * rho - 1.0) / (rho + 1.0),
            force: rho / (rho + 1.0),
        }
    }

    pub(crate) fn gamma(&self) -> f64 {
        0.5 - self.inertia + self.force
    }

    pub(crate) fn beta(&self) -> f64 {
        0.25 * (1.0 - self.inertia + self.force).powi(2)
    }

    pub(crate) fn step_map(&self, dt: f64) -> StepMap {
        let (beta, gamma) = (self.beta(), self.gamma());
        let displacement = Row {
            u: 1.0,
            v: dt,
            a: dt * dt * (0.5 - beta),
            x: dt * dt * beta,
            ..Row::default()
        };
        let velocity = Row {
            v: 1.0,
            a: dt * (1.0 - gamma),
            x: dt * gamma,
            ..Row::default()
        };
        let end = 1.0 - self.force;
        let impulse = Impulse {
            old: 1.0 - gamma,
            new: gamma,
            gain: 1.0 / (1.0 - self.inertia),
            carry: self.inertia / (1.0 - self.inertia),
        };
        StepMap {
            inertia: Row {
                a: self.inertia,
                x: 1.0 - self.inertia,
                ..Row::default()
            },
            force: Row {
                u: 1.0,
                v: end * displacement.v,
                a: end * displacement.a,
                x: end * displacement.x,
                ..Row::default()
            },
            force_fraction: Some(end),
            displacement,
            velocity,
            acceleration: Row::UNKNOWN,
            placed: Row::START,
            gap: displacement,
            rate: velocity,
            moves: dt,
            memory: Row::default(),
            contact: 1.0,
            impulse,
            contact_impulse: impulse,
        }
    }

    pub(crate) fn energy_identity(&self, dt: f64) -> EnergyIdentity {
        let b = self.beta() - 0.5 * self.gamma();
        EnergyIdentity {
            inertia: 0.5 * b * dt * dt,
            new: 1.0,
            displacement: 0.5 - self.force,
            acceleration: (self.force - self.inertia) * b * dt * dt,
            mixed: 0.5 - self.force,
            ..EnergyIdentity::default()
        }
    }
}
