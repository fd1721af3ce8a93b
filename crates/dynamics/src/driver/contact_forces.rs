//! Contact forces of an iteration: one problem of all candidates, one of each group that acts on itself alone, or one of forces and
//! motion together where matrices are solved with by iterations.

use std::sync::Arc;
use std::time::Instant;

use carom_algebra::Error as AlgebraError;
use carom_contact::law::Status;
use carom_nonsmooth::{Compliance as D, Condensed, ContactSolver, Unsolved};

use super::Driver;
use super::describe::rows_of;
use super::owners::{Attempt, Contacts, Parts};
use super::paired::sums_compliances;
use crate::compliance::Compliance;
use crate::coulomb::{FrictionFailure, FrictionProblem, Slip};
use crate::error::{Error, MeshNode};
use crate::interface::{Failure, InterfaceProblem};
use crate::operator::Operators;
use carom_system::ContactPair;

impl Driver {
    /// Forces and statuses of the candidates; their forces are added to the solve between its forward and its backward sweep.
    pub(super) fn solve_candidates(&mut self) -> Result<(), Error> {
        if self.contacts.candidates.is_empty() {
            self.contacts.release(&mut self.attempt);
            return Ok(());
        }
        let (begin, width) = (Instant::now(), self.contacts.width(&self.attempt));
        let solved = self.solve_condensed(width);
        if width > 1 {
            self.attempt.phases.friction += begin.elapsed();
        }
        solved?;
        self.take_forces(width)
    }

    /// Solves the problem of the candidates, of which each has `width` rows.
    fn solve_condensed(&mut self, width: u32) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let together = self.stages.is_one_group(&self.contacts, &self.attempt);
        let Some((operators, compliance)) = self.parts.effective.both() else {
            return Ok(());
        };
        if !self.parts.refined.holds_columns {
            let rows = self.contacts.rows(width);
            let points = (&self.contacts.candidates[..], width, together);
            let room = compliance.has_room(points, rows, &system.fixed, operators);
            room.map_err(|cause| Error::no_room(self.attempt.state.step, cause))?;
            compliance.update(points, rows, &system.fixed, operators);
        }
        let (several, iterate) = (compliance.groups().several(), operators.iterate());
        let (parts, attempt) = (&self.parts, &self.attempt);
        self.contacts
            .describe_candidates(attempt, width, |contacts, number| {
                contacts.free_along((parts, attempt), width, number)
            });
        match (iterate, several) {
            (true, _) => self
                .contacts
                .solve_with_motion(&mut self.parts, &mut self.attempt, width),
            (_, true) => self
                .contacts
                .solve_groups(&mut self.parts, &self.attempt, width),
            _ => self.solve_all(width),
        }
    }

    /// The problem of all candidates, with a dense D.
    fn solve_all(&mut self, width: u32) -> Result<(), Error> {
        let system = Arc::clone(&self.attempt.system);
        let mut s = self.contacts.factors_of_forces(&self.attempt);
        let Some((operators, compliance, mut linking)) = self.parts.effective.all() else {
            return Ok(());
        };
        let Contacts {
            pairing,
            stacked,
            candidate_data,
            solver,
            weak,
            with_weak,
            ..
        } = &mut self.contacts;
        let rows = rows_of(width, pairing, stacked);
        let (mut matrix, mut version) = match &mut linking {
            Some(linking) => linking.compliance(&system, (&mut *operators, compliance), rows),
            None => (compliance.matrix(), compliance.version),
        };
        if let Some(stage) = &mut self.stages.impulses
            && sums_compliances(&system, self.attempt.maps.first())
        {
            let rate = self.attempt.maps.first().rate;
            let own = (rate.x * self.attempt.maps.contact(), matrix);
            if let Some(sum) = stage.sum(&system, rows, compliance.rows(), own, rate.c) {
                (matrix, s) = (sum, [0.0, 1.0, 1.0]);
            }
        }
        if width == 1 {
            let condensed = ((matrix, compliance.rows(), version), rows);
            (matrix, version) = with_weak.of(weak, &system, condensed, [s[0], s[1]]);
        }
        let solved = solver.solve(
            candidate_data.all(),
            &Condensed {
                d: D::Dense(matrix),
                version,
                s,
                tangents: width as usize - 1,
                tolerance: system.nonlinear.iteration.tolerance,
            },
        );
        if let Err(failure) = solved {
            let entries = Some((matrix.to_vec(), s));
            return Err(self.contacts.unsolved(&self.attempt, failure, entries));
        }
        Ok(())
    }

    /// Writes the forces and statuses found, and adds the forces to the begun solve.
    fn take_forces(&mut self, width: u32) -> Result<(), Error> {
        let (system, factor) = (
            Arc::clone(&self.attempt.system),
            self.attempt.maps.contact(),
        );
        let Some((operators, compliance, linking)) = self.parts.effective.all() else {
            return Ok(());
        };
        let interface = &mut self.attempt.next.interface;
        interface.force.fill(0.0);
        interface.friction.fill([0.0; 2]);
        interface.status.fill(Status::Open);
        self.contacts.slips.fill(Slip::Open);
        self.contacts.take_found(&mut self.attempt);
        let (points, found) = (&self.contacts.candidates, &self.contacts.solver.found);
        let of_rows = points.iter().zip(found).flat_map(|(&point, found)| {
            let [one, two] = found.tangential;
            let forces = [found.normal, one, two].map(|force| factor * force);
            (point * width..(point + 1) * width).zip(forces)
        });
        let half = &mut self.attempt.vectors.half;
        for (row, force) in of_rows.clone().filter(|(_, force)| *force != 0.0) {
            compliance.add(row, force, operators, half);
        }
        if let Some(linking) = linking {
            let pushed = &mut self.links.multipliers.change[1];
            linking.answer(&system, operators, of_rows, (half, pushed));
        }
        self.part_links();
        self.contacts.take_weak(&self.attempt);
        Ok(())
    }
}

