//! The parts at the start of a run.

use std::sync::Arc;

use super::Parts;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::vectors::Vectors;
use crate::exchange::Exchange;
use crate::ledger::{Ledger, reactions};
use crate::resultant::Resultant;
use crate::step_forces::OutsideForces;

impl Parts {
    /// The ledger at the start, of linear forces.
    pub(crate) fn start_identity(&mut self, attempt: &mut Attempt, strain: f64) {
        let system = Arc::clone(&attempt.system);
        let energies = self.energies_at_the_start(attempt, strain);
        let motion = &attempt.state.motion;
        let Vectors {
            inertia,
            work,
            place,
            ..
        } = &mut attempt.vectors;
        system.mass.multiply(&motion.a, inertia);
        work.copy_from_slice(&motion.internal_force);
        reactions(&system, attempt.maps.first(), motion, motion, inertia, work);
        place.copy_from_slice(&motion.u);
        attempt.take_linear_springs_at_place();
        let motion = &attempt.state.motion;
        let Vectors { work, place, .. } = &mut attempt.vectors;
        let supports = Resultant::of(&system, work);
        for (i, force) in work.iter_mut().enumerate() {
            *force += system.load[i] + motion.link_of(i);
        }
        system.mass.multiply(&motion.v, place);
        let map = attempt.maps.first();
        let apart = map.impulse != map.contact_impulse;
        let contact = &attempt.state.motion.contact_force;
        let held = |(&force, &fixed): (&f64, &bool)| if apart && fixed { -force } else { 0.0 };
        let held: Vec<f64> = contact.iter().zip(&system.fixed).map(held).collect();
        attempt.state.exchange = Exchange::start(&system, place, [work, &held]);
        let held = Resultant::of(&system, &held);
        let loads = Resultant::of(&system, &system.load);
        let link = Resultant::of(&system, &attempt.state.motion.link_force);
        let contact = Resultant::of(&system, &attempt.state.motion.contact_force);
        let forces = OutsideForces {
            loads,
            contacts: contact,
            supports,
            held,
            links: link,
        };
        let identity = attempt.identity.unwrap_or_default();
        attempt.state.ledger = Ledger::start(&energies, &identity, forces);
    }
}
