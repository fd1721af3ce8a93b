//! The interface problem of an iteration with friction.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::Status;
use carom_nonsmooth::Compliance;

use super::Driver;
use super::owners::{Attempt, Contacts, Parts};
use super::paired::sums_compliances;
use crate::coulomb::{FrictionFailure, FrictionProblem, Posed, Slip, Tangential};
use crate::error::Error;
use crate::interface::Candidate;
use crate::step_map::{Row, StepMap};

impl Driver {
    /// The interface problem of the candidates with friction.
    pub(super) fn solve_with_friction(&mut self) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let tangents = system.tangents();
        let width = 1 + tangents as u32;
        let together = self.stages.is_one_group(&self.contacts, &self.attempt);
        let factor = self.attempt.maps.contact();
        let first = self.attempt.maps.first();
        let s = [
            first.gap.x,
            first.rate.x,
            self.contacts.sliding(&self.attempt).0(first).x,
        ]
        .map(|s| s * factor);
        let Some((operators, compliance)) = self.parts.effective.both() else {
            return Ok(());
        };
        let begin = Instant::now();
        let points = (&self.contacts.candidates[..], width, together);
        if !self.parts.refined.holds_columns {
            let of = (&self.contacts.stacked, &system.fixed[..]);
            let room = compliance.has_room(points, of.0, of.1, operators);
            room.map_err(|cause| Error::no_room(self.attempt.state.step, cause))?;
            compliance.update(points, of.0, of.1, operators);
        }
        let (several, iterate) = (compliance.groups().several(), operators.iterate());
        self.contacts
            .describe_candidates(&self.parts, &self.attempt, Some(tangents as u32));
        let mut friction = Vec::new();
        let interface = &self.attempt.next.interface;
        let last = |number: u32| {
            let (point, row) = (
                number as usize / (1 + tangents),
                number as usize % (1 + tangents),
            );
            match row {
                0 => interface.force[point],
                _ => interface.friction[point][row - 1],
            }
        };
        let free = |number| {
            self.parts
                .free_along(&self.attempt, number, &self.contacts.stacked, last(number))
        };
        self.contacts
            .describe_friction(&self.attempt, free, &mut friction);
        if iterate {
            let solved =
                self.contacts
                    .find_with_friction(&mut self.parts, &mut self.attempt, &friction, s);
            self.attempt.phases.friction += begin.elapsed();
            solved?;
            return self.take_forces_with_friction(factor);
        }
        if several {
            let solved = self.contacts.solve_groups_with_friction(
                &mut self.parts,
                &self.attempt,
                &friction,
                s,
            );
            self.attempt.phases.friction += begin.elapsed();
            solved?;
            return self.take_forces_with_friction(factor);
        }
        let Some((operators, compliance, mut linking)) = self.parts.effective.all() else {
            return Ok(());
        };
        let (matrix, _) = match &mut linking {
            Some(linking) => linking.compliance(
                &system,
                (&mut *operators, compliance),
                &self.contacts.stacked,
            ),
            None => (compliance.matrix(), compliance.version),
        };
        let impulsive = match &mut self.stages.impulses {
            Some(stage) if sums_compliances(&system, self.attempt.maps.first()) => {
                let rate = self.attempt.maps.first().rate;
                let own = (rate.x * factor, matrix);
                stage.sum(
                    &system,
                    &self.contacts.stacked,
                    compliance.rows(),
                    own,
                    rate.c,
                )
            }
            _ => None,
        };
        let (matrix, s) = match impulsive {
            Some(matrix) => (matrix, [0.0, 1.0, 1.0]),
            None => (matrix, s),
        };
        let posed = Posed {
            candidates: &self.contacts.candidate_data,
            friction: &friction,
            tangents,
            d: Compliance::Dense(matrix),
            s,
            tolerance: system.nonlinear.iteration.tolerance,
        };
        let solved = self.contacts.coulomb.solve(&posed);
        self.attempt.phases.friction += begin.elapsed();
        if let Err(failure) = solved {
            let compliance = matrix.to_vec();
            self.contacts
                .keep_failed(&self.attempt, friction, compliance, s);
            return Err(self.contacts.friction_error(&self.attempt, failure));
        }
        self.take_forces_with_friction(factor)
    }

    /// Writes the forces and statuses found, and adds the forces, times `factor`, to the begun solve.
    fn take_forces_with_friction(&mut self, factor: f64) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let width = 1 + system.tangents() as u32;
        let rows = |&point: &u32| point * width..(point + 1) * width;
        let Some((operators, compliance, linking)) = self.parts.effective.all() else {
            return Ok(());
        };
        let interface = &mut self.attempt.next.interface;
        interface.force.fill(0.0);
        interface.friction.fill([0.0; 2]);
        interface.status.fill(Status::Open);
        self.contacts.slips.fill(Slip::Open);
        for (k, &point) in self.contacts.candidates.iter().enumerate() {
            let at = point as usize;
            let (p, t) = (
                self.contacts.coulomb.forces[k],
                self.contacts.coulomb.tangential[k],
            );
            interface.force[at] = p;
            interface.friction[at] = t;
            interface.status[at] = self.contacts.coulomb.statuses[k];
            self.contacts.slips[at] = self.contacts.coulomb.slips[k];
            let forces = [p, t[0], t[1]];
            for (row, force) in rows(&point).zip(forces).filter(|(_, force)| *force != 0.0) {
                compliance.add(
                    row,
                    factor * force,
                    operators,
                    &mut self.attempt.vectors.half,
                );
            }
        }
        if let Some(linking) = linking {
            let coulomb = &self.contacts.coulomb;
            let of_point = |(k, point): (usize, &u32)| {
                let (p, t) = (coulomb.forces[k], coulomb.tangential[k]);
                let forces = [p, t[0], t[1]].map(|force| factor * force);
                rows(point).zip(forces)
            };
            let forces = self
                .contacts
                .candidates
                .iter()
                .enumerate()
                .flat_map(of_point);
            let pushed = &mut self.links.multipliers.change[1];
            linking.answer(
                &system,
                operators,
                forces,
                (&mut self.attempt.vectors.half, pushed),
            );
        }
        self.part_links();
        Ok(())
    }
}

