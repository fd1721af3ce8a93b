//! The interface problem of an iteration: candidates, forces, and the motion with them.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::Status;

use super::Driver;
use super::paired::{approaches, sums_compliances};
use crate::coulomb::Slip;
use crate::error::Error;
use crate::interface::{Failure, InterfaceProblem};

/// Additions of missed candidates within one iteration.
const ADDITIONS: usize = 10;

impl Driver {
    /// The motion `dx` of the iteration and the contact forces after it.
    pub(super) fn solve_interface(&mut self) -> Result<(), Error> {
        self.load_iteration();
        self.choose_candidates();
        for _ in 0..ADDITIONS {
            self.begin_solve();
            self.solve_candidates()?;
            self.end_iteration();
            if !self.add_missed() {
                break;
            }
        }
        Ok(())
    }

    /// Forces of the iteration without those of contacts, into `work`.
    fn load_iteration(&mut self) {
        self.begin_link_iteration();
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
    fn begin_solve(&mut self) {
        let begin = Instant::now();
        if let Some((operators, _)) = self.effective.both() {
            operators.begin(&self.vectors.work, &mut self.vectors.half);
        }
        self.hold_links();
        self.phases.sweeps += begin.elapsed();
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
    pub(super) fn free_motion(&mut self) {
        if self.jumps() {
            self.load_jump();
        }
        self.begin_solve();
        self.end_iteration();
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
    }

    fn approaches(&self, point: usize) -> bool {
        let tolerance = self.system.tolerance;
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
        let system = Arc::clone(&self.system);
        let Some((operators, compliance)) = self.effective.both() else {
            return Ok(());
        };
        let rows = &self.pairing.rows;
        compliance.update(&self.candidates, rows, &system.fixed, operators);
        self.describe_candidates(None);
        let factor = self.maps.contact();
        let Some((operators, compliance, mut linking)) = self.effective.all() else {
            return Ok(());
        };
        let rows = &self.pairing.rows;
        let (matrix, version) = match &mut linking {
            Some(linking) => linking.compliance(&system, (&mut *operators, compliance), rows),
            None => (&compliance.matrix[..], compliance.version),
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
        let condensed = (matrix, &compliance.candidates[..], version);
        let matrix = self
            .with_weak
            .of(&self.weak, &system, (condensed, rows), factors);
        let solved = self.interface.solve(&self.candidate_data, matrix, factors);
        if let Err(failure) = solved {
            let compliance = matrix.0.to_vec();
            return Err(self.keep_problem(failure, compliance, factors));
        }
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
        self.warn_of_circles();
        self.take_weak();
        Ok(())
    }

    pub(super) fn warn_of_circles(&self) {
        if let Some(candidate) = self.interface.circled {
            let name = self.name(self.candidates[candidate] as usize);
            tracing::warn!(
                "step {}: contact statuses cycle at {name}; they now change one at a time",
                self.state.step + 1
            );
        }
    }

    /// No contact force at all.
    pub(super) fn release(&mut self) {
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
        }
    }
}
