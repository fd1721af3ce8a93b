//! The end of a step: its motion, and the balance of a step whose forces are not all linear.
//!
//! The balance of forces of the step, times the way Δu, is the balance of energy: what inertia takes beyond the change of
//! the kinetic energy, and internal forces beyond what is stored and dissipated by the material, is the scheme's share, of
//! no fixed sign. The residual is the work of what the iterations left unbalanced.

use std::sync::Arc;

use carom_contact::law::Level;

use super::identity::{End, energies};
use super::mean_forces::{MeanForces, Weighted};
use super::owners::{Attempt, Contacts, Parts};
use super::reported;
use super::scratch::Works;
use super::{Driver, Which};
use crate::error::Error;
use crate::resultant::Resultant;
use crate::scheme::EnergyIdentity;
use crate::step_forces::{OutsideForces, StepForces};
use crate::step_map::{Impulse, Row, StepMap};
use crate::step_terms::{Beyond, Energies, StepTerms};
use crate::tolerated::Tolerated;

impl Driver {
    /// Writes the motion at the end of the step, its internal forces and histories.
    pub(super) fn advance(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let old = &self.attempt.state.motion;
        let new = &mut self.attempt.next.motion;
        let (x, push) = (&self.attempt.vectors.x, &self.attempt.vectors.push);
        self.attempt
            .maps
            .whole(|map| map.displacement, old, [x, push], &mut new.u);
        self.attempt
            .maps
            .whole(|map| map.velocity, old, [x, push], &mut new.v);
        self.attempt
            .maps
            .whole(|map| map.acceleration, old, [x, push], &mut new.a);
        new.frames.clone_from(&old.frames);
        if self.attempt.maps.all().iter().any(StepMap::has_memory) {
            self.attempt
                .maps
                .whole(|map| map.memory, old, [x, push], &mut new.memory);
        }
        for i in system.massless.iter().map(|&unknown| unknown as usize) {
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.attempt.dt, 0.0);
        }
        if !system.nonlinear.follows.is_empty() {
            self.attempt.follow_motions();
        }
        if self.attempt.maps.is_static() {
            self.attempt.next.motion.v.fill(0.0);
            self.attempt.next.motion.a.fill(0.0);
            self.attempt.next.motion.memory.fill(0.0);
        }
        self.contacts
            .end_forces(&mut self.parts, &mut self.attempt)?;
        let new = &mut self.attempt.next.motion;
        new.internal_force
            .copy_from_slice(&self.attempt.vectors.internal);
        new.history.copy_from_slice(&self.attempt.vectors.history);
        new.contact_force
            .copy_from_slice(&self.attempt.vectors.contact);
        new.link_force.clone_from(&self.links.force);
        self.attempt.keep_bolts();
        self.contacts.end_interface(&mut self.attempt);
        self.contacts.crush(&mut self.attempt);
        Ok(())
    }

    /// Energy and momentum of the step.
    pub(super) fn balance(&mut self) {
        match self.attempt.system.is_nonlinear() {
            true => self.balance_by_works(),
            false => self.balance_by_identity(),
        }
    }

    fn balance_by_works(&mut self) {
        let system = Arc::clone(&self.attempt.system);
        let weights = self.attempt.weights();
        let plain = self.attempt.is_plain();
        let identity = self.attempt.identity_of_ledger();
        let pushes = !self.attempt.vectors.push.is_empty();
        // forces that push by themselves are in no other force of the balance
        let of_contact = match pushes {
            true => vec![[0.0, 1.0]; weights.len()],
            false => weights.clone(),
        };
        let friction = self.contacts.friction_work(&self.attempt, &of_contact);
        let obstacles = self.obstacle_work(&of_contact, &|contact| {
            self.contacts.pushed(&self.attempt, contact)
        });
        let own_before = self
            .parts
            .own_energy_at_the_start(&mut self.attempt, &identity);
        let own_after = self.parts.own_energies(
            &mut self.attempt,
            End::Finish,
            &identity,
            self.parts.stored.strain,
        );
        let mut works = std::mem::take(&mut self.balances.works);
        self.attempt.balanced_springs(&mut works.springs);
        let factor = self.attempt.contact_factor();
        let counted = self
            .attempt
            .identity
            .is_some()
            .then(|| self.attempt.work_weights());
        let (old, new) = (&self.attempt.state.motion, &self.attempt.next.motion);
        let maps = &self.attempt.maps;
        let vectors = &mut self.attempt.vectors;
        let with_acceleration = identity.inertia != 0.0;
        let of = (
            self.parts.stored.strain,
            with_acceleration,
            Some(&new.u[..]),
        );
        let [memory, lagged] = own_after;
        let energies = Energies {
            memory,
            lagged,
            ..energies(&system, new, of, &mut vectors.work).of_zones(
                &self.attempt.maps,
                &system,
                new,
            )
        };
        if pushes {
            for (f, c) in vectors.inertia.iter_mut().zip(&vectors.contact) {
                *f -= maps.contact() * c;
            }
        }
        let link = &self.links.force[..];
        works.hold(
            &system,
            vectors,
            (link, factor, pushes.then(|| maps.contact())),
        );
        let Works {
            contact,
            own,
            held,
            reaction,
            springs,
            mean,
            given,
            ..
        } = &mut works;
        given.clear();
        given.resize(system.parts.len(), 0.0);
        let now = StepForces {
            load: &vectors.load[..],
            contact: &contact[..],
            reaction: &reaction[..],
            inertia: &vectors.inertia[..],
            internal: &vectors.balanced[..],
            damping: &vectors.damping[..],
            link,
            spring: &springs[..],
        };
        let before = &self.attempt.state.forces;
        let weighted = |before, now, weights| Weighted {
            before,
            now,
            weights,
        };
        let mut means = MeanForces {
            system: &system,
            old,
            new,
            mean,
        };
        let (load, loads) = means.given(weighted(&before.load, now.load, &weights), given);
        let of = weighted(&before.contact, now.contact, &of_contact);
        let (touch, contacts) = means.work_and_resultant(of);
        let of = weighted(&before.reaction, now.reaction, &weights);
        let (support, reactions) = means.given(of, given);
        let mut inertia = means.work(weighted(&before.inertia, now.inertia, &weights));
        let internal = means.work(weighted(&before.internal, now.internal, &weights));
        let of = weighted(&before.damping, now.damping, &weights);
        let (damping, damped) = means.work_and_resultant(of);
        let (links, linked) = means.work_and_resultant(weighted(&before.link, now.link, &weights));
        let of = weighted(&before.spring, now.spring, &weights);
        let (_, sprung) = means.work_and_resultant(of);
        if pushes {
            // the inertia of the push is the force that gives it
            inertia += touch + means.work(weighted(&[], &held[..], &of_contact));
        }
        let start = &self.attempt.state.ledger.balance;
        // what supports that jump give is no inertia of the step
        let gained = energies.kinetic - start.kinetic - self.balances.jump.work;
        let stored = energies.strain - start.strain + self.parts.stored.hardening - start.hardening;
        let own_energy = energies.of_scheme(&identity) - own_before;
        // what contacts do is counted as the identity of the scheme counts it, whichever forces the balance takes
        let work_contact = match counted {
            Some(weights) if weights.differ(of_contact[0].map(|weight| weight * factor)) => {
                let moved = |i: usize| {
                    let change = new.v[i] - old.v[i];
                    new.u[i] - old.u[i] - weights.lag * change
                };
                let travel: Vec<f64> = (0..new.u.len()).map(moved).collect();
                weights.of([old, new], &travel)
            }
            _ => touch,
        };
        let scheme = work_contact - touch + inertia - gained - own_energy + internal
            - stored
            - self.parts.stored.dissipated
            - self.parts.stored.viscous;
        let nodes = system.nodes_of_whole as f64;
        let travel = (0..new.u.len()).map(|i| (new.u[i] - old.u[i]).powi(2));
        let tolerated = Tolerated {
            energy: self.parts.left_over * travel.sum::<f64>().sqrt(),
            momentum: self.parts.left_over * nodes.sqrt() * self.attempt.dt,
        };
        let apart = |i: usize| if pushes { held[i] } else { 0.0 };
        let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
        let at = (&old.frames[..], Some(&new.u[..]));
        reported::write(&mut self.balances.reactions, &system, at, |i| {
            reaction[i] + apart(i) - spring(i)
        });
        let places = (&old.frames[..], &[&old.u[..], &new.u[..]][..]);
        let forces = OutsideForces {
            loads,
            contacts,
            supports: reactions.plus(&sprung.reversed()),
            held: match pushes {
                true => Resultant::at(&system, places, held),
                false => Resultant::default(),
            },
            links: linked.plus(&damped.reversed()),
        };
        let go_on = weights.iter().any(|of| of[0] != 0.0) || maps.is_static();
        for (kept, force) in self
            .attempt
            .next
            .forces
            .each_mut()
            .into_iter()
            .zip(now.each())
        {
            kept.clear();
            kept.extend_from_slice(if go_on { force } else { &[] });
        }
        if !maps.is_static() {
            let exchange = &mut self.attempt.next.exchange;
            exchange.follow(&self.attempt.state.exchange);
            if let Some(impulses) = self.balances.jump.impulses() {
                exchange.jump(&system, impulses);
            }
            let linked = |i: usize| link.get(i).unwrap_or(&0.0);
            let own =
                |i: usize| vectors.load[i] + own[i] + linked(i) - vectors.damping[i] - spring(i);
            let dt = self.attempt.dt;
            exchange.add(&system, (0, dt, |i| maps.of(i).impulse), own);
            exchange.add(&system, (1, dt, |i| maps.of(i).contact_impulse), |i| {
                held[i]
            });
        }
        let one = Impulse::weights(0.0, 1.0);
        let [impulse, contact_impulse] = match plain || maps.is_static() {
            true => [&one, &one],
            false => [&maps.first().impulse, &maps.first().contact_impulse],
        };
        self.attempt.next.ledger = self.attempt.state.ledger.after(&StepTerms {
            dt: if maps.is_static() {
                0.0
            } else {
                self.attempt.dt
            },
            is_static: maps.is_static(),
            identity: &identity,
            impulse,
            contact_impulse,
            energies,
            work_loads: load,
            work_contacts: work_contact - friction - obstacles,
            work_links: links,
            dissipation: scheme,
            energy_of_scheme: (identity != EnergyIdentity::default()).then_some(own_before),
            forces,
            kick: self.balances.jump.impulse,
            beyond: Some(Beyond {
                work_supports: support + self.balances.jump.work,
                work_obstacles: obstacles,
                tolerated,
                dissipation_material: self.parts.stored.dissipated,
                dissipation_damping: damping,
                dissipation_friction: -friction,
                dissipation_viscosity: self.parts.stored.viscous,
                hardening: self.parts.stored.hardening,
                hourglass: self.parts.stored.hourglass,
            }),
            rounding: Tolerated::default(),
        });
        self.balances.works = works;
    }
}

