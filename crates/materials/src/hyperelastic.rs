//! Laws that have a stored energy alone: the form that they share, its stress and tangent, and the algorithmic stress of a
//! step that does exactly the work of the energy difference.

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;

use crate::lagrange::{Moduli, add_geometric, add_product, positive};
use crate::tensor::{
    Tensor, cofactor, determinant, double, green_lagrange, matrix, plus, plus_unit, product, rows,
    scaled, symmetric_product, trace,
};
use crate::{Answer, Conserving, Elastic, Failure, Material, Pointwise, Response, Want};

/// A hyperelastic law, chosen by the coefficients of its [`Potential`].
pub(crate) trait Hyperelastic {
    /// Stored energy.
    fn potential(&self) -> Potential;
    /// Linear elasticity of the undeformed material.
    fn initial(&self) -> Elastic;
}

impl<L: Hyperelastic> Pointwise for L {
    #[inline(always)]
    fn answer<T: Number>(&self, h: &Tensor<T>, _dt: f64, _old: &[T], _new: &mut [T]) -> Answer<T> {
        self.potential().answer(h)
    }
}

impl<T: Hyperelastic> Material for T {
    fn history_len(&self) -> usize {
        0
    }

    fn start(&self, _history: &mut [f64]) {}

    fn update(
        &self,
        f: &Mat3,
        _dt: f64,
        _history: (&[f64], &mut [f64]),
        want: Want,
    ) -> Result<Response, Failure> {
        self.potential().response(f, want)
    }

    fn between(&self, f_0: &Mat3, f_1: &Mat3, want: Want) -> Option<Result<Response, Failure>> {
        Some(self.potential().between(f_0, f_1, want))
    }

    fn between_strains(
        &self,
        e_1: &Mat3,
        d: &Mat3,
        want: Want,
    ) -> Option<Result<Conserving, Failure>> {
        Some(self.potential().between_strains(e_1, d, want))
    }

    fn initial(&self) -> Elastic {
        Hyperelastic::initial(self)
    }
}

/// Stored energy ψ = a/2 (tr E)² + b E:E + m (tr E - ln J) + l/2 (ln J)² of the Green-Lagrange strain E, with
/// J = sqrt(det(I + 2E)): quadratic in E, and functions of the volume. All coefficients in Pa. It vanishes, and so does
/// its stress S = ∂ψ/∂E, at E = 0, where it is linear elasticity with λ = a + l and μ = b + m.
pub(crate) struct Potential {
    /// a, of (tr E)²/2.
    pub(crate) trace: f64,
    /// b, of E:E.
    pub(crate) square: f64,
    /// m, of tr E - ln J.
    pub(crate) barrier: f64,
    /// l, of (ln J)²/2.
    pub(crate) volume: f64,
}

/// A strain with what the potential asks of it.
struct State<T> {
    e: Tensor<T>,
    /// B = C⁻¹ = (I + 2E)⁻¹.
    b: Tensor<T>,
    /// det C.
    det: T,
    /// ln J.
    ln_j: T,
    /// tr E - ln J, not negative.
    gap: T,
}

impl<T: Number> State<T> {
    /// Of a strain; of use where det C is positive.
    ///
    /// det C - 1 = 2 I_1 + 4 I_2 + 8 I_3 with the invariants of E, and with it ln J and tr E - ln J free of cancellation:
    /// the energy keeps its digits however small the strain is. With r = (det C - 1)/(det C + 1), ln J is atanh r.
    #[inline(always)]
    fn new(e: Tensor<T>) -> State<T> {
        let sum = trace(&e);
        let (one, two) = (sum.like(1.0), sum.like(2.0));
        let c = plus_unit(&scaled(&e, two), one);
        let pairs = sum.mul_add(sum, -double(&e, &e));
        let rest = determinant(&e).mul_add(sum.like(4.0), pairs);
        let growth = (sum + rest).scale(2.0);
        let det = growth + one;
        let ratio = growth / (growth + two);
        let ln_j = growth.ln_1p().scale(0.5);
        // beyond, the rest of the series is not small, and ln J - r has no cancellation
        let above = (ratio.abs()).if_below(sum.like(NEAR), atanh_series(ratio), ln_j - ratio);
        State {
            b: scaled(&cofactor(&c), one / det),
            det,
            ln_j,
            gap: growth.scale(0.5).mul_add(ratio, -above) - rest,
            e,
        }
    }

