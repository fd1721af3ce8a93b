//! The balance of a step whose forces are not all linear, by the works of its forces.

use std::sync::Arc;

use super::Driver;
use super::attempt::balance::Weights;
use crate::scheme::EnergyIdentity;
use crate::step_map::Impulse;
use crate::step_terms::{NonlinearTerms, StepTerms};
use crate::tolerated::Tolerated;

impl Driver {
    pub(super) fn balance_by_works(&mut self) {
        let weights = self.attempt.weights_of_forces();
        let identity = self.attempt.identity_of_ledger();
        let told = weights.contacts.iter();
        let told: Vec<_> = told.map(|of| self.attempt.weights_as_told(*of)).collect();
        let friction = self.contacts.friction_work(&self.attempt, &told);
        let obstacles = self.obstacle_work(&told, &|contact| {
            self.contacts.pushed(&self.attempt, contact)
        });
        let own_before = self
            .parts
            .own_energy_at_the_start(&mut self.attempt, &identity);
        let energies = self.parts.energies_at_the_end(&mut self.attempt, &identity);
        self.hold_forces(&weights);
        let worked = self
            .balances
            .work(&self.attempt, self.links.force(), &weights);
        let counted = self.attempt.counted_work(worked.contact, &weights);
        let start = &self.attempt.state.ledger.balance;
        let (taken, jump) = (self.parts.stored(), self.balances.jump());
        // what supports that jump give is no inertia of the step
        let gained = energies.kinetic - start.kinetic - jump.work;
        let stored = energies.strain - start.strain + taken.hardening - start.hardening;
        let own_energy = energies.of_scheme(&identity) - own_before;
        let dissipation = counted - worked.contact + worked.inertia - gained - own_energy
            + worked.internal
            - stored
            - taken.dissipated
            - taken.viscous;
        let tolerated = self.parts.tolerated(&self.attempt);
        self.balances.report_reactions(&self.attempt, &weights);
        self.balances
            .keep_forces(&mut self.attempt, self.links.force(), &weights);
        self.balances
            .exchange(&mut self.attempt, self.links.force());
        let (maps, taken, jump) = (
            &self.attempt.maps,
            self.parts.stored(),
            self.balances.jump(),
        );
        let one = Impulse::weights(0.0, 1.0);
        let [impulse, contact_impulse] = match self.attempt.is_plain() || maps.is_static() {
            true => [&one, &one],
            false => [&maps.first().impulse, &maps.first().contact_impulse],
        };
        self.attempt.next.ledger = self.attempt.state.ledger.after(&StepTerms {
            dt: match maps.is_static() {
                true => 0.0,
                false => self.attempt.dt,
            },
            is_static: maps.is_static(),
            identity: &identity,
            impulse,
            contact_impulse,
            energies,
            work_loads: worked.load,
            work_contacts: counted - friction - obstacles,
            work_links: worked.link,
            dissipation,
            energy_of_scheme: (identity != EnergyIdentity::default()).then_some(own_before),
            forces: worked.forces,
            kick: jump.impulse,
            nonlinear: Some(NonlinearTerms {
                work_supports: worked.reaction + jump.work,
                work_obstacles: obstacles,
                tolerated,
                dissipation_material: taken.dissipated,
                dissipation_damping: worked.damping,
                dissipation_friction: -friction,
                dissipation_viscosity: taken.viscous,
                hardening: taken.hardening,
                hourglass: taken.hourglass,
            }),
            rounding: Tolerated::default(),
        });
    }

    /// Forces of supports and springs in the balance, and the inertia without what contact forces give by themselves.
    fn hold_forces(&mut self, weights: &Weights) {
        let system = Arc::clone(&self.attempt.system);
        let works = self.balances.works_mut();
        self.attempt.balanced_springs(&mut works.springs);
        let factor = self.attempt.contact_factor();
        let (maps, vectors) = (&self.attempt.maps, &mut self.attempt.vectors);
        let push = weights.pushes.then(|| maps.contact());
        if let Some(push) = push {
            for (f, c) in vectors.inertia.iter_mut().zip(&vectors.contact) {
                *f -= push * c;
            }
        }
        works.hold(&system, vectors, (self.links.force(), factor, push));
    }
}
