//! The inverse of A + B Bᵀ from the factor A = L Lᵀ, with few columns in B (Woodbury 1950).
//!
//! With V = L⁻¹ B, I + Vᵀ V = T Tᵀ and H = V T⁻ᵀ, it is L⁻ᵀ (I - H Hᵀ) L⁻¹. A solve costs 4 products of a column with a vector for each
//! column more than that with A, and N (A + B Bᵀ)⁻¹ Nᵀ of two rows their products Hᵀ L⁻¹ Nᵀ more.

use carom_algebra::Error as AlgebraError;
use carom_algebra::dense::DenseCholesky;
use carom_algebra::reduce::dot;
use carom_algebra::solver::{Cholesky, Response};

/// A factor and the columns of H.
pub(crate) struct LowRank {
    pub(crate) factor: Box<Cholesky>,
    columns: Vec<Vec<f64>>,
    products: Vec<f64>,
}

impl LowRank {
    /// `columns`: of B.
    ///
    /// # Errors
    /// Columns that are not finite.
    pub(crate) fn new(
        mut factor: Box<Cholesky>,
        columns: &[Vec<f64>],
    ) -> Result<LowRank, AlgebraError> {
        let count = columns.len();
        let forward = |column: &Vec<f64>| {
            let mut y = vec![0.0; column.len()];
            factor.forward(column, &mut y);
            y
        };
        let mut own: Vec<Vec<f64>> = columns.iter().map(forward).collect();
        let mut inner = vec![0.0; count * count];
        for i in 0..count {
            for j in 0..=i {
                let entry = dot(&own[i], &own[j]) + if i == j { 1.0 } else { 0.0 };
                (inner[i * count + j], inner[j * count + i]) = (entry, entry);
            }
        }
        let inner = DenseCholesky::new(count, &inner)?;
        let mut row = vec![0.0; count];
        for i in 0..own.first().map_or(0, Vec::len) {
            for (entry, column) in row.iter_mut().zip(&own) {
                *entry = column[i];
            }
            inner.forward(&mut row);
            for (entry, column) in row.iter().zip(&mut own) {
                column[i] = *entry;
            }
        }
        Ok(LowRank {
            factor,
            columns: own,
            products: vec![0.0; count],
        })
    }

    /// (I - H Hᵀ) L⁻¹ r.
    pub(crate) fn begin(&mut self, r: &[f64], y: &mut [f64]) {
        self.factor.forward(r, y);
        for (product, column) in self.products.iter_mut().zip(&self.columns) {
            *product = dot(column, y);
        }
        for (product, column) in self.products.iter().zip(&self.columns) {
            add(-product, column, y);
        }
    }

    /// Hᵀ of a column L⁻¹ Nᵀ.
    pub(crate) fn products(&self, response: &Response) -> Vec<f64> {
        let columns = self.columns.iter();
        columns.map(|column| response.dot_dense(column)).collect()
    }

    /// y += force (I - H Hᵀ) L⁻¹ Nᵀ.
    pub(crate) fn add(&self, (response, products): (&Response, &[f64]), force: f64, y: &mut [f64]) {
        response.add_scaled(force, y);
        for (product, column) in products.iter().zip(&self.columns) {
            add(-force * product, column, y);
        }
    }
}

/// y += factor x
fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
