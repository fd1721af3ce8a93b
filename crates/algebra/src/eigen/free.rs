//! A problem without its held unknowns.

use std::ops::Range;

use super::problem::Problem;
use crate::csr::Csr;
use crate::solver::SparseRow;

/// The problem over the unknowns that are not held.
pub(super) struct Free {
    pub(super) stiffness: Csr,
    pub(super) mass: Csr,
    pub(super) groups: Vec<u32>,
    pub(super) constraints: Vec<SparseRow>,
    ranges: Vec<Range<usize>>,
    /// Number of all unknowns.
    all: usize,
}

impl Free {
    /// Leaves out what is held, and unknowns without stiffness and mass.
    pub(super) fn new(problem: &Problem) -> Free {
        let Problem {
            stiffness, mass, ..
        } = *problem;
        let all = stiffness.n;
        let empty = |i: usize| {
            let values = stiffness.row(i).1.iter().chain(mass.row(i).1);
            values.copied().all(|value| value == 0.0)
        };
        let mut ranges: Vec<Range<usize>> = Vec::new();
        let mut place = vec![u32::MAX; all];
        let free = (0..all).filter(|&i| !problem.fixed[i] && !empty(i));
        for (n, i) in free.enumerate() {
            place[i] = n as u32;
            match ranges.last_mut() {
                Some(last) if last.end == i => last.end += 1,
                _ => ranges.push(i..i + 1),
            }
        }
        let within = |row: &SparseRow| {
            let terms = row.dofs.iter().zip(&row.coefficients);
            let kept = terms.filter(|(dof, c)| place[**dof as usize] != u32::MAX && **c != 0.0);
            let (dofs, coefficients) = kept.map(|(dof, c)| (place[*dof as usize], *c)).unzip();
            SparseRow { dofs, coefficients }
        };
        let rows = problem.constraints.iter().map(within);
        Free {
            stiffness: stiffness.restricted(&ranges),
            mass: mass.restricted(&ranges),
            groups: ranges
                .iter()
                .cloned()
                .flatten()
                .map(|i| problem.groups[i])
                .collect(),
            constraints: rows.filter(|row| !row.dofs.is_empty()).collect(),
            ranges,
            all,
        }
    }

    /// Number of unknowns.
    pub(super) fn len(&self) -> usize {
        self.stiffness.n
    }

    /// K + factor · M.
    pub(super) fn combined(&self, factor: f64) -> Csr {
        let mut a = self.stiffness.clone();
        for i in 0..self.len() {
            let (columns, values) = self.mass.row(i);
            for (&j, m) in columns.iter().zip(values).filter(|(_, m)| **m != 0.0) {
                a.add(i, j as usize, factor * m);
            }
        }
        a
    }

    /// Largest quotient of the diagonals of K and M.
    pub(super) fn scale(&self) -> f64 {
        let quotient = |i: usize| self.stiffness.get(i, i) / self.mass.get(i, i);
        let heavy = (0..self.len()).filter(|&i| self.mass.get(i, i) > 0.0);
        heavy.map(quotient).fold(0.0, f64::max)
    }

    /// A vector over all unknowns.
    pub(super) fn expand(&self, x: &[f64]) -> Vec<f64> {
        let mut whole = vec![0.0; self.all];
        for (i, x) in self.ranges.iter().cloned().flatten().zip(x) {
            whole[i] = *x;
        }
        whole
    }
}
