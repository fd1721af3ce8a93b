//! The operator P L⁻¹ M L⁻ᵀ P.

use crate::Error;
use crate::csr::Csr;
use crate::reduce::{dot, norm_squared};
use crate::solver::Cholesky;

/// What is left of a vector in the span of others, over its norm, below which it adds nothing to them.
const DEPENDENT: f64 = 1e-9;

/// P L⁻¹ M L⁻ᵀ P in the order of the factor.
pub(super) struct Operator<'a> {
    mass: &'a Csr,
    work: Work,
    /// Orthonormal vectors that P takes out.
    out: Vec<Vec<f64>>,
    /// Largest eigenvalue seen with this shift, also of a vector taken out since: images have its rounding.
    largest: f64,
}

struct Work {
    factor: Cholesky,
    y: Vec<f64>,
    x: Vec<f64>,
    product: Vec<f64>,
}

impl<'a> Operator<'a> {
    pub(super) fn new(shifted: &Csr, mass: &'a Csr, groups: &[u32]) -> Result<Self, Error> {
        let n = mass.n;
        let work = Work {
            factor: Cholesky::new(shifted, groups)?,
            y: vec![0.0; n],
            x: vec![0.0; n],
            product: vec![0.0; n],
        };
        Ok(Operator {
            mass,
            work,
            out: Vec::new(),
            largest: 0.0,
        })
    }

    /// Takes another shift; nothing is taken out any more.
    pub(super) fn refactor(&mut self, shifted: &Csr) -> Result<(), Error> {
        self.out.clear();
        self.largest = 0.0;
        self.work.factor.refactor(shifted)
    }

    /// The largest eigenvalue seen, after one more.
    pub(super) fn largest(&mut self, value: f64) -> f64 {
        self.largest = self.largest.max(value);
        self.largest
    }

    /// L⁻¹ f.
    pub(super) fn forward(&mut self, f: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; f.len()];
        self.work.factor.forward(f, &mut y);
        y
    }

    /// L⁻ᵀ y.
    pub(super) fn backward(&mut self, y: &[f64]) -> Vec<f64> {
        let (mut scratch, mut x) = (y.to_vec(), vec![0.0; y.len()]);
        self.work.factor.backward(&mut scratch, &mut x);
        x
    }

    /// Takes out a vector; whether it is not in the span of those taken out before.
    pub(super) fn take_out(&mut self, mut y: Vec<f64>) -> bool {
        let before = norm_squared(&y).sqrt();
        project(&self.out, &mut y);
        project(&self.out, &mut y);
        let norm = norm_squared(&y).sqrt();
        if norm.is_nan() || norm <= DEPENDENT * before {
            return false;
        }
        y.iter_mut().for_each(|y| *y /= norm);
        self.out.push(y);
        true
    }

    /// Number of unknowns.
    pub(super) fn len(&self) -> usize {
        self.mass.n
    }

    /// P y with the first `count` of the vectors taken out.
    pub(super) fn project(&self, count: usize, y: &mut [f64]) {
        project(&self.out[..count], y);
    }

    /// The operator on a vector.
    pub(super) fn image(&mut self, y: &[f64]) -> Vec<f64> {
        let mut inside = y.to_vec();
        project(&self.out, &mut inside);
        let mut image = vec![0.0; y.len()];
        let Work {
            factor,
            y,
            x,
            product,
        } = &mut self.work;
        y.copy_from_slice(&inside);
        factor.backward(y, x);
        self.mass.multiply(x, product);
        factor.forward(product, &mut image);
        project(&self.out, &mut image);
        image
    }

    /// The operator as a dense matrix.
    pub(super) fn dense(&mut self) -> Vec<f64> {
        let n = self.mass.n;
        let mut unit = vec![0.0; n];
        let mut all = Vec::with_capacity(n * n);
        for i in 0..n {
            unit[i] = 1.0;
            all.extend(self.image(&unit));
            unit[i] = 0.0;
        }
        all
    }
}

fn project(out: &[Vec<f64>], y: &mut [f64]) {
    for one in out {
        let share = dot(one, y);
        for (y, one) in y.iter_mut().zip(one) {
            *y -= share * one;
        }
    }
}