impl Attempt {
    /// Displacements and velocities of unknowns that follow a motion.
    pub(super) fn follow_motions(&mut self) {
        let system = &*self.system;
        let (old, new) = (&self.state.motion, &mut self.next.motion);
        let time = [self.state.time, self.state.time + self.dt];
        system.nonlinear.prescribe(time, &mut new.u);
        for follows in &system.nonlinear.follows {
            let i = follows.unknown as usize;
            // the mean rate: the end rate of a mid-point rule would swing about it
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.dt, 0.0);
        }
    }

    /// Weights of the forces at the start and of the step in their works, by zone.
    pub(super) fn weights(&self) -> Vec<[f64; 2]> {
        let zones = 0..self.maps.all().len();
        zones.map(|zone| self.weights_of(zone)).collect()
    }

    /// The same of one zone.
    pub(super) fn weights_of(&self, zone: usize) -> [f64; 2] {
        let impulse = &self.maps.all()[zone].impulse;
        match (self.is_plain(), self.maps.is_static()) {
            _ if self.state.forces.is_empty() => [0.0, 1.0],
            (true, _) => [impulse.old, impulse.new],
            // along a static step forces go from one equilibrium to the next
            (false, true) => [0.5, 0.5],
            (false, false) => [0.0, 1.0],
        }
    }

    /// Whether the forces of a dynamic step change the momentum as they are.
    pub(super) fn is_plain(&self) -> bool {
        let mut impulses = self.maps.all().iter().map(|map| &map.impulse);
        !self.maps.is_static() && impulses.all(|one| one.gain == 1.0 && one.carry == 0.0)
    }

    /// |a|²_M at the start of the step, as far as the identity asks for it.
    pub(super) fn acceleration_at_the_start(&mut self, identity: &EnergyIdentity) -> f64 {
        if identity.inertia == 0.0 {
            return 0.0;
        }
        let motion = &self.state.motion;
        if self.maps.only().is_none() {
            return self.maps.square_of_acceleration(&self.system, motion);
        }
        let work = &mut self.vectors.work;
        self.system.mass.multiply(&motion.a, work);
        carom_algebra::reduce::dot(&motion.a, work)
    }
}

