//! The stage before a step whose predictor is projected on the admissible displacements.
//!
//! `u* = u + dt v + w`, w = M⁻¹ Nᵀ R, `0 <= g(u*) ⟂ R >= 0`, on the rows of the step. The step finds 2 w/dt² where other
//! schemes have the acceleration at its start.

use super::Stages;
use crate::driver::attempt::Attempt;
use crate::driver::contacts::Contacts;
use crate::error::Error;

impl Stages {
    /// Gives the state back what a failed step has changed in it.
    pub(crate) fn forget_predictor(&mut self, attempt: &mut Attempt) {
        if self.predictor.kept.len() == attempt.state.motion.a.len() {
            attempt.state.motion.a.copy_from_slice(&self.predictor.kept);
            self.predictor.kept.clear();
        }
    }

    /// Projects the predictor.
    pub(crate) fn project_predictor(
        &mut self,
        contacts: &mut Contacts,
        attempt: &mut Attempt,
    ) -> Result<(), Error> {
        if !attempt.system.scheme.get().projects_predictor() || attempt.is_static() {
            return Ok(());
        }
        contacts.pair_now(attempt);
        contacts.stack(attempt);
        let dt = attempt.dt;
        let predictor = &mut self.predictor;
        let (motion, rows) = (&mut attempt.state.motion, contacts.normal_rows());
        predictor.kept.clone_from(&motion.a);
        motion.a.fill(0.0);
        predictor.gaps.clear();
        predictor.gaps.extend((0..rows.len()).map(|point| {
            let rate = rows.product(point, &motion.v) + rows.rate(point);
            rows.gap(point) + dt * rate
        }));
        predictor.points.clear();
        predictor.forces.clear();
        while self.add_penetrating(contacts, attempt) {
            self.solve_predictor(contacts, attempt)?;
        }
        let Some(stage) = &self.impulses else {
            return Ok(());
        };
        if !self.predictor.points.is_empty() {
            for (a, w) in attempt.state.motion.a.iter_mut().zip(&stage.change) {
                *a = 2.0 / (dt * dt) * w;
            }
        }
        Ok(())
    }

    /// Adds the points that the projection so far leaves behind the surface; whether there are any.
    fn add_penetrating(&mut self, contacts: &Contacts, attempt: &Attempt) -> bool {
        let Some(stage) = &self.impulses else {
            return false;
        };
        let (rows, predictor) = (contacts.normal_rows(), &mut self.predictor);
        let before = predictor.points.len();
        for point in 0..rows.len() as u32 {
            let at = point as usize;
            let moved = match before {
                0 => 0.0,
                _ => rows.product(at, &stage.change),
            };
            let pull = match before {
                0 => 0.0,
                _ => contacts.weak().pull(&attempt.system, at),
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

    fn solve_predictor(&mut self, contacts: &mut Contacts, attempt: &Attempt) -> Result<(), Error> {
        let predictor = &mut self.predictor;
        let Some(stage) = &mut self.impulses else {
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
        let dt = attempt.dt;
        let weak = (contacts.weak(), 0.5 * dt * dt);
        let points = &predictor.points;
        let solved = stage.solve(
            &attempt.system,
            weak,
            contacts.normal_rows(),
            points,
            values,
            present,
        );
        predictor.forces.clone_from(&stage.added);
        let forces = points.iter().zip(&predictor.forces);
        let forces = forces.map(|(&point, &force)| (point as usize, force));
        contacts.take_weak_forces(&attempt.system, forces, 2.0 / (dt * dt));
        solved.map_err(|failure| attempt.interface_error(failure, &self.predictor.points))
    }

    /// What the projection of the predictor takes in the step, (2/dt²) R · (g(u₊) - g(u*)) in J.
    pub(crate) fn predictor_loss(&self, contacts: &Contacts, attempt: &Attempt) -> f64 {
        let Some(stage) = &self.impulses else {
            return 0.0;
        };
        let (old, new, dt) = (&attempt.state.motion, &attempt.next.motion, attempt.dt);
        let predictor = &self.predictor;
        let terms = predictor.points.iter().zip(&predictor.forces);
        let sum: f64 = terms
            .map(|(&point, force)| {
                let on = |x: &[f64]| contacts.normal_rows().product(point as usize, x);
                force * (on(&new.u) - on(&old.u) - dt * on(&old.v) - on(&stage.change))
            })
            .sum();
        2.0 / (dt * dt) * sum
    }
}
