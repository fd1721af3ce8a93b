//! Contact forces where matrices are solved with by iterations: forces and motion are found together.

use std::sync::Arc;

use carom_algebra::Error as AlgebraError;
use carom_nonsmooth::Compliance as D;

use super::Driver;
use super::owners::{Attempt, Contacts, Parts};
use crate::compliance::Compliance;
use crate::coulomb::{Posed, Tangential};
use crate::error::{Error, MeshNode};
use crate::interface::Failure;
use crate::operator::Operators;
use carom_system::ContactPair;

impl Driver {
    /// Forces and statuses of the candidates; the motion of the forces is added to the begun solve. `factor`: that of contact forces in the
    /// balance.
    ///
    /// # Errors
    /// Iterations that do not end, statuses that do not settle.
    pub(super) fn solve_iterated(&mut self, factor: f64) -> Result<(), Error> {
        let map = self.attempt.maps.first();
        let factors = [map.gap.x * factor, map.rate.x * factor];
        let Some((operators, compliance)) = self.parts.effective.both() else {
            return Ok(());
        };
        let (lent, tolerance) = operators.lend();
        let rows = self
            .contacts
            .candidates
            .iter()
            .map(|&point| compliance.row(point, operators));
        let left = &self.attempt.vectors.left;
        let load = |load: &mut [f64]| {
            for (load, left) in load.iter_mut().zip(left) {
                *load = left / factor;
            }
        };
        self.contacts
            .saddle
            .get_mut()
            .begin(lent, rows, (tolerance, load));
        let problem = (D::Iterated(&self.contacts.saddle), compliance.version);
        let solved = self
            .contacts
            .interface
            .solve(&self.contacts.candidate_data, problem, factors);
        let saddle = self.contacts.saddle.get_mut();
        operators.take_back(saddle.end());
        match solved {
            Ok(()) => {}
            Err(Failure::Singular {
                cause: cause @ AlgebraError::Iterations { unknown, .. },
                ..
            }) => {
                let unknown = operators.unknown_at(unknown);
                return Err(self.attempt.not_solved(unknown, cause));
            }
            Err(failure) => {
                return Err(self
                    .attempt
                    .interface_error(failure, &self.contacts.candidates));
            }
        }
        saddle.add_motion(factor, &mut self.attempt.vectors.half);
        self.take_forces(factor)
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
}

impl Contacts {
    /// Whether the motion without contact forces is found together with them: no matrix has a factor, and nobody asks for it alone.
    pub(super) fn finds_all_at_once(&self, parts: &mut Parts, attempt: &Attempt) -> bool {
        let system = &*attempt.system;
        let asks = |contact: &ContactPair| contact.law.needs_free_gap();
        let asked = system.adaptive.is_some() || system.contacts.iter().any(asks);
        let iterates = |(operators, _): (&mut Operators, &mut Compliance)| operators.iterate();
        !asked && !self.candidates.is_empty() && parts.effective.both().is_some_and(iterates)
    }

    /// The same with friction: rows of each candidate are its normal and its tangents. `s`: factors of D p in gaps, rates and sliding.
    pub(super) fn find_with_friction(
        &mut self,
        parts: &mut Parts,
        attempt: &mut Attempt,
        friction: &[Tangential],
        s: [f64; 3],
    ) -> Result<(), Error> {
        let system = Arc::clone(&attempt.system);
        let (tangents, factor) = (system.tangents(), attempt.maps.contact());
        let width = 1 + tangents as u32;
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
        let posed = Posed {
            candidates: &self.candidate_data,
            friction,
            tangents,
            d: D::Iterated(&self.saddle),
            s,
            tolerance: system.nonlinear.iteration.tolerance,
        };
        let solved = self.coulomb.solve(&posed);
        let saddle = self.saddle.get_mut();
        operators.take_back(saddle.end());
        match (solved, self.coulomb.cause.take()) {
            (Ok(()), _) => {}
            (Err(_), Some(cause @ AlgebraError::Iterations { unknown, .. })) => {
                let unknown = operators.unknown_at(unknown);
                return Err(attempt.not_solved(unknown, cause));
            }
            (Err(failure), _) => return Err(self.friction_error(attempt, failure)),
        }
        saddle.add_motion(factor, &mut attempt.vectors.half);
        Ok(())
    }
}
