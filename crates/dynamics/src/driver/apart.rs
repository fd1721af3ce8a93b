//! The contact problem of a diagonal matrix: groups of points that share no unknown are solved apart, on all threads. Of a large
//! group the compliance is the product of its sparse rows, and nothing is dense.

use std::sync::Arc;

use carom_nonsmooth::Unsolved;
use rayon::prelude::*;

use super::Driver;
use super::contacts::span::Candidates;
use super::explicit::leapfrog::Apart;
use crate::error::Error;
use crate::groups::Masses;

/// Rows of the largest group whose problem is kept where it is not solved.
const KEPT: usize = 1000;

impl Driver {
    /// Forces and statuses of the candidates. `free`: acceleration of an unknown without contact forces, m/s².
    ///
    /// # Errors
    /// A group without solution.
    pub(super) fn solve_apart(
        &mut self,
        apart: &mut Apart,
        free: impl Fn(&Driver, usize) -> f64,
    ) -> Result<(), Error> {
        self.contacts.split(&self.attempt, apart);
        apart.points.clear();
        let points = apart.groups.order().iter();
        apart
            .points
            .extend(points.map(|&place| self.contacts.candidates[place as usize]));
        std::mem::swap(&mut self.contacts.candidates, &mut apart.points);
        self.describe_apart(&mut apart.free, free);
        // what the laws see of the state is in their data now
        self.contacts.release(&mut self.attempt);
        let candidates = std::mem::take(&mut self.contacts.candidates);
        let data = std::mem::take(&mut self.contacts.candidate_data);
        apart.share();
        let (system, map) = (Arc::clone(&self.attempt.system), self.attempt.maps.first());
        let of = Candidates {
            points: &candidates,
            data: &data,
            rows: self.contacts.rows_of_points(&self.attempt),
            masses: Masses {
                lumped: &system.mass.lumped,
                fixed: &system.fixed,
                unknowns: &system.unknowns,
            },
            factors: [
                map.gap.x,
                map.rate.x,
                self.contacts.sliding(&self.attempt).0(map).x,
            ],
            tolerance: system.nonlinear.iteration.tolerance,
            interrupt: &self.attempt.interrupt,
        };
        match &mut apart.spans[..] {
            [one] => one.solve(&of),
            spans => spans.par_iter_mut().for_each(|span| span.solve(&of)),
        }
        let mut failed = None;
        if let Some(span) = apart.spans.iter_mut().find(|span| span.unsolved.is_some()) {
            failed = span.unsolved.take().map(|(group, failure)| {
                let rubs = matches!(failure, Unsolved::Friction(_));
                let entries = span.entries(&of, group.clone(), (rubs, KEPT));
                (group, failure, entries.map(|entries| (entries, of.factors)))
            });
        }
        (self.contacts.candidates, self.contacts.candidate_data) = (candidates, data);
        if let Some((group, failure, entries)) = failed {
            let places: Vec<u32> = group.map(|place| place as u32).collect();
            self.contacts.keep_places(&places);
            return Err(self.contacts.unsolved(&self.attempt, failure, entries));
        }
        self.contacts.gather(&apart.spans);
        for &candidate in apart.spans.iter().flat_map(|span| &span.circled) {
            self.contacts.warn_of_circle(&self.attempt, candidate);
        }
        self.contacts.take_found(&mut self.attempt);
        std::mem::swap(&mut self.contacts.candidates, &mut apart.points);
        Ok(())
    }

    /// Describes the candidates. `room`: a system vector.
    fn describe_apart(&mut self, room: &mut Vec<f64>, free: impl Fn(&Driver, usize) -> f64) {
        room.resize(self.attempt.system.unknowns(), 0.0);
        let rows = self.contacts.rows_of_points(&self.attempt);
        let width = rows.width();
        let points = self.contacts.candidates.iter();
        let numbers = points.flat_map(|&point| point * width..(point + 1) * width);
        for &dof in numbers.flat_map(|number| rows.row(number).0) {
            room[dof as usize] = free(self, dof as usize);
        }
        let attempt = &self.attempt;
        self.contacts
            .describe_candidates(attempt, width, |contacts, number| {
                contacts.rows_of_points(attempt).product(number, room)
            });
    }
}
