//! Laws that have a stored energy alone: the form that they share, its stress and tangent. `conserving.rs` has the algorithmic
//! stress of a step that does exactly the work of the energy difference.

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;

use crate::lagrange::{Derivative, Moduli};
use crate::material::positive;
use crate::tensor::{
    Tensor, cofactor, determinant, double, green_lagrange, plus, plus_unit, product, rows, scaled,
    symmetric_product, trace,
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

    #[inline(always)]
    fn between<T: Number>(&self, h: [&Tensor<T>; 2]) -> Option<Answer<T>> {
        Some(self.potential().answer_between(h))
    }

    #[inline(always)]
    fn between_strains<T: Number>(&self, e_1: &Tensor<T>, d: &Tensor<T>) -> Option<Answer<T>> {
        Some(self.potential().answer_between_strains(e_1, d))
    }

    #[inline(always)]
    fn derivative<T: Number>(
        &self,
        h: &Tensor<T>,
        from: Option<&Tensor<T>>,
    ) -> Option<Derivative<T>> {
        let potential = self.potential();
        Some(match from {
            Some(from) => potential.derivative_between([from, h]),
            None => potential.derivative(h),
        })
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
        Some(self.potential().between([f_0, f_1], want))
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
pub(crate) struct State<T> {
    pub(crate) e: Tensor<T>,
    /// B = C⁻¹ = (I + 2E)⁻¹.
    pub(crate) b: Tensor<T>,
    /// det C.
    pub(crate) det: T,
    /// ln J.
    pub(crate) ln_j: T,
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
pub(crate) const NEAR: f64 = 0.2;

/// atanh(t) - t = t³/3 + t⁵/5 + ..., to its last digits for |t| below [`NEAR`].
#[inline(always)]
pub(crate) fn atanh_series<T: Number>(t: T) -> T {
    let square = t * t;
    let mut series = t.like(0.0);
    for &c in ATANH.iter().rev() {
        series = series.mul_add(square, t.like(c));
    }
    series * square * t
}

impl Potential {
    /// Whether it has parts that are functions of the volume.
    #[inline(always)]
    pub(crate) fn has_volume(&self) -> bool {
        self.barrier != 0.0 || self.volume != 0.0
    }

    /// What it asks of a strain.
    #[inline(always)]
    pub(crate) fn state<T: Number>(&self, e: Tensor<T>) -> State<T> {
        match self.has_volume() {
            true => State::new(e),
            false => State::plain(e),
        }
    }

    #[inline(always)]
    pub(crate) fn energy<T: Number>(&self, state: &State<T>) -> T {
        let State { e, ln_j, gap, .. } = state;
        let sum = trace(e);
        let quadratic = (sum * sum).scale(0.5 * self.trace) + double(e, e).scale(self.square);
        quadratic + gap.scale(self.barrier) + (*ln_j * *ln_j).scale(0.5 * self.volume)
    }

    /// S = a tr(E) I + 2 b E + m (I - B) + l ln(J) B, where I - B = 2 B E.
    #[inline(always)]
    pub(crate) fn stress<T: Number>(&self, state: &State<T>) -> Tensor<T> {
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
        let state = self.state(e);
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
    #[inline(always)]
    pub(crate) fn moduli<T: Number>(&self, state: &State<T>) -> Moduli<T> {
        let ln_j = state.ln_j;
        Moduli {
            trace: ln_j.like(self.trace),
            identity: ln_j.like(2.0 * self.square),
            product: ln_j.like(self.volume),
            cross: ln_j.scale_add(-2.0 * self.volume, ln_j.like(2.0 * self.barrier)),
            b: state.b,
        }
    }

    /// Derivative of the stress of [`Potential::answer`], δ_ik S_JL + F_iM (∂S/∂E)_MJNL F_kN.
    #[inline(always)]
    pub(crate) fn derivative<T: Number>(&self, h: &Tensor<T>) -> Derivative<T> {
        let f = plus_unit(h, h[0][0].like(1.0));
        let state = self.state(green_lagrange(h));
        Derivative {
            sides: [f, f],
            moduli: self.moduli(&state),
            stress: self.stress(&state),
            bent: None,
            positive: determinant(&f).least(state.det),
        }
    }

    /// [`Potential::answer`] with its derivative.
    fn response(&self, f: &Mat3, want: Want) -> Result<Response, Failure> {
        let h = rows(&(f - Mat3::identity()));
        let answer = self.answer(&h);
        positive(f.determinant())?;
        positive(answer.positive)?;
        let tangent = want.has_tangent().then(|| self.derivative(&h).tangent());
        Ok(Response::of(&answer, tangent))
    }
}
