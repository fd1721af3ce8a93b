//! The contact problem of a diagonal matrix: groups of points that share no unknown are solved apart, on all threads. Of a large
//! group the compliance is the product of its sparse rows, and nothing is dense.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::Driver;
use super::leapfrog::Apart;
use super::owners::{Attempt, Contacts};
use super::span::{Candidates, Span, Unsolved};
use crate::coulomb::Tangential;
use crate::error::Error;
use crate::groups::{Masses, PointRows};

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
        let mut friction = std::mem::take(&mut apart.friction);
        self.describe_apart((&mut apart.free, &mut friction), free);
        // what the laws see of the state is in their data now
        self.contacts.release(&mut self.attempt);
        let candidates = std::mem::take(&mut self.contacts.candidates);
        let data = std::mem::take(&mut self.contacts.candidate_data);
        apart.share();
        let (system, map) = (Arc::clone(&self.attempt.system), self.attempt.maps.first());
        let of = Candidates {
            points: &candidates,
            data: &data,
            friction: &friction,
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
                (group, failure, entries, of.factors)
            });
        }
        (self.contacts.candidates, self.contacts.candidate_data) = (candidates, data);
        if let Some((group, failure, entries, factors)) = failed {
            let own = friction.get(group.clone()).unwrap_or_default();
            return Err(self.contacts.unsolved(
                &self.attempt,
                (group, own),
                failure,
                (entries, factors),
            ));
        }
        self.contacts.take_found(&mut self.attempt, &apart.spans);
        apart.friction = friction;
        std::mem::swap(&mut self.contacts.candidates, &mut apart.points);
        Ok(())
    }

    /// What the laws of the candidates know, and what friction adds to each; nothing without friction. `room`: a system vector.
    fn describe_apart(
        &mut self,
        (room, friction): (&mut Vec<f64>, &mut Vec<Tangential>),
        free: impl Fn(&Driver, usize) -> f64,
    ) {
        room.resize(self.attempt.system.unknowns(), 0.0);
        let mut data = std::mem::take(&mut self.contacts.candidate_data);
        data.clear();
        let rows = self.contacts.rows_of_points(&self.attempt);
        let width = rows.width();
        let points = self.contacts.candidates.iter();
        let numbers = points.flat_map(|&point| point * width..(point + 1) * width);
        for &dof in numbers.flat_map(|number| rows.row(number).0) {
            room[dof as usize] = free(self, dof as usize);
        }
        let along = |number: u32| rows.product(number, room);
        let points = self.contacts.candidates.iter();
        data.extend(points.map(|&point| {
            self.contacts
                .candidate(&self.attempt, point as usize, along(point * width))
        }));
        friction.clear();
        if width > 1 {
            self.contacts
                .describe_friction(&self.attempt, along, friction);
        }
        self.contacts.candidate_data = data;
    }
}

impl Contacts {
    /// Splits the candidates into groups.
    pub(super) fn split(&self, attempt: &Attempt, apart: &mut Apart) {
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
    pub(super) fn rows_of_points(&self, attempt: &Attempt) -> PointRows<'_> {
        PointRows {
            normals: &self.pairing.rows,
            tangents: &self.pairing.tangents[..attempt.system.tangents()],
        }
    }

    /// The error of a group without solution, whose problem is kept.
    pub(super) fn unsolved(
        &mut self,
        attempt: &Attempt,
        (group, friction): (Range<usize>, &[Tangential]),
        failure: Unsolved,
        (entries, factors): (Option<Vec<f64>>, [f64; 3]),
    ) -> Error {
        self.keep_places(&group.map(|place| place as u32).collect::<Vec<_>>());
        match (failure, entries) {
            (Unsolved::Normal(failure), Some(entries)) => {
                self.keep_problem(attempt, failure, entries, [factors[0], factors[1]])
            }
            (Unsolved::Normal(failure), None) => attempt.interface_error(failure, &self.candidates),
            (Unsolved::Friction(failure), entries) => {
                if let Some(entries) = entries {
                    self.keep_failed(attempt, friction.to_vec(), entries, factors);
                }
                self.friction_error(attempt, failure)
            }
        }
    }

    /// Takes the forces and statuses of the candidates.
    pub(super) fn take_found(&mut self, attempt: &mut Attempt, spans: &[Span]) {
        let interface = &mut attempt.next.interface;
        let found = spans.iter().flat_map(|span| &span.found);
        for (&point, found) in self.candidates.iter().zip(found) {
            let at = point as usize;
            interface.force[at] = found.force;
            interface.status[at] = found.status;
            if let Some(friction) = interface.friction.get_mut(at) {
                *friction = found.tangential;
                self.slips[at] = found.slip;
            }
        }
        let passes = spans.iter().map(|span| span.passes);
        self.interface.passes = passes.max().unwrap_or(0);
        for &candidate in spans.iter().flat_map(|span| &span.circled) {
            self.warn_of_circle(attempt, candidate);
        }
        self.note_clipped(attempt, spans.iter().find_map(|span| span.unsettled));
    }
}
