//! Mean dilatation between two displacements: forces whose work over the step is the change of the energy.
//!
//! The energy Σ w ψ(Ē), Ē = (s² C - I)/2, s = (θ/J)^(1/3), J = det F, θ = Σ v J, v = dV/V, is a function of the strains E of
//! all points of the element. Between two states, with ⟨x⟩ = (x_0 + x_1)/2, Δx = x_1 - x_0, C_m = ⟨C⟩, F_m = ⟨F⟩ and
//! D = ΔE = sym(F_mᵀ ΔF), each link of that chain has a difference that is linear in those before it, exactly:
//!
//! ΔJ = N : D,   N = (cof C_m + cof(D)/3)/⟨J⟩;   Δθ = Σ v ΔJ;
//!
//! Δs² = R (⟨J⟩ Δθ - ⟨θ⟩ ΔJ),   R = (s_0 + s_1)/((s_0² + s_0 s_1 + s_1²) J_0 J_1);
//!
//! ΔĒ = ⟨s²⟩ D + Δs² C_m/2;   Δψ = S̄ : ΔĒ, the algorithmic stress of the law.
//!
//! So with p = R S̄:C_m/2 and M = Σ w p ⟨J⟩ the change of the energy is Σ T : D with
//!
//! T = w ⟨s²⟩ S̄ + (M v - w p ⟨θ⟩) N,   f = Σ Bᵀ F_m T.
//!
//! f·Δu = ΔU, T is symmetric, so that f has no moment about the places in the middle, and all turns with both ends. Nothing
//! is a difference of energies, and nothing is divided by D, but in the law: a small step keeps all its digits.
//!
//! Derivative by u_1, with B_1 = cof(C_1)/J_1 (that of J_1), 𝕂 = ∂S̄/∂Ē_1, k = 𝕂:C_1, q = M v - w p ⟨θ⟩, A = C_m + D/3 and the
//! derivative A× of its cofactors:
//!
//! K = Σ Bᵀ (F_m 𝕃 F_1 + T/2) B + y ⊗ d + n ⊗ z,
//!
//! d = Σ v Bᵀ F_1 B_1 (that of θ_1),   n = Σ v Bᵀ F_m N,   y = Σ Bᵀ F_m (Y/θ_1 - w (⟨θ⟩ β/θ_1 + p/2) N),
//!
//! z = Σ w Bᵀ F_1 (⟨J⟩ Π + p B_1/2) + (Σ w ⟨J⟩ β/θ_1) d (that of M),
//!
//! 𝕃 = w ⟨s²⟩ s_1² 𝕂 - Y⊗B_1/J_1 + (q/⟨J⟩) (A× - N⊗B_1/2) - w ⟨θ⟩ N⊗Π,   Y = w s_1² (⟨s²⟩ k + S̄)/3,
//!
//! Π = R (S̄ + s_1² C_m:𝕂)/2 - (β + p) B_1/J_1,   β = s_1 (R s_1 C_m:k/2 + p r)/3, r = ∂ ln R/∂s_1.
//!
//! Conserving elements with an assumed volume ratio: Armero (2008), whose text was not at hand; the chain is derived here.

use carom_algebra::tensor::Mat3;
use carom_materials::{Conserving, Failure, Tangent, Want};

use super::Stored;
use super::cell::{Element, MAX_UNKNOWNS};
use super::element::{Fault, Local};

/// How one point moves.
struct Motion {
    f_1: Mat3,
    f_m: Mat3,
    c_m: Mat3,
    d: Mat3,
    /// J.
    jacobian: [f64; 2],
    /// N.
    slope: Mat3,
    /// dV in m³.
    volume: f64,
}

/// How the volume ratio of an element changes.
#[derive(Default)]
struct Dilation {
    /// θ.
    ratio: [f64; 2],
    /// Δθ.
    change: f64,
    /// V in m³.
    reference: f64,
}

/// One point and its stress.
struct Point {
    motion: Motion,
    s: [f64; 2],
    /// R.
    rate: f64,
    /// p in Pa.
    pressure: f64,
    /// v.
    share: f64,
    /// w in m³.
    weighted: f64,
    /// Of the law, at Ē.
    law: Conserving,
}

