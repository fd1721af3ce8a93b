//! The end of a step: its motion, and the balance of a step whose forces are not all linear.
//!
//! The balance of forces of the step, times the way Δu, is the balance of energy: what inertia takes beyond the change of
//! the kinetic energy, and internal forces beyond what is stored and dissipated by the material, is the scheme's share, of
//! no fixed sign. The residual is the work of what the iterations left unbalanced.

use std::sync::Arc;

use carom_contact::law::Level;

use super::owners::{Attempt, Contacts, Parts};
use super::{Configuration, Driver};
use crate::error::Error;
use crate::scheme::EnergyIdentity;
use crate::step_map::{Row, StepMap};

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

    /// Weights of the forces at the start ([`Impulse`](crate::step_map::Impulse)) and of the step in their works, by zone.
    pub(super) fn weights(&self) -> Vec<[f64; 2]> {
        let zones = 0..self.maps.all().len();
        zones.map(|zone| self.weights_of(zone)).collect()
    }

    /// The same of one zone.
    pub(super) fn weights_of(&self, zone: usize) -> [f64; 2] {
        let impulse = &self.maps.all()[zone].impulse;
        match (self.is_plain(), self.maps.is_static()) {
            _ if self.state.forces.is_empty() => [0.0, 1.0],
            (true, _) => [impulse.of_start(), impulse.new],
            // along a static step forces go from one equilibrium to the next
            (false, true) => [0.5, 0.5],
            (false, false) => [0.0, 1.0],
        }
    }

    /// Whether the forces of a dynamic step change the momentum as they are, or in stages by their sums.
    pub(super) fn is_plain(&self) -> bool {
        let staged = self.stage.is_one_of_several();
        let mut impulses = self.maps.all().iter().map(|map| &map.impulse);
        !self.maps.is_static()
            && impulses.all(|one| one.gain == 1.0 && (one.carry == 0.0 || staged))
    }

    /// What forces of friction and of obstacles weigh at the start and in the step in their works. In stages they are not kept as the momentum
    /// takes them: the force of the stage keeps its weight, and that at its start has what is left of 1.
    pub(super) fn weights_as_told(&self, weights: [f64; 2]) -> [f64; 2] {
        match self.stage.is_one_of_several() && !self.maps.is_static() {
            true => [1.0 - weights[1], weights[1]],
            false => weights,
        }
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
}

impl Contacts {
    /// Gaps and rates at the end of the step, and times without force.
    pub(super) fn end_interface(&self, attempt: &mut Attempt) {
        let system = Arc::clone(&attempt.system);
        let interface = &mut attempt.next.interface;
        for point in self.active.within(0..system.points()) {
            interface.carried[point] = interface.force[point];
        }
        if attempt.stage.is_one_of_several() && !attempt.maps.is_static() {
            let carry = attempt.maps.first().contact_impulse.carry;
            for point in self.active.within(0..system.points()) {
                interface.carried[point] -= carry * attempt.state.interface.carried[point];
            }
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
            parts.stored = parts.internal(attempt, (Configuration::Next, false), |_| dt)?;
        }
        if affine && !known && attempt.system.is_nonlinear() {
            parts.balance_linear_forces(attempt);
        }
        Ok(())
    }
}
