//! What a zone does for the links to other zones: the forces on it, and steps that are completed, dropped and accepted from outside.
//!
//! A link force enters the momentum balance where the loads do. The multipliers L of the links are pointwise in time; in a
//! step the balance sees `Cᵀ Λ` with `Λ = w₀ L_k + w₁ L_{k+1}`, (1 - θ, θ) in the theta scheme and (0, 1) where the balance
//! holds at the end of the step.

use std::time::Instant;

use super::Driver;
use super::linearised::WayWeights;
use super::paired::approaches;
use crate::error::Error;
use crate::report::Notices;
use crate::state::State;
use crate::system::{LinkRow, on};

impl Driver {
    /// Makes the solver take forces of links from its next start on, which is with this force (N).
    pub fn link(&mut self, force: &[f64]) {
        self.links.set_force(force.to_vec());
    }

    /// Makes the solver forget links until its next `link`.
    pub fn unlink(&mut self) {
        self.links.forget_force();
    }

    /// Sets Cᵀ Λ of the step, N.
    pub fn set_link_force(&mut self, rows: &[(u32, LinkRow)], multipliers: &[f64]) {
        self.links.set_row_forces(rows, multipliers);
    }

    /// Sets the force of the links, given term by term in the order of the rows, N.
    pub fn set_link_terms(&mut self, rows: &[(u32, LinkRow)], forces: &[f64]) {
        self.links.set_term_forces(rows, forces);
    }

    /// Adds forces of other rows to those of the links, N: of contacts between zones.
    pub fn add_link_rows(&mut self, rows: &[(u32, LinkRow)], forces: &[f64]) {
        self.links.make_room(self.attempt.system.unknowns());
        self.links.add_row_forces(rows, forces);
    }

    /// Computes the next state from the state, with the forces of links as they stand.
    ///
    /// # Errors
    /// As [`Driver::step`]; a step of a zone is not halved.
    pub fn complete(&mut self) -> Result<(), Error> {
        self.report.attempts = 1;
        if self.parts.is_prepared() {
            self.attempt.notices = Notices::default();
            let outcome = self.solve_step().and_then(|()| self.attempt.check_finite());
            self.attempt.unless_interrupted(outcome)?;
        } else {
            self.attempt(self.attempt.dt, self.ahead)?;
        }
        let State {
            step,
            time,
            control,
            ..
        } = &self.attempt.state;
        self.attempt.next.step = step + 1;
        self.attempt.next.time = control.instant(*step, *time, self.attempt.dt);
        self.attempt.next.control = *control;
        self.attempt.next.control.pace = self.parts.pace().fresh;
        self.attempt.next.control.compression = self.parts.stored().compression;
        Ok(())
    }

    /// The state at the end of the step just completed, which is not accepted yet.
    pub fn ended(&self) -> &State {
        &self.attempt.next
    }

    /// Accepts the step just completed.
    pub fn take(&mut self) {
        let (step, time) = (self.attempt.state.step, self.attempt.state.time);
        let mut control = self.attempt.next.control;
        control.take(None, (step, time, self.attempt.dt), self.attempt.system.dt);
        self.report.notices.clone_from(&self.attempt.notices);
        self.accept(control, self.attempt.dt);
    }

    /// Makes the state that of an earlier instant.
    pub fn go_back(&mut self, state: &State) {
        self.parts.set_prepared(false);
        self.attempt.state.clone_from(state);
    }

    /// Makes `dt` the size of the next steps, of an explicit scheme before one of the size `next` (both s).
    pub fn resize(&mut self, dt: f64, next: f64) {
        self.parts.set_prepared(false);
        self.ahead = next;
        self.contacts.size(&mut self.attempt, dt, next);
    }

    /// Weights of L at the start and the end of a step in Λ.
    pub fn link_weights(&self) -> [f64; 2] {
        self.attempt.system.scheme.get().link_weights()
    }