impl Parts {
    /// Internal forces of linear bodies where the balance of the step takes them.
    pub(super) fn balance_linear_forces(&mut self, attempt: &mut Attempt) {
        if attempt
            .maps
            .all()
            .iter()
            .any(|map| map.force_fraction.is_none())
        {
            let super::Vectors { x, push, place, .. } = &mut attempt.vectors;
            attempt
                .maps
                .whole(|map| map.force, &attempt.state.motion, [x, push], place);
            self.linear_forces(attempt);
            let super::Vectors { balanced, work, .. } = &mut attempt.vectors;
            balanced.copy_from_slice(work);
        }
        let (old, new) = (
            &attempt.state.motion.internal_force,
            &attempt.vectors.internal,
        );
        for (span, map) in attempt.maps.spans() {
            let Some(part) = map.force_fraction else {
                continue;
            };
            for i in span {
                attempt.vectors.balanced[i] = (1.0 - part) * old[i] + part * new[i];
            }
        }
    }

    /// The term of the scheme in the energy of the ledger, at the start of the step, J.
    pub(super) fn own_energy_at_the_start(
        &mut self,
        attempt: &mut Attempt,
        identity: &EnergyIdentity,
    ) -> f64 {
        let strain = attempt.state.ledger.balance.strain;
        let [memory, lagged] = self.own_energies(attempt, End::Start, identity, strain);
        let acceleration = attempt.acceleration_at_the_start(identity);
        identity.inertia * acceleration + identity.memory * memory + lagged
    }
}

