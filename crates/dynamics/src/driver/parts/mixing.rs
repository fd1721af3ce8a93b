//! Contact forces before an iteration: one that goes a part of its way takes that part of the change of the forces.

use carom_algebra::dense::DenseCholesky;
use carom_algebra::reduce::{dot, norm_squared};
use carom_contact::law::Status;

use crate::coulomb::Slip;
use crate::state::InterfaceState;

/// Contact forces of all points.
#[derive(Default)]
pub(crate) struct Carried {
    force: Vec<f64>,
    friction: Vec<[f64; 2]>,
}

impl Carried {
    /// Keeps the forces before an iteration.
    pub(crate) fn keep(&mut self, interface: &InterfaceState) {
        self.force.clone_from(&interface.force);
        self.friction.clone_from(&interface.friction);
    }

    /// Halves the change of the forces since they were kept.
    pub(crate) fn halve(&self, interface: &mut InterfaceState) {
        for (force, before) in interface.force.iter_mut().zip(&self.force) {
            *force = 0.5 * (*force + before);
        }
        for (point, friction) in interface.friction.iter_mut().enumerate() {
            let before = self.friction.get(point).copied();
            for (t, before) in friction.iter_mut().zip(before.unwrap_or_default()) {
                *t = 0.5 * (*t + before);
            }
        }
    }
}

/// Iterations that are mixed.
const DEPTH: usize = 4;

/// Length of a motion over that of the one before from which on iterations are mixed.
const SLOW: f64 = 0.1;

/// Least pivot, over the entry of the diagonal, of the products of the changes of the motions: motions closer to each other
/// than its root are one.
const INDEPENDENT: f64 = 1e-8;

/// Largest Σ |α_i|.
pub(crate) const LARGEST: f64 = 100.0;

/// The same where parts float: motions that contacts hardly hold, whose lengths are limited otherwise.
pub(crate) const LARGEST_OF_FLOATING: f64 = 1e4;

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
pub(crate) struct Mixing {
    kept: Vec<Iterate>,
    count: usize,
    status: Vec<Status>,
}

impl Mixing {
    /// Forgets all iterations.
    pub(crate) fn clear(&mut self) {
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
    pub(crate) fn mix(
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

/// What the passes need.
#[derive(Default)]
pub(crate) struct Refined {
    pub(crate) mixing: Mixing,
    /// x and residual where the iteration begins.
    pub(crate) x: Vec<f64>,
    pub(crate) residual: Vec<f64>,
    /// d, and K̂ d.
    pub(crate) motion: Vec<f64>,
    pub(crate) product: Vec<f64>,
    /// What it was before the last pass, and the contacts.
    pub(crate) before: Vec<f64>,
    pub(crate) interface: InterfaceState,
    pub(crate) slips: Vec<Slip>,
    /// Whether the columns of the contact points are those of the iteration, wherever points are.
    pub(crate) holds_columns: bool,
}
