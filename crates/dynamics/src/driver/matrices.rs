//! When the matrices of a step are made.

use std::sync::Arc;
use std::time::Instant;

use carom_algebra::reduce::norm_squared;
use carom_contact::Sliding;

use super::Driver;
use super::effective::{At, Turning};
use super::floating::{GROWTH as HEAVIER, LARGEST};
use super::owners::{Attempt, Contacts, Parts};
use crate::error::Error;
use carom_system::ContactPair;

/// Motion over the size of the model by which loads say what stiffness a model has.
const DEFLECTION: f64 = 1e-3;

impl Driver {
    /// Makes the effective matrix at x. Where it is not positive definite with the turning contact forces, it is made
    /// without them, then in the configuration at the start of the step, or with more of the proximal term: the iterations take
    /// longer, and the answer is the same. A first guess that compresses what is nearly incompressible has pressures of many
    /// times the shear modulus, whose stiffness is negative across them; the step itself has nothing of them.
    pub(super) fn renew(&mut self) -> Result<(), Error> {
        if !self.parts.effective.iterates() {
            return Ok(());
        }
        let begin = Instant::now();
        self.parts.pace.is_sized = false;
        let system = Arc::clone(&self.attempt.system);
        let motion = &self.attempt.state.motion;
        self.attempt.maps.whole(
            |map| map.force,
            motion,
            [&self.attempt.vectors.x, &self.attempt.vectors.push],
            &mut self.attempt.vectors.place,
        );
        let floats = match self.parts.floats(&self.attempt) {
            true => Some(&*self.parts.floating.pieces),
            false => None,
        };
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
            rows: &self.links.rows,
            proximal: (floats, self.parts.floating.weight),
            without: self.attempt.stiffness_by_load(),
            whole: self.contacts.leaves_out(&self.attempt),
            apart: self.contacts.leaves_out(&self.attempt) && self.parts.may_refine(&self.attempt),
        };
        let forces = self.attempt.next.interface.force.iter().enumerate();
        let turned =
            forces.map(|(point, force)| force * self.contacts.turning(system.contact_of(point)));
        let mut turning = Turning {
            forces: turned.collect(),
            pairing: &self.contacts.pairing,
            factor: self.attempt.maps.contact(),
        };
        let mut made = self.parts.effective.renew(&system, &at, &turning);
        if made.is_err() && turning.forces.iter().any(|force| *force != 0.0) {
            turning.forces.fill(0.0);
            made = self.parts.effective.renew(&system, &at, &turning);
        }
        if made.is_err() && !self.attempt.maps.is_static() {
            at.u = &motion.u;
            made = self.parts.effective.renew(&system, &at, &turning);
        }
        while made.is_err() && floats.is_some() && at.proximal.1 < LARGEST {
            at.proximal.1 *= HEAVIER;
            made = self.parts.effective.renew(&system, &at, &turning);
        }
        self.parts.floating.weight = at.proximal.1;
        self.attempt.phases.factorisation += begin.elapsed();
        made
    }
}

impl Parts {
    /// Takes the matrices of the attempt: those of linear parts are ready with it.
    pub(super) fn take_matrices(&mut self, attempt: &mut Attempt) -> Result<(), Error> {
        if self.effective.stands(&attempt.maps) {
            return Ok(());
        }
        let begin = Instant::now();
        let system = Arc::clone(&attempt.system);
        let iterated = (0..system.parts.len()).map(|part| self.is_iterated(attempt, part));
        let iterated = iterated.collect();
        let between = attempt.between();
        let taken = self
            .effective
            .take(&system, &attempt.maps, iterated, between);
        attempt.phases.factorisation += begin.elapsed();
        taken
    }

    /// Whether the matrix of a part changes within a step.
    pub(super) fn is_iterated(&self, attempt: &Attempt, part: usize) -> bool {
        let system = &*attempt.system;
        if attempt.maps.of(system.parts[part].start).force.x == 0.0 {
            return false;
        }
        let mut bodies = (0..system.bodies.len()).filter(|&k| system.part_of_body[k] == part);
        let own = &system.parts[part];
        let mut pieces = self.floating.pieces.iter();
        let floats = self.floats(attempt) && pieces.any(|piece| own.contains(&piece.unknowns[0]));
        let changes = |k: usize| !system.bodies[k].is_linear() || system.nonlinear.has_follower(k);
        floats || bodies.any(changes)
    }
}

impl Contacts {
    /// Whether the effective matrix leaves out much of the derivative of the forces: of those between two states what is not
    /// symmetric, of contacts whose points slide how rows and weights move with them.
    pub(super) fn leaves_out(&self, attempt: &Attempt) -> bool {
        let mut contacts = attempt.system.contacts.iter().enumerate();
        let slides = |(number, contact): (usize, &ContactPair)| {
            contact.sliding == Sliding::Finite && self.turning(number) != 0.0
        };
        attempt.between() || contacts.any(slides)
    }
}

impl Attempt {
    /// A stiffness of the size of what the model has where it has none that is known, N/m: the loads would move it by a thousandth of itself.
    pub(super) fn stiffness_by_load(&self) -> f64 {
        let (load, size) = (
            norm_squared(&self.vectors.load).sqrt(),
            self.system.mesh.size(),
        );
        match load > 0.0 && size > 0.0 {
            true => load / (DEFLECTION * size),
            false => 1.0,
        }
    }
}
