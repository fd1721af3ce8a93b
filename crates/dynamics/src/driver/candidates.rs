//! The interface problem of an iteration: candidates, forces, and the motion with them.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::Status;
use carom_nonsmooth::Compliance;

use super::Driver;
use super::deletion::as_narrowed;
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
            self.look_further();
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
                self.leave_solve();
                Ok(())
            }
            false => self.begin_solve(),
        }
    }

    /// Contact forces, and the motion with them.
    pub(super) fn find_forces(&mut self) -> Result<(), Error> {
        let solved = self.solve_candidates();
        if solved.is_ok() {
            self.end_iteration();
        }
        // a column that could not be solved for comes before what follows from it
        self.solves_ended()?;
        solved
    }

    /// Forces of the iteration without those of contacts, into `work`.
    fn load_iteration(&mut self) {
        self.begin_link_iteration();
        self.rebound.begin();
        let jumps = self.jumps();
        let vectors = &mut self.vectors;
        vectors.work.copy_from_slice(&vectors.residual);
        if jumps {
            self.load_jump();
        }
    }

    /// Adds to the forces in `work` what the jump of the supports gives.
    fn load_jump(&mut self) {
        let vectors = &mut self.vectors;
        self.effective.load_of(&vectors.jump, &mut vectors.place);
        for (i, (r, k)) in vectors.work.iter_mut().zip(&vectors.place).enumerate() {
            *r = if self.system.fixed[i] { 0.0 } else { *r - k };
        }
    }

    /// The first half of the solve with the forces in `work`.
    ///
    /// # Errors
    /// Iterations that do not end.
    fn begin_solve(&mut self) -> Result<(), Error> {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.begin(&self.vectors.work, &mut self.vectors.half);
        }
        self.vectors.left.clear();
        self.hold_links();
        self.phases.sweeps += begin.elapsed();
        self.solves_ended()
    }

    /// Whether all solves since the last begin have ended.
    ///
    /// # Errors
    /// Iterations that did not.
    fn solves_ended(&mut self) -> Result<(), Error> {
        let operators = self.effective.both();
        match operators.and_then(|(operators, _)| operators.failure()) {
            None => Ok(()),
            Some((unknown, cause)) => Err(self.not_solved(unknown, cause)),
        }
    }

    /// Leaves the solve with the forces in `work` to the problem of contacts.
    fn leave_solve(&mut self) {
        if let Some((operators, _)) = self.effective.both() {
            let vectors = &mut self.vectors;
            operators.leave(&vectors.work, &mut vectors.half, &mut vectors.left);
        }
    }

    /// The motion of the iteration from the begun solve with all forces in it.
    fn end_iteration(&mut self) {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.end(&mut self.vectors.half, &mut self.vectors.dx);
        }
        if self.vectors.jumps {
            for (dx, jump) in self.vectors.dx.iter_mut().zip(&self.vectors.jump) {
                *dx += jump;
            }
        }
        self.phases.sweeps += begin.elapsed();
    }

    /// The motion `dx` that the forces in `work` and the jump of the supports give.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub(super) fn free_motion(&mut self) -> Result<(), Error> {
        if self.jumps() {
            self.load_jump();
        }
        self.begin_solve()?;
        self.end_iteration();
        Ok(())
    }

    /// Points that may carry a force. Some laws say so before the forces; of others, those are taken that carried one or that
    /// close at the x of the iteration or at twice the rate at the start, and the rest is looked at after the solve.
    pub(super) fn choose_candidates(&mut self) {
        self.candidates.clear();
        let active = std::mem::take(&mut self.active);
        for point in active.within(0..self.system.points()) {
            let chosen = match self.told(point) {
                Some(told) => told,
                None => self.next.interface.status[point] != Status::Open || self.approaches(point),
            };
            self.next.interface.watched[point] = chosen;
            if chosen {
                self.candidates.push(point as u32);
            }
        }
        self.active = active;
        if self.maps.is_explicit() {
            self.leave_to_others();
        }
    }

    /// Leaves out points whose contact those opposite to them tell, where forces of both would hardly move anything apart.
    fn leave_to_others(&mut self) {
        let (system, pairing) = (Arc::clone(&self.system), &self.pairing);
        let chosen = &self.next.interface.watched;
        self.candidates.retain(|&point| {
            let number = system.contact_of(point as usize);
            let contact = as_narrowed(&self.narrowed, &system, number);
            let first = system.contacts[number].range.start;
            let takes_part = |other: usize| chosen[first + other];
            !contact.leaves_it((pairing, first), point as usize - first, takes_part)
        });
    }

    fn approaches(&self, point: usize) -> bool {
        let tolerance = self.system.tolerance_at(point);
        match self.is_affine() {
            true => {
                let gap = self.pairing.rows.gap(point);
                approaches((gap, self.rate_at_start(point)), self.dt, tolerance)
            }
            false => self.now(point, true).0 <= tolerance,
        }
    }

    /// Forces and statuses of the candidates, whose forces are added to the begun solve.
    fn solve_candidates(&mut self) -> Result<(), Error> {
        if self.candidates.is_empty() {
            self.release();
            return Ok(());
        }
        if self.rubs() {
            return self.solve_with_friction();
        }
        let (system, together) = (Arc::clone(&self.system), self.is_one_group());
        let Some((operators, compliance)) = self.effective.both() else {
            return Ok(());
        };
        let rows = &self.pairing.rows;
        let points = (&self.candidates[..], 1, together);
        if !self.refined.holds_columns {
            let room = compliance.has_room(points, rows, &system.fixed, operators);
            room.map_err(|cause| Error::no_room(self.state.step, cause))?;
            compliance.update(points, rows, &system.fixed, operators);
        }
        let (several, iterate) = (compliance.groups().several(), operators.iterate());
        self.describe_candidates(None);
        let factor = self.maps.contact();
        if iterate {
            return self.solve_iterated(factor);
        }
        if several {
            let map = self.maps.first();
            self.solve_groups([map.gap.x * factor, map.rate.x * factor])?;
            return self.take_forces(factor);
        }
        let Some((operators, compliance, mut linking)) = self.effective.all() else {
            return Ok(());
        };
        let rows = &self.pairing.rows;
        let (matrix, version) = match &mut linking {
            Some(linking) => linking.compliance(&system, (&mut *operators, compliance), rows),
            None => (compliance.matrix(), compliance.version),
        };
        let impulsive = match &mut self.impulses {
            Some(stage) if sums_compliances(&system, self.maps.first()) => {
                let rate = self.maps.first().rate;
                let own = (rate.x * factor, matrix);
                stage.sum(&system, rows, &self.candidates, own, rate.c)
            }
            _ => None,
        };
        let (matrix, factors) = match impulsive {
            Some(matrix) => (matrix, [0.0, 1.0]),
            None => (
                matrix,
                [
                    self.maps.first().gap.x * factor,
                    self.maps.first().rate.x * factor,
                ],
            ),
        };
        let condensed = (matrix, compliance.rows(), version);
        let matrix = self
            .with_weak
            .of(&self.weak, &system, (condensed, rows), factors);
        let problem = (Compliance::Dense(matrix.0), matrix.1);
        let solved = self.interface.solve(&self.candidate_data, problem, factors);
        if let Err(failure) = solved {
            let compliance = matrix.0.to_vec();
            return Err(self.keep_problem(failure, compliance, factors));
        }
        self.take_forces(factor)
    }

    /// Writes the forces and statuses found, and adds the forces, times `factor`, to the begun solve.
    pub(super) fn take_forces(&mut self, factor: f64) -> Result<(), Error> {
        let system = Arc::clone(&self.system);
        self.note_clipped(self.interface.unsettled);
        let Some((operators, compliance, linking)) = self.effective.all() else {
            return Ok(());
        };
        let interface = &mut self.next.interface;
        interface.force.fill(0.0);
        interface.status.fill(Status::Open);
        for (k, &point) in self.candidates.iter().enumerate() {
            let force = self.interface.forces[k];
            interface.force[point as usize] = force;
            interface.status[point as usize] = self.interface.statuses[k];
            if force != 0.0 {
                compliance.add(point, factor * force, operators, &mut self.vectors.half);
            }
        }
        if let Some(linking) = linking {
            let forces = self.candidates.iter().zip(&self.interface.forces);
            let forces = forces.map(|(&point, force)| (point, factor * force));
            let pushed = &mut self.multipliers.change[1];
            linking.answer(&system, operators, forces, (&mut self.vectors.half, pushed));
        }
        self.part_links();
        if let Some(candidate) = self.interface.circled {
            self.warn_of_circle(candidate);
        }
        self.take_weak();
        Ok(())
    }

    /// Whether all candidates are one problem, whatever they share: where links, weak forms or the mass couple them besides.
    pub(super) fn is_one_group(&self) -> bool {
        let sums = self.impulses.is_some() && sums_compliances(&self.system, self.maps.first());
        sums || self.has_links() || !self.weak.none()
    }

    /// Forces and statuses of candidates in several groups, each solved by itself.
    fn solve_groups(&mut self, factors: [f64; 2]) -> Result<(), Error> {
        let Some((_, compliance)) = self.effective.both() else {
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
                solver.interrupt.clone_from(&self.interrupt);
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
            return Err(self.keep_problem(failure, block, factors));
        }
        Ok(())
    }

    /// Makes the candidates those at some places, to be told of.
    pub(super) fn keep_places(&mut self, places: &[u32]) {
        let (points, data) = (&self.candidates, &self.candidate_data);
        let points = places.iter().map(|&place| points[place as usize]).collect();
        let data = places.iter().map(|&place| data[place as usize]).collect();
        (self.candidates, self.candidate_data) = (points, data);
    }

    /// Notes the candidate whose tension did not settle, if there is one, in place of that of the iteration before.
    pub(super) fn note_clipped(&mut self, candidate: Option<usize>) {
        self.notices.clipped.count = 0;
        if let Some(candidate) = candidate {
            let place = self.name(self.candidates[candidate] as usize);
            self.notices.clipped.add(|| place);
        }
    }

    /// Warns that statuses of contact points went in circles from this candidate on.
    pub(super) fn warn_of_circle(&self, candidate: usize) {
        let name = self.name(self.candidates[candidate] as usize);
        tracing::warn!(
            "step {}: contact statuses cycle at {name}; they now change one at a time",
            self.state.step + 1
        );
    }

    /// No contact force at all.
    pub(super) fn release(&mut self) {
        self.note_clipped(None);
        for point in self.active.within(0..self.system.points()) {
            self.next.interface.release(point);
            if let Some(slip) = self.slips.get_mut(point) {
                *slip = Slip::Open;
            }
        }
        self.take_weak();
    }

    /// Adds the points that were no candidates and whose law asks for a force; whether there are any.
    fn add_missed(&mut self) -> bool {
        let before = self.candidates.len();
        let active = std::mem::take(&mut self.active);
        for point in active.within(0..self.system.points()) {
            let known = self.candidates[..before].binary_search(&(point as u32));
            if known.is_ok() || self.told(point).is_some() {
                continue;
            }
            let step = self.pairing.rows.product(point, &self.vectors.dx);
            let (gap, rate) = self.now(point, false);
            let [closing, approach] = self.added(point, step);
            let ahead = (gap + closing, rate + approach);
            let (gap, rate) = self.weakly(point, ahead);
            if self.asks(point, gap, rate) {
                self.candidates.push(point as u32);
                self.next.interface.watched[point] = true;
            }
        }
        self.active = active;
        self.candidates.sort_unstable();
        self.candidates.len() > before
    }

    /// Keeps the interface problem that was not solved, and names the failure.
    pub(super) fn keep_problem(
        &mut self,
        failure: Failure,
        compliance: Vec<f64>,
        factors: [f64; 2],
    ) -> Error {
        let names = self.candidates.iter();
        let names = names.map(|&point| self.name(point as usize));
        self.failed = Some(InterfaceProblem {
            step: self.state.step + 1,
            names: names.collect(),
            candidates: self.candidate_data.clone(),
            compliance,
            factors,
        });
        self.interface_error(failure, &self.candidates)
    }

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
