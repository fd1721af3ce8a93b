//! The balance of a step whose forces are not all linear, by the works of its forces.

use std::sync::Arc;

use super::Driver;
use super::identity::{End, energies};
use super::mean_forces::{MeanForces, Weighted};
use super::owners::{Attempt, Balances, Parts};
use super::reported;
use super::scratch::{Vectors, Works};
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::step_forces::{OutsideForces, StepForces};
use crate::step_map::Impulse;
use crate::step_terms::{Energies, NonlinearTerms, StepTerms};
use crate::tolerated::Tolerated;

/// Weights of the forces at the start and of the step in their means, by zone.
struct Weights {
    forces: Vec<[f64; 2]>,
    contacts: Vec<[f64; 2]>,
    /// Whether contact forces push by themselves.
    pushes: bool,
}

/// Works of the forces on the way of the step, J, and resultants, N.
struct Worked {
    load: f64,
    contact: f64,
    reaction: f64,
    inertia: f64,
    internal: f64,
    damping: f64,
    link: f64,
    forces: OutsideForces<Resultant>,
}

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
            .work(&self.attempt, &self.links.force, &weights);
        let counted = self.attempt.counted_work(worked.contact, &weights);
        let start = &self.attempt.state.ledger.balance;
        let (taken, jump) = (&self.parts.stored, &self.balances.jump);
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
            .keep_forces(&mut self.attempt, &self.links.force, &weights);
        self.balances.exchange(&mut self.attempt, &self.links.force);
        let (maps, taken, jump) = (&self.attempt.maps, &self.parts.stored, &self.balances.jump);
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
        let works = &mut self.balances.works;
        self.attempt.balanced_springs(&mut works.springs);
        let factor = self.attempt.contact_factor();
        let (maps, vectors) = (&self.attempt.maps, &mut self.attempt.vectors);
        let push = weights.pushes.then(|| maps.contact());
        if let Some(push) = push {
            for (f, c) in vectors.inertia.iter_mut().zip(&vectors.contact) {
                *f -= push * c;
            }
        }
        works.hold(&system, vectors, (&self.links.force, factor, push));
    }
}

/// The forces in the balance of the step.
fn balanced<'a>(
    vectors: &'a Vectors,
    link: &'a [f64],
    [contact, reaction, spring]: [&'a [f64]; 3],
) -> StepForces<&'a [f64]> {
    StepForces {
        load: &vectors.load,
        contact,
        reaction,
        inertia: &vectors.inertia,
        internal: &vectors.balanced,
        damping: &vectors.damping,
        link,
        spring,
    }
}

impl Balances {
    /// What the forces of the step do on its way.
    fn work(&mut self, attempt: &Attempt, link: &[f64], weights: &Weights) -> Worked {
        let system = &*attempt.system;
        let (old, new) = (&attempt.state.motion, &attempt.next.motion);
        let Works {
            contact,
            held,
            reaction,
            springs,
            mean,
            given,
            ..
        } = &mut self.works;
        given.clear();
        given.resize(system.parts.len(), 0.0);
        let now = balanced(&attempt.vectors, link, [contact, reaction, springs]);
        let before = &attempt.state.forces;
        let weigh = |before, now, weights| Weighted {
            before,
            now,
            weights,
        };
        let own = |before, now| weigh(before, now, &weights.forces);
        let of_contacts = |before, now| weigh(before, now, &weights.contacts);
        let mut means = MeanForces {
            system,
            old,
            new,
            mean,
        };
        let (load, loads) = means.given(own(&before.load, now.load), given);
        let (touch, contacts) = means.work_and_resultant(of_contacts(&before.contact, now.contact));
        let (reaction, reactions) = means.given(own(&before.reaction, now.reaction), given);
        let mut inertia = means.work(own(&before.inertia, now.inertia));
        let internal = means.work(own(&before.internal, now.internal));
        let (damping, damped) = means.work_and_resultant(own(&before.damping, now.damping));
        let (link, linked) = means.work_and_resultant(own(&before.link, now.link));
        let (_, sprung) = means.work_and_resultant(own(&before.spring, now.spring));
        if weights.pushes {
            // the inertia of the push is the force that gives it
            inertia += touch + means.work(of_contacts(&[], held));
        }
        let places = (&old.frames[..], &[&old.u[..], &new.u[..]][..]);
        Worked {
            load,
            contact: touch,
            reaction,
            inertia,
            internal,
            damping,
            link,
            forces: OutsideForces {
                loads,
                contacts,
                supports: reactions.plus(&sprung.reversed()),
                held: match weights.pushes {
                    true => Resultant::at(system, places, held),
                    false => Resultant::default(),
                },
                links: linked.plus(&damped.reversed()),
            },
        }
    }

    /// Forces of the named supports.
    fn report_reactions(&mut self, attempt: &Attempt, weights: &Weights) {
        let Works {
            held,
            reaction,
            springs,
            ..
        } = &self.works;
        let apart = |i: usize| if weights.pushes { held[i] } else { 0.0 };
        let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
        let (frames, u) = (&attempt.state.motion.frames[..], &attempt.next.motion.u[..]);
        reported::write(
            &mut self.reactions,
            &attempt.system,
            (frames, Some(u)),
            |i| reaction[i] + apart(i) - spring(i),
        );
    }

