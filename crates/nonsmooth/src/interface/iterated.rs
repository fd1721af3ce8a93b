//! The equations of the closed points where D is the product of sparse rows: conjugate gradients.
//!
//! `D = N M⁻¹ Nᵀ` of a lumped mass is as well conditioned as the masses of the nodes that touch are alike, whatever the number of
//! points, so that the iterations do not grow with it. They end where the residual is rounding.

use carom_algebra::Error;
use carom_laws::Status;

use crate::Lumped;

/// Residual over the right-hand side, in the norm of the preconditioner, at which iterations end.
const ROUNDING: f64 = 1e-14;

/// Residual that is still a solution where rounding lets it fall no further.
const NEAR: f64 = 1e-11;

/// Iterations without a smaller residual before the end.
const PATIENCE: usize = 100;

/// Solver with its memory.
#[derive(Default)]
pub(super) struct Iterated {
    /// Bᵀ p.
    motion: Vec<f64>,
    solution: Vec<f64>,
    best: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
}

impl Iterated {
    /// D P over all points.
    pub(super) fn multiply(&mut self, d: &Lumped, forces: &[f64], product: &mut [f64]) {
        d.gather(forces, &mut self.motion);
        for (row, product) in product.iter_mut().enumerate() {
            *product = d.along(row, &self.motion);
        }
    }

    /// x ← (D + C)⁻¹ x over some points, C the diagonal of their own compliances.
    ///
    /// # Errors
    /// The matrix is not positive definite.
    pub(super) fn solve(
        &mut self,
        d: &Lumped,
        (points, own): (&[(u32, Status)], &[f64]),
        x: &mut [f64],
    ) -> Result<(), Error> {
        let inverse = |k: usize| 1.0 / (d.block(points[k].0 as usize, 0, 0) + own[k]);
        let n = points.len();
        self.solution.clear();
        self.solution.resize(n, 0.0);
        self.best.clone_from(&self.solution);
        self.residual.clear();
        self.residual.extend_from_slice(x);
        self.direction.clear();
        self.direction.extend((0..n).map(|k| inverse(k) * x[k]));
        self.image.resize(n, 0.0);
        let square = |residual: &[f64]| -> f64 {
            (0..n).map(|k| residual[k] * inverse(k) * residual[k]).sum()
        };
        let first = square(&self.residual);
        let (mut now, mut least, mut patience) = (first, first, PATIENCE);
        while now > ROUNDING * ROUNDING * first && patience > 0 {
            self.apply(d, (points, own));
            let slope: f64 = self
                .direction
                .iter()
                .zip(&self.image)
                .map(|(p, q)| p * q)
                .sum();
            if slope.is_nan() || slope <= 0.0 {
                break;
            }
            let step = now / slope;
            for k in 0..n {
                self.solution[k] += step * self.direction[k];
                self.residual[k] -= step * self.image[k];
            }
            let next = square(&self.residual);
            for k in 0..n {
                self.direction[k] = inverse(k) * self.residual[k] + next / now * self.direction[k];
            }
            now = next;
            if now < least {
                (least, patience) = (now, PATIENCE);
                self.best.clone_from(&self.solution);
            } else {
                patience -= 1;
            }
        }
        x.copy_from_slice(&self.best);
        match least <= NEAR * NEAR * first {
            true => Ok(()),
            false => Err(self.singular(d, points)),
        }
    }

    /// The image of the direction.
    fn apply(&mut self, d: &Lumped, (points, own): (&[(u32, Status)], &[f64])) {
        self.motion.clear();
        self.motion.resize(d.count(), 0.0);
        for (&(i, _), &p) in points.iter().zip(&self.direction) {
            d.add(i as usize, p, &mut self.motion);
        }
        for (k, (&(i, _), own)) in points.iter().zip(own).enumerate() {
            self.image[k] = d.along(i as usize, &self.motion) + own * self.direction[k];
        }
    }

    /// The failure, at the point with the largest residual.
    fn singular(&self, d: &Lumped, points: &[(u32, Status)]) -> Error {
        let size = |k: usize| self.residual[k].abs();
        let worst = (0..points.len()).fold(0, |worst, k| match size(k) > size(worst) {
            true => k,
            false => worst,
        });
        Error::NotPositiveDefinite {
            unknown: worst,
            diagonal: d.block(points[worst].0 as usize, 0, 0),
        }
    }
}