impl Contacts {
    /// Factors of D p in gaps, rates and sliding, with the force factor of the balance.
    fn factors_of_forces(&self, attempt: &Attempt) -> [f64; 3] {
        let (first, factor) = (attempt.maps.first(), attempt.maps.contact());
        let sliding = self.sliding(attempt).0(first).x;
        [first.gap.x, first.rate.x, sliding].map(|s| s * factor)
    }

    /// N x of the motion of the iteration without contact forces, along a row of a candidate; see [`Parts::free_along`].
    fn free_along(&self, (parts, attempt): (&Parts, &Attempt), width: u32, number: u32) -> f64 {
        let point = (number / width) as usize;
        let interface = &attempt.next.interface;
        let last = match (number % width) as usize {
            0 => interface.force[point],
            row => interface.friction[point][row - 1],
        };
        parts.free_along(attempt, number, self.rows(width), last)
    }

    /// Takes the forces and statuses found for the candidates, and tells what went on in the solve.
    pub(super) fn take_found(&mut self, attempt: &mut Attempt) {
        self.note_clipped(attempt, self.solver.unsettled);
        let interface = &mut attempt.next.interface;
        for (&point, found) in self.candidates.iter().zip(&self.solver.found) {
            let at = point as usize;
            interface.force[at] = found.normal;
            interface.status[at] = found.status;
            if let Some(friction) = interface.friction.get_mut(at) {
                *friction = found.tangential;
                self.slips[at] = found.slip;
            }
        }
        if let Some(candidate) = self.solver.circled {
            self.warn_of_circle(attempt, candidate);
        }
    }

    /// Whether the motion without contact forces is found together with them: no matrix has a factor, and nobody asks for it alone.
    pub(super) fn finds_all_at_once(&self, parts: &mut Parts, attempt: &Attempt) -> bool {
        let system = &*attempt.system;
        let asks = |contact: &ContactPair| contact.law.needs_free_gap();
        let asked = system.adaptive.is_some() || system.contacts.iter().any(asks);
        let iterates = |(operators, _): (&mut Operators, &mut Compliance)| operators.iterate();
        !asked && !self.candidates.is_empty() && parts.effective.both().is_some_and(iterates)
    }

    /// Forces and motion by iterations of both; the motion of the forces is added to the begun solve.
    ///
    /// # Errors
    /// Iterations that do not end, statuses that do not settle.
    fn solve_with_motion(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
        width: u32,
    ) -> Result<(), Error> {
        let (factor, s) = (attempt.maps.contact(), self.factors_of_forces(attempt));
        let Some((operators, compliance)) = parts.effective.both() else {
            return Ok(());
        };
        let (lent, tolerance) = operators.lend();
        let numbers = self.candidates.iter();
        let numbers = numbers.flat_map(|&point| point * width..(point + 1) * width);
        let rows = numbers.map(|number| compliance.row(number, operators));
        let left = &attempt.vectors.left;
        let load = |load: &mut [f64]| {
            for (load, left) in load.iter_mut().zip(left) {
                *load = left / factor;
            }
        };
        self.saddle.get_mut().begin(lent, rows, (tolerance, load));
        let solved = self.solver.solve(
            self.candidate_data.all(),
            &Condensed {
                d: D::Iterated(&self.saddle),
                version: compliance.version,
                s,
                tangents: width as usize - 1,
                tolerance: attempt.system.nonlinear.iteration.tolerance,
            },
        );
        let saddle = self.saddle.get_mut();
        operators.take_back(saddle.end());
        match solved {
            Ok(()) => {}
            Err(Unsolved::Iterations { unknown, cause }) => {
                let unknown = operators.unknown_at(unknown);
                return Err(attempt.not_solved(unknown, cause));
            }
            Err(failure) => return Err(self.unsolved(attempt, failure, None)),
        }
        saddle.add_motion(factor, &mut attempt.vectors.half);
        Ok(())
    }