impl Contacts {
    /// Writes what the solver knows of the friction of each candidate.
    /// `free`: product of a stacked row with the motion of the iteration without contact forces.
    pub(super) fn describe_friction(
        &self,
        attempt: &Attempt,
        free: impl Fn(u32) -> f64,
        out: &mut Vec<Tangential>,
    ) {
        let (row, time) = self.sliding(attempt);
        // what the forces of the iteration give by themselves is in the matrix
        let without = move |map: &StepMap| Row { c: 0.0, ..row(map) };
        let tangents = attempt.system.tangents();
        let width = 1 + tangents as u32;
        let of = |&point: &u32| {
            let at = point as usize;
            let mut q = [0.0; 2];
            for (k, q) in q.iter_mut().enumerate().take(tangents) {
                let number = point * width + 1 + k as u32;
                let factor = row(attempt.map_of(attempt.system.contact_of(at))).x;
                let step = factor * free(number);
                *q = self.slid(attempt, at, k, (without, time)) + step;
            }
            let (mu, slides) = self.coefficients(attempt, at);
            Tangential {
                mu,
                sliding: (slides < mu).then_some(slides),
                free: q,
                slip: self.slips[at],
                force: attempt.next.interface.friction[at],
                pressed: attempt.next.interface.force[at],
            }
        };
        out.clear();
        out.extend(self.candidates.iter().map(of));
    }

    /// Keeps the problem that was not solved.
    pub(super) fn keep_failed(
        &mut self,
        attempt: &Attempt,
        friction: Vec<Tangential>,
        compliance: Vec<f64>,
        factors: [f64; 3],
    ) {
        let name = |&point: &u32| attempt.name(point as usize);
        self.failed_friction = Some(FrictionProblem {
            step: attempt.state.step + 1,
            names: self.candidates.iter().map(name).collect(),
            candidates: self.candidate_data.clone(),
            friction,
            tangents: attempt.system.tangents(),
            compliance,
            factors,
            tolerance: attempt.system.nonlinear.iteration.tolerance,
        });
    }

    pub(super) fn friction_error(&self, attempt: &Attempt, failure: FrictionFailure) -> Error {
        Error::Friction {
            step: attempt.state.step + 1,
            point: attempt.name(self.candidates[failure.candidate] as usize),
            cause: failure,
        }
    }

    /// Forces and statuses of candidates in several groups, each solved by itself.
    pub(super) fn solve_groups_with_friction(
        &mut self,
        parts: &mut Parts,
        attempt: &Attempt,
        friction: &[Tangential],
        s: [f64; 3],
    ) -> Result<(), Error> {
        let Some((_, compliance)) = parts.effective.both() else {
            return Ok(());
        };
        let n = self.candidates.len();
        let (mut forces, mut tangential) = (vec![0.0; n], vec![[0.0; 2]; n]);
        let (mut statuses, mut slips) = (vec![Status::Open; n], vec![Slip::Open; n]);
        let mut failed = None;
        for (group, range) in compliance.groups().ranges().enumerate() {
            let places = &compliance.groups().order()[range];
            let of_place = |&place: &u32| self.candidate_data[place as usize];
            let candidates: Vec<Candidate> = places.iter().map(of_place).collect();
            let of_place = |&place: &u32| friction[place as usize];
            let own: Vec<Tangential> = places.iter().map(of_place).collect();
            let block = compliance.block(group);
            let posed = Posed {
                candidates: &candidates,
                friction: &own,
                tangents: attempt.system.tangents(),
                d: Compliance::Dense(block),
                s,
                tolerance: attempt.system.nonlinear.iteration.tolerance,
            };
            if let Err(failure) = self.coulomb.solve(&posed) {
                failed = Some((failure, block.to_vec(), places.to_vec(), own));
                break;
            }
            for (k, &place) in places.iter().enumerate() {
                let at = place as usize;
                forces[at] = self.coulomb.forces[k];
                tangential[at] = self.coulomb.tangential[k];
                statuses[at] = self.coulomb.statuses[k];
                slips[at] = self.coulomb.slips[k];
            }
        }
        if let Some((failure, block, places, own)) = failed {
            self.keep_places(&places);
            self.keep_failed(attempt, own, block, s);
            return Err(self.friction_error(attempt, failure));
        }
        let all = &mut self.coulomb;
        (all.forces, all.tangential) = (forces, tangential);
        (all.statuses, all.slips) = (statuses, slips);
        Ok(())
    }
}
