//! The forces of contacts that are compressed at the start.
//!
//! A law with a compliance gives its force for any gap and rate, so also for those at the start, where an acceleration in balance
//! contains it: `M a_0 = p_0 - f_0 + Nᵀ P_0`. Without P_0 the first half step lacks it, an error of first order. Exact laws have no
//! force before a step: theirs follows from it.

use std::sync::Arc;

use carom_contact::law::{ContactLaw, End, Level, Local, Status};

use super::Contacts;
use super::record::total;
use crate::driver::attempt::Attempt;

/// Looks at the piece of a law's curve, each of which may lead to the next one.
const LOOKS: u32 = 20;

impl Contacts {
    /// Gives the state its gaps, rates, and the forces that laws with a compliance have there.
    pub(crate) fn compress(&mut self, attempt: &mut Attempt) {
        let system = Arc::clone(&attempt.system);
        self.pair_now(attempt);
        for point in 0..system.points() {
            let rows = &self.pairing.rows;
            let (gap, rate) = (rows.gap(point), self.rate_at_start(attempt, point));
            let interface = &mut attempt.state.interface;
            (interface.gap[point], interface.rate[point]) = (gap, rate);
            (interface.force[point], interface.carried[point]) = (0.0, 0.0);
        }
        attempt.state.motion.contact_force.fill(0.0);
        for (number, contact) in system.contacts.iter().enumerate() {
            let zone = system.zone_of_body[system.contacts[number].secondary_body];
            let law = attempt.law(contact);
            let keeps = system.schemes[zone].get().keeps_acceleration();
            if law.get().level() != Level::GapAndRate || !keeps || attempt.is_static() {
                continue;
            }
            for point in system.points_of(number) {
                let interface = &attempt.state.interface;
                let (gap, rate) = (interface.gap[point], interface.rate[point]);
                let (status, force) =
                    at_rest(law.get(), (gap, rate), &self.local(attempt, point, gap));
                if force == 0.0 {
                    continue;
                }
                let interface = &mut attempt.state.interface;
                interface.force[point] = force;
                interface.carried[point] = force;
                interface.status[point] = status;
                let forces = &mut attempt.state.motion.contact_force;
                self.pairing.rows.add_force(point, force, forces);
            }
            let force = |point: usize| attempt.state.interface.force[point];
            let begun = total(system.points_of(number), &self.pairing.rows, force);
            attempt.state.records.contacts[number].begin(begun);
        }
    }
}

/// Status and force (N) of a law with a compliance at a gap (m) and a rate (m/s).
fn at_rest(law: &dyn ContactLaw, (gap, rate): (f64, f64), local: &Local) -> (Status, f64) {
    let local = &local.about(gap, rate);
    let (mut status, mut force) = (Status::Open, 0.0);
    for look in 0..LOOKS {
        let end = End {
            gap_released: gap,
            gap,
            rate,
            force,
        };
        let next = law.status(status, &end, local, look);
        if next == status {
            break;
        }
        status = next;
        let relation = law.relation(status, local);
        force = match status {
            Status::Open => 0.0,
            _ => {
                -(relation.gap * gap + relation.rate * rate + relation.offset) / relation.compliance
            }
        };
    }
    match law.clips() {
        true => (status, force.max(0.0)),
        false => (status, force),
    }
}
