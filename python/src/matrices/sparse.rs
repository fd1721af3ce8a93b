//! Matrices in the format CSR, and their sums.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use pyo3::prelude::*;

use crate::errors::wrong;

/// Pointers, columns and values of a matrix by rows.
pub(super) type GivenMatrix = (Vec<usize>, Vec<u32>, Vec<f64>);

/// The matrix; `n`: its size.
pub(super) fn read(n: usize, (pointers, columns, values): &GivenMatrix) -> PyResult<Csr> {
    let sound = pointers.len() == n + 1
        && pointers.windows(2).all(|pair| pair[0] <= pair[1])
        && pointers.last() == Some(&columns.len())
        && columns.len() == values.len()
        && columns.iter().all(|column| (*column as usize) < n);
    if !sound {
        return Err(wrong(format!(
            "not a square matrix of {n} rows in the format CSR"
        )));
    }
    let mut pairs = Cliques::new();
    let entries = |i: usize| (pointers[i]..pointers[i + 1]).map(|k| (columns[k], values[k]));
    for i in 0..n {
        for (j, _) in entries(i) {
            pairs.push(&[i as u32, j]);
        }
    }
    let mut matrix = Csr::from_cliques(n, &pairs);
    for i in 0..n {
        for (j, value) in entries(i) {
            matrix.add(i, j as usize, value);
        }
    }
    Ok(matrix)
}

/// Σ factor matrix.
pub(super) fn sum(n: usize, parts: &[(f64, &Csr)]) -> Csr {
    let mut pairs = Cliques::new();
    let used = || parts.iter().filter(|(factor, _)| *factor != 0.0);
    for (_, part) in used() {
        for i in 0..n {
            for &j in part.row(i).0 {
                pairs.push(&[i as u32, j]);
            }
        }
    }
    let mut sum = Csr::from_cliques(n, &pairs);
    for (factor, part) in used() {
        for i in 0..n {
            let (columns, values) = part.row(i);
            for (&j, value) in columns.iter().zip(values) {
                sum.add(i, j as usize, factor * value);
            }
        }
    }
    sum
}