    /// Keeps the forces of the step for the balance of the next one, if that has them at its start; in stages as the momentum takes them.
    fn keep_forces(&self, attempt: &mut Attempt, link: &[f64], weights: &Weights) {
        let go_on = weights.forces.iter().any(|of| of[0] != 0.0) || attempt.maps.is_static();
        let carry = match attempt.is_plain() {
            true => attempt.maps.first().impulse.carry,
            false => 0.0,
        };
        let works = &self.works;
        let own = [&works.contact[..], &works.reaction, &works.springs];
        let now = balanced(&attempt.vectors, link, own);
        let kept = attempt.next.forces.each_mut().into_iter();
        for (kept, force) in kept.zip(now.each()) {
            kept.clear();
            kept.extend_from_slice(if go_on { force } else { &[] });
        }
        if carry == 0.0 {
            return;
        }
        let (kept, before) = (&mut attempt.next.forces, &attempt.state.forces);
        for (kept, before) in kept.each_mut().into_iter().zip(before.each()) {
            let both = kept.iter_mut().zip(before);
            both.for_each(|(kept, before)| *kept -= carry * before);
        }
    }

    /// What the forces from outside give to the momentum of each connected part; not in a static stage.
    fn exchange(&self, attempt: &mut Attempt, link: &[f64]) {
        let maps = &attempt.maps;
        if maps.is_static() {
            return;
        }
        let (system, vectors) = (&*attempt.system, &attempt.vectors);
        let exchange = &mut attempt.next.exchange;
        exchange.follow(&attempt.state.exchange);
        if let Some(impulses) = self.jump.impulses() {
            exchange.jump(system, impulses);
        }
        let Works {
            own, held, springs, ..
        } = &self.works;
        let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
        let linked = |i: usize| link.get(i).unwrap_or(&0.0);
        let own = |i: usize| vectors.load[i] + own[i] + linked(i) - vectors.damping[i] - spring(i);
        let dt = attempt.dt;
        exchange.add(system, (0, dt, |i| maps.of(i).impulse), own);
        exchange.add(system, (1, dt, |i| maps.of(i).contact_impulse), |i| held[i]);
    }
}

impl Parts {
    /// Energies of the end, with what the scheme balances beside.
    fn energies_at_the_end(
        &mut self,
        attempt: &mut Attempt,
        identity: &EnergyIdentity,
    ) -> Energies {
        let strain = self.stored.strain;
        let [memory, lagged] = self.own_energies(attempt, End::Finish, identity, strain);
        let (system, new) = (&*attempt.system, &attempt.next.motion);
        let of = (strain, identity.inertia != 0.0, Some(&new.u[..]));
        let found = energies(system, new, of, &mut attempt.vectors.work);
        Energies {
            memory,
            lagged,
            ..found.of_zones(&attempt.maps, system, new)
        }
    }

    /// What the iterations of the step may leave of energy and momentum.
    fn tolerated(&self, attempt: &Attempt) -> Tolerated {
        let (old, new) = (&attempt.state.motion.u, &attempt.next.motion.u);
        let travel = (0..new.len()).map(|i| (new[i] - old[i]).powi(2));
        let nodes = attempt.system.nodes_of_whole as f64;
        Tolerated {
            energy: self.left_over * travel.sum::<f64>().sqrt(),
            momentum: self.left_over * nodes.sqrt() * attempt.dt,
        }
    }

    /// The term of the scheme in the energy of the ledger, at the start of the step, J.
    fn own_energy_at_the_start(&mut self, attempt: &mut Attempt, identity: &EnergyIdentity) -> f64 {
        let strain = attempt.state.ledger.balance.strain;
        let [memory, lagged] = self.own_energies(attempt, End::Start, identity, strain);
        let acceleration = attempt.acceleration_at_the_start(identity);
        identity.inertia * acceleration + identity.memory * memory + lagged
    }
}

impl Attempt {
    fn weights_of_forces(&self) -> Weights {
        let forces = self.weights();
        let pushes = !self.vectors.push.is_empty();
        Weights {
            // forces that push by themselves are in no other force of the balance
            contacts: match pushes {
                true => vec![[0.0, 1.0]; forces.len()],
                false => forces.clone(),
            },
            forces,
            pushes,
        }
    }

    /// Work of the contact forces, J, as the identity of the scheme counts it, whichever forces the balance takes. `touch`: that in the balance.
    fn counted_work(&self, touch: f64, of: &Weights) -> f64 {
        let factor = self.contact_factor();
        let counted = self.identity.is_some().then(|| self.work_weights());
        let (old, new) = (&self.state.motion, &self.next.motion);
        match counted {
            Some(weights) if weights.differ(of.contacts[0].map(|weight| weight * factor)) => {
                let moved = |i: usize| {
                    let change = new.v[i] - old.v[i];
                    new.u[i] - old.u[i] - weights.lag * change
                };
                let travel: Vec<f64> = (0..new.u.len()).map(moved).collect();
                weights.of([old, new], &travel)
            }
            _ => touch,
        }
    }
}