    /// Forces and statuses of candidates in several groups, each solved by itself.
    fn solve_groups(
        &mut self,
        parts: &mut Parts,
        attempt: &Attempt,
        width: u32,
    ) -> Result<(), Error> {
        let s = self.factors_of_forces(attempt);
        let Some((_, compliance)) = parts.effective.both() else {
            return Ok(());
        };
        self.solver.open(self.candidates.len());
        for (group, range) in compliance.groups().ranges().enumerate() {
            let places = &compliance.groups().order()[range];
            if self.group_solvers.len() == group {
                let mut solver = ContactSolver::default();
                solver.heed(&attempt.interrupt);
                self.group_solvers.push(solver);
            }
            let (solver, all) = (&mut self.group_solvers[group], &mut self.solver);
            let (own, block) = (self.candidate_data.at(places), compliance.block(group));
            let problem = Condensed {
                d: D::Dense(block),
                version: compliance.version,
                s,
                tangents: width as usize - 1,
                tolerance: attempt.system.nonlinear.iteration.tolerance,
            };
            if let Err(failure) = solver.solve(own.all(), &problem) {
                let (block, places) = (block.to_vec(), places.to_vec());
                self.keep_places(&places);
                return Err(self.unsolved(attempt, failure, Some((block, s))));
            }
            for (&place, found) in places.iter().zip(&solver.found) {
                all.found[place as usize] = *found;
            }
            let place = |k: usize| places[k] as usize;
            all.passes = all.passes.max(solver.passes);
            all.circled = all.circled.or(solver.circled.map(place));
            all.unsettled = all.unsettled.or(solver.unsettled.map(place));
        }
        Ok(())
    }

    /// The error of candidates without solution, whose problem is kept. `entries`: D and the factors of D p, where D is known.
    pub(super) fn unsolved(
        &mut self,
        attempt: &Attempt,
        failure: Unsolved,
        entries: Option<(Vec<f64>, [f64; 3])>,
    ) -> Error {
        let step = attempt.state.step + 1;
        let rubs = matches!(failure, Unsolved::Friction(_));
        if let Some((compliance, factors)) = entries {
            let names = self.candidates.iter();
            let names = names.map(|&point| attempt.name(point as usize)).collect();
            let candidates = self.candidate_data.normal.clone();
            match rubs {
                true => {
                    self.failed_friction = Some(FrictionProblem {
                        step,
                        names,
                        candidates,
                        friction: self.candidate_data.friction.clone(),
                        tangents: attempt.system.tangents(),
                        compliance,
                        factors,
                        tolerance: attempt.system.nonlinear.iteration.tolerance,
                    });
                }
                false => {
                    self.failed = Some(InterfaceProblem {
                        step,
                        names,
                        candidates,
                        compliance,
                        factors: [factors[0], factors[1]],
                    });
                }
            }
        }
        match failure {
            Unsolved::Normal(failure) => attempt.interface_error(failure, &self.candidates),
            Unsolved::Friction(failure) => self.friction_error(attempt, failure),
            Unsolved::Iterations { unknown, cause } => attempt.not_solved(unknown, cause),
        }
    }

    fn friction_error(&self, attempt: &Attempt, failure: FrictionFailure) -> Error {
        Error::Friction {
            step: attempt.state.step + 1,
            point: attempt.name(self.candidates[failure.candidate] as usize),
            cause: failure,
        }
    }
}

impl Attempt {
    /// The error of iterations that do not end. `unknown`: the one with the largest residual.
    pub(super) fn not_solved(&self, unknown: usize, cause: AlgebraError) -> Error {
        let system = &*self.system;
        Error::Factor {
            matrix: "effective matrix",
            node: MeshNode::of(system, system.unknowns.node(unknown)),
            cause,
        }
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
