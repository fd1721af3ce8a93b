//! Anderson's mixing of the last iterations of a step.
//!
//! An iteration leads from x to g(x) = x + f(x), f its motion. Where its matrix is not the derivative of the residual (a
//! factor that is kept, the symmetric part of the forces between two states, friction, the weights of mortar) iterations
//! shrink errors by a factor each, the same directions again and again. With the last m iterations the next x is
//!
//! `x₊ = Σ α_i g(x_i),   Σ α_i = 1,   |Σ α_i f(x_i)| least,`
//!
//! for a map that is linear the m-th step of GMRES, whether iterations shrink or grow. Contact forces are mixed with the same
//! α: where no point has opened or closed the relations of the normal hold for the mixture as they do for its parts. Points
//! may stick in one iteration and slip in the next: where iterations go to and fro about the answer, the way between two of
//! them changes sign in just the points that slide the least. What a step ends with is tested without any of this, Coulomb's
//! law with it.
//!
//! D. G. Anderson (1965), J. ACM 12; H. F. Walker, P. Ni (2011), SIAM J. Numer. Anal. 49.

use carom_algebra::dense::DenseCholesky;
use carom_algebra::reduce::{dot, norm_squared};
use carom_contact::law::Status;

use crate::state::InterfaceState;

/// Iterations that are mixed.
const DEPTH: usize = 4;

/// Length of a motion over that of the one before from which on iterations are mixed.
const SLOW: f64 = 0.1;

/// Least pivot, over the entry of the diagonal, of the products of the changes of the motions: motions closer to each other
/// than its root are one.
const INDEPENDENT: f64 = 1e-8;

/// Largest Σ |α_i|.
pub(super) const LARGEST: f64 = 100.0;

/// The same where parts float: motions that contacts hardly hold, whose lengths are limited otherwise.
pub(super) const LARGEST_OF_FLOATING: f64 = 1e4;

/// One iteration.
#[derive(Clone, Default)]
struct Iterate {
    /// f.
    motion: Vec<f64>,
    /// x + f.
    end: Vec<f64>,
    force: Vec<f64>,
    friction: Vec<[f64; 2]>,
}

/// The iterations of an attempt that are remembered, the last first.
#[derive(Default)]
pub(super) struct Mixing {
    kept: Vec<Iterate>,
    count: usize,
    status: Vec<Status>,
}

impl Mixing {
    /// Forgets all iterations.
    pub(super) fn clear(&mut self) {
        self.count = 0;
    }

    /// Forgets all iterations but the last, after one that made the residual grow: those before it belong to another map.
    /// Where each iteration makes it grow, the last and the next one are what ends that.
    pub(super) fn keep_last(&mut self) {
        self.count = self.count.min(1);
    }

    /// Room for one more iteration, now the last; the oldest is forgotten.
    fn next(&mut self) -> &mut Iterate {
        self.kept.resize(DEPTH, Iterate::default());
        self.kept.rotate_right(1);
        self.count = DEPTH.min(self.count + 1);
        &mut self.kept[0]
    }

    /// The α of the iterations, those of the last first; none where it goes fast enough without, or motions depend on each
    /// other.
    fn weights(&self, largest: f64) -> Option<Vec<f64>> {
        let [last, before, ..] = &self.kept[..self.count] else {
            return None;
        };
        if norm_squared(&last.motion) <= SLOW * SLOW * norm_squared(&before.motion) {
            return None;
        }
        let products: Vec<f64> = (0..self.count * self.count)
            .map(|k| (k / self.count, k % self.count))
            .map(|(i, j)| dot(&self.kept[i].motion, &self.kept[j].motion))
            .collect();
        (1..self.count).rev().find_map(|m| {
            let product = |i: usize, j: usize| products[i * self.count + j];
            // of the changes f_i - f_0 to the last motion
            let change = |i, j| product(i, j) - product(i, 0) - product(0, j) + product(0, 0);
            let size = |i: usize| change(i, i).sqrt();
            let sizes: Vec<f64> = (1..=m).map(size).collect();
            if sizes.iter().any(|size| size.is_nan() || *size == 0.0) {
                return None;
            }
            let entry = |k: usize| {
                let (i, j) = (k / m, k % m);
                change(i + 1, j + 1) / (sizes[i] * sizes[j])
            };
            let matrix: Vec<f64> = (0..m * m).map(entry).collect();
            let factor = DenseCholesky::new(m, &matrix).ok()?;
            if factor.least_pivot() < INDEPENDENT {
                return None;
            }
            let mut weights: Vec<f64> = (0..m)
                .map(|i| (product(0, 0) - product(i + 1, 0)) / sizes[i])
                .collect();
            factor.solve(&mut weights);
            for (weight, size) in weights.iter_mut().zip(&sizes) {
                *weight /= size;
            }
            weights.insert(0, 1.0 - weights.iter().sum::<f64>());
            let sum: f64 = weights.iter().map(|weight| weight.abs()).sum();
            (sum <= largest).then_some(weights)
        })
    }

