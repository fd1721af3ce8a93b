//! Contact forces of an iteration: one problem of all candidates, one of each group that acts on itself alone, or one of forces and
//! motion together where matrices are solved with by iterations.

use std::sync::Arc;
use std::time::Instant;

use carom_contact::law::Status;

use super::Driver;
use crate::error::Error;

impl Driver {
    /// Forces and statuses of the candidates; their forces are added to the solve between its forward and its backward sweep.
    pub(super) fn solve_candidates(&mut self) -> Result<(), Error> {
        if self.contacts.candidates().is_empty() {
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
        let held = self.parts.holds_columns();
        let Some((operators, compliance)) = self.parts.effective_mut().both() else {
            return Ok(());
        };
        if !held {
            let rows = self.contacts.rows(width);
            let points = (self.contacts.candidates(), width, together);
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
            _ => self.contacts.solve_all(
                (&mut self.parts, self.stages.impulses_mut()),
                &self.attempt,
                width,
            ),
        }
    }

    /// Writes the forces and statuses found, and adds the forces to the begun solve.
    fn take_forces(&mut self, width: u32) -> Result<(), Error> {
        if !self.parts.effective().has_matrices() {
            return Ok(());
        }
        let interface = &mut self.attempt.next.interface;
        interface.force.fill(0.0);
        interface.friction.fill([0.0; 2]);
        interface.status.fill(Status::Open);
        self.contacts.take_all_found(&mut self.attempt);
        let pushed = self.links.pushed_mut();
        self.contacts
            .add_found((&mut self.parts, pushed), &mut self.attempt, width);
        self.part_links();
        self.contacts.take_weak(&self.attempt);
        Ok(())
    }
}