    /// Of a law quadratic in E, which asks for the strain alone.
    #[inline(always)]
    fn plain(e: Tensor<T>) -> State<T> {
        let zero = e[0][0].like(0.0);
        State {
            e,
            b: [[zero; 3]; 3],
            det: zero.like(1.0),
            ln_j: zero,
            gap: zero,
        }
    }
}

impl State<f64> {
    /// # Errors
    /// det C not positive, as round-off makes it where the volume is pressed to nothing.
    fn checked(e: &Mat3) -> Result<State<f64>, Failure> {
        let state = State::new(rows(e));
        positive(state.det)?;
        Ok(state)
    }

    /// B.
    fn inverse(&self) -> Mat3 {
        matrix(&self.b)
    }
}

/// The discrete gradient of a step.
struct Algorithmic {
    /// S_alg in Pa.
    stress: Mat3,
    /// ∂S_alg/∂E_1 without D⊗w.
    moduli: Moduli,
    /// w, where it is wanted and not too small.
    slope: Option<Mat3>,
    /// ψ(E_1) in Pa.
    stored: f64,
}

/// 1/3, 1/5, ..., 1/25: the coefficients of t³, t⁵, ... in atanh t.
const ATANH: [f64; 12] = {
    let mut table = [0.0; 12];
    let mut k = 0;
    while k < table.len() {
        table[k] = 1.0 / (2 * k + 3) as f64;
        k += 1;
    }
    table
};

/// Below, the next term of the series, 0.04¹²/27, is less than the last digit of the first.
const NEAR: f64 = 0.2;

/// atanh(t) - t = t³/3 + t⁵/5 + ..., to its last digits for |t| below [`NEAR`].
#[inline(always)]
fn atanh_series<T: Number>(t: T) -> T {
    let square = t * t;
    let mut series = t.like(0.0);
    for &c in ATANH.iter().rev() {
        series = series.mul_add(square, t.like(c));
    }
    series * square * t
}

/// atanh(t) - t, to its last digits for small t.
fn atanh_rest(t: f64) -> f64 {
    if t.abs() > NEAR {
        t.atanh() - t
    } else {
        atanh_series(t)
    }
}

impl Potential {
    /// Whether it has parts that are functions of the volume.
    #[inline(always)]
    fn has_volume(&self) -> bool {
        self.barrier != 0.0 || self.volume != 0.0
    }

    #[inline(always)]
    fn energy<T: Number>(&self, state: &State<T>) -> T {
        let State { e, ln_j, gap, .. } = state;
        let sum = trace(e);
        let quadratic = (sum * sum).scale(0.5 * self.trace) + double(e, e).scale(self.square);
        quadratic + gap.scale(self.barrier) + (*ln_j * *ln_j).scale(0.5 * self.volume)
    }

    /// S = a tr(E) I + 2 b E + m (I - B) + l ln(J) B, where I - B = 2 B E.
    #[inline(always)]
    fn stress<T: Number>(&self, state: &State<T>) -> Tensor<T> {
        let State { e, b, ln_j, .. } = state;
        let mut s = scaled(e, ln_j.like(2.0 * self.square));
        if self.has_volume() {
            s = plus(&s, ln_j.like(2.0 * self.barrier), &symmetric_product(b, e));
            s = plus(&s, ln_j.scale(self.volume), b);
        }
        plus_unit(&s, trace(e).scale(self.trace))
    }

