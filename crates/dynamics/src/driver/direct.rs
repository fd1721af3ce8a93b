//! Explicit steps whose matrix is the lumped mass: central differences of solids.
//!
//! Displacements and forces of the end are known before the accelerations, and there is nothing to iterate. So the vectors of the
//! end are written where they stay, and one pass ([`Update`]) finds accelerations, velocities and all terms of the balances. Contact
//! forces are those of the interface problem of the other steps; where no point may carry one, it is not looked at.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::Rows;
use rayon::prelude::*;

use super::Driver;
use super::forces::{Bodies, add_up};
use super::leapfrog::{Direct, is_leapfrog};
use super::loads::damping_rate;
use super::owners::{Attempt, Balances, Contacts, Parts};
use super::reported;
use crate::error::Error;
use crate::step_map::{Known, Row};
use crate::update::{Sums, Update};

/// Unknowns of which one thread writes the displacement, at least.
const UNKNOWNS: usize = 8192;

impl Driver {
    /// Whether the attempt is such a step.
    pub(super) fn is_direct(&self) -> bool {
        let leapfrog = match (self.attempt.maps.only(), &self.attempt.identity) {
            (Some(map), Some(identity)) => is_leapfrog(map, identity),
            _ => false,
        };
        leapfrog
            && self.explicit.direct.is_some()
            && !self.attempt.maps.is_static()
            && self.stages.impulses.is_none()
            && (self.attempt.has_links() || self.links.force.is_empty())
    }

    /// Whether the motion of the attempt is known to be finite without a look at it.
    pub(super) fn is_known_finite(&self) -> bool {
        self.explicit
            .direct
            .as_ref()
            .is_some_and(|direct| direct.finite)
    }

    /// Tells that an attempt of another kind begins.
    pub(super) fn leave_direct(&mut self) {
        self.contacts.passage.forget();
        if let Some(mut direct) = self.explicit.direct.take() {
            self.contacts.forget_step(&mut direct);
            self.explicit.direct = Some(direct);
        } else {
            self.contacts.active.leave();
        }
    }

    /// Takes the attempt.
    pub(super) fn explicit_step(&mut self) -> Result<(), Error> {
        let Some(mut direct) = self.explicit.direct.take() else {
            return Ok(());
        };
        let clean = std::mem::take(&mut direct.clean);
        direct.finite = false;
        let taken = match self.ranks.shared.take() {
            None => self.explicit_pass(&mut direct, clean),
            Some(mut shared) => {
                let taken = self.step_on_ranks(&mut shared, &mut direct, clean);
                self.ranks.shared = Some(shared);
                taken
            }
        };
        self.explicit.direct = Some(direct);
        taken
    }

