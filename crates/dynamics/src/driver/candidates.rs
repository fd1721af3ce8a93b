//! The interface problem of an iteration: candidates, forces, and the motion with them.

use std::sync::Arc;

use carom_contact::law::Status;
use carom_nonsmooth::Compliance;

use super::Driver;
use super::deletion::as_narrowed;
use super::owners::{Attempt, Contacts, Parts, Stages};
use super::paired::{approaches, sums_compliances};
use crate::coulomb::Slip;
use crate::error::Error;
use crate::interface::{Candidate, Failure, Interface, InterfaceProblem};

/// Additions of missed candidates within one iteration.
const ADDITIONS: usize = 10;

impl Driver {
    /// The motion `dx` of the iteration and the contact forces after it.
    pub(super) fn solve_interface(&mut self) -> Result<(), Error> {
        self.load_iteration();
        self.contacts
            .choose_candidates(&self.parts, &mut self.attempt);
        for _ in 0..ADDITIONS {
            self.begin_forces()?;
            self.find_forces()?;
            self.contacts.look_further(&mut self.attempt);
            if !self.contacts.add_missed(&self.parts, &mut self.attempt) {
                break;
            }
        }
        self.limit_rebound()
    }

    /// The motion `dx` and the contact forces of a pass with the forces in `work` and the columns that are at hand.
    pub(super) fn solve_with_columns(&mut self) -> Result<(), Error> {
        self.links.begin_solve(&mut self.parts, &mut self.attempt)?;
        self.find_forces()
    }

    /// Begins the solve with the forces in `work` in the way in which contact forces are found.
    pub(super) fn begin_forces(&mut self) -> Result<(), Error> {
        match self
            .contacts
            .finds_all_at_once(&mut self.parts, &self.attempt)
        {
            true => {
                self.parts.leave_solve(&mut self.attempt);
                Ok(())
            }
            false => self.links.begin_solve(&mut self.parts, &mut self.attempt),
        }
    }

    /// Contact forces, and the motion with them.
    pub(super) fn find_forces(&mut self) -> Result<(), Error> {
        let solved = self.solve_candidates();
        if solved.is_ok() {
            self.parts.end_iteration(&mut self.attempt);
        }
        // a column that could not be solved for comes before what follows from it
        self.parts.solves_ended(&self.attempt)?;
        solved
    }

    /// Forces of the iteration without those of contacts, into `work`.
    fn load_iteration(&mut self) {
        self.links.begin_link_iteration();
        self.contacts.rebound.begin();
        let jumps = self.attempt.jumps();
        let vectors = &mut self.attempt.vectors;
        vectors.work.copy_from_slice(&vectors.residual);
        if jumps {
            self.parts.load_jump(&mut self.attempt);
        }
    }

