//! What a nonlinear zone does for the links to other zones: the counterpart of the linear driver's.

use std::sync::Arc;

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_bodies::Placement;

use super::Newton;
use crate::driver::linked::{LinkRow, Ramp, on};
use crate::error::Error;
use crate::operator::{Operator, Operators};
use crate::scheme::{Scheme, Theta};
use crate::state::State;
use crate::step_map::StepMap;
use crate::system::push_cliques;
use crate::zones::Origin;

impl Newton {
    /// Makes the solver take forces of links from its next start on, which is with this force (N).
    pub(crate) fn link(&mut self, force: &[f64]) {
        self.link_force = force.to_vec();
    }

    /// Makes the solver forget links until its next `link`.
    pub(crate) fn unlink(&mut self) {
        self.link_force.clear();
    }

    /// Sets Cᵀ Λ of the step, N.
    pub(crate) fn set_link_force(&mut self, rows: &[(u32, LinkRow)], multipliers: &[f64]) {
        self.link_force.fill(0.0);
        for (row, terms) in rows {
            for &(dof, c) in terms {
                self.link_force[dof as usize] += c * multipliers[*row as usize];
            }
        }
    }

    /// Computes the next state from the state, with the forces of links as they stand.
    ///
    /// # Errors
    /// As [`Newton::step`]; a step of a zone is not halved.
    pub(crate) fn complete(&mut self) -> Result<(), Error> {
        self.report.attempts = 1;
        self.attempt(self.dt)?;
        let State {
            step,
            time,
            control,
            ..
        } = &self.state;
        self.next.step = step + 1;
        self.next.time = control.instant(*step, *time, self.dt);
        self.next.control = *control;
        self.next.control.pace = self.pace.fresh;
        Ok(())
    }

    /// Velocity at the end of the step just completed, which is not accepted yet.
    pub(crate) fn next_velocity(&self) -> &[f64] {
        &self.next.motion.v
    }

    /// Accepts the step just completed.
    pub(crate) fn take(&mut self) {
        let (step, time) = (self.state.step, self.state.time);
        self.next
            .control
            .take(None, (step, time, self.dt), self.system.dt);
        std::mem::swap(&mut self.state, &mut self.next);
        self.tell(self.dt);
    }

    /// Makes the state that of an earlier instant.
    pub(crate) fn go_back(&mut self, state: &State) {
        self.state.clone_from(state);
    }

    /// Work of the force of one row in the step just completed, J: `before` and `now` are the row's Λ of the step before and
    /// of this one.
    pub(crate) fn row_work(&self, terms: &LinkRow, before: f64, now: f64) -> f64 {
        let travel = on(terms, &self.next.motion.u) - on(terms, &self.state.motion.u);
        (self.map.impulse.old * before + self.map.impulse.new * now) * travel
    }

    /// Factors of M and K in the effective matrix, and of its solution in the velocity at the end of a step.
    pub(crate) fn effective(&self) -> (f64, f64, f64) {
        let map = self.linear_map();
        (map.inertia.x, map.force.x, map.velocity.x)
    }

    /// The map of the linearised zone: where forces belong to the way of the step they are those of its middle.
    fn linear_map(&self) -> StepMap {
        match self.between() {
            true => Scheme::Theta(Theta { theta: 0.5 }).get().step_map(self.dt),
            false => self.map,
        }
    }

    /// Loads at the present instant, after a start, N.
    pub(crate) fn load(&self) -> &[f64] {
        &self.vectors.load
    }

    /// Velocity that multipliers growing linearly from 0 to 1 in `steps` steps leave in the rows, without contact: the dense
    /// matrix `C V`, row-major over the rows given, of the zone linearised at the origin.
    ///
    /// # Errors
    /// An effective matrix that is not positive definite.
    pub(crate) fn ramp(
        &mut self,
        (rows, steps): (&[(u32, LinkRow)], u32),
        origin: &Origin,
    ) -> Result<Vec<f64>, Error> {
        let system = Arc::clone(&self.system);
        let n = system.unknowns();
        let mut cliques = Cliques::new();
        for body in &system.bodies {
            push_cliques(body, &system.unknowns, &(0..n), &mut cliques);
        }
        let mut stiffness = Csr::from_cliques(n, &cliques);
        let still = vec![0.0; n];
        for (k, body) in system.bodies.iter().enumerate() {
            let at = Placement {
                u: &origin.u,
                v: &still,
                from: None,
                dt: self.dt,
                old: &origin.history[system.nonlinear.histories[k].clone()],
            };
            body.add_tangent(&at, [1.0, 0.0], &mut stiffness)?;
        }
        let weights = system.scheme.link_weights().unwrap_or([0.0, 1.0]);
        let map = self.linear_map();
        let mut operators = self.linear_operators(&map, &stiffness)?;
        let mut ramp = Ramp {
            system: &system,
            map: &map,
            operators: &mut operators,
            forces: &mut |u, f| stiffness.multiply(u, f),
        };
        Ok(ramp.matrix(rows, steps, weights))
    }

    /// The factor of the effective matrix with this stiffness.
    fn linear_operators(&self, map: &StepMap, stiffness: &Csr) -> Result<Operators, Error> {
        let system = &*self.system;
        let n = system.unknowns();
        if map.force.x == 0.0 && system.mass.consistent.is_none() {
            let lumped = system.mass.lumped.iter();
            let diagonal: Vec<f64> = lumped.map(|m| map.inertia.x * m).collect();
            return Ok(Operators::whole(
                Operator::diagonal(&diagonal, &system.fixed),
                n,
            ));
        }
        let mut a = stiffness.clone();
        a.scale(map.force.x);
        system.mass.add_to(map.inertia.x, &(0..n), &mut a);
        let operator = Operator::factored(&a, &system.fixed, system.unknowns.node_of_each());
        let operator = operator.map_err(|cause| Error::Factor {
            matrix: "effective matrix",
            node: system.mesh_node[0],
            cause,
        })?;
        Ok(Operators::whole(operator, n))
    }
}
