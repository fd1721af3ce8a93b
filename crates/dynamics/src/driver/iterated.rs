//! Contact forces where matrices are solved with by iterations: forces and motion are found together.

use carom_algebra::Error as AlgebraError;
use carom_nonsmooth::Condensed;

use super::Driver;
use crate::error::{Error, MeshNode};

impl Driver {
    /// Forces and statuses of the candidates; the motion of the forces is added to the begun solve. `factor`: that of contact forces in the
    /// balance.
    ///
    /// # Errors
    /// Iterations that do not end, statuses that do not settle.
    pub(super) fn solve_iterated(&mut self, factor: f64) -> Result<(), Error> {
        let map = self.maps.first();
        let factors = [map.gap.x * factor, map.rate.x * factor];
        let Some((operators, compliance)) = self.effective.both() else {
            return Ok(());
        };
        let (lent, tolerance) = operators.lend();
        let rows = self
            .candidates
            .iter()
            .map(|&point| compliance.row(point, operators));
        self.saddle.get_mut().begin(lent, rows, tolerance);
        let problem = (Condensed::Iterated(&self.saddle), compliance.version);
        let solved = self.interface.solve(&self.candidate_data, problem, factors);
        let saddle = self.saddle.get_mut();
        operators.take_back(saddle.end());
        if let Err(failure) = solved {
            return Err(self.interface_error(failure, &self.candidates));
        }
        saddle.add_motion(factor, &mut self.vectors.half);
        self.take_forces(factor)
    }

    /// The error of iterations that do not end. `unknown`: the first of the part.
    pub(super) fn not_solved(&self, unknown: usize, cause: AlgebraError) -> Error {
        let system = &*self.system;
        let unknown = match &cause {
            AlgebraError::Iterations { unknown: worst, .. } => unknown + worst,
            _ => unknown,
        };
        Error::Factor {
            matrix: "effective matrix",
            node: MeshNode::of(system, system.unknowns.node(unknown)),
            cause,
        }
    }
}
