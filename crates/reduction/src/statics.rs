//! Static responses of a body, also of one that floats.

use carom_algebra::Error;
use carom_algebra::csr::Csr;
use carom_algebra::solver::Cholesky;

/// Shift of a floating body, over the largest quotient of the diagonals of K and M.
const SHIFT: f64 = 1e-9;

/// Change of a response at which it has converged, over its largest entry.
const CONVERGED: f64 = 1e-15;

/// Corrections of a response.
const CORRECTIONS: usize = 60;

/// K x = f with unknowns held at zero, in the complement of some modes: f has no part along M z, x is M-orthogonal to z.
pub(crate) struct Statics<'a> {
    factor: Cholesky,
    mass: &'a Csr,
    fixed: &'a [bool],
    shift: f64,
    /// Modes z with zᵀ M z = 1, and M z.
    modes: Vec<[&'a [f64]; 2]>,
}

impl<'a> Statics<'a> {
    /// `floats`: whether K is singular, of a body with rigid motions; these are then among the modes.
    pub(crate) fn new(
        (stiffness, mass): (&Csr, &'a Csr),
        fixed: &'a [bool],
        (modes, floats): (Vec<[&'a [f64]; 2]>, bool),
        groups: &[u32],
    ) -> Result<Statics<'a>, Error> {
        let quotient = |i: usize| stiffness.get(i, i) / mass.get(i, i);
        let heavy = (0..mass.n).filter(|&i| mass.get(i, i) > 0.0);
        let scale = heavy.map(quotient).fold(0.0, f64::max);
        let shift = if floats { SHIFT * scale } else { 0.0 };
        let mut shifted = stiffness.clone();
        for i in 0..mass.n {
            let (columns, values) = mass.row(i);
            for (&j, m) in columns.iter().zip(values).filter(|(_, m)| **m != 0.0) {
                shifted.add(i, j as usize, shift * m);
            }
        }
        Ok(Statics {
            factor: Cholesky::new(&shifted.with_identity(fixed), groups)?,
            mass,
            fixed,
            shift,
            modes,
        })
    }

    /// The response to a force. With a shift s it is the limit of x ← (K + s M)⁻¹ (f + s M x), which converges as s over the
    /// smallest ω² that is left.
    pub(crate) fn solve(&mut self, mut force: Vec<f64>) -> Vec<f64> {
        for [mode, inertia] in &self.modes {
            let share = dot(mode, &force);
            add(-share, inertia, &mut force);
        }
        self.hold(&mut force);
        let mut x = force.clone();
        self.factor.solve(&mut x);
        self.orthogonalise(&mut x);
        let corrections = if self.shift == 0.0 { 0 } else { CORRECTIONS };
        let mut inertia = vec![0.0; x.len()];
        for _ in 0..corrections {
            self.mass.multiply(&x, &mut inertia);
            let mut next = force.clone();
            add(self.shift, &inertia, &mut next);
            self.hold(&mut next);
            self.factor.solve(&mut next);
            self.orthogonalise(&mut next);
            let largest = next.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let pairs = x.iter().zip(&next);
            let change = pairs.fold(0.0_f64, |most, (old, new)| most.max((old - new).abs()));
            x = next;
            if change <= CONVERGED * largest {
                break;
            }
        }
        x
    }

    fn hold(&self, force: &mut [f64]) {
        for (force, _) in force
            .iter_mut()
            .zip(self.fixed)
            .filter(|(_, fixed)| **fixed)
        {
            *force = 0.0;
        }
    }

    fn orthogonalise(&self, x: &mut [f64]) {
        for [mode, inertia] in &self.modes {
            let share = dot(inertia, x);
            add(-share, mode, x);
        }
    }
}

pub(crate) fn dot(x: &[f64], y: &[f64]) -> f64 {
    carom_algebra::reduce::dot(x, y)
}

/// y ← y + factor · x
pub(crate) fn add(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// xᵀ M x.
pub(crate) fn mass_of(mass: &Csr, x: &[f64]) -> f64 {
    let mut image = vec![0.0; x.len()];
    mass.multiply(x, &mut image);
    dot(x, &image)
}
