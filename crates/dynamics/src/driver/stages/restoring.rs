//! The stage that follows a step of a scheme that gives the velocity back the work of the contact.
//!
//! `v₊ = v* + M⁻¹ Nᵀ I` with impulses I on the points that have closed in the step, each of which does the work that its
//! force took, `I_i N_i (v* + v₊)/2 = -P_i N_i Δu > 0`.

use carom_contact::law::Status;

use super::{Projected, Stages};
use crate::driver::attempt::Attempt;
use crate::driver::contacts::Contacts;
use crate::step_terms::Jump;

impl Stages {
    /// Gives the velocity at the end of an attempt what the contact took; the jump, if there is one.
    pub(crate) fn restore(&mut self, contacts: &Contacts, attempt: &mut Attempt) -> Option<Jump> {
        self.projected.clear();
        let (rows, projected, works) = (
            contacts.normal_rows(),
            &mut self.projected,
            &mut self.restoring.works,
        );
        let [old, new] = [&attempt.state, &attempt.next];
        works.clear();
        projected.values.clear();
        for &point in contacts.candidates() {
            let at = point as usize;
            let [before, now] = [old, new].map(|state| state.interface.status[at]);
            if before != Status::Open || now == Status::Open {
                continue;
            }
            let on = |x: &[f64]| rows.product(at, x);
            let obstacle = rows.rate(at);
            let way = on(&new.motion.u) - on(&old.motion.u) + attempt.dt * obstacle;
            let taken = -new.interface.force[at] * way;
            if taken > 0.0 {
                projected.points.push(point);
                projected.values.push(on(&new.motion.v) + obstacle);
                works.push(taken);
            }
        }
        let Some(stage) = &mut self.impulses else {
            return None;
        };
        if works.is_empty() {
            return None;
        }
        let Projected { points, values, .. } = &self.projected;
        stage.give_work(&attempt.system, rows, points, values, works);
        let impulses = self.jump_velocity(contacts, attempt);
        let (work, work_obstacles) = self.works_of_impulses(contacts);
        Some(Jump {
            impulses,
            work,
            work_obstacles,
            ..Jump::default()
        })
    }
}
