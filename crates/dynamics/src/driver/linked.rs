//! What a zone does for the links to other zones: forces on it, and how it answers to them.
//!
//! A link force enters the momentum balance where the loads do. The multipliers L of the links are pointwise in time; in a
//! step the balance sees `Cᵀ Λ` with `Λ = w₀ L_k + w₁ L_{k+1}`, (1 - θ, θ) in the theta scheme and (0, 1) where the balance
//! holds at the end of the step.

use std::sync::Arc;
use std::time::Instant;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::rotation::Rotation;
use carom_bodies::{Body, Placement};
use serde::{Deserialize, Serialize};

use super::Driver;
use super::owners::Attempt;
use super::paired::approaches;
use crate::error::Error;
use crate::operator::{Operators, factored, single};
use crate::report::Notices;
use crate::scheme::{Scheme, Theta};
use crate::state::State;
use crate::step_map::StepMap;
use crate::system::{LinkRow, Motion, System, on, push_cliques};

/// How forces on rows run over some steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Growth {
    /// They grow linearly from 0 to 1.
    Linear,
    /// They are 1.
    Constant,
}

impl Driver {
    /// Makes the solver take forces of links from its next start on, which is with this force (N).
    pub fn link(&mut self, force: &[f64]) {
        self.links.force = force.to_vec();
    }

    /// Makes the solver forget links until its next `link`.
    pub fn unlink(&mut self) {
        self.links.force.clear();
    }

    /// Sets Cᵀ Λ of the step, N.
    pub fn set_link_force(&mut self, rows: &[(u32, LinkRow)], multipliers: &[f64]) {
        self.links.force.fill(0.0);
        for (row, terms) in rows {
            for &(dof, c) in terms {
                self.links.force[dof as usize] += c * multipliers[*row as usize];
            }
        }
    }

    /// Sets the force of the links, given term by term in the order of the rows, N.
    pub fn set_link_terms(&mut self, rows: &[(u32, LinkRow)], forces: &[f64]) {
        self.links.force.fill(0.0);
        let terms = rows.iter().flat_map(|(_, terms)| terms);
        for ((dof, _), force) in terms.zip(forces) {
            self.links.force[*dof as usize] += force;
        }
    }

    /// Adds forces of other rows to those of the links, N.
    pub fn add_link_rows(&mut self, rows: &[(u32, LinkRow)], forces: &[f64]) {
        if self.links.force.is_empty() {
            self.links.force.resize(self.attempt.system.unknowns(), 0.0);
        }
        for (row, terms) in rows {
            for &(dof, c) in terms {
                self.links.force[dof as usize] += c * forces[*row as usize];
            }
        }
    }

