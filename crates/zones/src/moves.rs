//! Broyden's method for the multipliers: the operator H without contact, corrected by what the passes of the step have
//! shown, so that contact which the rows feel costs fewer of them.
//!
//! With s_k the moves, B₀ = H and `z = -B₀⁻¹ r`, the good update of Broyden makes
//! `z ← z + s_{j+1} (s_j · z) / |s_j|²` for the earlier j and `s_{k+1} = z / (1 - s_k · z / |s_k|²)`.
//!
//! Source: Broyden (1965); the recursion with moves alone: Kelley, Iterative Methods for Linear and Nonlinear Equations (1995),
//! section 7.3, whose text was not at hand; derived again from the formula of Sherman and Morrison.

use carom_algebra::reduce::dot;

/// Moves of the passes over one step.
#[derive(Default)]
pub(crate) struct Moves {
    moves: Vec<Vec<f64>>,
    /// |s|² of each.
    squares: Vec<f64>,
    used: usize,
}

impl Moves {
    /// Forgets those of another step.
    pub(crate) fn clear(&mut self) {
        self.used = 0;
    }

    /// Whether this step has made none so far.
    pub(crate) fn is_empty(&self) -> bool {
        self.used == 0
    }

    /// Makes the next move of H⁻¹ r.
    pub(crate) fn next(&mut self, z: &mut [f64]) {
        z.iter_mut().for_each(|z| *z = -*z);
        let used = self.used;
        for j in 0..used {
            let along = dot(&self.moves[j], z) / self.squares[j];
            if j + 1 < used {
                for (z, s) in z.iter_mut().zip(&self.moves[j + 1]) {
                    *z += along * s;
                }
            } else if (1.0 - along).abs() > 0.1 {
                z.iter_mut().for_each(|z| *z /= 1.0 - along);
            }
        }
        if used == self.moves.len() {
            self.moves.push(vec![0.0; z.len()]);
            self.squares.push(0.0);
        }
        self.moves[used].copy_from_slice(z);
        self.squares[used] = dot(z, z).max(f64::MIN_POSITIVE);
        self.used += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::Moves;

    #[test]
    fn a_linear_problem_of_two_unknowns_ends_after_four_moves() {
        // r = A x - b with B₀ = 1: Broyden's method ends in 2 n steps on linear problems (Gay 1979)
        let a = [[1.3, 0.4], [-0.2, 0.8]];
        let residual =
            |x: &[f64; 2]| [0, 1].map(|i| a[i][0] * x[0] + a[i][1] * x[1] - [1.0, -2.0][i]);
        let (mut x, mut moves) = ([0.0; 2], Moves::default());
        for _ in 0..5 {
            let mut z = residual(&x);
            moves.next(&mut z);
            x = [0, 1].map(|i| x[i] + z[i]);
        }
        assert!(residual(&x).iter().all(|r| r.abs() < 1e-10));
    }
}
