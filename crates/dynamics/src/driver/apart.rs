//! The contact problem of a diagonal matrix: groups of points that share no unknown are solved apart, in their order. Of a large
//! group the compliance is the product of its sparse rows, and nothing is dense.

use std::ops::Range;
use std::sync::Arc;

use carom_contact::Rows;

use super::Driver;
use super::leapfrog::Apart;
use crate::coulomb::{Posed, Tangential};
use crate::error::Error;
use crate::groups::OfGroup;

/// Rows of the largest group whose problem is kept where it is not solved.
const KEPT: usize = 1000;

impl Driver {
    /// Splits the candidates into groups.
    fn split(&self, apart: &mut Apart) {
        let (rows, width) = self.rows_of_points();
        let fixed = &self.system.fixed;
        let unknowns = |point: u32| {
            let numbers = point * width..(point + 1) * width;
            let dofs = numbers.flat_map(|number| rows.row(number as usize).0);
            let dofs = dofs.map(|&dof| dof as usize);
            dofs.filter(|&dof| !fixed[dof])
        };
        apart.groups.split(&self.candidates, unknowns, fixed.len());
    }

    /// The rows of all points, with those of tangents, and how many each has.
    fn rows_of_points(&self) -> (&Rows, u32) {
        match self.system.tangents() {
            0 => (&self.pairing.rows, 1),
            tangents => (&self.stacked, 1 + tangents as u32),
        }
    }

    /// Forces and statuses of the candidates. `free`: acceleration of an unknown without contact forces, m/s².
    ///
    /// # Errors
    /// A group without solution.
    pub(super) fn solve_apart(
        &mut self,
        apart: &mut Apart,
        free: impl Fn(usize) -> f64,
    ) -> Result<(), Error> {
        self.split(apart);
        apart.points.clear();
        let points = apart.groups.order().iter();
        apart
            .points
            .extend(points.map(|&place| self.candidates[place as usize]));
        std::mem::swap(&mut self.candidates, &mut apart.points);
        let friction = self.describe_apart(&mut apart.free, free);
        // what the laws see of the state is in their data now
        self.release();
        let mut passes = 0;
        for group in apart.groups.ranges() {
            apart.version += 1;
            let d = &mut apart.of_group;
            match friction[..].get(group.clone()) {
                Some(own) if own.iter().any(|own| own.mu > 0.0) => {
                    self.solve_rubbing(group.clone(), own, d)
                }
                _ => self.solve_normal(group.clone(), (d, apart.version)),
            }?;
            passes = passes.max(self.interface.passes);
        }
        self.interface.passes = passes;
        std::mem::swap(&mut self.candidates, &mut apart.points);
        Ok(())
    }

    /// What the laws of the candidates know, and what friction adds to each; nothing without friction. `room`: a system vector.
    fn describe_apart(
        &mut self,
        room: &mut Vec<f64>,
        free: impl Fn(usize) -> f64,
    ) -> Vec<Tangential> {
        room.resize(self.system.unknowns(), 0.0);
        let mut data = std::mem::take(&mut self.candidate_data);
        data.clear();
        let (rows, width) = self.rows_of_points();
        let points = self.candidates.iter();
        let numbers = points.flat_map(|&point| point * width..(point + 1) * width);
        for &dof in numbers.flat_map(|number| rows.row(number as usize).0) {
            room[dof as usize] = free(dof as usize);
        }
        let along = |number: u32| rows.product(number as usize, room);
        let points = self.candidates.iter();
        data.extend(points.map(|&point| self.candidate(point as usize, along(point * width))));
        let friction = match width {
            1 => Vec::new(),
            _ => self.tangential(along),
        };
        self.candidate_data = data;
        friction
    }

    /// One group without friction.
    fn solve_normal(
        &mut self,
        group: Range<usize>,
        (d, version): (&mut OfGroup, u64),
    ) -> Result<(), Error> {
        let (system, map) = (Arc::clone(&self.system), self.maps.first());
        let factors = [map.gap.x, map.rate.x];
        let (rows, width) = self.rows_of_points();
        let normals = self.candidates[group.clone()].iter();
        let normals = normals.map(|point| point * width);
        let mass = (&system.mass.lumped[..], &system.fixed[..]);
        let compliance = d.over(normals, 1, rows, mass);
        let candidates = &self.candidate_data[group.clone()];
        let problem = (compliance, version);
        if let Err(failure) = self.interface.solve(candidates, problem, factors) {
            self.keep_places(&group.map(|place| place as u32).collect::<Vec<_>>());
            return Err(match compliance.entries(KEPT) {
                Some(entries) => self.keep_problem(failure, entries, factors),
                None => self.interface_error(failure, &self.candidates),
            });
        }
        let interface = &mut self.next.interface;
        for (k, &point) in self.candidates[group].iter().enumerate() {
            interface.force[point as usize] = self.interface.forces[k];
            interface.status[point as usize] = self.interface.statuses[k];
        }
        self.warn_of_circles();
        Ok(())
    }

    /// One group with friction.
    fn solve_rubbing(
        &mut self,
        group: Range<usize>,
        friction: &[Tangential],
        d: &mut OfGroup,
    ) -> Result<(), Error> {
        let (system, map) = (Arc::clone(&self.system), self.maps.first());
        let factors = [map.gap.x, map.rate.x, self.sliding().0(map).x];
        let (rows, width) = self.rows_of_points();
        let numbers = self.candidates[group.clone()].iter();
        let numbers = numbers.flat_map(|point| point * width..(point + 1) * width);
        let mass = (&system.mass.lumped[..], &system.fixed[..]);
        let compliance = d.over(numbers, width as usize, rows, mass);
        let posed = Posed {
            candidates: &self.candidate_data[group.clone()],
            friction,
            tangents: system.tangents(),
            d: compliance,
            s: factors,
            tolerance: system.nonlinear.iteration.tolerance,
        };
        if let Err(failure) = self.coulomb.solve(&posed) {
            self.keep_places(&group.map(|place| place as u32).collect::<Vec<_>>());
            if let Some(entries) = compliance.entries(KEPT) {
                self.keep_failed(friction.to_vec(), entries, factors);
            }
            return Err(self.friction_error(failure));
        }
        let interface = &mut self.next.interface;
        for (k, &point) in self.candidates[group].iter().enumerate() {
            let at = point as usize;
            interface.force[at] = self.coulomb.forces[k];
            interface.friction[at] = self.coulomb.tangential[k];
            interface.status[at] = self.coulomb.statuses[k];
            self.slips[at] = self.coulomb.slips[k];
        }
        Ok(())
    }
}