    /// Work of the force of one row in the step just completed, J: `before` and `now` are the row's Λ of the step before and
    /// of this one.
    pub fn row_work(&self, terms: &LinkRow, before: f64, now: f64) -> f64 {
        let weights = &self.attempt.link_work_weights(0);
        let [old, new] = [&self.attempt.state.motion, &self.attempt.next.motion];
        let travel = on(terms, &new.u) - on(terms, &old.u);
        // a row of many terms costs as much again
        let later = match weights.lag == 0.0 {
            true => 0.0,
            false => weights.lag * (on(terms, &new.v) - on(terms, &old.v)),
        };
        (weights.old * before + weights.new * now) * (travel - later)
    }

    /// Work of the forces of links, given term by term in the order of the rows, in the step just completed, J; each row with its number to
    /// `add`. `before` and `now`: forces of the step before and of this one, N.
    pub fn terms_work(
        &self,
        rows: &[(u32, LinkRow)],
        [before, now]: [&[f64]; 2],
        mut add: impl FnMut(u32, f64),
    ) {
        let weights = &self.attempt.link_work_weights(0);
        let [old, new] = [&self.attempt.state.motion, &self.attempt.next.motion];
        let mut forces = before.iter().zip(now);
        for (row, terms) in rows {
            let work = |(&(dof, _), (before, now)): (&(u32, f64), (&f64, &f64))| {
                let i = dof as usize;
                let way = new.u[i] - old.u[i] - weights.lag * (new.v[i] - old.v[i]);
                (weights.old * before + weights.new * now) * way
            };
            let work = terms.iter().zip(forces.by_ref()).map(work).sum();
            add(*row, work);
        }
    }

    /// Factors of M and K in the effective matrix, and of its solution in the velocity at the end of a step.
    pub fn effective(&self) -> (f64, f64, f64) {
        let map = self.attempt.linear_map();
        (map.inertia.x, map.force.x, map.velocity.x)
    }

    /// Loads at the present instant, after a start, N.
    pub fn load(&self) -> &[f64] {
        &self.attempt.vectors.load
    }

    /// Weights of what a row does at the start and at the end of a step in its way.
    pub fn way_weights(&self) -> WayWeights {
        let keeps = self.attempt.system.scheme.get().keeps_acceleration();
        WayWeights::of_map(&self.attempt.linear_map(), keeps)
    }

    /// Way of a row in the step just completed, m.
    pub fn row_way(&self, terms: &LinkRow) -> f64 {
        let (map, push) = (self.attempt.linear_map(), &self.attempt.vectors.push);
        let ends = [&self.attempt.state.motion, &self.attempt.next.motion];
        let way = self.way_weights().of(terms, ends);
        match push.is_empty() {
            true => way,
            // the acceleration at the end is the unknown without what contacts of the zone give by themselves
            false => way - map.displacement.x * map.acceleration.c * on(terms, push),
        }
    }

    /// Makes ready what the forces of links do not change, of a step that is linear in the unknown.
    ///
    /// # Errors
    /// As [`Driver::step`].
    pub fn prepare(&mut self) -> Result<(), Error> {
        self.contacts.begin_attempt();
        self.parts.set_prepared(false);
        self.begin_stage()?;
        let scheme = self.attempt.system.scheme.get();
        if !self.attempt.system.nonlinear.follows.is_empty() || scheme.projects_predictor() {
            return Ok(());
        }
        let (begin, before) = (Instant::now(), self.attempt.phases);
        self.parts.take_matrices(&mut self.attempt)?;
        if self.contacts.is_affine(&self.parts) {
            self.begin_iterations(false)?;
            self.parts.set_prepared(true);
        }
        self.attempt.count_contact(begin, before);
        Ok(())
    }

    /// Whether a contact point carries a force or may do so within `dt` (s), at twice its present rate.
    pub fn may_touch(&self, dt: f64) -> bool {
        let interface = &self.attempt.state.interface;
        let touches = |point: usize| {
            let ahead = (interface.gap[point], interface.rate[point]);
            interface.force[point] != 0.0
                || approaches(ahead, dt, self.attempt.system.tolerance_at(point))
        };
        (0..self.attempt.system.points()).any(touches)
    }
}
