//! Dense systems, as textbooks have them, and random numbers: what small problems are judged by.

/// Rows of a matrix.
pub type Matrix = Vec<Vec<f64>>;

/// Numbers in [0, 1) from a fixed seed.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn list(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

/// A x = b.
pub struct Dense {
    pub matrix: Matrix,
    pub right: Vec<f64>,
}

impl Dense {
    pub fn new(n: usize) -> Dense {
        Dense {
            matrix: vec![vec![0.0; n]; n],
            right: vec![0.0; n],
        }
    }

    /// Gauss with pivots by column.
    pub fn solve(mut self) -> Vec<f64> {
        let n = self.right.len();
        for k in 0..n {
            let size = |i: &usize| self.matrix[*i][k].abs();
            let pivot = (k..n).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap();
            self.matrix.swap(k, pivot);
            self.right.swap(k, pivot);
            let row = self.matrix[k].clone();
            for i in k + 1..n {
                let factor = self.matrix[i][k] / row[k];
                for j in k..n {
                    self.matrix[i][j] -= factor * row[j];
                }
                self.right[i] -= factor * self.right[k];
            }
        }
        for k in (0..n).rev() {
            let sum: f64 = (k + 1..n).map(|j| self.matrix[k][j] * self.right[j]).sum();
            self.right[k] = (self.right[k] - sum) / self.matrix[k][k];
        }
        self.right
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Largest difference over the largest entry; zero of nothing.
pub fn error(found: &[f64], exact: &[f64]) -> f64 {
    assert_eq!(found.len(), exact.len());
    assert!(found.iter().all(|x| x.is_finite()));
    let largest = |x: &mut dyn Iterator<Item = f64>| x.fold(0.0, |m: f64, x| m.max(x.abs()));
    match largest(&mut found.iter().zip(exact).map(|(a, b)| a - b)) {
        0.0 => 0.0,
        difference => difference / largest(&mut exact.iter().copied()),
    }
}
