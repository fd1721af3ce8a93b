//! Inertia and damping in the balance of a step whose forces are all linear.

use carom_algebra::reduce::dot;
use carom_bodies::Body;

use super::Attempt;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::step_map::Impulse;
use crate::step_terms::{Energies, Squares};
use crate::system::{Motion, System};

/// How contact forces work in the energy balance.
#[derive(Clone, Copy)]
pub(crate) struct WorkWeights {
    /// Weight of the forces at the start.
    pub(crate) old: f64,
    /// Weight of the forces of the step.
    pub(crate) new: f64,
    /// How far the displacements on which they work lie back along the velocity, s.
    pub(crate) lag: f64,
}

impl WorkWeights {
    /// Whether they count otherwise than forces with these weights at the start and of the step.
    pub(crate) fn differ(&self, weights: [f64; 2]) -> bool {
        self.lag != 0.0 || [self.old, self.new] != weights
    }

    /// Work of the contact forces on the way Δū of the step, J.
    pub(crate) fn of(&self, [old, new]: [&Motion; 2], travel: &[f64]) -> f64 {
        self.old * dot(travel, &old.contact_force) + self.new * dot(travel, &new.contact_force)
    }
}

/// One of the two states around the step.
#[derive(Clone, Copy)]
pub(crate) enum End {
    Start,
    Finish,
}

/// What changed from the old to the new motion, as far as the identity asks for it. Leaves Δu in `travel`.
pub(crate) fn squares(
    system: &System,
    identity: &EnergyIdentity,
    (old, new): (&Motion, &Motion),
    (travel, change, work): (&mut [f64], &mut [f64], &mut [f64]),
) -> Squares {
    let mut squares = Squares::default();
    difference(&old.u, &new.u, travel);
    if identity.velocity != 0.0 {
        difference(&old.v, &new.v, change);
        system.mass.multiply(change, work);
        squares.velocity = dot(change, work);
    }
    if identity.acceleration != 0.0 || identity.mixed != 0.0 {
        difference(&old.a, &new.a, change);
        system.mass.multiply(change, work);
        squares.acceleration = dot(change, work);
        squares.mixed = dot(travel, work);
    }
    if identity.contact != 0.0 {
        difference(&old.a, &new.a, change);
        squares.contact = dot(change, &new.contact_force);
    }
    if identity.displacement != 0.0 {
        // K is linear and symmetric: |Δu|²_K = Δu · Δf
        squares.displacement = dot(travel, &new.internal_force) - dot(travel, &old.internal_force);
    }
    squares
}

/// new - old.
pub(crate) fn difference(old: &[f64], new: &[f64], change: &mut [f64]) {
    for i in 0..change.len() {
        change[i] = new[i] - old[i];
    }
}

/// Energies and momentum of a motion with this strain energy (J): |a|²_M where it is asked for, angular momentum about
/// [`System::about`] of the nodes at these displacements, or in the reference configuration.
pub(crate) fn energies(
    system: &System,
    motion: &Motion,
    (strain, with_acceleration, u): (f64, bool, Option<&[f64]>),
    work: &mut [f64],
) -> Energies {
    system.mass.multiply(&motion.v, work);
    let kinetic = 0.5 * dot(&motion.v, work);
    let momentum = match u {
        Some(u) => Resultant::at(system, (&motion.frames, &[u]), work),
        None => Resultant::of(system, work),
    };
    let mut acceleration = 0.0;
    if with_acceleration {
        system.mass.multiply(&motion.a, work);
        acceleration = dot(&motion.a, work);
    }
    Energies {
        kinetic,
        strain,
        acceleration,
        memory: 0.0,
        lagged: 0.0,
        momentum,
    }
}

impl Attempt {
    /// Weights of the contact forces at the start and of the step in their work: those of the energy identity, or of the
    /// impulse where there is none.
    pub(crate) fn work_weights(&self) -> WorkWeights {
        let Impulse { old, new, .. } = self.maps.first().contact_impulse;
        let of_impulse = WorkWeights { old, new, lag: 0.0 };
        self.identity.map_or(of_impulse, |identity| WorkWeights {
            old: identity.old,
            new: identity.new,
            lag: identity.lag,
        })
    }

    pub(crate) fn motion_at(&self, end: End) -> &Motion {
        match end {
            End::Start => &self.state.motion,
            End::Finish => &self.next.motion,
        }
    }

    /// The factor of |a|²_M in the energy that one scheme balances; zero of several.
    pub(crate) fn inertia_of_identity(&self) -> f64 {
        match self.maps.only() {
            Some(_) => self.identity_of_ledger().inertia,
            None => 0.0,
        }
    }

    /// The identity by which the ledger counts: that of the scheme where all forces are linear, otherwise as far as it is inertia
    /// alone. The forces of bodies that are not linear give the energy that the scheme balances no other form; all else that the scheme
    /// takes is found from its works.
    pub(crate) fn identity_of_ledger(&self) -> EnergyIdentity {
        if self.maps.only().is_none() {
            // the energies of the zones are added, each with its factor
            return EnergyIdentity {
                inertia: 1.0,
                ..EnergyIdentity::default()
            };
        }
        let identity = self.identity.unwrap_or_default();
        match self.system.is_nonlinear() {
            false => identity,
            true => {
                let keeps = self.system.scheme.get().keeps_acceleration();
                let own = EnergyIdentity {
                    inertia: if keeps { identity.inertia } else { 0.0 },
                    ..EnergyIdentity::default()
                };
                // the other terms are quadratic in K
                match self.system.bodies.iter().all(Body::is_linear) {
                    true => EnergyIdentity {
                        lag: identity.lag,
                        memory: identity.memory,
                        ..own
                    },
                    false => own,
                }
            }
        }
    }
}