    /// First Piola-Kirchhoff stress P = F S.
    #[inline(always)]
    fn answer<T: Number>(&self, h: &Tensor<T>) -> Answer<T> {
        let f = plus_unit(h, h[0][0].like(1.0));
        let e = green_lagrange(h);
        let state = match self.has_volume() {
            true => State::new(e),
            false => State::plain(e),
        };
        let zero = h[0][0].like(0.0);
        Answer {
            stress: product(&f, &self.stress(&state)),
            stored: self.energy(&state),
            hardening: zero,
            dissipated: zero,
            positive: determinant(&f).least(state.det),
        }
    }

    /// ∂S/∂E, with ∂ ln J/∂E = B and ∂B/∂E = -2 B⊙B.
    fn moduli(&self, state: &State<f64>) -> Moduli {
        Moduli {
            trace: self.trace,
            identity: 2.0 * self.square,
            product: self.volume,
            cross: 2.0 * (self.barrier - self.volume * state.ln_j),
            b: state.inverse(),
        }
    }

    /// [`Potential::answer`] with the derivative δ_ik S_JL + F_iM (∂S/∂E)_MJNL F_kN.
    fn response(&self, f: &Mat3, want: Want) -> Result<Response, Failure> {
        let h = rows(&(f - Mat3::identity()));
        let answer = self.answer(&h);
        positive(f.determinant())?;
        positive(answer.positive)?;
        let tangent = (want == Want::Tangent).then(|| {
            let state = State::new(green_lagrange(&h));
            let mut tangent = self.moduli(&state).pushed(f, f);
            add_geometric(&mut tangent, &matrix(&self.stress(&state)));
            tangent
        });
        Ok(Response::of(&answer, tangent))
    }

    /// P_alg = F_m S_alg of [`Potential::conserving`], F_m = (F_0 + F_1)/2, so that P_alg : (F_1 - F_0) = S_alg : D, because
    /// sym(F_mᵀ (F_1 - F_0)) = D. ∂P_alg/∂F_1 = S_alg/2 on each row, and F_m (∂S_alg/∂E_1) F_1.
    fn between(&self, f_0: &Mat3, f_1: &Mat3, want: Want) -> Result<Response, Failure> {
        positive(f_0.determinant())?;
        positive(f_1.determinant())?;
        let f_m = (f_0 + f_1) * 0.5;
        let product = f_m.tr_mul(&(f_1 - f_0));
        let d = (product + product.transpose()) * 0.5;
        let e_1 = strain(f_1);
        let e_m = (strain(f_0) + e_1) * 0.5;
        let algorithmic = self.conserving((e_m, e_1), &d, want)?;
        let s = algorithmic.stress;
        let tangent = (want == Want::Tangent).then(|| {
            let mut tangent = algorithmic.moduli.pushed(&f_m, f_1);
            add_geometric(&mut tangent, &(s * 0.5));
            if let Some(w) = algorithmic.slope {
                add_product(&mut tangent, &(f_m * d), &(f_1 * w));
            }
            tangent
        });
        Ok(Response {
            stress: f_m * s,
            tangent,
            stored: algorithmic.stored,
            hardening: 0.0,
            dissipated: 0.0,
        })
    }

    /// The same of strains.
    fn between_strains(&self, e_1: &Mat3, d: &Mat3, want: Want) -> Result<Conserving, Failure> {
        let algorithmic = self.conserving((e_1 - d * 0.5, *e_1), d, want)?;
        let moduli = (want == Want::Tangent).then(|| {
            let unit = Mat3::identity();
            let mut moduli = algorithmic.moduli.pushed(&unit, &unit);
            if let Some(w) = algorithmic.slope {
                add_product(&mut moduli, d, &w);
            }
            moduli
        });
        Ok(Conserving {
            stress: algorithmic.stress,
            moduli,
            stored: algorithmic.stored,
        })
    }

