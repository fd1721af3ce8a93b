//! Lanczos' method in blocks: the largest pairs of an operator in the space of a block and its images.
//!
//! Each block is orthogonalised against all before it, so that vectors stay orthonormal to rounding, and a block of b vectors has
//! multiple eigenvalues up to b times. Source: Golub and Underwood, in Mathematical Software III (1977).

use super::operator::Operator;
use crate::Error;
use crate::dense_eigen::symmetric;
use crate::reduce::{dot, norm_squared};

/// Vectors of a block.
const BLOCK: usize = 6;

/// Residual of a pair at which it has converged, over its own eigenvalue, and over the largest of the operator, which is rounding, also
/// where its vector has been taken out.
const CONVERGED: [f64; 2] = [1e-12, 1e-14];

/// What is left of a vector after orthogonalisation, over its norm, below which it is rounding.
const DEPENDENT: f64 = 1e-12;

/// Blocks between two looks at what has converged.
const LOOK: usize = 4;

/// Vectors of the largest eigenvalues, orthonormal: at most `count`, fewer where some do not converge in a space of this dimension.
pub(super) fn largest(
    operator: &mut Operator,
    count: usize,
    dimension: usize,
) -> Result<Vec<Vec<f64>>, Error> {
    let mut space = Space::default();
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15);
    let start = (0..BLOCK.max(count.min(2 * BLOCK))).map(|_| {
        let y = noise.vector(operator.len());
        operator.image(&y)
    });
    let mut block: Vec<Vec<f64>> = start.collect();
    let mut blocks = 0;
    loop {
        let next = space.extend(std::mem::take(&mut block));
        let full = space.basis.len() >= dimension;
        if blocks % LOOK == LOOK - 1 || next == 0 || full {
            let found = space.converged(count, operator)?;
            if found.len() == count || next == 0 || full {
                return Ok(found);
            }
        }
        block = space.images(operator);
        blocks += 1;
    }
}

/// An orthonormal basis V and the operator in it.
#[derive(Default)]
struct Space {
    basis: Vec<Vec<f64>>,
    /// Rows of Vᵀ C V for the vectors whose images are known, each up to its own column.
    projected: Vec<Vec<f64>>,
    /// What the last images have outside of the vectors before the last block: coefficients of the last block, one row for each
    /// image.
    outside: Vec<Vec<f64>>,
}

impl Space {
    /// Orthogonalises the vectors and adds what is independent; the number of them.
    fn extend(&mut self, block: Vec<Vec<f64>>) -> usize {
        let before = self.basis.len();
        self.outside.clear();
        for mut y in block {
            let size = norm_squared(&y).sqrt();
            let mut row = vec![0.0; self.basis.len() - before];
            for _ in 0..2 {
                for (k, v) in self.basis.iter().enumerate() {
                    let share = dot(v, &y);
                    if k >= before {
                        row[k - before] += share;
                    }
                    for (y, v) in y.iter_mut().zip(v) {
                        *y -= share * v;
                    }
                }
            }
            let norm = norm_squared(&y).sqrt();
            if norm > DEPENDENT * size {
                y.iter_mut().for_each(|y| *y /= norm);
                self.basis.push(y);
                row.push(norm);
            }
            self.outside.push(row);
        }
        self.basis.len() - before
    }

    /// Images of the vectors that have none, and their rows of the projected operator.
    fn images(&mut self, operator: &mut Operator) -> Vec<Vec<f64>> {
        let mut images = Vec::new();
        for k in self.projected.len()..self.basis.len() {
            let image = operator.image(&self.basis[k]);
            let row = self.basis[..=k].iter().map(|v| dot(v, &image));
            self.projected.push(row.collect());
            images.push(image);
        }
        images
    }

    /// The vectors of the largest eigenvalues, as many as have converged before one that has not.
    fn converged(&self, count: usize, operator: &mut Operator) -> Result<Vec<Vec<f64>>, Error> {
        let m = self.projected.len();
        let mut matrix = vec![0.0; m * m];
        for (i, row) in self.projected.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                (matrix[i * m + j], matrix[j * m + i]) = (*entry, *entry);
            }
        }
        let (values, combinations) = symmetric(m, &matrix)?;
        let residual = |z: &[f64]| {
            // the images of the last block are what leaves the space
            let last = &z[m - self.outside.len().min(m)..];
            let width = self.outside.iter().map(Vec::len).max().unwrap_or(0);
            let part = |k: usize| {
                let terms = self.outside.iter().zip(last);
                terms
                    .map(|(row, z)| row.get(k).unwrap_or(&0.0) * z)
                    .sum::<f64>()
            };
            (0..width).map(|k| part(k).powi(2)).sum::<f64>().sqrt()
        };
        let top = operator.largest(values.last().copied().unwrap_or(0.0));
        let pairs = values.iter().zip(combinations.chunks_exact(m.max(1))).rev();
        let good = |(value, z): &(&f64, &[f64])| {
            **value > 0.0 && residual(z) <= CONVERGED[0] * **value + CONVERGED[1] * top
        };
        let vector = |(_, z): (&f64, &[f64])| {
            let mut y = vec![0.0; self.basis[0].len()];
            for (v, z) in self.basis.iter().zip(z) {
                for (y, v) in y.iter_mut().zip(v) {
                    *y += z * v;
                }
            }
            y
        };
        Ok(pairs.take(count).take_while(good).map(vector).collect())
    }
}

/// Numbers between -1 and 1 that are the same in each run (a linear congruence, Knuth).
struct Noise(u64);

impl Noise {
    fn vector(&mut self, n: usize) -> Vec<f64> {
        let next = || {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        std::iter::repeat_with(next).take(n).collect()
    }
}
