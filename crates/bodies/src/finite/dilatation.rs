//! Mean dilatation: one volume ratio for a whole element, against volumetric locking.
//!
//! With θ = ∫ det F dV / V, the law sees F̄ = s F, s = (θ / det F)^(1/3), whose determinant is θ at every point, and the
//! energy is Σ ψ(F̄) δ dV. Simo, Taylor and Pister (1985). The force is its derivative, so that energy and force agree for
//! any law, and the tangent is symmetric, unlike that of the F-bar method of de Souza Neto et al. (1996), which takes the
//! ratio at the centre and the stress alone. In plane strain F̄ has F̄_33 = s.
//!
//! With the Piola-Kirchhoff stress P̄ and tangent Ā at F̄, g = F^-T, G = B^T g (the derivative of ln det F),
//! c = dV det F / (θ V), d = Σ c G (the derivative of ln θ), e = (d - G)/3 (that of ln s), m = P̄ : F̄ / 3 and w = δ dV:
//!
//! f = Σ w B^T (s P̄ - m g) + M d, with M = Σ w m;
//!
//! K = Σ B^T [w s² Ā + (M c - w m) h + M c g ⊗ g] B + w (y ⊗ e + e ⊗ y) + w (s² F : Ā : F + 3 m) e ⊗ e - M d ⊗ d,
//! with h_ijkl = -g_il g_kj and y = B^T (s² Ā : F + s P̄).

use carom_algebra::tensor::Mat3;
use carom_materials::{Failure, Response, Tangent, Want};

use super::Stored;
use super::between::cofactor;
use super::cell::{Element, MAX_UNKNOWNS};
use super::element::{Fault, Local, tangent};
use super::gradient::symmetric;
use super::viscosity::Damped;

/// Volume change of an element.
pub(super) struct Dilatation {
    /// θ.
    pub(super) ratio: f64,
    /// θ V, the current volume in m³.
    volume: f64,
}

/// What the sums over the points need of one.
struct Point {
    f: Mat3,
    /// F^-T.
    g: Mat3,
    /// (θ / det F)^(1/3).
    s: f64,
    /// dV det F / (θ V).
    share: f64,
    /// w.
    weighted: f64,
    /// P̄ : F̄ / 3 in Pa.
    pressure: f64,
    /// At F̄.
    response: Response,
    damped: Damped<f64>,
}

impl Element {
    /// θ of an element; fails where a point is turned inside out.
    pub(super) fn dilatation(&self, u: &[f64]) -> Result<Dilatation, Fault> {
        let (mut reference, mut volume) = (0.0, 0.0);
        for point in 0..self.points {
            let determinant = self.gradient(point).deformation(u).determinant();
            if determinant.is_nan() || determinant <= 0.0 {
                let failure = Failure::Inverted { determinant };
                return Err(Fault::Law { point, failure });
            }
            reference += self.volume(point);
            volume += self.volume(point) * determinant;
        }
        Ok(Dilatation {
            ratio: volume / reference,
            volume,
        })
    }

    fn dilated_point(
        &self,
        point: usize,
        dilatation: &Dilatation,
        at: &Local,
        new: &mut [f64],
        want: Want,
    ) -> Result<Point, Fault> {
        let f = self.gradient(point).deformation(at.u);
        let determinant = f.determinant();
        let s = (dilatation.ratio / determinant).cbrt();
        let (response, damped) = at.update(self.points, point, &(f * s), new, want)?;
        Ok(Point {
            g: cofactor(&f) / determinant,
            s,
            share: self.volume(point) * determinant / dilatation.volume,
            weighted: self.weighted(point),
            pressure: s * response.stress.dot(&f) / 3.0,
            f,
            response,
            damped,
        })
    }

    pub(super) fn dilated_force(
        &self,
        at: &Local,
        new: &mut [f64],
        f: &mut [f64],
    ) -> Result<Stored, Fault> {
        let dilatation = self.dilatation(at.u)?;
        let (mut stored, mut mean) = (Stored::default(), 0.0);
        let mut volume = [0.0; MAX_UNKNOWNS];
        for place in 0..self.points {
            let point = self.dilated_point(place, &dilatation, at, new, Want::Stress)?;
            stored.add(point.weighted, (&point.response, &point.damped));
            mean += point.weighted * point.pressure;
            let deviator = point.response.stress * point.s - point.g * point.pressure;
            let gradient = self.gradient(place);
            gradient.add_transposed(point.weighted, &deviator, f);
            gradient.add_transposed(point.share, &point.g, &mut volume[..f.len()]);
        }
        for (f, d) in f.iter_mut().zip(&volume) {
            *f += mean * d;
        }
        Ok(stored)
    }

    pub(super) fn dilated_tangent(
        &self,
        (at, want): (&Local, Want),
        new: &mut [f64],
        matrix: &mut [f64],
    ) -> Result<(), Fault> {
        let dilatation = self.dilatation(at.u)?;
        let n = at.u.len();
        let mut points = Vec::with_capacity(self.points);
        let (mut mean, mut d) = (0.0, [0.0; MAX_UNKNOWNS]);
        for place in 0..self.points {
            let point = self.dilated_point(place, &dilatation, at, new, want)?;
            mean += point.weighted * point.pressure;
            let gradient = self.gradient(place);
            gradient.add_transposed(point.share, &point.g, &mut d[..n]);
            points.push(point);
        }
        for (place, point) in points.iter().enumerate() {
            let gradient = self.gradient(place);
            let (a, by_f, twice) = point.tangents(mean);
            gradient.add_product(&a, matrix);
            let (mut y, mut e) = ([0.0; MAX_UNKNOWNS], [0.0; MAX_UNKNOWNS]);
            gradient.add_transposed(1.0, &by_f, &mut y[..n]);
            gradient.add_transposed(-1.0 / 3.0, &point.g, &mut e[..n]);
            for (e, d) in e.iter_mut().zip(&d) {
                *e += d / 3.0;
            }
            for row in 0..n {
                for column in row..n {
                    matrix[row * n + column] +=
                        y[row] * e[column] + e[row] * y[column] + twice * e[row] * e[column];
                }
            }
        }
        for row in 0..n {
            for column in row..n {
                matrix[row * n + column] -= mean * d[row] * d[column];
            }
        }
        Ok(())
    }
}

impl Point {
    /// w s² Ā + (M c - w m) h + M c g ⊗ g; w (s² Ā : F + s P̄); w (s² F : Ā : F + 3 m). `mean`: M.
    fn tangents(&self, mean: f64) -> (Tangent, Mat3, f64) {
        let w = self.weighted;
        let mut a = symmetric(w * self.s * self.s, tangent(&self.response));
        let along = Mat3::from_fn(|i, j| {
            let row = &a[3 * i + j];
            (0..9).map(|k| row[k] * self.f[(k / 3, k % 3)]).sum()
        });
        let spread = mean * self.share;
        let skew = spread - w * self.pressure;
        for (r, row) in a.iter_mut().enumerate() {
            for (c, a) in row.iter_mut().enumerate() {
                let (i, j, k, l) = (r / 3, r % 3, c / 3, c % 3);
                *a += spread * self.g[(i, j)] * self.g[(k, l)]
                    - skew * self.g[(i, l)] * self.g[(k, j)];
            }
        }
        let by_f = along + self.response.stress * (w * self.s);
        let twice = along.dot(&self.f) + 3.0 * w * self.pressure;
        (a, by_f, twice)
    }
}
