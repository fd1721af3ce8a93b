//! Forces and tangents of one element at finite strain.

use carom_algebra::tensor::Mat3;
use carom_materials::{Failure, Material, Response, Tangent, Want};

use super::Stored;
use super::cell::Element;
use super::gradient::{Gradient, mirror, scaled, symmetric};
use super::viscosity::{Damped, add_pressure, damp};

/// Where one element is.
pub(super) struct Local<'a> {
    pub(super) law: &'a dyn Material,
    /// Displacement of its nodes in m.
    pub(super) u: &'a [f64],
    /// That at the start of the step, for the stress between the two.
    pub(super) from: Option<&'a [f64]>,
    /// Time since the old history, s.
    pub(super) dt: f64,
    /// History of its points at the start of the step.
    pub(super) old: &'a [f64],
    /// Numbers that the law keeps of a point.
    pub(super) of_law: usize,
    /// Coefficients of the bulk viscosity.
    pub(super) viscosity: Option<[f64; 2]>,
}

/// Why an element gave no force.
#[derive(Clone, Debug)]
pub(super) enum Fault {
    /// The law gave no stress at a point.
    Law { point: usize, failure: Failure },
    /// There is no stress between two displacements.
    NoBetween,
}

impl Stored {
    pub(super) fn add(&mut self, volume: f64, (response, damped): (&Response, &Damped<f64>)) {
        self.strain += volume * response.stored;
        self.hardening += volume * response.hardening;
        self.dissipated += volume * response.dissipated;
        self.viscous += volume * damped.work;
        self.compression = self.compression.max(damped.compression);
    }
}

impl Element {
    pub(super) fn gradient(&self, point: usize) -> Gradient<'_> {
        Gradient {
            dim: self.dim,
            axisymmetric: self.axisymmetric,
            dn: self.gradients(point),
        }
    }

    /// Adds the forces of an element (N) to `f`, writes its history into `new`.
    pub(super) fn force(
        &self,
        at: &Local,
        new: &mut [f64],
        f: &mut [f64],
    ) -> Result<Stored, Fault> {
        if self.dilatation {
            return match at.from {
                None => self.dilated_force(at, new, f),
                Some(from) => self.dilated_force_between(from, at, f),
            };
        }
        let mut stored = Stored::default();
        for point in 0..self.points {
            let (response, damped) = self.response(point, at, new, Want::Stress)?;
            let volume = self.weighted(point);
            stored.add(volume, (&response, &damped));
            let gradient = self.gradient(point);
            gradient.add_transposed(volume, &response.stress, f);
        }
        if let Some(hourglass) = &self.hourglass {
            stored.hourglass = hourglass.force(self.dim, at.u, at.from, f);
            stored.strain += stored.hourglass;
        }
        Ok(stored)
    }

    /// Writes ∂f/∂u of an element (N/m, row-major). It is symmetric but between two displacements, where the force is virtual work at
    /// the middle and varies at the end. `want`: which one; `new`: room for its history.
    pub(super) fn tangent(
        &self,
        (at, want): (&Local, Want),
        new: &mut [f64],
        matrix: &mut [f64],
    ) -> Result<(), Fault> {
        let between = at.from.is_some();
        matrix.fill(0.0);
        if self.dilatation {
            match at.from {
                None => self.dilated_tangent((at, want), new, matrix)?,
                Some(from) => self.dilated_tangent_between(from, at, matrix)?,
            }
        } else {
            for point in 0..self.points {
                let (response, _) = self.response(point, at, new, want)?;
                let (w, a, gradient) = (
                    self.weighted(point),
                    tangent(&response),
                    self.gradient(point),
                );
                match between {
                    true => gradient.add_whole_product(&scaled(w, a), matrix),
                    false => gradient.add_product(&symmetric(w, a), matrix),
                }
            }
        }
        if let Some(hourglass) = &self.hourglass {
            let factor = if between { 0.5 } else { 1.0 };
            hourglass.tangent(self.dim, (factor, between), matrix);
        }
        if !between {
            mirror(matrix);
        }
        Ok(())
    }

    /// The law at one point, at its own F.
    fn response(
        &self,
        point: usize,
        at: &Local,
        new: &mut [f64],
        want: Want,
    ) -> Result<(Response, Damped<f64>), Fault> {
        let gradient = self.gradient(point);
        let f = gradient.deformation(at.u);
        let failed = |failure| Fault::Law { point, failure };
        let Some(from) = at.from else {
            return at.update(self.points, point, &f, new, want);
        };
        let between = at.law.between(&gradient.deformation(from), &f, want);
        new.copy_from_slice(at.old);
        let response = between.ok_or(Fault::NoBetween)?.map_err(failed)?;
        Ok((response, Damped::default()))
    }

    /// Cauchy stress σ = P F^T / det F and det F times dV at a point, by the F that its law sees.
    pub(super) fn cauchy(&self, at: &Local, new: &mut [f64]) -> Result<(f64, Mat3), Fault> {
        let theta = match self.dilatation {
            true => Some(self.dilatation(at.u)?.ratio),
            false => None,
        };
        let (mut volume, mut stress) = (0.0, Mat3::zeros());
        for point in 0..self.points {
            let mut f = self.gradient(point).deformation(at.u);
            let current = self.volume(point) * f.determinant();
            if let Some(theta) = theta {
                f *= (theta / f.determinant()).cbrt();
            }
            let (response, _) = at.update(self.points, point, &f, new, Want::Stress)?;
            stress += response.stress * f.transpose() * (current / f.determinant());
            volume += current;
        }
        Ok((volume, stress / volume))
    }
}

impl Local<'_> {
    /// The law and the bulk viscosity at a point with this F, one of `points` in the element.
    pub(super) fn update(
        &self,
        points: usize,
        point: usize,
        f: &Mat3,
        new: &mut [f64],
        want: Want,
    ) -> Result<(Response, Damped<f64>), Fault> {
        let length = new.len() / points;
        let range = point * length..(point + 1) * length;
        let (old, before) = self.old[range.clone()].split_at(self.of_law);
        let (new, after) = new[range].split_at_mut(self.of_law);
        after.copy_from_slice(before);
        let updated = self.law.update(f, self.dt, (old, new), want);
        let mut response = updated.map_err(|failure| Fault::Law { point, failure })?;
        let mut damped = Damped::default();
        if let (Some(coefficients), [before, ..], [after, ..]) = (self.viscosity, before, after) {
            let h = [0, 1, 2].map(|i| [0, 1, 2].map(|j| f[(i, j)] - f64::from(u8::from(i == j))));
            damped = damp(&h, coefficients, (*before, self.dt));
            let mut stress = [[0.0; 3]; 3];
            add_pressure(&mut stress, &h, damped.pressure);
            response.stress += Mat3::from_fn(|i, j| stress[i][j]);
            *after = damped.logarithm;
        }
        Ok((response, damped))
    }
}

/// The tangent of a response for which one was wanted.
pub(super) fn tangent(response: &Response) -> &Tangent {
    const NONE: &Tangent = &[[0.0; 9]; 9];
    debug_assert!(response.tangent.is_some());
    response.tangent.as_deref().unwrap_or(NONE)
}
