//! When the matrices of a step are made.

use std::sync::Arc;
use std::time::Instant;

use super::Driver;
use super::parts::effective::{At, Turning};
use super::parts::floating::{GROWTH as HEAVIER, LARGEST};
use crate::error::Error;

impl Driver {
    /// Makes the effective matrix at x. Where it is not positive definite with the turning contact forces, it is made
    /// without them, then in the configuration at the start of the step, or with more of the proximal term: the iterations take
    /// longer, and the answer is the same. A first guess that compresses what is nearly incompressible has pressures of many
    /// times the shear modulus, whose stiffness is negative across them; the step itself has nothing of them.
    pub(super) fn renew(&mut self) -> Result<(), Error> {
        if !self.parts.effective().iterates() {
            return Ok(());
        }
        let begin = Instant::now();
        self.parts.pace_mut().is_sized = false;
        let system = Arc::clone(&self.attempt.system);
        let motion = &self.attempt.state.motion;
        self.attempt.maps.whole(
            |map| map.force,
            motion,
            [&self.attempt.vectors.x, &self.attempt.vectors.push],
            &mut self.attempt.vectors.place,
        );
        let pieces = Arc::clone(self.parts.floating().pieces());
        let floats = self.parts.floats(&self.attempt).then_some(&*pieces);
        let mut at = At {
            maps: &self.attempt.maps,
            dt: self.attempt.dt,
            between: self.attempt.between(),
            start: self.attempt.state.time,
            u: &self.attempt.vectors.place,
            v: &self.attempt.vectors.rate,
            from: self.attempt.between().then_some(&motion.u[..]),
            frames: &motion.frames,
            history: &motion.history,
            rows: self.links.rows(),
            proximal: (floats, self.parts.floating().weight),
            without: self.attempt.stiffness_by_load(),
            whole: self.contacts.leaves_out(&self.attempt),
            apart: self.contacts.leaves_out(&self.attempt) && self.parts.may_refine(&self.attempt),
        };
        let forces = self.attempt.next.interface.force.iter().enumerate();
        let turned =
            forces.map(|(point, force)| force * self.contacts.turning(system.contact_of(point)));
        let mut turning = Turning {
            forces: turned.collect(),
            pairing: self.contacts.pairing(),
            factor: self.attempt.maps.contact(),
        };
        let mut made = self.parts.effective_mut().renew(&system, &at, &turning);
        if made.is_err() && turning.forces.iter().any(|force| *force != 0.0) {
            turning.forces.fill(0.0);
            made = self.parts.effective_mut().renew(&system, &at, &turning);
        }
        if made.is_err() && !self.attempt.maps.is_static() {
            at.u = &motion.u;
            made = self.parts.effective_mut().renew(&system, &at, &turning);
        }
        while made.is_err() && floats.is_some() && at.proximal.1 < LARGEST {
            at.proximal.1 *= HEAVIER;
            made = self.parts.effective_mut().renew(&system, &at, &turning);
        }
        self.parts.floating_mut().weight = at.proximal.1;
        self.attempt.phases.factorisation += begin.elapsed();
        made
    }
}