/// Derivatives at one point by E_1 and θ_1.
struct Slopes {
    /// B_1.
    b_1: Mat3,
    /// Y.
    dilating: Mat3,
    /// Π: of p by E_1.
    pressure: Mat3,
    /// β/θ_1: of p by θ_1.
    pressure_by_ratio: f64,
}

impl Element {
    /// Fails where the point is turned inside out.
    fn motion(&self, point: usize, u: [&[f64]; 2]) -> Result<Motion, Fault> {
        let gradient = self.gradient(point);
        let f = u.map(|u| gradient.deformation(u));
        let jacobian = f.map(|f| f.determinant());
        for determinant in jacobian {
            if determinant.is_nan() || determinant <= 0.0 {
                let failure = Failure::Inverted { determinant };
                return Err(Fault::Law { point, failure });
            }
        }
        let [f_0, f_1] = f;
        let f_m = (f_0 + f_1) * 0.5;
        let product = f_m.tr_mul(&(f_1 - f_0));
        let d = (product + product.transpose()) * 0.5;
        let c_m = (f_0.tr_mul(&f_0) + f_1.tr_mul(&f_1)) * 0.5;
        Ok(Motion {
            slope: (cofactor(&c_m) + cofactor(&d) / 3.0) / mean(jacobian),
            f_1,
            f_m,
            c_m,
            d,
            jacobian,
            volume: self.volume(point),
        })
    }

    fn dilation(&self, u: [&[f64]; 2]) -> Result<Dilation, Fault> {
        let mut sum = Dilation::default();
        for point in 0..self.points {
            let motion = self.motion(point, u)?;
            sum.reference += motion.volume;
            sum.change += motion.volume * motion.slope.dot(&motion.d);
            for (ratio, jacobian) in sum.ratio.iter_mut().zip(motion.jacobian) {
                *ratio += motion.volume * jacobian;
            }
        }
        sum.change /= sum.reference;
        sum.ratio = sum.ratio.map(|ratio| ratio / sum.reference);
        Ok(sum)
    }

    fn point_between(
        &self,
        point: usize,
        (dilation, from): (&Dilation, &[f64]),
        at: &Local,
        want: Want,
    ) -> Result<Point, Fault> {
        let motion = self.motion(point, [from, at.u])?;
        let Motion { c_m, d, .. } = &motion;
        let [j_0, j_1] = motion.jacobian;
        let s = [0, 1].map(|k| (dilation.ratio[k] / motion.jacobian[k]).cbrt());
        let [s_0, s_1] = s;
        let rate = (s_0 + s_1) / ((s_0 * s_0 + s_0 * s_1 + s_1 * s_1) * j_0 * j_1);
        let growth = rate
            * (mean(motion.jacobian) * dilation.change
                - mean(dilation.ratio) * motion.slope.dot(d));
        let h = motion.f_1 * s_1 - Mat3::identity();
        let strain = (h + h.transpose() + h.tr_mul(&h)) * 0.5;
        let change = d * mean_square(s) + c_m * (0.5 * growth);
        let law = at.law.between_strains(&strain, &change, want);
        let failed = |failure| Fault::Law { point, failure };
        let law = law.ok_or(Fault::NoBetween)?.map_err(failed)?;
        Ok(Point {
            pressure: 0.5 * rate * law.stress.dot(c_m),
            share: motion.volume / dilation.reference,
            weighted: self.weighted(point),
            motion,
            s,
            rate,
            law,
        })
    }

    /// Adds the forces of an element (N) between `from` and `at.u` to `f`.
    pub(super) fn dilated_force_between(
        &self,
        from: &[f64],
        at: &Local,
        f: &mut [f64],
    ) -> Result<Stored, Fault> {
        let dilation = self.dilation([from, at.u])?;
        let (mut stored, mut whole) = (Stored::default(), 0.0);
        let mut volume = [0.0; MAX_UNKNOWNS];
        for place in 0..self.points {
            let point = self.point_between(place, (&dilation, from), at, Want::Stress)?;
            stored.strain += point.weighted * point.law.stored;
            whole += point.pull();
            let (gradient, f_m) = (self.gradient(place), &point.motion.f_m);
            gradient.add_transposed(1.0, &(f_m * point.stress(&dilation, 0.0)), f);
            let slope = f_m * point.motion.slope;
            gradient.add_transposed(point.share, &slope, &mut volume[..f.len()]);
        }
        for (f, n) in f.iter_mut().zip(&volume) {
            *f += whole * n;
        }
        Ok(stored)
    }