impl Contacts {
    /// Gaps and rates at the end of the step, and times without force.
    pub(super) fn end_interface(&self, attempt: &mut Attempt) {
        let system = Arc::clone(&attempt.system);
        let interface = &mut attempt.next.interface;
        for point in self.active.within(0..system.points()) {
            interface.carried[point] = interface.force[point];
        }
        interface.count_flights(&attempt.state.interface.flight, attempt.dt);
        let has_rate = attempt
            .maps
            .all()
            .iter()
            .any(|map| map.rate != Row::default());
        for (k, contact) in system.contacts.iter().enumerate() {
            let paired = self.paired_at(k);
            let start_in_way = attempt.map_of(k).start_in_way();
            let ahead = |map: &StepMap| map.displacement.since(&paired.row(map));
            let of_rate = attempt.law(contact).get().level() == Level::Rate;
            for point in self.active.within(system.points_of(k)) {
                let motion = &attempt.state.motion;
                let xc = [&attempt.vectors.x[..], &attempt.vectors.push];
                let rows = &self.pairing.rows;
                let way = attempt.maps.on((rows, point), ahead, motion, xc);
                let gap = rows.gap(point) + way;
                let rate = match (has_rate, system.massless.is_empty()) {
                    (false, _) => 0.0,
                    (true, true) => {
                        let rate = |map: &StepMap| map.rate;
                        attempt.maps.on((rows, point), rate, motion, xc) + rows.rate(point)
                    }
                    (true, false) => rows.product(point, &attempt.next.motion.v) + rows.rate(point),
                };
                let opening = match of_rate && start_in_way != 0.0 {
                    true => (start_in_way * self.rate_at_start(attempt, point)).max(0.0),
                    false => 0.0,
                };
                let interface = &mut attempt.next.interface;
                interface.gap[point] = gap;
                interface.rate[point] = rate;
                interface.opening[point] = opening;
            }
        }
        self.note_landings(attempt);
    }

    /// Renews the memory of the laws at the points that carry a force at the end of the step.
    pub(super) fn crush(&self, attempt: &mut Attempt) {
        let (old, new) = (&attempt.state.interface, &mut attempt.next.interface);
        for point in self.active.within(0..attempt.system.points()) {
            new.crush[point] = old.crush[point];
            if new.status[point] != carom_contact::law::Status::Open {
                let law = &attempt.system.point(point).0.law;
                new.crush[point] = law.crushed(old.crush[point], new.gap[point]);
            }
        }
    }

    /// Internal forces at the end of the step and in its balance; of a step that is linear in the unknown the other forces at
    /// the x found too.
    pub(super) fn end_forces(&self, parts: &mut Parts, attempt: &mut Attempt) -> Result<(), Error> {
        let affine = self.is_affine(parts);
        let known = attempt.maps.is_explicit();
        let at_the_end = |map: &StepMap| map.force == map.displacement;
        let all = attempt.maps.all().iter().all(at_the_end);
        let ended = match affine {
            true => known && all,
            false => attempt.between() || all,
        };
        if affine {
            attempt.evaluate_inertia();
            attempt.evaluate_rate();
            parts.evaluate_damping(attempt);
        }
        attempt
            .vectors
            .balanced
            .copy_from_slice(&attempt.vectors.internal);
        let dt = attempt.dt;
        if !ended {
            parts.stored = parts.internal(attempt, (Which::Next, false), |_| dt)?;
        }
        if affine && !known && attempt.system.is_nonlinear() {
            parts.balance_linear_forces(attempt);
        }
        Ok(())
    }
}
