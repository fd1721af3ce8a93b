//! Time schemes: a step map and an energy identity each.
//!
//! Adding a scheme: one file here, one variant of [`Scheme`], one arm of [`Scheme::get`].

mod central_difference;
mod contact_stabilised;
mod energy_momentum;
mod generalised_alpha;
mod hht;
mod kane;
mod krenk;
mod laursen_chawla;
mod laursen_love;
mod newmark;
mod nonsmooth_alpha;
mod paoli_schatzman;
mod tchamwa_wielgosz;
mod theta;

use carom_contact::law::Level;
use serde::{Deserialize, Serialize};

use crate::step_map::StepMap;

pub use central_difference::CentralDifference;
pub use contact_stabilised::ContactStabilised;
pub use energy_momentum::EnergyMomentum;
pub use generalised_alpha::GeneralisedAlpha;
pub use hht::Hht;
pub use kane::Kane;
pub use krenk::Krenk;
pub use laursen_chawla::LaursenChawla;
pub use laursen_love::LaursenLove;
pub use newmark::Newmark;
pub use nonsmooth_alpha::NonsmoothAlpha;
pub use paoli_schatzman::PaoliSchatzman;
pub use tchamwa_wielgosz::TchamwaWielgosz;
pub use theta::Theta;

/// The exact energy balance of one step of a linear system without damping. With ū = u - lag v, E = ½|v|²_M + U(ū), G the
/// dead loads, P the contact forces and Δ the change over the step,
///
/// `Δ(E + inertia |a|²_M + memory |m|²_K) = Δū · (G + Nᵀ (old P_k + new P_{k+1})) - D`
///
/// `D = velocity |Δv|²_M + displacement |Δu|²_K + acceleration |Δa|²_M + filtered |Δm|²_K + mixed Δu·MΔa + contact Δa·NᵀP_{k+1}`
///
/// with m the memory of the scheme. D is the dissipation of the scheme. Where its factors have no common sign, D gives back in some steps what it took in
/// others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyIdentity {
    /// How far the displacements that the scheme balances lie back along the velocity, in s; zero for most schemes.
    pub lag: f64,
    /// Factor of |a|²_M in the energy that the scheme conserves, in s².
    pub inertia: f64,
    /// Factor of |m|²_K in that energy, in s².
    pub memory: f64,
    /// Weight of the contact forces at the start of the step.
    pub old: f64,
    /// Weight of the contact forces of the step.
    pub new: f64,
    /// Dissipation factor of |Δv|²_M.
    pub velocity: f64,
    /// Dissipation factor of |Δu|²_K.
    pub displacement: f64,
    /// Dissipation factor of |Δa|²_M, in s².
    pub acceleration: f64,
    /// Dissipation factor of |Δm|²_K, in s².
    pub filtered: f64,
    /// Dissipation factor of Δu·MΔa.
    pub mixed: f64,
    /// Dissipation factor of Δa·NᵀP_{k+1}, in s².
    pub contact: f64,
}