    /// Forces and statuses of the candidates; their forces are added to the solve between its forward and its backward sweep.
    fn solve_candidates(&mut self) -> Result<(), Error> {
        if self.contacts.candidates.is_empty() {
            self.contacts.release(&mut self.attempt);
            return Ok(());
        }
        if self.contacts.rubs(&self.attempt) {
            return self.solve_with_friction();
        }
        let (system, together) = (
            Arc::clone(&self.attempt.system),
            self.stages.is_one_group(&self.contacts, &self.attempt),
        );
        let Some((operators, compliance)) = self.parts.effective.both() else {
            return Ok(());
        };
        let rows = &self.contacts.pairing.rows;
        let points = (&self.contacts.candidates[..], 1, together);
        if !self.parts.refined.holds_columns {
            let room = compliance.has_room(points, rows, &system.fixed, operators);
            room.map_err(|cause| Error::no_room(self.attempt.state.step, cause))?;
            compliance.update(points, rows, &system.fixed, operators);
        }
        let (several, iterate) = (compliance.groups().several(), operators.iterate());
        self.contacts
            .describe_candidates(&self.parts, &self.attempt, None);
        let factor = self.attempt.maps.contact();
        if iterate {
            return self.solve_iterated(factor);
        }
        if several {
            let map = self.attempt.maps.first();
            self.contacts.solve_groups(
                &mut self.parts,
                &self.attempt,
                [map.gap.x * factor, map.rate.x * factor],
            )?;
            return self.take_forces(factor);
        }
        let Some((operators, compliance, mut linking)) = self.parts.effective.all() else {
            return Ok(());
        };
        let rows = &self.contacts.pairing.rows;
        let (matrix, version) = match &mut linking {
            Some(linking) => linking.compliance(&system, (&mut *operators, compliance), rows),
            None => (compliance.matrix(), compliance.version),
        };
        let impulsive = match &mut self.stages.impulses {
            Some(stage) if sums_compliances(&system, self.attempt.maps.first()) => {
                let rate = self.attempt.maps.first().rate;
                let own = (rate.x * factor, matrix);
                stage.sum(&system, rows, &self.contacts.candidates, own, rate.c)
            }
            _ => None,
        };
        let (matrix, factors) = match impulsive {
            Some(matrix) => (matrix, [0.0, 1.0]),
            None => (
                matrix,
                [
                    self.attempt.maps.first().gap.x * factor,
                    self.attempt.maps.first().rate.x * factor,
                ],
            ),
        };
        let condensed = (matrix, compliance.rows(), version);
        let matrix =
            self.contacts
                .with_weak
                .of(&self.contacts.weak, &system, (condensed, rows), factors);
        let problem = (Compliance::Dense(matrix.0), matrix.1);
        let solved = self
            .contacts
            .interface
            .solve(&self.contacts.candidate_data, problem, factors);
        if let Err(failure) = solved {
            let compliance = matrix.0.to_vec();
            return Err(self
                .contacts
                .keep_problem(&self.attempt, failure, compliance, factors));
        }
        self.take_forces(factor)
    }

    /// Writes the forces and statuses found, and adds the forces, times `factor`, to the begun solve.
    pub(super) fn take_forces(&mut self, factor: f64) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        self.contacts
            .note_clipped(&mut self.attempt, self.contacts.interface.unsettled);
        let Some((operators, compliance, linking)) = self.parts.effective.all() else {
            return Ok(());
        };
        let interface = &mut self.attempt.next.interface;
        interface.force.fill(0.0);
        interface.status.fill(Status::Open);
        for (k, &point) in self.contacts.candidates.iter().enumerate() {
            let force = self.contacts.interface.forces[k];
            interface.force[point as usize] = force;
            interface.status[point as usize] = self.contacts.interface.statuses[k];
            if force != 0.0 {
                compliance.add(
                    point,
                    factor * force,
                    operators,
                    &mut self.attempt.vectors.half,
                );
            }
        }
        if let Some(linking) = linking {
            let forces = self
                .contacts
                .candidates
                .iter()
                .zip(&self.contacts.interface.forces);
            let forces = forces.map(|(&point, force)| (point, factor * force));
            let pushed = &mut self.links.multipliers.change[1];
            linking.answer(
                &system,
                operators,
                forces,
                (&mut self.attempt.vectors.half, pushed),
            );
        }
        self.part_links();
        if let Some(candidate) = self.contacts.interface.circled {
            self.contacts.warn_of_circle(&self.attempt, candidate);
        }
        self.contacts.take_weak(&self.attempt);
        Ok(())
    }
}

impl Contacts {
    /// Leaves out points whose contact those opposite to them tell, where forces of both would hardly move anything apart.
    pub(super) fn leave_to_others(&mut self, attempt: &Attempt) {
        let (system, pairing) = (Arc::clone(&attempt.system), &self.pairing);
        let chosen = &attempt.next.interface.watched;
        self.candidates.retain(|&point| {
            let number = system.contact_of(point as usize);
            let contact = as_narrowed(&self.narrowed, &system, number);
            let first = system.contacts[number].range.start;
            let takes_part = |other: usize| chosen[first + other];
            !contact.leaves_it((pairing, first), point as usize - first, takes_part)
        });
    }

