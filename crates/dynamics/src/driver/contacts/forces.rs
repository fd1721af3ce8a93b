//! The contact forces of an iteration.

use std::sync::Arc;

use carom_nonsmooth::{Compliance as D, Condensed, ContactSolver, Unsolved};
use carom_system::ContactPair;

use super::Contacts;
use super::describe::rows_of;
use crate::compliance::Compliance;
use crate::coulomb::{FrictionFailure, FrictionProblem, Slip};
use crate::driver::attempt::Attempt;
use crate::driver::paired::sums_compliances;
use crate::driver::parts::Parts;
use crate::driver::stages::impulse::Impulses;
use crate::error::Error;
use crate::interface::InterfaceProblem;
use crate::operator::Operators;

impl Contacts {
    /// Takes what was found for the candidates; all other points have no status of friction.
    pub(crate) fn take_all_found(&mut self, attempt: &mut Attempt) {
        self.slips.fill(Slip::Open);
        self.take_found(attempt);
    }

    /// Adds the forces found to the begun solve of the parts, and to what they push the rows of links with.
    pub(crate) fn add_found(
        &self,
        (parts, pushed): (&mut Parts, &mut [f64]),
        attempt: &mut Attempt,
        width: u32,
    ) {
        let factor = attempt.maps.contact();
        let Some((operators, compliance, linking)) = parts.effective_mut().all() else {
            return;
        };
        let found = self.candidates.iter().zip(&self.solver.found);
        let of_rows = found.flat_map(|(&point, found)| {
            let [one, two] = found.tangential;
            let forces = [found.normal, one, two].map(|force| factor * force);
            (point * width..(point + 1) * width).zip(forces)
        });
        let half = &mut attempt.vectors.half;
        for (row, force) in of_rows.clone().filter(|(_, force)| *force != 0.0) {
            compliance.add(row, force, operators, half);
        }
        if let Some(linking) = linking {
            linking.answer(&attempt.system, operators, of_rows, (half, pushed));
        }
    }

    /// Factors of D p in gaps, rates and sliding, with the force factor of the balance.
    fn factors_of_forces(&self, attempt: &Attempt) -> [f64; 3] {
        let (first, factor) = (attempt.maps.first(), attempt.maps.contact());
        let sliding = self.sliding(attempt).0(first).x;
        [first.gap.x, first.rate.x, sliding].map(|s| s * factor)
    }

    /// N x of the motion of the iteration without contact forces, along a row of a candidate; see [`Parts::free_along`].
    pub(crate) fn free_along(
        &self,
        (parts, attempt): (&Parts, &Attempt),
        width: u32,
        number: u32,
    ) -> f64 {
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
    pub(crate) fn finds_all_at_once(&self, parts: &mut Parts, attempt: &Attempt) -> bool {
        let system = &*attempt.system;
        let asks = |contact: &ContactPair| contact.law.needs_free_gap();
        let asked = system.adaptive.is_some() || system.contacts.iter().any(asks);
        let iterates = |(operators, _): (&mut Operators, &mut Compliance)| operators.iterate();
        !asked && !self.candidates.is_empty() && parts.effective_mut().both().is_some_and(iterates)
    }

    /// Forces and motion by iterations of both; the motion of the forces is added to the begun solve.
    ///
    /// # Errors
    /// Iterations that do not end, statuses that do not settle.
    pub(crate) fn solve_with_motion(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
        width: u32,
    ) -> Result<(), Error> {
        let (factor, s) = (attempt.maps.contact(), self.factors_of_forces(attempt));
        let Some((operators, compliance)) = parts.effective_mut().both() else {
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
    pub(crate) fn solve_groups(
        &mut self,
        parts: &mut Parts,
        attempt: &Attempt,
        width: u32,
    ) -> Result<(), Error> {
        let s = self.factors_of_forces(attempt);
        let Some((_, compliance)) = parts.effective_mut().both() else {
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

    /// The problem of all candidates, with a dense D.
    pub(crate) fn solve_all(
        &mut self,
        (parts, stage): (&mut Parts, Option<&mut Impulses>),
        attempt: &Attempt,
        width: u32,
    ) -> Result<(), Error> {
        let system = Arc::clone(&attempt.system);
        let mut s = self.factors_of_forces(attempt);
        let Some((operators, compliance, mut linking)) = parts.effective_mut().all() else {
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
        } = self;
        let rows = rows_of(width, pairing, stacked);
        let (mut matrix, mut version) = match &mut linking {
            Some(linking) => linking.compliance(&system, (&mut *operators, compliance), rows),
            None => (compliance.matrix(), compliance.version),
        };
        if let Some(stage) = stage
            && sums_compliances(&system, attempt.maps.first())
        {
            let rate = attempt.maps.first().rate;
            let own = (rate.x * attempt.maps.contact(), matrix);
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
            return Err(self.unsolved(attempt, failure, entries));
        }
        Ok(())
    }
}
