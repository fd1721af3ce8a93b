//! Groups of contact points that do not act on each other, solved apart.

use super::Contacts;
use super::span::Span;
use crate::driver::attempt::Attempt;
use crate::driver::explicit::leapfrog::Apart;
use crate::groups::PointRows;

impl Contacts {
    /// Splits the candidates into groups.
    pub(crate) fn split(&self, attempt: &Attempt, apart: &mut Apart) {
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
    pub(crate) fn rows_of_points(&self, attempt: &Attempt) -> PointRows<'_> {
        PointRows {
            normals: &self.pairing.rows,
            tangents: &self.pairing.tangents[..attempt.system.tangents()],
        }
    }

    /// What was found for the candidates of all groups.
    pub(crate) fn gather(&mut self, spans: &[Span]) {
        self.solver.open(0);
        let found = spans.iter().flat_map(|span| &span.found);
        self.solver.found.extend(found);
        let passes = spans.iter().map(|span| span.passes);
        self.solver.passes = passes.max().unwrap_or(0);
        self.solver.unsettled = spans.iter().find_map(|span| span.unsettled);
    }
}