    /// Gonzalez' discrete gradient: with D = E_1 - E_0,
    ///
    /// S_alg = S(E_m) + x/(D:D) D,   x = ψ(E_1) - ψ(E_0) - S(E_m):D,
    ///
    /// so that S_alg : D = ψ(E_1) - ψ(E_0). x is of third order in D; taken from [`Potential::excess`] and not from the
    /// difference of energies it brings no noise into small steps.
    ///
    /// ∂S_alg/∂E_1 = (∂S/∂E)_m/2 + x/(D:D) 𝕀 + D⊗w,   w = (S_1 - S_m - (∂S/∂E)_m:D/2)/(D:D) - 2x/(D:D)² D.
    ///
    /// The stress is that of Gonzalez (2000), Comput. Methods Appl. Mech. Eng. 190, 1763, after Simo and Tarnow (1992), ZAMP 43,
    /// 757; the derivative is derived here.
    fn conserving(
        &self,
        (e_m, e_1): (Mat3, Mat3),
        d: &Mat3,
        want: Want,
    ) -> Result<Algorithmic, Failure> {
        let end = State::checked(&e_1)?;
        let middle = State::checked(&e_m)?;
        let length = d.norm_squared();
        let rate = if length > 0.0 {
            self.excess(&middle, d) / length
        } else {
            0.0
        };
        let s_m = matrix(&self.stress(&middle));
        let mut moduli = self.moduli(&middle).half();
        // below, D⊗w is smaller than the round-off of its parts
        let slope = (want == Want::Tangent && length > 1e-16).then(|| {
            let bent = matrix(&self.stress(&end)) - s_m - moduli.times(d);
            (bent - d * (2.0 * rate)) / length
        });
        moduli.identity += rate;
        Ok(Algorithmic {
            stress: s_m + d * rate,
            moduli,
            slope,
            stored: self.energy(&end),
        })
    }

    /// ψ(E_m + D/2) - ψ(E_m - D/2) - S(E_m):D without cancellation. The part quadratic in E has none. With
    ///
    /// det(C_m ± D)/det C_m = 1 ± a + b ± c,   a = B:D, b = C_m:cof(D)/det C_m, c = det(D)/det C_m,
    ///
    /// ln J_1 - ln J_0 = atanh t, t = (a + c)/(1 + b), and the mean of ln J_0 and ln J_1 is
    /// ln J_m + ln((1 + b)² - (a + c)²)/4.
    fn excess(&self, middle: &State<f64>, d: &Mat3) -> f64 {
        let c_m = Mat3::identity() + matrix(&middle.e) * 2.0;
        let a = middle.inverse().dot(d);
        let b = c_m.dot(&matrix(&cofactor(&rows(d)))) / middle.det;
        let c = d.determinant() / middle.det;
        let beyond = atanh_rest((a + c) / (1.0 + b)) + (c - a * b) / (1.0 + b);
        let shift = 0.25 * (b * (2.0 + b) - (a + c) * (a + c)).ln_1p();
        (self.volume * (middle.ln_j + shift) - self.barrier) * beyond + self.volume * shift * a
    }
}

/// Green-Lagrange strain of F.
fn strain(f: &Mat3) -> Mat3 {
    matrix(&green_lagrange(&rows(&(f - Mat3::identity()))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_of_atanh_has_all_its_digits_on_both_sides_of_the_threshold() {
        for t in [1e-8, 1e-3, 0.1, 0.1999, 0.2001, 0.7, -0.15, -0.9] {
            let terms = (1..400)
                .rev()
                .map(|k| f64::powi(t, 2 * k + 1) / f64::from(2 * k + 1));
            let sum: f64 = terms.sum();
            // above the threshold t itself, a hundred times the rest at most, is rounded
            assert!((atanh_rest(t) - sum).abs() < 2e-14 * sum.abs(), "{t}");
        }
    }
}
