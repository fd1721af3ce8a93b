//! Contact forces of an iteration: one problem of all candidates, one of each group that acts on itself alone, or one of forces and
//! motion together where matrices are solved with by iterations.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::Status;
use carom_nonsmooth::{Compliance as D, Condensed};

use super::Driver;
use super::contacts::Contacts;
use super::contacts::describe::rows_of;
use super::paired::sums_compliances;
use crate::coulomb::Slip;
use crate::error::Error;

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
