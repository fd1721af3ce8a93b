//! The stage that follows a step in which points of a law with projection close.

use std::sync::Arc;

use carom_algebra::reduce::dot;
use carom_contact::law::Status;

use super::{Projected, Stages};
use crate::driver::attempt::Attempt;
use crate::driver::attempt::vectors::Vectors;
use crate::driver::contacts::Contacts;
use crate::driver::links::linking::add_all_forces;
use crate::error::Error;
use crate::resultant::Resultant;
use crate::step_forces::OutsideForces;

impl Stages {
    /// Works of the impulses after the step, J: on the motion relative to obstacles, and of the obstacles.
    pub(crate) fn works_of_impulses(&self, contacts: &Contacts) -> (f64, f64) {
        let (projected, rows) = (&self.projected, contacts.normal_rows());
        let points = projected.points.iter().map(|&point| point as usize);
        let of_obstacle = |point: usize| -projected.impulse(point) * rows.rate(point);
        (projected.work.iter().sum(), points.map(of_obstacle).sum())
    }

    /// Lists the closed points of laws with projection; whether any of them has just closed.
    pub(crate) fn projected_points(&mut self, contacts: &Contacts, attempt: &Attempt) -> bool {
        let points = &mut self.projected.points;
        let [before, now] = [&attempt.state, &attempt.next].map(|state| &state.interface.status);
        let mut closing = false;
        for &point in contacts.candidates() {
            let at = point as usize;
            if now[at] != Status::Open && attempt.system.point(at).0.law.projects() {
                points.push(point);
                closing |= before[at] == Status::Open;
            }
        }
        closing
    }

    /// Projects the velocity; impulses on the momentum from contacts, supports and links.
    pub(crate) fn project_velocity(
        &mut self,
        contacts: &Contacts,
        attempt: &mut Attempt,
    ) -> Result<OutsideForces<Resultant>, Error> {
        let weights = attempt.maps.first().contact_impulse;
        let [old, new] = [&attempt.state, &attempt.next].map(|state| &state.interface);
        let rows = contacts.normal_rows();
        let projected = &mut self.projected;
        projected.values.clear();
        projected.present.clear();
        for &point in &projected.points {
            let at = point as usize;
            let rate = rows.product(at, &attempt.next.motion.v) + rows.rate(at);
            projected.values.push(rate);
            let mean = weights.old * old.carried[at] + weights.new * new.force[at];
            projected.present.push(attempt.dt * mean);
        }
        self.solve_impulses(contacts, attempt)?;
        Ok(self.jump_velocity(contacts, attempt))
    }

    /// Adds what the impulses of the stage change in the velocity, from the rates in `values`; impulses on the momentum from
    /// contacts, supports and links.
    pub(super) fn jump_velocity(
        &mut self,
        contacts: &Contacts,
        attempt: &mut Attempt,
    ) -> OutsideForces<Resultant> {
        let system = Arc::clone(&attempt.system);
        let Some(stage) = &self.impulses else {
            return OutsideForces::default();
        };
        let (motion, interface) = (&mut attempt.next.motion, &mut attempt.next.interface);
        for (v, change) in motion.v.iter_mut().zip(&stage.change) {
            *v += change;
        }
        let Vectors {
            place: known,
            work,
            half,
            ..
        } = &mut attempt.vectors;
        known.fill(0.0);
        let (projected, rows) = (&mut self.projected, contacts.normal_rows());
        for (k, &point) in projected.points.iter().enumerate() {
            let at = point as usize;
            let impulse = stage.added[k];
            let after = rows.product(at, &motion.v) + rows.rate(at);
            projected.impulse[at] = impulse;
            projected.work[at] = 0.5 * impulse * (projected.values[k] + after);
            rows.add_force(at, impulse, known);
        }
        for point in 0..system.points() {
            interface.rate[point] = rows.product(point, &motion.v) + rows.rate(point);
        }
        let contact = Resultant::of(&system, known);
        half.fill(0.0);
        add_all_forces(&system, &stage.links, half);
        system.mass.multiply(&stage.change, work);
        for i in 0..work.len() {
            work[i] = match system.fixed[i] {
                true => work[i] - known[i] - half[i],
                false => 0.0,
            };
        }
        let [supports, links] = [&*work, &*half].map(|p| Resultant::of(&system, p));
        for (own, link) in work.iter_mut().zip(half) {
            *own += *link;
        }
        attempt.next.exchange.jump(&system, work);
        OutsideForces {
            contacts: contact,
            supports,
            links,
            ..OutsideForces::default()
        }
    }

    /// Projects the acceleration and the force that the next step begins with; change of |a|²_M.
    pub(crate) fn project_acceleration(
        &mut self,
        contacts: &Contacts,
        attempt: &mut Attempt,
    ) -> Result<f64, Error> {
        let projected = &mut self.projected;
        let Some(stage) = &self.impulses else {
            return Ok(0.0);
        };
        projected.values.clear();
        projected.present.clear();
        for (k, &point) in projected.points.iter().enumerate() {
            let at = point as usize;
            // points that the projection lets go have no acceleration to lose: their force ends with the step
            projected.values.push(match stage.active[k] {
                true => contacts.normal_rows().product(at, &attempt.next.motion.a),
                false => f64::INFINITY,
            });
            projected.present.push(attempt.next.interface.force[at]);
        }
        self.solve_impulses(contacts, attempt)?;
        let Some(stage) = &self.impulses else {
            return Ok(0.0);
        };
        let (motion, interface) = (&mut attempt.next.motion, &mut attempt.next.interface);
        let Vectors { place: known, .. } = &mut attempt.vectors;
        known.fill(0.0);
        for (k, &point) in self.projected.points.iter().enumerate() {
            interface.carried[point as usize] += stage.added[k];
            contacts
                .normal_rows()
                .add_force(point as usize, stage.added[k], known);
        }
        let before = dot(known, &motion.a);
        for (a, change) in motion.a.iter_mut().zip(&stage.change) {
            *a += change;
        }
        for (f, change) in motion.contact_force.iter_mut().zip(known.iter()) {
            *f += change;
        }
        if !stage.links.is_empty() {
            self.projected.links.extend_from_slice(&stage.links);
            add_all_forces(&attempt.system, &stage.links, &mut motion.link_force);
        }
        // a vanishes at the supports, so that |a'|²_M - |a|²_M = Nᵀ Q · (a + a')
        Ok(before + dot(known, &motion.a))
    }

    fn solve_impulses(&mut self, contacts: &Contacts, attempt: &Attempt) -> Result<(), Error> {
        let Projected {
            points,
            values,
            present,
            ..
        } = &self.projected;
        let Some(stage) = &mut self.impulses else {
            return Ok(());
        };
        // laws with projection have no weak form: the ratio of impulse and force enters nothing
        let weak = (contacts.weak(), 1.0);
        let solved = stage.solve(
            &attempt.system,
            weak,
            contacts.normal_rows(),
            points,
            values,
            present,
        );
        solved.map_err(|failure| attempt.interface_error(failure, &self.projected.points))
    }
}