    /// Computes the next state from the state, with the forces of links as they stand.
    ///
    /// # Errors
    /// As [`Driver::step`]; a step of a zone is not halved.
    pub fn complete(&mut self) -> Result<(), Error> {
        self.report.attempts = 1;
        if self.parts.prepared {
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
        self.attempt.next.control.pace = self.parts.pace.fresh;
        self.attempt.next.control.compression = self.parts.stored.compression;
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
        self.parts.prepared = false;
        self.attempt.state.clone_from(state);
    }

    /// Makes `dt` the size of the next steps, of an explicit scheme before one of the size `next` (both s).
    pub fn resize(&mut self, dt: f64, next: f64) {
        self.parts.prepared = false;
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

    /// Weights of the velocities at the start and at the end of a step in its way, s: of the schemes whose way is one of velocities.
    pub fn way_weights(&self) -> [f64; 2] {
        let map = self.attempt.linear_map();
        let end = map.displacement.x / map.velocity.x;
        [map.displacement.v - end * map.velocity.v, end]
    }

    /// Way of a row in the step just completed, m.
    pub fn row_way(&self, terms: &LinkRow) -> f64 {
        let [start, end] = self.way_weights();
        start * on(terms, &self.attempt.state.motion.v)
            + end * on(terms, &self.attempt.next.motion.v)
    }

    /// Velocities that multipliers leave in the rows over some steps, without contact, and the ways of the rows: the dense
    /// matrices `C V` and `C Σ U`, row-major over the rows given, of the zone linearised at the origin.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub fn ramp(
        &mut self,
        (rows, steps): (&[(u32, LinkRow)], (u32, Growth)),
        origin: &Origin,
    ) -> Result<[Vec<f64>; 2], Error> {
        let system = Arc::clone(&self.attempt.system);
        let weights = [self.link_weights(), self.way_weights()];
        let map = self.attempt.linear_map();
        self.parts.take_matrices(&mut self.attempt)?;
        if system.bodies.iter().all(Body::is_linear)
            && !self.parts.effective.iterates()
            && let Some((operators, _)) = self.parts.effective.both()
        {
            let scratch = &mut self.parts.scratch;
            let mut ramp = Ramp {
                system: &system,
                map: &map,
                operators,
                forces: &mut |u, f| {
                    f.fill(0.0);
                    for (body, scratch) in system.bodies.iter().zip(&mut *scratch) {
                        body.internal_force(u, scratch, f);
                    }
                },
            };
            return Ok(ramp.matrix(rows, steps, weights));
        }
        let n = system.unknowns();
        let mut cliques = Cliques::new();
        for body in &system.bodies {
            push_cliques(body, &system.unknowns, &(0..n), &mut cliques);
        }
        let still = vec![0.0; n];
        let mut stiffness = Csr::from_cliques(n, &cliques);
        for (k, body) in system.bodies.iter().enumerate() {
            let at = Placement {
                u: &origin.u,
                v: &still,
                from: None,
                frames: &origin.frames,
                dt: self.attempt.dt,
                old: &origin.history[system.nonlinear.histories[k].clone()],
            };
            body.add_tangent(&at, [1.0, 0.0], &mut stiffness)?;
        }
        let mut operators = self.attempt.linear_operators(&map, &stiffness)?;
        let mut ramp = Ramp {
            system: &system,
            map: &map,
            operators: &mut operators,
            forces: &mut |u, f| stiffness.multiply(u, f),
        };
        Ok(ramp.matrix(rows, steps, weights))
    }

    /// Makes ready what the forces of links do not change, of a step that is linear in the unknown.
    ///
    /// # Errors
    /// As [`Driver::step`].
    pub fn prepare(&mut self) -> Result<(), Error> {
        (self.contacts.failed, self.contacts.failed_friction) = (None, None);
        self.parts.prepared = false;
        self.begin_stage()?;
        let scheme = self.attempt.system.scheme.get();
        if !self.attempt.system.nonlinear.follows.is_empty() || scheme.projects_predictor() {
            return Ok(());
        }
        let (begin, before) = (Instant::now(), self.attempt.phases);
        self.parts.take_matrices(&mut self.attempt)?;
        if self.contacts.is_affine(&self.parts) {
            self.begin_iterations(false)?;
            self.parts.prepared = true;
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

impl Attempt {
    /// The map of the linearised zone: where forces belong to the way of the step they are those of its middle.
    pub(super) fn linear_map(&self) -> StepMap {
        match self.between() {
            true => Scheme::Theta(Theta { theta: 0.5 }).get().step_map(self.dt),
            false => *self.maps.first(),
        }
    }

    /// The factors of the effective matrix with this stiffness.
    pub(super) fn linear_operators(
        &self,
        map: &StepMap,
        stiffness: &Csr,
    ) -> Result<Operators, Error> {
        let system = &*self.system;
        if map.force.x == 0.0 && system.mass.is_lumped() {
            return Operators::new(system, map.inertia.x, 0.0, "effective matrix");
        }
        let mut a = stiffness.clone();
        a.scale(map.force.x);
        let mut operators = Operators::of(&system.parts, single(system.parts.len()));
        for group in &mut operators.groups {
            let part = group.parts[0].clone();
            system.mass.add_to(map.inertia.x, &part, 0, &mut a);
            let own = a.restricted(&group.parts);
            let fixed = &system.fixed[part.clone()];
            let operator = factored(system, &part, &own, fixed, "effective matrix")?;
            group.operator = Some(operator);
        }
        Ok(operators)
    }
}

/// How a zone answers to multipliers that grow, without contact and linearised.
struct Ramp<'a> {
    system: &'a System,
    map: &'a StepMap,
    operators: &'a mut Operators,
    /// K u.
    forces: &'a mut dyn FnMut(&[f64], &mut [f64]),
}

impl Ramp<'_> {
    /// See [`Driver::ramp`]; weights of L and of velocities in the way, at the start and the end of a step.
    fn matrix(
        &mut self,
        rows: &[(u32, LinkRow)],
        (steps, growth): (u32, Growth),
        [weights, of_way]: [[f64; 2]; 2],
    ) -> [Vec<f64>; 2] {
        let n = rows.len();
        let [mut ends, mut ways] = [vec![0.0; n * n], vec![0.0; n * n]];
        let zeros = || vec![0.0; self.system.unknowns()];
        let mut motion = Motion {
            u: zeros(),
            v: zeros(),
            a: zeros(),
            memory: match self.map.has_memory() {
                true => zeros(),
                false => Vec::new(),
            },
            ..Motion::default()
        };
        let mut ended = motion.clone();
        for (column, (_, terms)) in rows.iter().enumerate() {
            let Motion {
                u, v, a, memory, ..
            } = &mut motion;
            for vector in [u, v, a, memory] {
                vector.fill(0.0);
            }
            for step in 0..steps {
                let part = |k: u32| f64::from(k) / f64::from(steps);
                let force = match growth {
                    Growth::Linear => weights[0] * part(step) + weights[1] * part(step + 1),
                    Growth::Constant => 1.0,
                };
                self.step(step == 0, &motion, (terms, force), &mut ended);
                for (row, (_, terms)) in rows.iter().enumerate() {
                    let [start, end] = [&motion.v, &ended.v].map(|v| on(terms, v));
                    ways[row * n + column] += of_way[0] * start + of_way[1] * end;
                }
                std::mem::swap(&mut motion, &mut ended);
            }
            for (row, (_, terms)) in rows.iter().enumerate() {
                ends[row * n + column] = on(terms, &motion.v);
            }
        }
        [ends, ways]
    }

    /// One step under the force of one row alone.
    fn step(
        &mut self,
        at_rest: bool,
        motion: &Motion,
        (terms, force): (&LinkRow, f64),
        end: &mut Motion,
    ) {
        let n = self.system.unknowns();
        let mut r = vec![0.0; n];
        let mut x = vec![0.0; n];
        if !at_rest {
            let (mut known, mut inertia) = (vec![0.0; n], vec![0.0; n]);
            self.map.force.known(motion, &mut known);
            (self.forces)(&known, &mut r);
            self.map.inertia.known(motion, &mut known);
            self.system.mass.multiply(&known, &mut inertia);
            for (i, r) in r.iter_mut().enumerate() {
                *r = match self.system.fixed[i] {
                    true => 0.0,
                    false => -*r - inertia[i],
                };
            }
        }
        for &(dof, c) in terms {
            if !self.system.fixed[dof as usize] {
                r[dof as usize] += c * force;
            }
        }
        let mut half = vec![0.0; n];
        self.operators.begin(&r, &mut half);
        self.operators.end(&mut half, &mut x);
        let none = vec![0.0; n];
        self.map.displacement.whole(motion, &x, &none, &mut end.u);
        self.map.velocity.whole(motion, &x, &none, &mut end.v);
        self.map.acceleration.whole(motion, &x, &none, &mut end.a);
        self.map.memory.whole(motion, &x, &none, &mut end.memory);
    }
}

/// Where a zone was linearised; empty of a linear zone.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Origin {
    /// Displacement, m.
    pub u: Vec<f64>,
    /// Histories of its materials.
    pub history: Vec<f64>,
    /// Rotations of its nodes.
    pub frames: Vec<Rotation>,
}

impl Origin {
    /// Whether it is of the same zone as another one, in the length of each array.
    pub fn is_like(&self, other: &Origin) -> bool {
        let lengths = |one: &Origin| [one.u.len(), one.history.len(), one.frames.len()];
        lengths(self) == lengths(other)
    }

    /// The present state of a zone.
    pub fn of(driver: &Driver) -> Origin {
        let mut bodies = driver.system().bodies.iter();
        match bodies.all(|body| body.is_linear()) {
            true => Origin::default(),
            false => Origin {
                u: driver.state().motion.u.clone(),
                history: driver.state().motion.history.clone(),
                frames: driver.state().motion.frames.clone(),
            },
        }
    }
}
