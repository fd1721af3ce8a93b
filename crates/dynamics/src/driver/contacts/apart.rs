//! The contact problem of a diagonal matrix: groups of points that share no unknown are solved apart, on all threads. Of a large
//! group the compliance is the product of its sparse rows, and nothing is dense.

use std::sync::Arc;

use carom_nonsmooth::Unsolved;
use rayon::prelude::*;

use super::Contacts;
use super::span::{Candidates, Span};
use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Apart;
use crate::error::Error;
use crate::groups::{Masses, PointRows};

/// Rows of the largest group whose problem is kept where it is not solved.
const KEPT: usize = 1000;

impl Contacts {
    /// Forces and statuses of the candidates. `free`: acceleration of an unknown without contact forces, m/s².
    ///
    /// # Errors
    /// A group without solution.
    pub(crate) fn solve_apart(
        &mut self,
        attempt: &mut Attempt,
        apart: &mut Apart,
        free: impl Fn(&Attempt, usize) -> f64,
    ) -> Result<(), Error> {
        self.split(attempt, apart);
        apart.points.clear();
        let points = apart.groups.order().iter();
        apart
            .points
            .extend(points.map(|&place| self.candidates[place as usize]));
        std::mem::swap(&mut self.candidates, &mut apart.points);
        self.describe_apart(attempt, &mut apart.free, free);
        // what the laws see of the state is in their data now
        self.release(attempt);
        let candidates = std::mem::take(&mut self.candidates);
        let data = std::mem::take(&mut self.candidate_data);
        apart.share();
        let (system, map) = (Arc::clone(&attempt.system), attempt.maps.first());
        let of = Candidates {
            points: &candidates,
            data: &data,
            rows: self.rows_of_points(attempt),
            masses: Masses {
                lumped: &system.mass.lumped,
                fixed: &system.fixed,
                unknowns: &system.unknowns,
            },
            factors: [map.gap.x, map.rate.x, self.sliding(attempt).0(map).x],
            tolerance: system.nonlinear.iteration.tolerance,
            interrupt: &attempt.interrupt,
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
        (self.candidates, self.candidate_data) = (candidates, data);
        if let Some((group, failure, entries)) = failed {
            let places: Vec<u32> = group.map(|place| place as u32).collect();
            self.keep_places(&places);
            return Err(self.unsolved(attempt, failure, entries));
        }
        self.gather(&apart.spans);
        for &candidate in apart.spans.iter().flat_map(|span| &span.circled) {
            self.warn_of_circle(attempt, candidate);
        }
        self.take_found(attempt);
        std::mem::swap(&mut self.candidates, &mut apart.points);
        Ok(())
    }

    /// Describes the candidates. `room`: a system vector.
    fn describe_apart(
        &mut self,
        attempt: &Attempt,
        room: &mut Vec<f64>,
        free: impl Fn(&Attempt, usize) -> f64,
    ) {
        room.resize(attempt.system.unknowns(), 0.0);
        let rows = self.rows_of_points(attempt);
        let width = rows.width();
        let points = self.candidates.iter();
        let numbers = points.flat_map(|&point| point * width..(point + 1) * width);
        for &dof in numbers.flat_map(|number| rows.row(number).0) {
            room[dof as usize] = free(attempt, dof as usize);
        }
        self.describe_candidates(attempt, width, |contacts, number| {
            contacts.rows_of_points(attempt).product(number, room)
        });
    }

    /// Splits the candidates into groups.
    fn split(&self, attempt: &Attempt, apart: &mut Apart) {
        let (rows, fixed) = (self.rows_of_points(attempt), &attempt.system.fixed);
        let unknowns = |point: u32| {
            let numbers = point * rows.width()..(point + 1) * rows.width();
            let dofs = numbers.flat_map(|number| rows.row(number).0);
            let dofs = dofs.map(|&dof| dof as usize);
            dofs.filter(|&dof| !fixed[dof])
        };
        apart.groups.split(&self.candidates, unknowns, fixed.len());
    }

    /// The rows of all points.
    fn rows_of_points(&self, attempt: &Attempt) -> PointRows<'_> {
        PointRows {
            normals: &self.pairing.rows,
            tangents: &self.pairing.tangents[..attempt.system.tangents()],
        }
    }

    /// What was found for the candidates of all groups.
    fn gather(&mut self, spans: &[Span]) {
        self.solver.open(0);
        let found = spans.iter().flat_map(|span| &span.found);
        self.solver.found.extend(found);
        let passes = spans.iter().map(|span| span.passes);
        self.solver.passes = passes.max().unwrap_or(0);
        self.solver.unsettled = spans.iter().find_map(|span| span.unsettled);
    }
}