    fn explicit_pass(&mut self, direct: &mut Direct, clean: bool) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.attempt.phases);
        if !self.contacts.weak.none() {
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
            self.contacts.candidates.clear();
            return Ok(());
        }
        self.attempt.vectors.ahead.clear();
        self.contacts.pair_near(&mut self.attempt);
        self.contacts
            .choose_candidates(&self.parts, &mut self.attempt);
        if self.contacts.candidates.is_empty() {
            self.contacts.release(&mut self.attempt);
            return Ok(());
        }
        match self.contacts.weak.none() {
            true => {
                let free = |driver: &Driver, i: usize| {
                    driver.attempt.left(loads, i) / driver.attempt.system.mass.lumped[i]
                };
                self.solve_apart(&mut direct.apart, free)?;
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
        self.explicit.rates.refer(&system.part_of_body, shapes);
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
            reference: &self.explicit.rates.reference,
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

impl Contacts {
    /// Forgets what the step before left for the next.
    pub(super) fn forget_step(&mut self, direct: &mut Direct) {
        (direct.clean, direct.finite) = (false, false);
        (direct.pending, direct.ready) = (None, None);
        self.active.leave();
    }

    /// Adds the forces of the points to those of the nodes.
    pub(super) fn spread_directly(&self, attempt: &mut Attempt, direct: &mut Direct) {
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
    pub(super) fn end_points(&self, attempt: &mut Attempt) {
        // the unknown is the acceleration
        std::mem::swap(&mut attempt.vectors.x, &mut attempt.next.motion.a);
        self.end_interface(attempt);
        std::mem::swap(&mut attempt.vectors.x, &mut attempt.next.motion.a);
        self.crush(attempt);
    }
}

impl Parts {
    /// Begins the step; `clean`: whether it is known which blocks have contact forces.
    pub(super) fn begin_explicit_pass(
        &mut self,
        attempt: &mut Attempt,
        direct: &mut Direct,
        clean: bool,
    ) {
        self.residuals.clear();
        self.residuals.push(0.0);
        (self.pace.age, self.pace.fresh) = (0, attempt.state.control.pace);
        direct.clear(
            clean,
            attempt.system.dim,
            &mut attempt.next.motion.contact_force,
        );
        if !clean {
            attempt.vectors.x.fill(0.0);
        }
    }

    /// Internal forces and histories of the end.
    pub(super) fn forces_of_end(&mut self, attempt: &mut Attempt) -> Result<(), Error> {
        let begin = Instant::now();
        self.force_sweeps += 1;
        let motion = &mut attempt.next.motion;
        motion.internal_force.fill(0.0);
        let at = Bodies {
            u: &motion.u,
            v: &[],
            from: None,
            frames: &attempt.state.motion.frames,
            history: &attempt.state.motion.history,
        };
        let out = (&mut motion.history[..], &mut motion.internal_force[..]);
        let dt = attempt.dt;
        self.stored = add_up(&attempt.system, &at, |_| dt, out, &mut self.scratch)?;
        attempt.phases.forces += begin.elapsed();
        Ok(())
    }

    /// Forces of damping, at the velocity that is known before the forces.
    pub(super) fn damping_of_end(&mut self, attempt: &mut Attempt) {
        if !attempt.system.has_damping() {
            return;
        }
        let (row, start) = (
            damping_rate(attempt.maps.first()),
            Known::from(&attempt.state.motion),
        );
        let (unknowns, vectors) = (attempt.system.unknowns(), &mut attempt.vectors);
        for vector in [&mut vectors.rate, &mut vectors.damping, &mut vectors.work] {
            vector.resize(unknowns, 0.0);
        }
        let rates = vectors.rate.par_chunks_mut(UNKNOWNS).enumerate();
        rates.for_each(|(chunk, rates)| {
            let first = chunk * UNKNOWNS;
            row.known(start.within(first..first + rates.len()), rates);
        });
        self.evaluate_damping(attempt);
    }
}

impl Attempt {
    /// Displacements of the end: those found ahead, if the step is as long as it was taken to be.
    pub(super) fn place_end(&mut self, direct: &mut Direct) {
        let (row, motion) = (self.maps.first().displacement, &self.state.motion);
        direct.pending = None;
        if direct.ready.take() == Some(row) {
            std::mem::swap(&mut self.next.motion.u, &mut direct.ahead);
            self.next.motion.frames.clone_from(&motion.frames);
            return;
        }
        let start = Known::from(motion);
        let ends = self.next.motion.u.par_chunks_mut(UNKNOWNS).enumerate();
        ends.for_each(|(chunk, end)| {
            let first = chunk * UNKNOWNS;
            row.known(start.within(first..first + end.len()), end);
        });
        self.next.motion.frames.clone_from(&motion.frames);
    }

    /// Loads at the end: those of `load` where they vary, otherwise what the dead loads are multiplied with.
    pub(super) fn loads_of_end(&mut self, loaded: bool) -> Loads {
        if !self.system.nonlinear.loads.is_empty() {
            self.vectors.place.clone_from(&self.next.motion.u);
            self.vectors.load.resize(self.system.unknowns(), 0.0);
            self.evaluate_loads_of_step();
            return Loads::Varying;
        }
        let time = self.state.time;
        let ramp = [time, time + self.dt].map(|time| self.system.nonlinear.ramp(time));
        if loaded {
            Loads::Dead(ramp)
        } else {
            Loads::None
        }
    }

    /// What loads, internal forces and those beside them leave at the end on an unknown, N; zero on held ones.
    pub(super) fn left(&self, loads: Loads, i: usize) -> f64 {
        let damping = self.vectors.damping.get(i).unwrap_or(&0.0);
        let inside = self.next.motion.internal_force[i] + damping;
        match loads {
            _ if self.system.fixed[i] => 0.0,
            Loads::None => -inside,
            Loads::Dead([_, factor]) => factor * self.system.load[i] - inside,
            Loads::Varying => self.vectors.load[i] - inside,
        }
    }

    /// Whether forces beside the internal ones depend on the motion: damping, less the forces of links.
    pub(super) fn has_forces_beside(&self) -> bool {
        self.system.has_damping() || self.has_links()
    }
}

/// Loads of such a step.
#[derive(Clone, Copy)]
pub(super) enum Loads {
    None,
    /// The dead loads, times these factors at start and end.
    Dead([f64; 2]),
    /// Those in the vector of loads.
    Varying,
}

impl Balances {
    /// Forces of the named supports at the end: what is held has no acceleration. Those on nodes that do not `count` are left out.
    pub(super) fn report_supports(
        &mut self,
        attempt: &Attempt,
        loads: Loads,
        count: &dyn Fn(usize) -> bool,
    ) {
        let motion = &attempt.next.motion;
        let load = |i: usize| match loads {
            Loads::None => 0.0,
            Loads::Dead([_, factor]) => factor * attempt.system.load[i],
            Loads::Varying => attempt.vectors.load[i],
        };
        let displacement = attempt.system.is_nonlinear().then_some(&motion.u[..]);
        let at = (&attempt.state.motion.frames[..], displacement);
        let unknowns = &attempt.system.unknowns;
        reported::write(&mut self.reactions, &attempt.system, at, |i| {
            if !count(unknowns.node(i) as usize) {
                return 0.0;
            }
            let damping = attempt.vectors.damping.get(i).unwrap_or(&0.0);
            motion.internal_force[i] + damping - load(i) - motion.contact_force[i]
        });
    }
}
