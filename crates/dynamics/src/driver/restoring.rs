//! The stage that follows a step of a scheme that gives the velocity back the work of the contact.
//!
//! `v₊ = v* + M⁻¹ Nᵀ I` with impulses I on the points that have closed in the step, each of which does the work that its
//! force took, `I_i N_i (v* + v₊)/2 = -P_i N_i Δu > 0`.

use carom_contact::law::Status;

use super::Driver;
use super::stages::Projected;
use crate::step_terms::Jump;

impl Driver {
    /// Gives the velocity back what the contact took, if the scheme does so.
    pub(super) fn restore(&mut self) {
        if !self.attempt.system.scheme.get().restores_contact_work()
            || self.attempt.maps.is_static()
        {
            return;
        }
        self.stages.projected.clear();
        let (rows, projected, works) = (
            &self.contacts.pairing.rows,
            &mut self.stages.projected,
            &mut self.stages.restoring.works,
        );
        let [old, new] = [&self.attempt.state, &self.attempt.next];
        works.clear();
        projected.values.clear();
        for &point in &self.contacts.candidates {
            let at = point as usize;
            let [before, now] = [old, new].map(|state| state.interface.status[at]);
            if before != Status::Open || now == Status::Open {
                continue;
            }
            let on = |x: &[f64]| rows.product(at, x);
            let obstacle = rows.rate(at);
            let way = on(&new.motion.u) - on(&old.motion.u) + self.attempt.dt * obstacle;
            let taken = -new.interface.force[at] * way;
            if taken > 0.0 {
                projected.points.push(point);
                projected.values.push(on(&new.motion.v) + obstacle);
                works.push(taken);
            }
        }
        let Some(stage) = &mut self.stages.impulses else {
            return;
        };
        if works.is_empty() {
            return;
        }
        let Projected { points, values, .. } = &self.stages.projected;
        stage.give_work(&self.attempt.system, rows, points, values, works);
        let impulses = self.stages.jump_velocity(&self.contacts, &mut self.attempt);
        let (work, work_obstacles) = self.stages.works_of_impulses(&self.contacts);
        let jump = Jump {
            impulses,
            work,
            work_obstacles,
            ..Jump::default()
        };
        self.enter_jump(jump);
    }
}
