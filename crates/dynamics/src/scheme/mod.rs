//! Time schemes: a step map and an energy identity each.
//!
//! Adding a scheme: one file here, one variant of [`Scheme`], one arm of [`Scheme::get`].

mod central_difference;
mod newmark;
mod theta;

use serde::{Deserialize, Serialize};

use crate::step_map::StepMap;

pub use central_difference::CentralDifference;
pub use newmark::Newmark;
pub use theta::Theta;

/// The exact energy balance of one step of a linear system without damping. With E = ½|v|²_M + U(u), F the sum of
/// external and contact forces and Δ the change over the step,
///
/// `Δ(E + inertia |a|²_M) = Δu · (old F_k + new F_{k+1}) - (velocity |Δv|²_M + displacement |Δu|²_K + acceleration |Δa|²_M)`
///
/// The bracket is the dissipation of the scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyIdentity {
    /// Factor of |a|²_M in the energy that the scheme conserves, in s².
    pub inertia: f64,
    /// Weight of the forces at the start of the step.
    pub old: f64,
    /// Weight of the forces of the step.
    pub new: f64,
    /// Dissipation factor of |Δv|²_M.
    pub velocity: f64,
    /// Dissipation factor of |Δu|²_K.
    pub displacement: f64,
    /// Dissipation factor of |Δa|²_M, in s².
    pub acceleration: f64,
}

/// What a time scheme must answer.
pub trait TimeScheme {
    /// Name as in the case file.
    fn name(&self) -> &'static str;
    /// How the step of length `dt` (s) depends on its unknown.
    fn step_map(&self, dt: f64) -> StepMap;
    /// Its energy balance for a step of length `dt` (s); `None` where none is known: the ledger then says so, and its
    /// residual holds what the scheme dissipates.
    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity>;
    /// Whether the state holds an acceleration in balance, which needs one at the start.
    fn keeps_acceleration(&self) -> bool;
    /// Whether end displacements are known before the forces: no linear solve, lumped mass only, a critical step.
    fn is_explicit(&self) -> bool;
}

/// A time scheme, as chosen in the case file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Scheme {
    /// Newmark's family.
    Newmark(Newmark),
    /// The theta scheme in velocities.
    Theta(Theta),
    /// Central differences.
    CentralDifference(CentralDifference),
}

impl Scheme {
    /// The scheme behind the choice.
    pub fn get(&self) -> &dyn TimeScheme {
        match self {
            Scheme::Newmark(scheme) => scheme,
            Scheme::Theta(scheme) => scheme,
            Scheme::CentralDifference(scheme) => scheme,
        }
    }

    /// One of each, with usual parameters: what the batteries run over.
    pub fn registered() -> Vec<Scheme> {
        vec![
            Scheme::Newmark(Newmark {
                beta: 0.25,
                gamma: 0.5,
            }),
            Scheme::Newmark(Newmark {
                beta: 0.49,
                gamma: 0.9,
            }),
            Scheme::Theta(Theta { theta: 0.5 }),
            Scheme::Theta(Theta { theta: 0.75 }),
            Scheme::CentralDifference(CentralDifference),
        ]
    }
}
