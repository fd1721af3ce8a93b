//! The stage before a step whose predictor is projected on the admissible displacements.
//!
//! `u* = u + dt v + w`, w = M⁻¹ Nᵀ R, `0 <= g(u*) ⟂ R >= 0`, on the rows of the step. The step finds 2 w/dt² where other
//! schemes have the acceleration at its start.

use super::Driver;
use super::owners::{Attempt, Stages};
use crate::error::Error;

impl Driver {
    /// Projects the predictor.
    pub(super) fn project_predictor(&mut self) -> Result<(), Error> {
        if !self.attempt.system.scheme.get().projects_predictor() || self.attempt.is_static() {
            return Ok(());
        }
        self.contacts.pair_now(&mut self.attempt);
        self.contacts.stack(&self.attempt);
        let dt = self.attempt.dt;
        let predictor = &mut self.stages.predictor;
        let (motion, rows) = (&mut self.attempt.state.motion, &self.contacts.pairing.rows);
        predictor.kept.clone_from(&motion.a);
        motion.a.fill(0.0);
        predictor.gaps.clear();
        predictor.gaps.extend((0..rows.len()).map(|point| {
            let rate = rows.product(point, &motion.v) + rows.rate(point);
            rows.gap(point) + dt * rate
        }));
        predictor.points.clear();
        predictor.forces.clear();
        while self.add_penetrating() {
            self.solve_predictor()?;
        }
        let Some(stage) = &self.stages.impulses else {
            return Ok(());
        };
        if !self.stages.predictor.points.is_empty() {
            for (a, w) in self.attempt.state.motion.a.iter_mut().zip(&stage.change) {
                *a = 2.0 / (dt * dt) * w;
            }
        }
        Ok(())
    }

    /// Adds the points that the projection so far leaves behind the surface; whether there are any.
    fn add_penetrating(&mut self) -> bool {
        let Some(stage) = &self.stages.impulses else {
            return false;
        };
        let (rows, predictor) = (&self.contacts.pairing.rows, &mut self.stages.predictor);
        let before = predictor.points.len();
        for point in 0..rows.len() as u32 {
            let at = point as usize;
            let moved = match before {
                0 => 0.0,
                _ => rows.product(at, &stage.change),
            };
            let pull = match before {
                0 => 0.0,
                _ => self.contacts.weak.pull(&self.attempt.system, at),
            };
            if predictor.gaps[at] + moved - pull < 0.0
                && predictor.points[..before].binary_search(&point).is_err()
            {
                predictor.points.push(point);
            }
        }
        predictor.points.sort_unstable();
        predictor.points.len() > before
    }

    fn solve_predictor(&mut self) -> Result<(), Error> {
        let predictor = &mut self.stages.predictor;
        let Some(stage) = &mut self.stages.impulses else {
            return Ok(());
        };
        predictor.values.clear();
        let gaps = predictor
            .points
            .iter()
            .map(|&point| predictor.gaps[point as usize]);
        predictor.values.extend(gaps);
        predictor.present.clear();
        predictor.present.resize(predictor.points.len(), 0.0);
        let (values, present) = (&predictor.values, &predictor.present);
        let dt = self.attempt.dt;
        let weak = (&self.contacts.weak, 0.5 * dt * dt);
        let points = &predictor.points;
        let solved = stage.solve(
            &self.attempt.system,
            weak,
            &self.contacts.pairing.rows,
            points,
            values,
            present,
        );
        predictor.forces.clone_from(&stage.added);
        let forces = points.iter().zip(&predictor.forces);
        let forces = forces.map(|(&point, &force)| (point as usize, force));
        self.contacts
            .weak
            .take(&self.attempt.system, forces, 2.0 / (dt * dt));
        solved.map_err(|failure| {
            self.attempt
                .interface_error(failure, &self.stages.predictor.points)
        })
    }

    /// What the projection of the predictor takes in the step, (2/dt²) R · (g(u₊) - g(u*)) in J.
    pub(super) fn predictor_loss(&self) -> f64 {
        let Some(stage) = &self.stages.impulses else {
            return 0.0;
        };
        let (old, new, dt) = (
            &self.attempt.state.motion,
            &self.attempt.next.motion,
            self.attempt.dt,
        );
        let predictor = &self.stages.predictor;
        let terms = predictor.points.iter().zip(&predictor.forces);
        let sum: f64 = terms
            .map(|(&point, force)| {
                let on = |x: &[f64]| self.contacts.pairing.rows.product(point as usize, x);
                force * (on(&new.u) - on(&old.u) - dt * on(&old.v) - on(&stage.change))
            })
            .sum();
        2.0 / (dt * dt) * sum
    }
}

impl Stages {
    /// Gives the state back what a failed step has changed in it.
    pub(super) fn forget_predictor(&mut self, attempt: &mut Attempt) {
        if self.predictor.kept.len() == attempt.state.motion.a.len() {
            attempt.state.motion.a.copy_from_slice(&self.predictor.kept);
            self.predictor.kept.clear();
        }
    }
}
