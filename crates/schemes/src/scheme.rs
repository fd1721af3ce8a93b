//! What a time scheme is asked, and its energy balance.

use carom_laws::Level;

use crate::StepMap;

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
    /// Lengths of the stages of a step as parts of it, of sum 1: one in most schemes. Each stage has an unknown, a balance and contact forces of
    /// its own, and starts from the end of the stage before; what later stages need of the start of the step is in the memory.
    fn stages(&self) -> Vec<f64> {
        vec![1.0]
    }
    /// How a stage of a step of the length `dt` (s) depends on its unknown; [`TimeScheme::step_map`] is that of the last one.
    fn stage_map(&self, _stage: usize, dt: f64) -> StepMap {
        self.step_map(dt)
    }
    /// The same before a step of the length `next` (s). The forces of an explicit scheme move the points in the next step alone, so
    /// that the rate which a law constrains is that of the next step.
    fn step_map_before(&self, dt: f64, _next: f64) -> StepMap {
        self.step_map(dt)
    }
    /// Its energy balance for a step of length `dt` (s); `None` where none is known: the energy of all steps is then balanced by works, and
    /// what the scheme dissipates is found as their difference.
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
    /// to its middle.
    fn is_between(&self) -> bool {
        false
    }
    /// Weights of the multipliers of links at the start and the end of a step in the force that the momentum balance sees: those of
    /// a course that is linear between the two, at the instant of the balance. A scheme that balances at the start sees the
    /// multiplier that the step finds.
    fn link_weights(&self) -> [f64; 2] {
        let part = self.step_map(1.0).instant(1.0);
        match part > 0.0 {
            true => [1.0 - part, part],
            false => [0.0, 1.0],
        }
    }
    /// Weights of the forces of links at the start and of the step in their work, over the same displacements as that of contact
    /// forces ([`EnergyIdentity`]), and those of contact forces in most schemes.
    fn link_work(&self, dt: f64) -> [f64; 2] {
        match self.energy_identity(dt) {
            Some(identity) => [identity.old, identity.new],
            None => {
                let impulse = self.step_map(dt).impulse;
                [impulse.old, impulse.new]
            }
        }
    }
    /// Parameters with which the batteries run over the scheme.
    fn usual() -> Vec<Self>
    where
        Self: Sized + Default,
    {
        vec![Self::default()]
    }
    /// Whether a contact law that constrains this quantity can hold.
    fn takes(&self, level: Level) -> bool {
        !(self.is_explicit() && level == Level::Gap)
    }
}
