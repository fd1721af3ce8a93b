//! What a zone does for the links to other zones: forces on it, and how it answers to them.
//!
//! A link force enters the momentum balance where the loads do. The multipliers L of the links are pointwise in time; in a
//! step the balance sees `Cᵀ Λ` with `Λ = w₀ L_k + w₁ L_{k+1}`, (1 - θ, θ) in the theta scheme and (0, 1) where the balance
//! holds at the end of the step.

use std::sync::Arc;

use super::Driver;
use crate::operator::Operators;
use crate::state::{Motion, State};
use crate::step_map::StepMap;
use crate::system::System;

/// One row of C: unknowns of the zone and coefficients, with the sign of the zone's side.
pub(crate) type LinkRow = Vec<(u32, f64)>;

/// Forces of links on the zone.
pub(super) struct Linked {
    /// Residual of the step without them, N.
    residual: Vec<f64>,
    /// Cᵀ Λ of the step, N.
    force: Vec<f64>,
    /// Whether `residual` is that of the step.
    fresh: bool,
}

impl Driver {
    /// Makes the driver take forces of links, and starts anew with the force of L₀, N.
    pub(crate) fn begin_linked(&mut self) {
        if let Some(linked) = &self.linked {
            self.state.motion.link_force.clone_from(&linked.force);
        }
    }

    /// Makes the driver take forces of links from its next start on, which is with this force (N).
    pub(crate) fn link(&mut self, force: &[f64]) {
        self.linked = Some(Linked {
            residual: vec![0.0; force.len()],
            force: force.to_vec(),
            fresh: false,
        });
    }

    /// Makes the driver forget links until its next `link`.
    pub(crate) fn unlink(&mut self) {
        self.linked = None;
    }

    /// Sets Cᵀ Λ of the step, N.
    pub(crate) fn set_link_force(&mut self, rows: &[(u32, LinkRow)], multipliers: &[f64]) {
        if let Some(linked) = &mut self.linked {
            linked.force.fill(0.0);
            for (row, terms) in rows {
                for &(dof, c) in terms {
                    linked.force[dof as usize] += c * multipliers[*row as usize];
                }
            }
        }
    }

    /// Marks the residual as that of a new step.
    pub(super) fn renew_link(&mut self) {
        if let Some(linked) = &mut self.linked {
            linked.fresh = false;
        }
    }

    /// Adds the forces of links to the residual.
    pub(super) fn add_link_force(&mut self) {
        let Some(linked) = &mut self.linked else {
            return;
        };
        let residual = &mut self.vectors.residual;
        match linked.fresh {
            // the balance of an earlier attempt has used the vector
            true => residual.copy_from_slice(&linked.residual),
            false => linked.residual.copy_from_slice(residual),
        }
        linked.fresh = true;
        for (i, r) in residual.iter_mut().enumerate() {
            if !self.system.fixed[i] {
                *r += linked.force[i];
            }
        }
        self.next.motion.link_force.clone_from(&linked.force);
    }

    /// Work of the force of one row in the step just completed, J: `before` and `now` are the row's Λ of the step before and
    /// of this one.
    pub(crate) fn row_work(&self, terms: &LinkRow, before: f64, now: f64) -> f64 {
        let travel = on(terms, &self.next.motion.u) - on(terms, &self.state.motion.u);
        (self.map.impulse.old * before + self.map.impulse.new * now) * travel
    }

    /// Velocity at the end of the step just completed, which is not accepted yet.
    pub(crate) fn next_velocity(&self) -> &[f64] {
        &self.next.motion.v
    }

    /// Accepts the step just completed.
    pub(crate) fn take(&mut self) {
        self.accept(self.state.control);
    }

    /// Makes the state that of an earlier instant.
    pub(crate) fn go_back(&mut self, state: &State) {
        self.state.clone_from(state);
    }

    /// Weights of L at the start and the end of a step in Λ.
    pub(crate) fn link_weights(&self) -> [f64; 2] {
        self.system.scheme.link_weights().unwrap_or([0.0, 1.0])
    }

    /// Factors of M and K in the effective matrix, and of its solution in the velocity at the end of a step.
    pub(crate) fn effective(&self) -> (f64, f64, f64) {
        (self.map.inertia.x, self.map.force.x, self.map.velocity.x)
    }

    /// Velocity that multipliers growing linearly from 0 to 1 in `steps` steps leave in the rows, without contact: the
    /// dense matrix `C V`, row-major over the rows given.
    pub(crate) fn ramp(&mut self, rows: &[(u32, LinkRow)], steps: u32) -> Vec<f64> {
        let system = Arc::clone(&self.system);
        let weights = self.link_weights();
        let forces = &mut self.forces;
        let mut ramp = Ramp {
            system: &system,
            map: &self.map,
            operators: &mut self.operators,
            forces: &mut |u, f| {
                forces.evaluate(&system, u, f);
            },
        };
        ramp.matrix(rows, steps, weights)
    }
}

/// How a zone answers to multipliers that grow, without contact and linearised.
pub(crate) struct Ramp<'a> {
    pub(crate) system: &'a System,
    pub(crate) map: &'a StepMap,
    pub(crate) operators: &'a mut Operators,
    /// K u.
    pub(crate) forces: &'a mut dyn FnMut(&[f64], &mut [f64]),
}

impl Ramp<'_> {
    /// See [`Driver::ramp`]; `weights`: of L at the start and the end of a step.
    pub(crate) fn matrix(
        &mut self,
        rows: &[(u32, LinkRow)],
        steps: u32,
        weights: [f64; 2],
    ) -> Vec<f64> {
        let n = rows.len();
        let mut matrix = vec![0.0; n * n];
        let zeros = || vec![0.0; self.system.unknowns()];
        let mut motion = Motion {
            u: zeros(),
            v: zeros(),
            a: zeros(),
            ..Motion::default()
        };
        let mut ended = motion.clone();
        for (column, (_, terms)) in rows.iter().enumerate() {
            for vector in [&mut motion.u, &mut motion.v, &mut motion.a] {
                vector.fill(0.0);
            }
            for step in 0..steps {
                let part = |k: u32| f64::from(k) / f64::from(steps);
                let force = weights[0] * part(step) + weights[1] * part(step + 1);
                self.step(step == 0, &motion, (terms, force), &mut ended);
                std::mem::swap(&mut motion, &mut ended);
            }
            for (row, (_, terms)) in rows.iter().enumerate() {
                matrix[row * n + column] = on(terms, &motion.v);
            }
        }
        matrix
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
    }
}

/// A row applied to a vector of the zone.
pub(crate) fn on(row: &LinkRow, vector: &[f64]) -> f64 {
    row.iter().map(|&(dof, c)| c * vector[dof as usize]).sum()
}
