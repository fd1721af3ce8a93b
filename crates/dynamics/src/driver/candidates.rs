//! The interface problem of an iteration: candidates, forces, and the motion with them.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::Status;
use carom_nonsmooth::Compliance;

use super::Driver;
use super::deletion::as_narrowed;
use super::owners::{Attempt, Contacts, Parts};
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
        self.choose_candidates();
        for _ in 0..ADDITIONS {
            self.begin_forces()?;
            self.find_forces()?;
            self.contacts.look_further(&mut self.attempt);
            if !self.add_missed() {
                break;
            }
        }
        self.limit_rebound()
    }

    /// The motion `dx` and the contact forces of a pass with the forces in `work` and the columns that are at hand.
    pub(super) fn solve_with_columns(&mut self) -> Result<(), Error> {
        self.begin_solve()?;
        self.find_forces()
    }

    /// Begins the solve with the forces in `work` in the way in which contact forces are found.
    pub(super) fn begin_forces(&mut self) -> Result<(), Error> {
        match self.finds_all_at_once() {
            true => {
                self.parts.leave_solve(&mut self.attempt);
                Ok(())
            }
            false => self.begin_solve(),
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

    /// The first half of the solve with the forces in `work`.
    ///
    /// # Errors
    /// Iterations that do not end.
    fn begin_solve(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        if let Some((operators, _)) = self.parts.effective.both() {
            operators.begin(&self.attempt.vectors.work, &mut self.attempt.vectors.half);
        }
        self.attempt.vectors.left.clear();
        self.hold_links();
        self.attempt.phases.sweeps += begin.elapsed();
        self.parts.solves_ended(&self.attempt)
    }

    /// The motion `dx` that the forces in `work` and the jump of the supports give.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(super) fn free_motion(&mut self) -> Result<(), Error> {
        if self.attempt.jumps() {
            self.parts.load_jump(&mut self.attempt);
        }
        self.begin_solve()?;
        self.parts.end_iteration(&mut self.attempt);
        Ok(())
    }

    /// Points that may carry a force. Some laws say so before the forces; of others, those are taken that carried one or that
    /// close at the x of the iteration or at twice the rate at the start, and the rest is looked at after the solve.
    pub(super) fn choose_candidates(&mut self) {
        self.contacts.candidates.clear();
        let active = std::mem::take(&mut self.contacts.active);
        for point in active.within(0..self.attempt.system.points()) {
            let chosen = match self.contacts.told(&self.attempt, point) {
                Some(told) => told,
                None => {
                    self.attempt.next.interface.status[point] != Status::Open
                        || self.approaches(point)
                }
            };
            self.attempt.next.interface.watched[point] = chosen;
            if chosen {
                self.contacts.candidates.push(point as u32);
            }
        }
        self.contacts.active = active;
        if self.attempt.maps.is_explicit() {
            self.contacts.leave_to_others(&self.attempt);
        }
    }

    fn approaches(&self, point: usize) -> bool {
        let tolerance = self.attempt.system.tolerance_at(point);
        match self.is_affine() {
            true => {
                let gap = self.contacts.pairing.rows.gap(point);
                approaches(
                    (gap, self.contacts.rate_at_start(&self.attempt, point)),
                    self.attempt.dt,
                    tolerance,
                )
            }
            false => self.contacts.now(&self.attempt, point, true).0 <= tolerance,
        }
    }

    /// Forces and statuses of the candidates, whose forces are added to the begun solve.
    fn solve_candidates(&mut self) -> Result<(), Error> {
        if self.contacts.candidates.is_empty() {
            self.contacts.release(&mut self.attempt);
            return Ok(());
        }
        if self.contacts.rubs(&self.attempt) {
            return self.solve_with_friction();
        }
        let (system, together) = (Arc::clone(&self.attempt.system), self.is_one_group());
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
        self.describe_candidates(None);
        let factor = self.attempt.maps.contact();
        if iterate {
            return self.solve_iterated(factor);
        }
        if several {
            let map = self.attempt.maps.first();
            self.solve_groups([map.gap.x * factor, map.rate.x * factor])?;
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

    /// Whether all candidates are one problem, whatever they share: where links, weak forms or the mass couple them besides.
    pub(super) fn is_one_group(&self) -> bool {
        let sums = self.stages.impulses.is_some()
            && sums_compliances(&self.attempt.system, self.attempt.maps.first());
        sums || self.attempt.has_links() || !self.contacts.weak.none()
    }

    /// Forces and statuses of candidates in several groups, each solved by itself.
    fn solve_groups(&mut self, factors: [f64; 2]) -> Result<(), Error> {
        let Some((_, compliance)) = self.parts.effective.both() else {
            return Ok(());
        };
        let n = self.contacts.candidates.len();
        let all = &mut self.contacts.interface;
        all.forces.clear();
        all.forces.resize(n, 0.0);
        all.statuses.clear();
        all.statuses.resize(n, Status::Open);
        (all.passes, all.circled, all.unsettled) = (0, None, None);
        let mut failed = None;
        for (group, range) in compliance.groups().ranges().enumerate() {
            let places = &compliance.groups().order()[range];
            if self.contacts.interfaces.len() == group {
                let mut solver = Interface::default();
                solver.interrupt.clone_from(&self.attempt.interrupt);
                self.contacts.interfaces.push(solver);
            }
            let (solver, all) = (
                &mut self.contacts.interfaces[group],
                &mut self.contacts.interface,
            );
            let of_place = |&place: &u32| self.contacts.candidate_data[place as usize];
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
            self.contacts.keep_places(&places);
            return Err(self
                .contacts
                .keep_problem(&self.attempt, failure, block, factors));
        }
        Ok(())
    }

    /// Adds the points that were no candidates and whose law asks for a force; whether there are any.
    fn add_missed(&mut self) -> bool {
        let before = self.contacts.candidates.len();
        let active = std::mem::take(&mut self.contacts.active);
        for point in active.within(0..self.attempt.system.points()) {
            let known = self.contacts.candidates[..before].binary_search(&(point as u32));
            if known.is_ok() || self.contacts.told(&self.attempt, point).is_some() {
                continue;
            }
            let step = self
                .contacts
                .pairing
                .rows
                .product(point, &self.attempt.vectors.dx);
            let (gap, rate) = self.contacts.now(&self.attempt, point, false);
            let [closing, approach] = self.attempt.added(point, step);
            let ahead = (gap + closing, rate + approach);
            let (gap, rate) = self.contacts.weakly(&self.attempt, point, ahead);
            if self.asks(point, gap, rate) {
                self.contacts.candidates.push(point as u32);
                self.attempt.next.interface.watched[point] = true;
            }
        }
        self.contacts.active = active;
        self.contacts.candidates.sort_unstable();
        self.contacts.candidates.len() > before
    }
}

impl Parts {
    /// Adds to the forces in `work` what the jump of the supports gives.
    pub(super) fn load_jump(&mut self, attempt: &mut Attempt) {
        let vectors = &mut attempt.vectors;
        self.effective.load_of(&vectors.jump, &mut vectors.place);
        for (i, (r, k)) in vectors.work.iter_mut().zip(&vectors.place).enumerate() {
            *r = if attempt.system.fixed[i] { 0.0 } else { *r - k };
        }
    }

    /// Whether all solves since the last begin have ended.
    ///
    /// # Errors
    /// Iterations that did not.
    pub(super) fn solves_ended(&mut self, attempt: &Attempt) -> Result<(), Error> {
        let operators = self.effective.both();
        match operators.and_then(|(operators, _)| operators.failure()) {
            None => Ok(()),
            Some((unknown, cause)) => Err(attempt.not_solved(unknown, cause)),
        }
    }

    /// Leaves the solve with the forces in `work` to the problem of contacts.
    pub(super) fn leave_solve(&mut self, attempt: &mut Attempt) {
        if let Some((operators, _)) = self.effective.both() {
            let vectors = &mut attempt.vectors;
            operators.leave(&vectors.work, &mut vectors.half, &mut vectors.left);
        }
    }

    /// The motion of the iteration from the begun solve with all forces in it.
    pub(super) fn end_iteration(&mut self, attempt: &mut Attempt) {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.end(&mut attempt.vectors.half, &mut attempt.vectors.dx);
        }
        if attempt.vectors.jumps {
            for (dx, jump) in attempt.vectors.dx.iter_mut().zip(&attempt.vectors.jump) {
                *dx += jump;
            }
        }
        attempt.phases.sweeps += begin.elapsed();
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
