//! Contact rows: the normal of each point, and its tangents after it.

use carom_algebra::solver::Cholesky;
use pyo3::prelude::*;

use crate::errors::wrong;

/// Rows with their unknowns and coefficients, all of a point one after another.
pub(super) struct Rows {
    rows: Vec<Vec<(usize, f64)>>,
    /// Tangents of a point.
    tangents: usize,
    unknowns: usize,
}

impl Rows {
    /// `rows` of as many `points`, over this many `unknowns`.
    pub(super) fn new(
        rows: Vec<Vec<(usize, f64)>>,
        points: usize,
        unknowns: usize,
    ) -> PyResult<Rows> {
        let width = rows.len().checked_div(points).unwrap_or(1);
        let sound = width * points == rows.len() && (1..=3).contains(&width);
        if !sound || rows.iter().flatten().any(|(i, _)| *i >= unknowns) {
            return Err(wrong(format!(
                "{} contact rows of {points} points; accepted: for each its normal and up to two tangents",
                rows.len()
            )));
        }
        Ok(Rows {
            rows,
            tangents: width - 1,
            unknowns,
        })
    }

    pub(super) fn unknowns(&self) -> usize {
        self.unknowns
    }

    pub(super) fn tangents(&self) -> usize {
        self.tangents
    }

    /// Number of the normal row of a point.
    pub(super) fn normal(&self, point: usize) -> usize {
        point * (1 + self.tangents)
    }

    /// Product of a row with a vector.
    pub(super) fn along(&self, row: usize, vector: &[f64]) -> f64 {
        self.rows[row].iter().map(|&(i, c)| c * vector[i]).sum()
    }

    /// Product of the normal row of a point with a vector.
    pub(super) fn along_normal(&self, point: usize, vector: &[f64]) -> f64 {
        self.along(self.normal(point), vector)
    }

    /// A⁻¹ Nᵀ of a factored A, one column for each row.
    pub(super) fn columns(&self, factor: &mut Cholesky) -> Vec<Vec<f64>> {
        let column = |row: &Vec<(usize, f64)>| {
            let mut column = vec![0.0; self.unknowns];
            row.iter().for_each(|&(i, c)| column[i] += c);
            factor.solve(&mut column);
            column
        };
        self.rows.iter().map(column).collect()
    }

    /// N times these columns, row-major.
    pub(super) fn compliance(&self, columns: &[Vec<f64>]) -> Vec<f64> {
        let rows = 0..self.rows.len();
        rows.flat_map(|row| columns.iter().map(move |column| self.along(row, column)))
            .collect()
    }
}