    /// Mixes an iteration, its motion `dx` from x and its contact forces, with those before it; whether it did. `largest`: of Σ |α_i|.
    pub(super) fn mix(
        &mut self,
        (x, dx): (&[f64], &mut [f64]),
        interface: &mut InterfaceState,
        largest: f64,
    ) -> bool {
        if self.status != interface.status {
            self.status.clone_from(&interface.status);
            self.clear();
        }
        let last = self.next();
        last.motion.clear();
        last.motion.extend_from_slice(dx);
        last.end.clone_from(&last.motion);
        for (end, x) in last.end.iter_mut().zip(x) {
            *end += x;
        }
        last.force.clone_from(&interface.force);
        last.friction.clone_from(&interface.friction);
        let Some(weights) = self.weights(largest) else {
            return false;
        };
        let of = |entry: &dyn Fn(&Iterate) -> f64| {
            let all = weights.iter().zip(&self.kept);
            all.map(|(weight, iterate)| weight * entry(iterate))
                .sum::<f64>()
        };
        for (i, dx) in dx.iter_mut().enumerate() {
            *dx = of(&|iterate| iterate.end[i]) - x[i];
        }
        for (point, force) in interface.force.iter_mut().enumerate() {
            *force = of(&|iterate| iterate.force[point]);
        }
        for (point, friction) in interface.friction.iter_mut().enumerate() {
            for (k, t) in friction.iter_mut().enumerate() {
                *t = of(&|iterate| iterate.friction[point][k]);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error of iterations x + f of a linear map whose errors shrink by these factors, at each x.
    fn errors(factors: [f64; 3], count: usize) -> Vec<f64> {
        let mut mixing = Mixing::default();
        let (exact, mut x) = ([1.0, -2.0, 0.5], vec![0.0; 3]);
        let step = |_| {
            let last = mixing.next();
            last.motion = (0..3)
                .map(|i| (1.0 - factors[i]) * (exact[i] - x[i]))
                .collect();
            last.end = x.iter().zip(&last.motion).map(|(x, f)| x + f).collect();
            let weights = mixing.weights(LARGEST).unwrap_or(vec![1.0]);
            let all = || weights.iter().zip(&mixing.kept);
            assert!((all().map(|(weight, _)| weight).sum::<f64>() - 1.0).abs() < 1e-12);
            x = (0..3)
                .map(|i| all().map(|(w, one)| w * one.end[i]).sum())
                .collect();
            let error = (0..3).map(|i| (x[i] - exact[i]).powi(2)).sum::<f64>();
            error.sqrt()
        };
        (0..count).map(step).collect()
    }

    #[test]
    fn a_linear_map_of_three_directions_ends_in_four_iterations() {
        let errors = errors([0.3, -0.6, 0.9], 4);
        // without mixing 0.9⁴ were left of the slow direction; products of motions have the square of their condition
        assert!(errors[2] > 1e-3 && errors[3] < 1e-10, "{errors:?}");
    }

    #[test]
    fn fast_iterations_are_left_alone() {
        let factors = [0.01, 0.05, 0.02];
        let exact: [f64; 3] = [1.0, -2.0, 0.5];
        for (k, error) in errors(factors, 4).into_iter().enumerate() {
            let left = (0..3).map(|i| (exact[i] * factors[i].powi(k as i32 + 1)).powi(2));
            let left = left.sum::<f64>().sqrt();
            assert!((error - left).abs() < 1e-14, "{k}: {error:e} {left:e}");
        }
    }
}
