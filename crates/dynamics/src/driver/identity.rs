//! The balance of a step whose forces are all linear: each term has its own formula, what the scheme takes that of its exact
//! identity ([`EnergyIdentity`]).

use std::sync::Arc;

use carom_algebra::reduce::dot;

use super::Driver;
use super::attempt::identity::{End, squares};
use super::attempt::vectors::Vectors;
use crate::ledger::reactions;
use crate::resultant::Resultant;
use crate::step_forces::OutsideForces;
use crate::step_terms::{Squares, StepTerms};

impl Driver {
    /// Energy and momentum of the step.
    pub(super) fn balance_by_identity(&mut self) {
        let system = Arc::clone(&self.attempt.system);
        let identity = self.attempt.identity.unwrap_or_default();
        let energies =
            self.parts
                .energies_at(&mut self.attempt, End::Finish, self.parts.stored().strain);
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
        let Vectors {
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
        let given = &mut self.balances.works_mut().given;
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
            let Vectors { x, push, place, .. } = &mut self.attempt.vectors;
            self.attempt.maps.whole(
                |map| map.force,
                &self.attempt.state.motion,
                [x, push],
                place,
            );
            self.parts.linear_forces(&mut self.attempt);
        }
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let Vectors { work, inertia, .. } = &mut self.attempt.vectors;
        reactions(&system, self.attempt.maps.first(), old, new, inertia, work);
        self.attempt.take_linear_springs();
        let new = &self.attempt.next.motion;
        let Vectors { half, work, .. } = &mut self.attempt.vectors;
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
        self.balances
            .write_reactions(&system, at, |i| work[i] - held(i));
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
