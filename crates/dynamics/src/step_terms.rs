//! What a step adds to the balance of energy and momentum: the one way in which linear steps, steps by works and explicit steps in one pass
//! tell it to the [`Ledger`](crate::ledger::Ledger).

use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::step_forces::OutsideForces;
use crate::step_map::Impulse;
use crate::system::{Maps, Motion, System};
use crate::tolerated::Tolerated;

/// The terms of a step.
pub(crate) struct StepTerms<'a> {
    /// Time over which the forces have an impulse, s; zero in a static stage.
    pub(crate) dt: f64,
    /// Whether it is a step of a static stage.
    pub(crate) is_static: bool,
    /// How the energy that the scheme balances is counted.
    pub(crate) identity: &'a EnergyIdentity,
    /// Of loads, supports and links.
    pub(crate) impulse: &'a Impulse,
    /// Of contacts, and of supports against them.
    pub(crate) contact_impulse: &'a Impulse,
    /// At the end.
    pub(crate) energies: Energies,
    /// Work of the loads, J.
    pub(crate) work_loads: f64,
    /// Work of the contacts, J: of obstacles that move and of friction not.
    pub(crate) work_contacts: f64,
    /// Work of the links, J.
    pub(crate) work_links: f64,
    /// What the scheme dissipates, J.
    pub(crate) dissipation: f64,
    /// Energy of the scheme at the start as this step counts it, J: what it gains by a new size of the step alone is no work. None where it is
    /// that of the step before.
    pub(crate) energy_of_scheme: Option<f64>,
    /// Mean forces over the step, or those that the impulses are made of, N.
    pub(crate) forces: OutsideForces<Resultant>,
    /// Impulse of supports at the start of the step, N s.
    pub(crate) kick: Resultant,
    /// What only a step that is not linear has.
    pub(crate) nonlinear: Option<NonlinearTerms>,
    /// What rounding may have left of a linear step.
    pub(crate) rounding: Tolerated,
}

/// What a step that is not linear adds to the balance, J.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NonlinearTerms {
    /// Work of supports that move.
    pub(crate) work_supports: f64,
    /// Work of obstacles that move.
    pub(crate) work_obstacles: f64,
    /// Dissipation of the materials.
    pub(crate) dissipation_material: f64,
    /// Dissipation of the damping.
    pub(crate) dissipation_damping: f64,
    /// Dissipation of friction.
    pub(crate) dissipation_friction: f64,
    /// Dissipation of bulk viscosity.
    pub(crate) dissipation_viscosity: f64,
    /// Energy that hardening stores at the end of the step.
    pub(crate) hardening: f64,
    /// Energy of hourglass modes at the end of the step.
    pub(crate) hourglass: f64,
    /// What the iterations of the step may leave unbalanced.
    pub(crate) tolerated: Tolerated,
}

/// Energies of a state, J.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energies {
    pub(crate) kinetic: f64,
    pub(crate) strain: f64,
    /// |a|²_M.
    pub(crate) acceleration: f64,
    /// |m|²_K.
    pub(crate) memory: f64,
    /// U(u - lag v) - U(u).
    pub(crate) lagged: f64,
    /// Momentum.
    pub(crate) momentum: Resultant,
}

/// What a projection after the step does.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Jump {
    /// Work of its impulses on the mean of the velocities around it, J.
    pub(crate) work: f64,
    /// Work of obstacles that move in its impulses, J.
    pub(crate) work_obstacles: f64,
    /// What the scheme's term in |a|² loses, J.
    pub(crate) dissipation: f64,
    /// Its impulses, N s.
    pub(crate) impulses: OutsideForces<Resultant>,
    /// Force of the contacts that the next step begins with, N.
    pub(crate) contacts: Resultant,
    /// The same of the supports.
    pub(crate) supports: Resultant,
    /// What it adds to the force of the links, N.
    pub(crate) links: Resultant,
}

/// What changed in a step: |Δv|²_M, |Δu|²_K, |Δa|²_M, |Δm|²_K, Δu·MΔa, Δa·NᵀP.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Squares {
    pub(crate) velocity: f64,
    pub(crate) displacement: f64,
    pub(crate) acceleration: f64,
    pub(crate) filtered: f64,
    pub(crate) mixed: f64,
    pub(crate) contact: f64,
    /// What a stage before the step takes, J.
    pub(crate) stage: f64,
}

impl Energies {
    /// These energies of a motion, with the term of the schemes where zones differ.
    pub(crate) fn of_zones(self, maps: &Maps, system: &System, motion: &Motion) -> Energies {
        match maps.only() {
            Some(_) => self,
            None => Energies {
                acceleration: maps.square_of_acceleration(system, motion),
                ..self
            },
        }
    }

    /// The term of the energy that the scheme balances beside kinetic and strain energy, J.
    pub(crate) fn of_scheme(&self, identity: &EnergyIdentity) -> f64 {
        identity.inertia * self.acceleration + identity.memory * self.memory + self.lagged
    }
}

impl Squares {
    /// What the scheme dissipates in the step, J.
    pub(crate) fn dissipation(&self, identity: &EnergyIdentity) -> f64 {
        identity.velocity * self.velocity
            + identity.displacement * self.displacement
            + identity.acceleration * self.acceleration
            + identity.filtered * self.filtered
            + identity.mixed * self.mixed
            + identity.contact * self.contact
            + self.stage
    }
}