    /// Makes the candidates those at some places, to be told of.
    pub(super) fn keep_places(&mut self, places: &[u32]) {
        let (points, data) = (&self.candidates, &self.candidate_data);
        let points = places.iter().map(|&place| points[place as usize]).collect();
        let data = places.iter().map(|&place| data[place as usize]).collect();
        (self.candidates, self.candidate_data) = (points, data);
    }

    /// Notes the candidate whose tension did not settle, if there is one, in place of that of the iteration before.
    pub(super) fn note_clipped(&self, attempt: &mut Attempt, candidate: Option<usize>) {
        attempt.notices.clipped.count = 0;
        if let Some(candidate) = candidate {
            let place = attempt.name(self.candidates[candidate] as usize);
            attempt.notices.clipped.add(|| place);
        }
    }

    /// Warns that statuses of contact points went in circles from this candidate on.
    pub(super) fn warn_of_circle(&self, attempt: &Attempt, candidate: usize) {
        let name = attempt.name(self.candidates[candidate] as usize);
        tracing::warn!(
            "step {}: contact statuses cycle at {name}; they now change one at a time",
            attempt.state.step + 1
        );
    }

    /// No contact force at all.
    pub(super) fn release(&mut self, attempt: &mut Attempt) {
        self.note_clipped(attempt, None);
        for point in self.active.within(0..attempt.system.points()) {
            attempt.next.interface.release(point);
            if let Some(slip) = self.slips.get_mut(point) {
                *slip = Slip::Open;
            }
        }
        self.take_weak(attempt);
    }

    /// Keeps the interface problem that was not solved, and names the failure.
    pub(super) fn keep_problem(
        &mut self,
        attempt: &Attempt,
        failure: Failure,
        compliance: Vec<f64>,
        factors: [f64; 2],
    ) -> Error {
        let names = self.candidates.iter();
        let names = names.map(|&point| attempt.name(point as usize));
        self.failed = Some(InterfaceProblem {
            step: attempt.state.step + 1,
            names: names.collect(),
            candidates: self.candidate_data.clone(),
            compliance,
            factors,
        });
        attempt.interface_error(failure, &self.candidates)
    }

    /// Points that may carry a force. Some laws say so before the forces; of others, those are taken that carried one or that
    /// close at the x of the iteration or at twice the rate at the start, and the rest is looked at after the solve.
    pub(super) fn choose_candidates(&mut self, parts: &Parts, attempt: &mut Attempt) {
        self.candidates.clear();
        let active = std::mem::take(&mut self.active);
        for point in active.within(0..attempt.system.points()) {
            let chosen = match self.told(attempt, point) {
                Some(told) => told,
                None => {
                    attempt.next.interface.status[point] != Status::Open
                        || self.approaches(parts, attempt, point)
                }
            };
            attempt.next.interface.watched[point] = chosen;
            if chosen {
                self.candidates.push(point as u32);
            }
        }
        self.active = active;
        if attempt.maps.is_explicit() {
            self.leave_to_others(attempt);
        }
    }

    pub(super) fn approaches(&self, parts: &Parts, attempt: &Attempt, point: usize) -> bool {
        let tolerance = attempt.system.tolerance_at(point);
        match self.is_affine(parts) {
            true => {
                let gap = self.pairing.rows.gap(point);
                approaches(
                    (gap, self.rate_at_start(attempt, point)),
                    attempt.dt,
                    tolerance,
                )
            }
            false => self.now(attempt, point, true).0 <= tolerance,
        }
    }

