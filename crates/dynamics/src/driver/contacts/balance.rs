//! Gaps and rates of the contact points at the end of a step, and what they miss of their laws.

use std::sync::Arc;

use carom_contact::law::Level;

use super::Contacts;
use crate::driver::attempt::{Attempt, Configuration};
use crate::driver::parts::Parts;
use crate::error::Error;
use crate::step_map::{Row, StepMap};

impl Contacts {
    /// Gaps and rates at the end of the step, and times without force.
    pub(crate) fn end_interface(&self, attempt: &mut Attempt) {
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
        interface.faced.clear();
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
                if interface.force[point] != 0.0 || gap <= 0.0 {
                    let faced = self.pairing.faced(point);
                    interface
                        .faced
                        .extend(faced.map(|faced| (point as u32, faced)));
                }
            }
        }
        self.note_landings(attempt);
    }

    /// Renews the memory of the laws at the points that carry a force at the end of the step.
    pub(crate) fn crush(&self, attempt: &mut Attempt) {
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
    pub(crate) fn end_forces(&self, parts: &mut Parts, attempt: &mut Attempt) -> Result<(), Error> {
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
            parts.internal(attempt, (Configuration::Next, false), |_| dt)?;
        }
        if affine && !known && attempt.system.is_nonlinear() {
            parts.balance_linear_forces(attempt);
        }
        Ok(())
    }
}
