//! The problem that is to be solved, as the solver and the measure of its error see it.

use carom_contact::law::{End, Relation, Status};

use super::Tangential;
use crate::interface::Candidate;

/// A problem with friction over n candidates. Row `i w` of D belongs to the normal of candidate i, the `tangents` rows
/// after it to its tangents, w = 1 + `tangents`.
#[derive(Clone, Copy)]
pub(crate) struct Posed<'a> {
    /// The candidates.
    pub(crate) candidates: &'a [Candidate],
    /// What friction adds to each.
    pub(crate) friction: &'a [Tangential],
    /// Tangents of a candidate: 1 in the plane, 2 in space.
    pub(crate) tangents: usize,
    /// D over all rows, row-major, symmetric.
    pub(crate) d: &'a [f64],
    /// [s_g, s_v, s_t], the factors of D p in the gap, in the rate, and in the sliding quantity.
    pub(crate) s: [f64; 3],
}

impl<'a> Posed<'a> {
    /// Candidates.
    pub(super) fn len(&self) -> usize {
        self.candidates.len()
    }

    /// Rows of D.
    pub(super) fn rows(&self) -> usize {
        self.len() * (1 + self.tangents)
    }

    /// The row of the normal of candidate `i`.
    pub(super) fn normal(&self, i: usize) -> usize {
        i * (1 + self.tangents)
    }

    /// One row of D.
    pub(super) fn d(&self, row: usize) -> &'a [f64] {
        let n = self.rows();
        &self.d[row * n..(row + 1) * n]
    }

    /// The relation of a candidate; of an open one, that of its closure.
    pub(super) fn relation(&self, i: usize, status: Status) -> Relation {
        let candidate = &self.candidates[i];
        let status = match status {
            Status::Open => Status::Closed,
            other => other,
        };
        candidate.law.get().relation(status, &candidate.local)
    }

    /// Factor of D p in a relation.
    pub(super) fn factor(&self, relation: &Relation) -> f64 {
        relation.gap * self.s[0] + relation.rate * self.s[1]
    }

    /// What a relation says before the forces of the step.
    pub(super) fn free(&self, i: usize, relation: &Relation) -> f64 {
        let candidate = &self.candidates[i];
        relation.gap * candidate.local.gap_free
            + relation.rate * candidate.rate_free
            + relation.offset
    }

    /// Derivative of a relation with respect to the force of its own candidate: it turns what the relation says into
    /// newtons.
    pub(super) fn slope(&self, i: usize, relation: &Relation) -> f64 {
        let row = self.normal(i);
        let slope = self.factor(relation) * self.d(row)[row] + relation.compliance;
        if slope > 0.0 { slope } else { 1.0 }
    }

    /// Force per sliding, N over the unit of q, that makes both comparable in candidate `i`.
    pub(super) fn weight(&self, i: usize) -> f64 {
        let row = self.normal(i);
        let own: f64 = (row + 1..=row + self.tangents)
            .map(|row| self.d(row)[row])
            .sum();
        let slope = self.s[2] * own / self.tangents as f64;
        if slope > 0.0 { 1.0 / slope } else { 1.0 }
    }

    /// End of the step in candidate `i` with the force `force`, with (D p)_n in all, and without its own forces.
    pub(super) fn end(&self, i: usize, force: f64, product: f64, others: f64) -> End {
        let candidate = &self.candidates[i];
        End {
            gap_released: candidate.local.gap_free + self.s[0] * others,
            gap: candidate.local.gap_free + self.s[0] * product,
            rate: candidate.rate_free + self.s[1] * product,
            force,
        }
    }

    /// (D p)_row of the forces of candidate `i` alone.
    pub(super) fn own(&self, i: usize, row: usize, p: &[f64]) -> f64 {
        let first = self.normal(i);
        (first..=first + self.tangents)
            .map(|column| self.d(row)[column] * p[column])
            .sum()
    }
}