    /// Adds ∂f/∂u_1 (N/m), which is not symmetric, to a row-major matrix.
    pub(super) fn dilated_tangent_between(
        &self,
        from: &[f64],
        at: &Local,
        matrix: &mut [f64],
    ) -> Result<(), Fault> {
        let dilation = self.dilation([from, at.u])?;
        let mut points = Vec::with_capacity(self.points);
        for place in 0..self.points {
            points.push(self.point_between(place, (&dilation, from), at, Want::Tangent)?);
        }
        let whole: f64 = points.iter().map(Point::pull).sum();
        let size = at.u.len();
        let [mut d, mut n, mut y, mut z] = [[0.0; MAX_UNKNOWNS]; 4];
        let mut by_ratio = 0.0;
        for (place, point) in points.iter().enumerate() {
            let gradient = self.gradient(place);
            let Motion {
                f_1, f_m, slope, ..
            } = &point.motion;
            let slopes = point.slopes(&dilation);
            let moduli = point.moduli(&dilation, whole, &slopes);
            let stress = point.stress(&dilation, whole);
            gradient.add_whole_product(&pushed(&moduli, (f_m, f_1), &stress), matrix);
            let add = |factor, p: Mat3, out: &mut [f64; MAX_UNKNOWNS]| {
                gradient.add_transposed(factor, &p, &mut out[..size]);
            };
            add(point.share, f_1 * slopes.b_1, &mut d);
            add(point.share, f_m * slope, &mut n);
            add(1.0, f_m * point.stress_by_ratio(&dilation, &slopes), &mut y);
            let pull =
                slopes.pressure * mean(point.motion.jacobian) + slopes.b_1 * (0.5 * point.pressure);
            add(point.weighted, f_1 * pull, &mut z);
            by_ratio += point.weighted * mean(point.motion.jacobian) * slopes.pressure_by_ratio;
        }
        for (z, d) in z.iter_mut().zip(&d) {
            *z += by_ratio * d;
        }
        for row in 0..size {
            for column in 0..size {
                matrix[row * size + column] += y[row] * d[column] + n[row] * z[column];
            }
        }
        Ok(())
    }
}

impl Point {
    /// w p ⟨J⟩, what the point gives to M.
    fn pull(&self) -> f64 {
        self.weighted * self.pressure * mean(self.motion.jacobian)
    }

    /// q, with `whole` = M.
    fn along(&self, dilation: &Dilation, whole: f64) -> f64 {
        whole * self.share - self.weighted * self.pressure * mean(dilation.ratio)
    }

    /// T, with `whole` = M.
    fn stress(&self, dilation: &Dilation, whole: f64) -> Mat3 {
        self.law.stress * (self.weighted * mean_square(self.s))
            + self.motion.slope * self.along(dilation, whole)
    }

    /// ∂T/∂θ_1 at the same M.
    fn stress_by_ratio(&self, dilation: &Dilation, slopes: &Slopes) -> Mat3 {
        let pressure = mean(dilation.ratio) * slopes.pressure_by_ratio + 0.5 * self.pressure;
        slopes.dilating / dilation.ratio[1] - self.motion.slope * (self.weighted * pressure)
    }

    fn slopes(&self, dilation: &Dilation) -> Slopes {
        let Motion { f_1, c_m, .. } = &self.motion;
        let (p, rate, stress) = (self.pressure, self.rate, &self.law.stress);
        let [s_0, s_1] = self.s;
        let j_1 = self.motion.jacobian[1];
        let c_1 = f_1.tr_mul(f_1);
        let b_1 = cofactor(&c_1) / j_1;
        let moduli = self.law_moduli();
        // sums over a pair; the moduli of a step are not the same from left and right
        let sum =
            |of: &dyn Fn(usize) -> f64, x: &Mat3| (0..9).map(|k| of(k) * x[(k / 3, k % 3)]).sum();
        let k = Mat3::from_fn(|i, j| sum(&|c| moduli[3 * i + j][c], &c_1));
        let left = Mat3::from_fn(|i, j| sum(&|r| moduli[r][3 * i + j], c_m));
        let r = 1.0 / (s_0 + s_1) - (s_0 + 2.0 * s_1) / (s_0 * s_0 + s_0 * s_1 + s_1 * s_1);
        let beta = s_1 / 3.0 * (0.5 * rate * s_1 * c_m.dot(&k) + p * r);
        Slopes {
            dilating: (k * mean_square(self.s) + stress) * (self.weighted * s_1 * s_1 / 3.0),
            pressure: (stress + left * (s_1 * s_1)) * (0.5 * rate) - b_1 * ((beta + p) / j_1),
            pressure_by_ratio: beta / dilation.ratio[1],
            b_1,
        }
    }

