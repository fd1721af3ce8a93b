//! The contacts of an explicit step with lumped mass.

use carom_contact::Rows;

use super::Contacts;
use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Direct;

impl Contacts {
    /// Forgets what the step before left for the next.
    pub(crate) fn forget_step(&mut self, direct: &mut Direct) {
        (direct.clean, direct.finite) = (false, false);
        (direct.pending, direct.ready) = (None, None);
        self.active.leave();
    }

    /// Adds the forces of the points to those of the nodes.
    pub(crate) fn spread_directly(&self, attempt: &mut Attempt, direct: &mut Direct) {
        let (system, interface) = (&*attempt.system, &attempt.next.interface);
        let forces = &mut attempt.next.motion.contact_force;
        let mut add = |rows: &Rows, point: usize, force: f64| {
            if force == 0.0 {
                return;
            }
            rows.add_force(point, force, forces);
            let mut last = usize::MAX;
            for &unknown in rows.row(point).0 {
                let node = unknown as usize / system.dim;
                if node != last {
                    direct.touch(node);
                }
                last = node;
            }
        };
        for point in self.active.within(0..system.points()) {
            add(&self.pairing.rows, point, interface.force[point]);
            let tangential = interface.friction.get(point).into_iter().flatten();
            for (rows, &t) in self.pairing.tangents.iter().zip(tangential) {
                add(rows, point, t);
            }
        }
    }

    /// Gaps, rates and memories of the contact points.
    pub(crate) fn end_points(&self, attempt: &mut Attempt) {
        // the unknown is the acceleration
        std::mem::swap(&mut attempt.vectors.x, &mut attempt.next.motion.a);
        self.end_interface(attempt);
        std::mem::swap(&mut attempt.vectors.x, &mut attempt.next.motion.a);
        self.crush(attempt);
    }
}
