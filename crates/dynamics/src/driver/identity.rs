//! The balance of a step whose forces are all linear: each term has its own formula, what the scheme takes that of its exact
//! identity ([`EnergyIdentity`]).

use std::sync::Arc;

use carom_algebra::reduce::dot;
use carom_bodies::Body;

use super::Driver;
use super::owners::{Attempt, Parts};
use super::reported;
use crate::ledger::reactions;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::step_forces::OutsideForces;
use crate::step_map::Impulse;
use crate::step_terms::{Energies, Squares, StepTerms};
use crate::system::{Motion, System};

/// How contact forces work in the energy balance.
#[derive(Clone, Copy)]
pub(super) struct WorkWeights {
    /// Weight of the forces at the start.
    pub(super) old: f64,
    /// Weight of the forces of the step.
    pub(super) new: f64,
    /// How far the displacements on which they work lie back along the velocity, s.
    pub(super) lag: f64,
}

impl WorkWeights {
    /// Whether they count otherwise than forces with these weights at the start and of the step.
    pub(super) fn differ(&self, weights: [f64; 2]) -> bool {
        self.lag != 0.0 || [self.old, self.new] != weights
    }

    /// Work of the contact forces on the way Δū of the step, J.
    pub(super) fn of(&self, [old, new]: [&Motion; 2], travel: &[f64]) -> f64 {
        self.old * dot(travel, &old.contact_force) + self.new * dot(travel, &new.contact_force)
    }
}

/// One of the two states around the step.
#[derive(Clone, Copy)]
pub(super) enum End {
    Start,
    Finish,
}

impl Driver {
    /// Energy and momentum of the step.
    pub(super) fn balance_by_identity(&mut self) {
        let system = Arc::clone(&self.attempt.system);
        let identity = self.attempt.identity.unwrap_or_default();
        let energies =
            self.parts
                .energies_at(&mut self.attempt, End::Finish, self.parts.stored.strain);
        let filtered = self.parts.filtered(&mut self.attempt, &identity);
        let [supports, held] = self.reactions();
        let stage = self.stages.predictor_loss(&self.contacts, &self.attempt);
        let (weights, of_links) = (
            self.attempt.work_weights(),
            self.attempt.link_work_weights(0),
        );
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let contact = Resultant::of(&system, &new.contact_force);
        let loads = Resultant::of(&system, &system.load);
        let links = Resultant::of(&system, &new.link_force);
        let super::Vectors {
            before: travel,
            place,
            work,
            ..
        } = &mut self.attempt.vectors;
        let squares = Squares {
            stage,
            filtered,
            ..squares(&system, &identity, (old, new), (travel, place, work))
        };
        if identity.lag != 0.0 {
            for i in 0..travel.len() {
                travel[i] -= identity.lag * (new.v[i] - old.v[i]);
            }
        }
        let work_contact = weights.of([old, new], travel);
        let work_loads = dot(travel, &system.load);
        let given = &mut self.balances.works.given;
        given.clear();
        given.extend(system.parts.iter().map(|part| {
            let unknowns = part.clone();
            unknowns.map(|i| travel[i] * system.load[i]).sum::<f64>()
        }));
        let work_links = match new.link_force.is_empty() {
            true => 0.0,
            false => {
                let weights = &of_links;
                weights.old * dot(travel, &old.link_force)
                    + weights.new * dot(travel, &new.link_force)
            }
        };
        let rounding = self.parts.rounding_of_step(&self.attempt);
        let energy_of_scheme = (self.attempt.dt != self.attempt.state.control.taken).then(|| {
            let strain = self.attempt.state.ledger.balance.strain;
            let at_the_start = self.parts.energies_at_the_start(&mut self.attempt, strain);
            at_the_start.of_scheme(&identity)
        });
        self.attempt.next.ledger = self.attempt.state.ledger.after(&StepTerms {
            dt: self.attempt.dt,
            is_static: false,
            identity: &identity,
            impulse: &self.attempt.maps.first().impulse,
            contact_impulse: &self.attempt.maps.first().contact_impulse,
            energies,
            work_loads,
            work_contacts: work_contact,
            work_links,
            dissipation: squares.dissipation(&identity),
            energy_of_scheme,
            forces: OutsideForces {
                loads,
                contacts: contact,
                supports,
                held,
                links,
            },
            kick: Resultant::default(),
            nonlinear: None,
            rounding,
        });
    }

    /// Resultants of the forces of the supports and the ground in the step; apart, those against contact forces that act in the
    /// impulse in their own way.
    fn reactions(&mut self) -> [Resultant; 2] {
        let system = Arc::clone(&self.attempt.system);
        if self.attempt.maps.first().force_fraction.is_none() {
            let super::Vectors { x, push, place, .. } = &mut self.attempt.vectors;
            self.attempt.maps.whole(
                |map| map.force,
                &self.attempt.state.motion,
                [x, push],
                place,
            );
            self.parts.linear_forces(&mut self.attempt);
        }
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let super::Vectors { work, inertia, .. } = &mut self.attempt.vectors;
        reactions(&system, self.attempt.maps.first(), old, new, inertia, work);
        self.attempt.take_linear_springs();
        let new = &self.attempt.next.motion;
        let super::Vectors { half, work, .. } = &mut self.attempt.vectors;
        let exchange = &mut self.attempt.next.exchange;
        exchange.follow(&self.attempt.state.exchange);
        let own = |i: usize| work[i] + system.load[i] + new.link_of(i);
        exchange.add(
            &system,
            (0, self.attempt.dt, |_| self.attempt.maps.first().impulse),
            own,
        );
        let supports = Resultant::of(&system, work);
        let apart = self.attempt.maps.first().impulse != self.attempt.maps.first().contact_impulse;
        let held = |i: usize| if apart { new.contact_force[i] } else { 0.0 };
        let at = (&self.attempt.state.motion.frames[..], None);
        reported::write(&mut self.balances.reactions, &system, at, |i| {
            work[i] - held(i)
        });
        if !apart {
            return [supports, Resultant::default()];
        }
        for (i, held) in half.iter_mut().enumerate() {
            *held = match system.fixed[i] {
                true => -new.contact_force[i],
                false => 0.0,
            };
        }
        exchange.add(
            &system,
            (1, self.attempt.dt, |_| {
                self.attempt.maps.first().contact_impulse
            }),
            |i| half[i],
        );
        [supports, Resultant::of(&system, half)]
    }
}

