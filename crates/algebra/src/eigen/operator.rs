//! The operator P L⁻¹ M L⁻ᵀ P, and faer's method of Lanczos with restarts on it.

use std::sync::Mutex;

use faer::{
    ColRef, MatMut, MatRef, Par,
    dyn_stack::{MemBuffer, MemStack, StackReq},
    matrix_free::{
        LinOp,
        eigen::{
            PartialEigenParams, partial_self_adjoint_eigen, partial_self_adjoint_eigen_scratch,
        },
    },
};

use crate::Error;
use crate::csr::Csr;
use crate::reduce::{dot, norm_squared};
use crate::solver::Cholesky;

/// Steps of the power method that estimate the norm of the operator.
const POWERS: usize = 12;

/// Residual of a pair at which it has converged, over the norm of the operator.
const CONVERGED: f64 = 1e-15;

/// What is left of a vector in the span of others, over its norm, below which it adds nothing to them.
const DEPENDENT: f64 = 1e-9;

/// Smallest dimension of the subspace before a restart.
const SUBSPACE: usize = 64;

/// Restarts after which the pairs that have not converged are given up.
const RESTARTS: usize = 60;

/// P L⁻¹ M L⁻ᵀ P in the order of the factor.
pub(super) struct Operator<'a> {
    mass: &'a Csr,
    work: Mutex<Work>,
    /// Orthonormal vectors that P takes out.
    out: Vec<Vec<f64>>,
}

struct Work {
    factor: Cholesky,
    y: Vec<f64>,
    x: Vec<f64>,
    product: Vec<f64>,
}

impl std::fmt::Debug for Operator<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "operator of {} unknowns", self.mass.n)
    }
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
            work: Mutex::new(work),
            out: Vec::new(),
        })
    }

    /// Takes another shift; nothing is taken out any more.
    pub(super) fn refactor(&mut self, shifted: &Csr) -> Result<(), Error> {
        self.out.clear();
        self.work().factor.refactor(shifted)
    }

    fn work(&mut self) -> &mut Work {
        self.work
            .get_mut()
            .unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// L⁻¹ f.
    pub(super) fn forward(&mut self, f: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; f.len()];
        self.work().factor.forward(f, &mut y);
        y
    }

    /// L⁻ᵀ y.
    pub(super) fn backward(&mut self, y: &[f64]) -> Vec<f64> {
        let (mut scratch, mut x) = (y.to_vec(), vec![0.0; y.len()]);
        self.work().factor.backward(&mut scratch, &mut x);
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

    /// P y with the first `count` of the vectors taken out.
    pub(super) fn project(&self, count: usize, y: &mut [f64]) {
        project(&self.out[..count], y);
    }

    fn image(&self, y: &[f64]) -> Vec<f64> {
        let mut inside = y.to_vec();
        project(&self.out, &mut inside);
        let mut image = vec![0.0; y.len()];
        let mut work = self
            .work
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        let Work {
            factor,
            y,
            x,
            product,
        } = &mut *work;
        y.copy_from_slice(&inside);
        factor.backward(y, x);
        self.mass.multiply(x, product);
        factor.forward(product, &mut image);
        project(&self.out, &mut image);
        image
    }

    /// The operator as a dense matrix.
    pub(super) fn dense(&self) -> Vec<f64> {
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

    /// An estimate of the norm from below, by the power method.
    fn norm(&self, mut y: Vec<f64>) -> f64 {
        let mut norm = 0.0;
        for _ in 0..POWERS {
            let length = norm_squared(&y).sqrt();
            if length == 0.0 {
                return 0.0;
            }
            y.iter_mut().for_each(|y| *y /= length);
            let image = self.image(&y);
            norm = dot(&y, &image);
            y = image;
        }
        norm
    }

    /// Vectors of the largest eigenvalues: at most `count`, fewer where some do not converge.
    pub(super) fn largest(&self, count: usize) -> Result<Vec<Vec<f64>>, Error> {
        let n = self.mass.n;
        let start = self.image(&noise(n));
        let norm = self.norm(start.clone());
        if norm == 0.0 {
            return Ok(Vec::new());
        }
        let params = PartialEigenParams {
            min_dim: 0,
            max_dim: subspace(count),
            max_restarts: RESTARTS,
            ..Default::default()
        };
        let scratch = partial_self_adjoint_eigen_scratch::<f64>(self, count, Par::Seq, params);
        let mut memory = MemBuffer::try_new(scratch).map_err(|_| Error::Analysis {
            unknowns: n,
            reason: "out of memory".into(),
        })?;
        let (mut values, mut vectors) = (vec![0.0; count], vec![0.0; n * count]);
        let info = partial_self_adjoint_eigen(
            MatMut::from_column_major_slice_mut(&mut vectors, n, count),
            &mut values,
            self,
            ColRef::from_slice(&start),
            CONVERGED * norm,
            Par::Seq,
            MemStack::new(&mut memory),
            params,
        );
        let found = vectors.chunks_exact(n).take(info.n_converged_eigen);
        Ok(found.map(<[f64]>::to_vec).collect())
    }
}

/// Dimension of the subspace for this number of vectors.
pub(super) fn subspace(count: usize) -> usize {
    SUBSPACE.max(2 * count)
}

fn project(out: &[Vec<f64>], y: &mut [f64]) {
    for one in out {
        let share = dot(one, y);
        for (y, one) in y.iter_mut().zip(one) {
            *y -= share * one;
        }
    }
}

/// Numbers between -1 and 1 that are the same in each run (a linear congruence, Knuth).
fn noise(n: usize) -> Vec<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    std::iter::repeat_with(next).take(n).collect()
}

impl LinOp<f64> for Operator<'_> {
    fn apply_scratch(&self, _: usize, _: Par) -> StackReq {
        StackReq::EMPTY
    }

    fn nrows(&self) -> usize {
        self.mass.n
    }

    fn ncols(&self) -> usize {
        self.mass.n
    }

    fn apply(&self, mut out: MatMut<'_, f64>, rhs: MatRef<'_, f64>, _: Par, _: &mut MemStack) {
        for k in 0..rhs.ncols() {
            let y: Vec<f64> = rhs.col(k).iter().copied().collect();
            for (out, image) in out.as_mut().col_mut(k).iter_mut().zip(self.image(&y)) {
                *out = image;
            }
        }
    }

    fn conj_apply(&self, out: MatMut<'_, f64>, rhs: MatRef<'_, f64>, p: Par, s: &mut MemStack) {
        self.apply(out, rhs, p, s);
    }
}
