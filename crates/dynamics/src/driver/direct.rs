//! Explicit steps whose matrix is the lumped mass: central differences of solids.
//!
//! Displacements and forces of the end are known before the accelerations, and there is nothing to iterate. So the vectors of the
//! end are written where they stay, and one pass ([`Update`]) finds accelerations, velocities and all terms of the balances. Contact
//! forces are those of the interface problem of the other steps; where no point may carry one, it is not looked at.

use std::sync::Arc;
use std::time::Instant;

use super::Driver;
use super::attempt::Attempt;
use super::attempt::forces::Loads;
use super::explicit::leapfrog::{Direct, is_leapfrog};
use crate::error::Error;
use crate::step_map::Row;
use crate::update::{Sums, Update};

impl Driver {
    /// Whether the attempt is such a step.
    pub(super) fn is_direct(&self) -> bool {
        let leapfrog = match (self.attempt.maps.only(), &self.attempt.identity) {
            (Some(map), Some(identity)) => is_leapfrog(map, identity),
            _ => false,
        };
        leapfrog
            && self.explicit.direct().is_some()
            && !self.attempt.maps.is_static()
            && !self.stages.are_any()
            && (self.attempt.has_links() || self.links.force().is_empty())
    }

    /// Whether the motion of the attempt is known to be finite without a look at it.
    pub(super) fn is_known_finite(&self) -> bool {
        self.explicit.direct().is_some_and(|direct| direct.finite)
    }

    /// Tells that an attempt of another kind begins.
    pub(super) fn leave_direct(&mut self) {
        self.contacts.forget_passages();
        if let Some(mut direct) = self.explicit.take() {
            self.contacts.forget_step(&mut direct);
            self.explicit.keep(direct);
        } else {
            self.contacts.leave_active();
        }
    }

    /// Takes the attempt.
    pub(super) fn explicit_step(&mut self) -> Result<(), Error> {
        let Some(mut direct) = self.explicit.take() else {
            return Ok(());
        };
        let clean = std::mem::take(&mut direct.clean);
        direct.finite = false;
        let taken = match self.ranks.take() {
            None => self.explicit_pass(&mut direct, clean),
            Some(mut shared) => {
                let taken = self.step_on_ranks(&mut shared, &mut direct, clean);
                self.ranks.keep(shared);
                taken
            }
        };
        self.explicit.keep(direct);
        taken
    }

    fn explicit_pass(&mut self, direct: &mut Direct, clean: bool) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.attempt.phases);
        if !self.contacts.weak().none() {
            self.parts.take_matrices(&mut self.attempt)?;
        }
        self.parts
            .begin_explicit_pass(&mut self.attempt, direct, clean);
        self.attempt.place_end(direct);
        self.parts.forces_of_end(&mut self.attempt)?;
        let loads = self.attempt.loads_of_end(direct.loaded);
        self.parts.damping_of_end(&mut self.attempt);
        self.hold_directly(direct, |driver, i| driver.attempt.left(loads, i))?;
        self.contacts.follow_interface(&mut self.attempt);
        self.touch(direct, loads)?;
        self.attempt.count_contact(begin, before);
        let begin = Instant::now();
        self.end_motion(direct, loads);
        direct.sum_parts();
        let sums = direct.total(self.attempt.system.axisymmetric);
        self.balances
            .report_supports(&self.attempt, loads, &|_| true);
        self.know_end(&sums, direct);
        self.contacts.end_points(&mut self.attempt);
        self.report_contacts();
        self.end_directly(&sums, direct);
        self.attempt.phases.balance += begin.elapsed();
        Ok(())
    }

    /// What the next steps know of the end.
    pub(super) fn know_end(&self, sums: &Sums, direct: &mut Direct) {
        direct.finite = (sums.velocity + sums.acceleration[1] + sums.way).is_finite();
        direct.clean = true;
    }

    /// Forces of the contacts.
    pub(super) fn touch(&mut self, direct: &mut Direct, loads: Loads) -> Result<(), Error> {
        self.attempt.vectors.jumps = false;
        if self.attempt.system.contacts.is_empty() {
            self.contacts.forget_candidates();
            return Ok(());
        }
        self.attempt.vectors.ahead.clear();
        self.contacts.pair_near(&mut self.attempt);
        self.contacts
            .choose_candidates(&self.parts, &mut self.attempt);
        if self.contacts.candidates().is_empty() {
            self.contacts.release(&mut self.attempt);
            return Ok(());
        }
        match self.contacts.weak().none() {
            true => {
                let free = |attempt: &Attempt, i: usize| {
                    attempt.left(loads, i) / attempt.system.mass.lumped[i]
                };
                self.contacts
                    .solve_apart(&mut self.attempt, &mut direct.apart, free)?;
            }
            false => {
                self.contacts.stack(&self.attempt);
                self.attempt.vectors.make_room(&self.attempt.state.motion);
                for i in 0..self.attempt.system.unknowns() {
                    self.attempt.vectors.residual[i] = self.attempt.left(loads, i);
                }
                self.solve_interface()?;
            }
        }
        self.contacts.spread_directly(&mut self.attempt, direct);
        Ok(())
    }

    /// Accelerations and velocities of the end, and the sums of the blocks.
    pub(super) fn end_motion(&mut self, direct: &mut Direct, loads: Loads) {
        let system = Arc::clone(&self.attempt.system);
        let map = self.attempt.maps.first();
        let means = [map.impulse.old, map.impulse.new];
        let moves = system.is_nonlinear();
        let shapes = &self.attempt.state.shapes.bodies;
        self.explicit
            .rates_mut()
            .refer(&system.part_of_body, shapes);
        let damped = self.attempt.has_forces_beside();
        let (old, new) = (&self.attempt.state.motion, &mut self.attempt.next.motion);
        let varying = &self.attempt.vectors.load[..];
        let known = |kept: &'_ [f64]| !kept.is_empty();
        let kept = &self.attempt.state.forces;
        let before = if known(&kept.load) {
            &kept.load[..]
        } else {
            varying
        };
        let damping = &self.attempt.vectors.damping[..];
        let before_damping = if known(&kept.damping) {
            &kept.damping[..]
        } else {
            damping
        };
        let none = (&system.load[..], 0.0);
        let update = Update {
            system: &system,
            u: &new.u,
            mass: &direct.mass,
            ahead: map.displacement,
            reference: &self.explicit.rates().reference,
            f: [&old.internal_force, &new.internal_force],
            v: &old.v,
            a: &old.a,
            load: match loads {
                Loads::None => damped.then_some([none; 2]),
                Loads::Dead(factors) => Some(factors.map(|factor| (&system.load[..], factor))),
                Loads::Varying => Some([(before, 1.0), (varying, 1.0)]),
            },
            damping: damped.then_some([(before_damping, 1.0), (damping, 1.0)]),
            contact: [&old.contact_force, &new.contact_force],
            way: map.displacement.since(&Row::START),
            velocity: map.velocity,
            weights: [means, if moves { means } else { [0.0, 1.0] }],
            moves,
        };
        let out = [&mut direct.ahead[..], &mut new.v, &mut new.a];
        update.run(&direct.blocks, &mut direct.sums, out);
        direct.pending = Some(map.displacement);
        let forces = &mut self.attempt.next.forces;
        forces.each_mut().into_iter().for_each(Vec::clear);
        if let Loads::Varying = loads {
            forces.load.extend_from_slice(&self.attempt.vectors.load);
        }
        if damped {
            forces
                .damping
                .extend_from_slice(&self.attempt.vectors.damping);
        }
    }
}
