//! A matrix that is solved with by iterations.

use carom_algebra::Error as AlgebraError;
use carom_algebra::solver::Iterative;

/// A matrix that is solved with by iterations.
pub(crate) struct Iterated {
    /// None while it is lent to the problem of contacts.
    pub(crate) solver: Option<Box<Iterative>>,
    /// Residual over the load at which iterations end.
    pub(crate) tolerance: f64,
    /// Why the last ones did not end.
    pub(crate) failed: Option<AlgebraError>,
}

impl Iterated {
    /// y = A⁻¹ r.
    pub(crate) fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        let Some(solver) = &mut self.solver else {
            unreachable!("a matrix is given back before the next solve")
        };
        self.failed = solver.solve(r, y, self.tolerance).err();
    }
}