    fn law_moduli(&self) -> &Tangent {
        const NONE: &Tangent = &[[0.0; 9]; 9];
        debug_assert!(self.law.moduli.is_some());
        self.law.moduli.as_deref().unwrap_or(NONE)
    }

    /// 𝕃, with `whole` = M.
    fn moduli(&self, dilation: &Dilation, whole: f64, slopes: &Slopes) -> Tangent {
        let Motion { c_m, d, slope, .. } = &self.motion;
        let jacobian = self.motion.jacobian;
        let of_law = self.weighted * mean_square(self.s) * self.s[1] * self.s[1];
        let along = self.along(dilation, whole) / mean(jacobian);
        // what stands before B_1, and before Π
        let by_volume = slopes.dilating / jacobian[1] + slope * (0.5 * along);
        let by_pressure = slope * (self.weighted * mean(dilation.ratio));
        let mut out = crossed(&(c_m + d / 3.0));
        for (r, (row, law)) in out.iter_mut().zip(self.law_moduli()).enumerate() {
            for (c, (out, law)) in row.iter_mut().zip(law).enumerate() {
                let (ij, kl) = ((r / 3, r % 3), (c / 3, c % 3));
                *out = along * *out + of_law * law
                    - by_volume[ij] * slopes.b_1[kl]
                    - by_pressure[ij] * slopes.pressure[kl];
            }
        }
        out
    }
}

/// L_iM 𝕃_MJNL R_kN + δ_ik T_JL/2.
fn pushed(moduli: &Tangent, (left, right): (&Mat3, &Mat3), stress: &Mat3) -> Tangent {
    let mut half = [[0.0; 9]; 9];
    for (r, half) in half.iter_mut().enumerate() {
        for (c, half) in half.iter_mut().enumerate() {
            let (k, l) = (c / 3, c % 3);
            *half = (0..3).map(|n| moduli[r][3 * n + l] * right[(k, n)]).sum();
        }
    }
    let mut out = [[0.0; 9]; 9];
    for (r, row) in out.iter_mut().enumerate() {
        for (c, out) in row.iter_mut().enumerate() {
            let (i, j) = (r / 3, r % 3);
            *out = (0..3).map(|m| left[(i, m)] * half[3 * m + j][c]).sum();
            if i == c / 3 {
                *out += 0.5 * stress[(j, c % 3)];
            }
        }
    }
    out
}

/// A× of a symmetric A: the derivative of the cofactors, A × X = A X + X A - tr(A) X - tr(X) A + (tr(A) tr(X) - A:X) I for
/// symmetric X.
fn crossed(a: &Mat3) -> Tangent {
    let unit = |i: usize, j: usize| if i == j { 1.0 } else { 0.0 };
    let trace = a.trace();
    let mut out = [[0.0; 9]; 9];
    for (r, row) in out.iter_mut().enumerate() {
        for (c, out) in row.iter_mut().enumerate() {
            let (i, j, k, l) = (r / 3, r % 3, c / 3, c % 3);
            let pair = |i: usize, j: usize| {
                unit(j, l) * (a[(i, k)] - trace * unit(i, k)) + unit(i, k) * a[(j, l)]
            };
            *out = 0.5 * (pair(i, j) + pair(j, i))
                - a[(i, j)] * unit(k, l)
                - unit(i, j) * (a[(k, l)] - trace * unit(k, l));
        }
    }
    out
}

fn mean([begin, end]: [f64; 2]) -> f64 {
    0.5 * (begin + end)
}

fn mean_square([begin, end]: [f64; 2]) -> f64 {
    0.5 * (begin * begin + end * end)
}

/// Cofactor matrix, det(A) A⁻ᵀ.
pub(super) fn cofactor(a: &Mat3) -> Mat3 {
    let [u, v, w] = [0, 1, 2].map(|j| a.column(j));
    Mat3::from_columns(&[v.cross(&w), w.cross(&u), u.cross(&v)])
}