    /// Forces and statuses of candidates in several groups, each solved by itself.
    pub(super) fn solve_groups(
        &mut self,
        parts: &mut Parts,
        attempt: &Attempt,
        factors: [f64; 2],
    ) -> Result<(), Error> {
        let Some((_, compliance)) = parts.effective.both() else {
            return Ok(());
        };
        let n = self.candidates.len();
        let all = &mut self.interface;
        all.forces.clear();
        all.forces.resize(n, 0.0);
        all.statuses.clear();
        all.statuses.resize(n, Status::Open);
        (all.passes, all.circled, all.unsettled) = (0, None, None);
        let mut failed = None;
        for (group, range) in compliance.groups().ranges().enumerate() {
            let places = &compliance.groups().order()[range];
            if self.interfaces.len() == group {
                let mut solver = Interface::default();
                solver.interrupt.clone_from(&attempt.interrupt);
                self.interfaces.push(solver);
            }
            let (solver, all) = (&mut self.interfaces[group], &mut self.interface);
            let of_place = |&place: &u32| self.candidate_data[place as usize];
            let own: Vec<Candidate> = places.iter().map(of_place).collect();
            let block = compliance.block(group);
            let problem = (Compliance::Dense(block), compliance.version);
            if let Err(failure) = solver.solve(&own, problem, factors) {
                failed = Some((failure, block.to_vec(), places.to_vec()));
                break;
            }
            for (k, &place) in places.iter().enumerate() {
                all.forces[place as usize] = solver.forces[k];
                all.statuses[place as usize] = solver.statuses[k];
            }
            all.passes = all.passes.max(solver.passes);
            let circled = solver.circled.map(|k| places[k] as usize);
            all.circled = all.circled.or(circled);
            let unsettled = solver.unsettled.map(|k| places[k] as usize);
            all.unsettled = all.unsettled.or(unsettled);
        }
        if let Some((failure, block, places)) = failed {
            self.keep_places(&places);
            return Err(self.keep_problem(attempt, failure, block, factors));
        }
        Ok(())
    }

    /// Adds the points that were no candidates and whose law asks for a force; whether there are any.
    pub(super) fn add_missed(&mut self, parts: &Parts, attempt: &mut Attempt) -> bool {
        let before = self.candidates.len();
        let active = std::mem::take(&mut self.active);
        for point in active.within(0..attempt.system.points()) {
            let known = self.candidates[..before].binary_search(&(point as u32));
            if known.is_ok() || self.told(attempt, point).is_some() {
                continue;
            }
            let step = self.pairing.rows.product(point, &attempt.vectors.dx);
            let (gap, rate) = self.now(attempt, point, false);
            let [closing, approach] = attempt.added(point, step);
            let ahead = (gap + closing, rate + approach);
            let (gap, rate) = self.weakly(attempt, point, ahead);
            if self.asks(parts, attempt, point, gap, rate) {
                self.candidates.push(point as u32);
                attempt.next.interface.watched[point] = true;
            }
        }
        self.active = active;
        self.candidates.sort_unstable();
        self.candidates.len() > before
    }
}

impl Attempt {
    /// The error behind a failure of the interface problem of some points.
    pub(super) fn interface_error(&self, failure: Failure, candidates: &[u32]) -> Error {
        let step = self.state.step + 1;
        match failure {
            Failure::Singular { points, cause } => Error::Interface {
                step,
                points,
                cause,
            },
            Failure::Cycling { passes, candidate } => {
                let (contact, point) = self.system.point(candidates[candidate] as usize);
                Error::Statuses {
                    step,
                    passes,
                    contact: contact.name.clone(),
                    point,
                }
            }
            Failure::Interrupted { .. } => Error::Interrupted,
        }
    }
}

impl Stages {
    /// Whether all candidates are one problem, whatever they share: where links, weak forms or the mass couple them besides.
    pub(super) fn is_one_group(&self, contacts: &Contacts, attempt: &Attempt) -> bool {
        let sums =
            self.impulses.is_some() && sums_compliances(&attempt.system, attempt.maps.first());
        sums || attempt.has_links() || !contacts.weak.none()
    }
}