/// What a time scheme must answer.
pub trait TimeScheme {
    /// Name as in the case file.
    fn name(&self) -> &'static str;
    /// How the step of length `dt` (s) depends on its unknown.
    fn step_map(&self, dt: f64) -> StepMap;
    /// The same before a step of the length `next` (s). The forces of an explicit scheme move the points in the next step alone, so
    /// that the rate which a law constrains is that of the next step.
    fn step_map_before(&self, dt: f64, _next: f64) -> StepMap {
        self.step_map(dt)
    }
    /// Its energy balance for a step of length `dt` (s); `None` where none is known: the ledger then says so, and its
    /// residual holds what the scheme dissipates.
    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity>;
    /// Whether the state holds an acceleration in balance, which needs one at the start.
    fn keeps_acceleration(&self) -> bool;
    /// Order of convergence in the step of displacement and velocity at the same instant, without contact.
    fn order(&self) -> u32;
    /// The critical ω dt of a scheme whose end displacements are known before the forces; `None` of one that solves for
    /// them.
    fn critical(&self) -> Option<f64>;
    /// Whether end displacements are known before the forces: no linear solve, a critical step.
    fn is_explicit(&self) -> bool {
        self.critical().is_some()
    }
    /// Whether the mass must be diagonal.
    fn needs_lumped_mass(&self) -> bool {
        self.is_explicit()
    }
    /// Whether the displacement predicted without forces is projected on the admissible ones before the step.
    fn projects_predictor(&self) -> bool {
        false
    }
    /// Whether the velocity gets back, after a step, the work that points took as they closed in it.
    fn restores_contact_work(&self) -> bool {
        false
    }
    /// Whether internal forces belong to the way from the start to the end of the step (a discrete gradient), and contacts
    /// to its middle. Only the nonlinear solver knows them.
    fn is_between(&self) -> bool {
        false
    }
    /// Whether a contact law that constrains this quantity can hold.
    fn takes(&self, level: Level) -> bool {
        !(self.is_explicit() && level == Level::Gap)
    }
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
    /// Generalised-alpha.
    GeneralisedAlpha(GeneralisedAlpha),
    /// Hilber, Hughes, Taylor.
    Hht(Hht),
    /// Explicit and dissipative, Tchamwa and Wielgosz.
    TchamwaWielgosz(TchamwaWielgosz),
    /// Two-step, Paoli and Schatzman.
    PaoliSchatzman(PaoliSchatzman),
    /// Mid-point rule with contact on the mean rate, Laursen and Chawla.
    LaursenChawla(LaursenChawla),
    /// Mid-point rule with the displacement law and a velocity that gets the energy back, Laursen and Love.
    LaursenLove(LaursenLove),
    /// Generalised-alpha with impulses apart, Chen, Acary, Virlez and Brüls.
    NonsmoothAlpha(NonsmoothAlpha),
    /// Extended state space with filtered velocity and acceleration, Krenk.
    Krenk(Krenk),
    /// Newmark with implicit contact forces, Kane, Repetto, Ortiz and Marsden.
    Kane(Kane),
    /// Trapezoid with a projected predictor, Deuflhard, Krause and Ertel.
    ContactStabilised(ContactStabilised),
    /// Discrete gradient, for large transformations, Simo and Tarnow, Gonzalez.
    EnergyMomentum(EnergyMomentum),
}

impl Scheme {
    /// The scheme behind the choice.
    pub fn get(&self) -> &dyn TimeScheme {
        match self {
            Scheme::Newmark(scheme) => scheme,
            Scheme::Theta(scheme) => scheme,
            Scheme::CentralDifference(scheme) => scheme,
            Scheme::GeneralisedAlpha(scheme) => scheme,
            Scheme::Hht(scheme) => scheme,
            Scheme::TchamwaWielgosz(scheme) => scheme,
            Scheme::PaoliSchatzman(scheme) => scheme,
            Scheme::LaursenChawla(scheme) => scheme,
            Scheme::LaursenLove(scheme) => scheme,
            Scheme::NonsmoothAlpha(scheme) => scheme,
            Scheme::Krenk(scheme) => scheme,
            Scheme::Kane(scheme) => scheme,
            Scheme::ContactStabilised(scheme) => scheme,
            Scheme::EnergyMomentum(scheme) => scheme,
        }
    }

    /// Weights of the multipliers of links at the start and the end of a step in the force that the momentum balance sees;
    /// `None` of schemes that no link takes.
    pub fn link_weights(&self) -> Option<[f64; 2]> {
        match self {
            Scheme::Theta(Theta { theta }) => Some([1.0 - theta, *theta]),
            Scheme::EnergyMomentum(_) => Some([0.5, 0.5]),
            Scheme::Newmark(_) | Scheme::CentralDifference(_) => Some([0.0, 1.0]),
            _ => None,
        }
    }

    /// One of each that the linear driver takes, with usual parameters: what the batteries run over.
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
            Scheme::GeneralisedAlpha(GeneralisedAlpha { rho_inf: 0.8 }),
            Scheme::Hht(Hht { alpha: -0.1 }),
            Scheme::TchamwaWielgosz(TchamwaWielgosz { phi: 1.033 }),
            Scheme::PaoliSchatzman(PaoliSchatzman { restitution: 0.0 }),
            Scheme::PaoliSchatzman(PaoliSchatzman { restitution: 0.5 }),
            Scheme::LaursenChawla(LaursenChawla),
            Scheme::LaursenLove(LaursenLove),
            Scheme::NonsmoothAlpha(NonsmoothAlpha { rho_inf: 0.8 }),
            Scheme::Krenk(Krenk { rho_inf: 0.8 }),
            Scheme::Kane(Kane {
                beta: 0.25,
                gamma: 0.5,
            }),
            Scheme::ContactStabilised(ContactStabilised),
        ]
    }
}
