//! Operators whose matrices are solved with by iterations, and their loan to the problem of contacts.

use carom_algebra::Error as AlgebraError;
use carom_algebra::solver::Iterative;

use crate::operator::{Operator, Operators};

impl Operators {
    /// Whether any matrix is solved with by iterations.
    pub(crate) fn iterate(&self) -> bool {
        (0..self.groups.len()).any(|group| self.iterates(group))
    }

    /// Whether the matrix of a group is solved with by iterations.
    pub(crate) fn iterates(&self, group: usize) -> bool {
        matches!(self.groups[group].operator, Some(Operator::Iterated(_)))
    }

    /// Leaves the loads of matrices that are solved with by iterations to the problem of contacts: zero in `y`, and the loads in `left`, both in the places
    /// of [`Operators::begin`]. The others begin as there.
    pub(crate) fn leave(&mut self, r: &[f64], y: &mut [f64], left: &mut Vec<f64>) {
        left.clear();
        left.resize(y.len(), 0.0);
        for group in &mut self.groups {
            if !matches!(group.operator, Some(Operator::Iterated(_))) {
                group.begin(r, y);
                continue;
            }
            y[group.place.clone()].fill(0.0);
            let parts = group.parts.iter().flat_map(|part| &r[part.clone()]);
            for (left, r) in left[group.place.clone()].iter_mut().zip(parts) {
                *left = *r;
            }
        }
    }

    /// The matrices that are solved with by iterations, and the places of their first unknowns in the y of `begin`; the largest tolerance.
    /// They come back by [`Operators::take_back`].
    pub(crate) fn lend(&mut self) -> (Vec<(usize, Box<Iterative>)>, f64) {
        let mut tolerance: f64 = 0.0;
        let mut lent = Vec::new();
        for group in &mut self.groups {
            if let Some(Operator::Iterated(iterated)) = &mut group.operator {
                tolerance = tolerance.max(iterated.tolerance);
                lent.extend(
                    iterated
                        .solver
                        .take()
                        .map(|solver| (group.place.start, solver)),
                );
            }
        }
        (lent, tolerance)
    }

    /// Takes the lent matrices back.
    pub(crate) fn take_back(&mut self, lent: Vec<(usize, Box<Iterative>)>) {
        let mut lent = lent.into_iter();
        for group in &mut self.groups {
            if let Some(Operator::Iterated(iterated)) = &mut group.operator {
                iterated.solver = lent.next().map(|(_, solver)| solver);
            }
        }
    }

    /// Why a solve since the last `begin` did not end, and the unknown with the largest residual.
    pub(crate) fn failure(&mut self) -> Option<(usize, AlgebraError)> {
        let failed = self.groups.iter_mut().find_map(|group| {
            let failed = match &mut group.operator {
                Some(Operator::Iterated(iterated)) => iterated.failed.take(),
                Some(Operator::Distributed(factor)) => factor.failure(),
                _ => None,
            };
            Some((group.place.start, failed?))
        });
        let (place, cause) = failed?;
        let worst = match &cause {
            AlgebraError::Iterations { unknown, .. } => *unknown,
            _ => 0,
        };
        Some((self.unknown_at(place + worst), cause))
    }

    /// The unknown with this place in the y of `begin`.
    pub(crate) fn unknown_at(&self, place: usize) -> usize {
        let mut left = place;
        for part in self.groups.iter().flat_map(|group| &group.parts) {
            if left < part.len() {
                return part.start + left;
            }
            left -= part.len();
        }
        unreachable!("every place is that of an unknown")
    }
}