impl Attempt {
    /// Weights of the contact forces at the start and of the step in their work: those of the energy identity, or of the
    /// impulse where there is none.
    pub(super) fn work_weights(&self) -> WorkWeights {
        let Impulse { old, new, .. } = self.maps.first().contact_impulse;
        let of_impulse = WorkWeights { old, new, lag: 0.0 };
        self.identity.map_or(of_impulse, |identity| WorkWeights {
            old: identity.old,
            new: identity.new,
            lag: identity.lag,
        })
    }

    pub(super) fn motion_at(&self, end: End) -> &Motion {
        match end {
            End::Start => &self.state.motion,
            End::Finish => &self.next.motion,
        }
    }

    /// The factor of |a|²_M in the energy that one scheme balances; zero of several.
    pub(super) fn inertia_of_identity(&self) -> f64 {
        match self.maps.only() {
            Some(_) => self.identity_of_ledger().inertia,
            None => 0.0,
        }
    }

    /// The identity by which the ledger counts: that of the scheme where all forces are linear, otherwise as far as it is inertia
    /// alone. The forces of bodies that are not linear give the energy that the scheme balances no other form; all else that the scheme
    /// takes is found from its works.
    pub(super) fn identity_of_ledger(&self) -> EnergyIdentity {
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

impl Parts {
    /// Energies of a motion with this strain energy (J), those that the scheme balances beside included.
    pub(super) fn energies_at(&mut self, attempt: &mut Attempt, end: End, strain: f64) -> Energies {
        let system = Arc::clone(&attempt.system);
        let identity = attempt.identity.unwrap_or_default();
        let [memory, lagged] = self.own_energies(attempt, end, &identity, strain);
        let motion = match end {
            End::Start => &attempt.state.motion,
            End::Finish => &attempt.next.motion,
        };
        let work = &mut attempt.vectors.work;
        let with_acceleration = identity.inertia != 0.0;
        Energies {
            memory,
            lagged,
            ..energies(&system, motion, (strain, with_acceleration, None), work)
        }
    }

    /// |m|²_K and U(u - lag v) - U(u) of a motion with this strain energy, J, as far as the identity asks for them; of linear bodies.
    pub(super) fn own_energies(
        &mut self,
        attempt: &mut Attempt,
        end: End,
        identity: &EnergyIdentity,
        strain: f64,
    ) -> [f64; 2] {
        let mut place = std::mem::take(&mut attempt.vectors.place);
        let mut lagged = 0.0;
        if identity.lag != 0.0 {
            let motion = attempt.motion_at(end);
            for (i, place) in place.iter_mut().enumerate() {
                *place = motion.u[i] - identity.lag * motion.v[i];
            }
            attempt.vectors.place = place;
            lagged = self.linear_forces(attempt) - strain;
            place = std::mem::take(&mut attempt.vectors.place);
        }
        let mut memory = 0.0;
        if identity.memory != 0.0 {
            place.copy_from_slice(&attempt.motion_at(end).memory);
            attempt.vectors.place = place;
            // U is quadratic
            memory = 2.0 * self.linear_forces(attempt);
            place = std::mem::take(&mut attempt.vectors.place);
        }
        attempt.vectors.place = place;
        [memory, lagged]
    }

    /// Energies of the state, with what the scheme of the step balances.
    pub(super) fn energies_at_the_start(&mut self, attempt: &mut Attempt, strain: f64) -> Energies {
        self.energies_at(attempt, End::Start, strain)
    }

    /// |Δm|²_K of the step, as far as the identity asks for it.
    pub(super) fn filtered(&mut self, attempt: &mut Attempt, identity: &EnergyIdentity) -> f64 {
        if identity.filtered == 0.0 {
            return 0.0;
        }
        let [old, new] = [&attempt.state, &attempt.next].map(|state| &state.motion.memory);
        difference(old, new, &mut attempt.vectors.place);
        2.0 * self.linear_forces(attempt)
    }
}

/// What changed from the old to the new motion, as far as the identity asks for it. Leaves Δu in `travel`.
fn squares(
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
fn difference(old: &[f64], new: &[f64], change: &mut [f64]) {
    for i in 0..change.len() {
        change[i] = new[i] - old[i];
    }
}

/// Energies and momentum of a motion with this strain energy (J): |a|²_M where it is asked for, angular momentum about
/// [`System::about`] of the nodes at these displacements, or in the reference configuration.
pub(super) fn energies(
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
