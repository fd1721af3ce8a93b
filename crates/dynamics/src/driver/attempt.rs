//! One attempt at a step: the stages of the scheme before it, the step, the stages after it, balance and records.

use std::time::Instant;

use carom_bodies::{Placement, Stored};

use super::{Driver, Which};
use crate::costs::Phases;
use crate::error::Error;
use crate::state::check_finite;
use crate::step_map::StepMap;

impl Driver {
    /// Computes the next state from the state, a step of `dt` further, of an explicit scheme before one of the size `next`
    /// (both s).
    pub(super) fn attempt(&mut self, dt: f64, next: f64) -> Result<(), Error> {
        (self.failed, self.failed_friction) = (None, None);
        self.size(dt, next);
        self.begin_stage()?;
        let outcome = self.attempt_after_jump(Driver::take_stages);
        self.forget_predictor();
        outcome?;
        check_finite(&self.next.motion, self.state.step + 1, self.state.time)
    }

    /// The map of the step of this size from the present state, of an explicit scheme before one of the size `next` (both s).
    pub(super) fn size(&mut self, dt: f64, next: f64) {
        self.dt = dt;
        if self.is_static() {
            self.maps.rest();
            self.identity = None;
            return;
        }
        self.maps.resize(&self.system.schemes, (dt, next));
        // zones of different schemes are balanced by works
        self.identity = match &self.system.schemes[..] {
            [scheme] => scheme.get().energy_identity(dt),
            _ => None,
        };
    }

    pub(super) fn take_stages(&mut self) -> Result<(), Error> {
        if !self.prepared {
            self.project_predictor()?;
        }
        self.solve_on_the_clock()?;
        let (solved, forces) = (Instant::now(), self.phases.forces);
        self.advance()?;
        self.balance();
        self.project()?;
        self.restore();
        self.record();
        self.record_links();
        let forces = self.phases.forces - forces;
        self.phases.balance += solved.elapsed().saturating_sub(forces);
        Ok(())
    }

    /// Solves, and counts as contact the time that is not counted elsewhere; that of attempts that fail too.
    fn solve_on_the_clock(&mut self) -> Result<(), Error> {
        let (begin, before) = (Instant::now(), self.phases);
        let solved = self.solve();
        self.count_contact(begin, before);
        solved
    }

    /// Counts as contact the time since `begin` that has not been added to the phases `before` elsewhere.
    pub(super) fn count_contact(&mut self, begin: Instant, before: Phases) {
        let counted = |phases: &Phases| {
            phases.factorisation + phases.forces + phases.sweeps + phases.friction
        };
        let counted = counted(&self.phases) - counted(&before);
        self.phases.contact += begin.elapsed().saturating_sub(counted);
    }

    /// Internal forces of all bodies where `place` says, into `internal`; histories into the scratch history. `dt`: time since
    /// the start of the step, s.
    ///
    /// # Errors
    /// An element turned inside out, a material without stress.
    pub(super) fn internal(
        &mut self,
        (place, from): (Which, bool),
        dt: impl Fn(&StepMap) -> f64,
    ) -> Result<Stored, Error> {
        let begin = Instant::now();
        let system = &*self.system;
        let super::Vectors {
            place: configuration,
            rate,
            internal,
            history,
            ..
        } = &mut self.vectors;
        let (u, v) = match place {
            Which::Place => (&configuration[..], &rate[..]),
            Which::Next => (&self.next.motion.u[..], &self.next.motion.v[..]),
        };
        let from = from.then_some(&self.state.motion.u[..]);
        internal.fill(0.0);
        self.force_sweeps += 1;
        let mut sum = Stored::default();
        for (k, body) in system.bodies.iter().enumerate() {
            let range = system.nonlinear.histories[k].clone();
            let at = Placement {
                u,
                v,
                from,
                dt: dt(&self.maps.all()[system.zone_of_body[k]]),
                old: &self.state.motion.history[range.clone()],
            };
            let stored = body.force(&at, &mut history[range], &mut self.scratch[k], internal)?;
            sum.strain += stored.strain;
            sum.hardening += stored.hardening;
            sum.dissipated += stored.dissipated;
        }
        self.phases.forces += begin.elapsed();
        Ok(sum)
    }

    /// Strain energy U(u), J, of linear bodies, and f(u), N, into `work`. `u`: in `place`.
    pub(super) fn linear_forces(&mut self) -> f64 {
        let super::Vectors { place, work, .. } = &mut self.vectors;
        work.fill(0.0);
        self.force_sweeps += 1;
        let bodies = self.system.bodies.iter().zip(&mut self.scratch);
        bodies
            .map(|(body, scratch)| body.internal_force(place, scratch, work))
            .sum()
    }
}
