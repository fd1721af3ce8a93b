//! The interface problem of an iteration: candidates, forces, and the motion with them.

use super::Driver;
use crate::error::Error;

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
        self.contacts.rebound_mut().begin();
        let jumps = self.attempt.jumps();
        let vectors = &mut self.attempt.vectors;
        vectors.work.copy_from_slice(&vectors.residual);
        if jumps {
            self.parts.load_jump(&mut self.attempt);
        }
    }
}
