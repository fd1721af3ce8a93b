//! The end of a step: its motion, and the balance of a step whose forces are not all linear.
//!
//! The balance of forces of the step, times the way Δu, is the balance of energy: what inertia takes beyond the change of
//! the kinetic energy, and internal forces beyond what is stored and dissipated by the material, is the scheme's share, of
//! no fixed sign. The residual is the work of what the iterations left unbalanced.

use std::sync::Arc;

use carom_contact::law::Level;

use super::identity::{End, energies};
use super::mean_forces::{MeanForces, Weighted};
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
        let system = Arc::clone(&self.system);
        let old = &self.state.motion;
        let new = &mut self.next.motion;
        let (x, push) = (&self.vectors.x, &self.vectors.push);
        self.maps
            .whole(|map| map.displacement, old, [x, push], &mut new.u);
        self.maps
            .whole(|map| map.velocity, old, [x, push], &mut new.v);
        self.maps
            .whole(|map| map.acceleration, old, [x, push], &mut new.a);
        new.frames.clone_from(&old.frames);
        if self.maps.all().iter().any(StepMap::has_memory) {
            self.maps
                .whole(|map| map.memory, old, [x, push], &mut new.memory);
        }
        for i in system.massless.iter().map(|&unknown| unknown as usize) {
            (new.v[i], new.a[i]) = ((new.u[i] - old.u[i]) / self.dt, 0.0);
        }
        if !system.nonlinear.follows.is_empty() {
            self.follow_motions();
        }
        if self.maps.is_static() {
            self.next.motion.v.fill(0.0);
            self.next.motion.a.fill(0.0);
            self.next.motion.memory.fill(0.0);
        }
        self.end_forces()?;
        let new = &mut self.next.motion;
        new.internal_force.copy_from_slice(&self.vectors.internal);
        new.history.copy_from_slice(&self.vectors.history);
        new.contact_force.copy_from_slice(&self.vectors.contact);
        new.link_force.clone_from(&self.link_force);
        self.keep_bolts();
        self.end_interface();
        self.crush();
        Ok(())
    }

    /// Displacements and velocities of unknowns that follow a motion.
    fn follow_motions(&mut self) {
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

    /// Internal forces at the end of the step and in its balance; of a step that is linear in the unknown the other forces at
    /// the x found too.
    fn end_forces(&mut self) -> Result<(), Error> {
        let affine = self.is_affine();
        let known = self.maps.is_explicit();
        let at_the_end = |map: &StepMap| map.force == map.displacement;
        let all = self.maps.all().iter().all(at_the_end);
        let ended = match affine {
            true => known && all,
            false => self.between() || all,
        };
        if affine {
            self.evaluate_inertia();
            self.evaluate_rate();
            self.evaluate_damping();
        }
        self.vectors
            .balanced
            .copy_from_slice(&self.vectors.internal);
        let dt = self.dt;
        if !ended {
            self.stored = self.internal((Which::Next, false), |_| dt)?;
        }
        if affine && !known && self.system.is_nonlinear() {
            self.balance_linear_forces();
        }
        Ok(())
    }

    /// Internal forces of linear bodies where the balance of the step takes them.
    fn balance_linear_forces(&mut self) {
        if self
            .maps
            .all()
            .iter()
            .any(|map| map.force_fraction.is_none())
        {
            let super::Vectors { x, push, place, .. } = &mut self.vectors;
            self.maps
                .whole(|map| map.force, &self.state.motion, [x, push], place);
            self.linear_forces();
            let super::Vectors { balanced, work, .. } = &mut self.vectors;
            balanced.copy_from_slice(work);
        }
        let (old, new) = (&self.state.motion.internal_force, &self.vectors.internal);
        for (span, map) in self.maps.spans() {
            let Some(part) = map.force_fraction else {
                continue;
            };
            for i in span {
                self.vectors.balanced[i] = (1.0 - part) * old[i] + part * new[i];
            }
        }
    }

    /// Gaps and rates at the end of the step, and times without force.
    pub(super) fn end_interface(&mut self) {
        let system = Arc::clone(&self.system);
        let interface = &mut self.next.interface;
        for point in self.active.within(0..system.points()) {
            interface.carried[point] = interface.force[point];
        }
        interface.count_flights(&self.state.interface.flight, self.dt);
        let has_rate = self.maps.all().iter().any(|map| map.rate != Row::default());
        for (k, contact) in system.contacts.iter().enumerate() {
            let paired = self.paired_at(k);
            let start_in_way = self.map_of(k).start_in_way();
            let ahead = |map: &StepMap| map.displacement.since(&paired.row(map));
            let of_rate = self.law(contact).get().level() == Level::Rate;
            for point in self.active.within(system.points_of(k)) {
                let motion = &self.state.motion;
                let xc = [&self.vectors.x[..], &self.vectors.push];
                let rows = &self.pairing.rows;
                let way = self.maps.on((rows, point), ahead, motion, xc);
                let gap = rows.gap(point) + way;
                let rate = match (has_rate, system.massless.is_empty()) {
                    (false, _) => 0.0,
                    (true, true) => {
                        let rate = |map: &StepMap| map.rate;
                        self.maps.on((rows, point), rate, motion, xc) + rows.rate(point)
                    }
                    (true, false) => rows.product(point, &self.next.motion.v) + rows.rate(point),
                };
                let opening = match of_rate && start_in_way != 0.0 {
                    true => (start_in_way * self.rate_at_start(point)).max(0.0),
                    false => 0.0,
                };
                let interface = &mut self.next.interface;
                interface.gap[point] = gap;
                interface.rate[point] = rate;
                interface.opening[point] = opening;
            }
        }
        self.note_landings();
    }

    /// Renews the memory of the laws at the points that carry a force at the end of the step.
    pub(super) fn crush(&mut self) {
        let (old, new) = (&self.state.interface, &mut self.next.interface);
        for point in self.active.within(0..self.system.points()) {
            new.crush[point] = old.crush[point];
            if new.status[point] != carom_contact::law::Status::Open {
                let law = &self.system.point(point).0.law;
                new.crush[point] = law.crushed(old.crush[point], new.gap[point]);
            }
        }
    }

    /// Energy and momentum of the step.
    pub(super) fn balance(&mut self) {
        match self.system.is_nonlinear() {
            true => self.balance_by_works(),
            false => self.balance_by_identity(),
        }
    }

    /// Weights of the forces at the start and of the step in their works, by zone.
    fn weights(&self) -> Vec<[f64; 2]> {
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
    fn is_plain(&self) -> bool {
        let mut impulses = self.maps.all().iter().map(|map| &map.impulse);
        !self.maps.is_static() && impulses.all(|one| one.gain == 1.0 && one.carry == 0.0)
    }

    fn balance_by_works(&mut self) {
        let system = Arc::clone(&self.system);
        let weights = self.weights();
        let plain = self.is_plain();
        let identity = self.identity_of_ledger();
        let pushes = !self.vectors.push.is_empty();
        // forces that push by themselves are in no other force of the balance
        let of_contact = match pushes {
            true => vec![[0.0, 1.0]; weights.len()],
            false => weights.clone(),
        };
        let friction = self.friction_work(&of_contact);
        let obstacles = self.obstacle_work(&of_contact, &|contact| self.pushed(contact));
        let own_before = self.own_energy_at_the_start(&identity);
        let own_after = self.own_energies(End::Finish, &identity, self.stored.strain);
        let mut works = std::mem::take(&mut self.works);
        self.balanced_springs(&mut works.springs);
        let factor = self.contact_factor();
        let counted = self.identity.is_some().then(|| self.work_weights());
        let (old, new) = (&self.state.motion, &self.next.motion);
        let maps = &self.maps;
        let vectors = &mut self.vectors;
        let with_acceleration = identity.inertia != 0.0;
        let of = (self.stored.strain, with_acceleration, Some(&new.u[..]));
        let [memory, lagged] = own_after;
        let energies = Energies {
            memory,
            lagged,
            ..energies(&system, new, of, &mut vectors.work).of_zones(&self.maps, &system, new)
        };
        if pushes {
            for (f, c) in vectors.inertia.iter_mut().zip(&vectors.contact) {
                *f -= maps.contact() * c;
            }
        }
        let link = &self.link_force[..];
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
        let before = &self.state.forces;
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
        let start = &self.state.ledger.balance;
        // what supports that jump give is no inertia of the step
        let gained = energies.kinetic - start.kinetic - self.jump.work;
        let stored = energies.strain - start.strain + self.stored.hardening - start.hardening;
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
            - self.stored.dissipated
            - self.stored.viscous;
        let nodes = system.nodes_of_whole as f64;
        let travel = (0..new.u.len()).map(|i| (new.u[i] - old.u[i]).powi(2));
        let tolerated = Tolerated {
            energy: self.left_over * travel.sum::<f64>().sqrt(),
            momentum: self.left_over * nodes.sqrt() * self.dt,
        };
        let apart = |i: usize| if pushes { held[i] } else { 0.0 };
        let spring = |i: usize| springs.get(i).unwrap_or(&0.0);
        let at = (&old.frames[..], Some(&new.u[..]));
        reported::write(&mut self.reactions, &system, at, |i| {
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
        for (kept, force) in self.next.forces.each_mut().into_iter().zip(now.each()) {
            kept.clear();
            kept.extend_from_slice(if go_on { force } else { &[] });
        }
        if !maps.is_static() {
            let exchange = &mut self.next.exchange;
            exchange.follow(&self.state.exchange);
            if let Some(impulses) = self.jump.impulses() {
                exchange.jump(&system, impulses);
            }
            let linked = |i: usize| link.get(i).unwrap_or(&0.0);
            let own =
                |i: usize| vectors.load[i] + own[i] + linked(i) - vectors.damping[i] - spring(i);
            let dt = self.dt;
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
        self.next.ledger = self.state.ledger.after(&StepTerms {
            dt: if maps.is_static() { 0.0 } else { self.dt },
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
            kick: self.jump.impulse,
            beyond: Some(Beyond {
                work_supports: support + self.jump.work,
                work_obstacles: obstacles,
                tolerated,
                dissipation_material: self.stored.dissipated,
                dissipation_damping: damping,
                dissipation_friction: -friction,
                dissipation_viscosity: self.stored.viscous,
                hardening: self.stored.hardening,
                hourglass: self.stored.hourglass,
            }),
            rounding: Tolerated::default(),
        });
        self.works = works;
    }

    /// The term of the scheme in the energy of the ledger, at the start of the step, J.
    fn own_energy_at_the_start(&mut self, identity: &EnergyIdentity) -> f64 {
        let strain = self.state.ledger.balance.strain;
        let [memory, lagged] = self.own_energies(End::Start, identity, strain);
        let acceleration = self.acceleration_at_the_start(identity);
        identity.inertia * acceleration + identity.memory * memory + lagged
    }

    /// |a|²_M at the start of the step, as far as the identity asks for it.
    fn acceleration_at_the_start(&mut self, identity: &EnergyIdentity) -> f64 {
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
