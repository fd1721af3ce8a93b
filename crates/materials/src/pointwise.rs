//! Stress and energy of a law at one point of one element, or of W elements at a time.

use carom_algebra::number::Number;

use crate::tensor::{Tensor, double, entries, plus_unit, trace};
use crate::{Derivative, Elastic, Plane};

/// Most numbers that a law may keep of a point.
pub const MAX_KEPT: usize = 30;

/// What a law answers at a point. Stress and energies are of no use where `positive` is not.
#[derive(Clone, Copy, Debug)]
pub struct Answer<T> {
    /// First Piola-Kirchhoff stress P in Pa.
    pub stress: Tensor<T>,
    /// Energy per reference volume that elastic strain stores, in J/m³.
    pub stored: T,
    /// Energy per reference volume that hardening stores, in J/m³.
    pub hardening: T,
    /// Energy per reference volume dissipated since the old history, in J/m³, not negative.
    pub dissipated: T,
    /// det F, or what else is positive only as long as the law gives a stress.
    pub positive: T,
}

/// A law that any [`Number`] can be asked of. Calls are inlined into the sweeps, so that they take their instruction set.
pub trait Pointwise {
    /// Answer at F = I + `h` at the end of a step of `dt` (s) that began with the history `old`; writes the history there into
    /// `new`. All nine components of H, as in [`Material`](crate::Material).
    fn answer<T: Number>(&self, h: &Tensor<T>, dt: f64, old: &[T], new: &mut [T]) -> Answer<T>;

    /// P_alg in the place of P, of a step from F_0 = I + `h[0]` to F_1 = I + `h[1]`, as [`Material::between`](crate::Material);
    /// `stored` is ψ(F_1). None of a law without.
    #[inline(always)]
    fn between<T: Number>(&self, _h: [&Tensor<T>; 2]) -> Option<Answer<T>> {
        None
    }

    /// S_alg in the place of P, of a step to the strain `e_1` that changes it by `d`, as
    /// [`Material::between_strains`](crate::Material). None of a law without.
    #[inline(always)]
    fn between_strains<T: Number>(&self, _e_1: &Tensor<T>, _d: &Tensor<T>) -> Option<Answer<T>> {
        None
    }

    /// ∂P/∂F at F = I + `h`, or ∂P_alg/∂F_1 of a step to it from F_0 = I + `from`. None of a law that has no stored energy alone,
    /// whose tangents are those of [`Material::update`](crate::Material).
    #[inline(always)]
    fn derivative<T: Number>(
        &self,
        _h: &Tensor<T>,
        _from: Option<&Tensor<T>>,
    ) -> Option<Derivative<T>> {
        None
    }
}

/// σ = λ tr(ε) I + 2 μ ε of the small strain ε = sym H in the place of P.
impl Pointwise for Elastic {
    #[inline(always)]
    fn answer<T: Number>(&self, h: &Tensor<T>, _dt: f64, _old: &[T], _new: &mut [T]) -> Answer<T> {
        let (lambda, mu) = (self.lame_1(Plane::Full), self.shear_modulus());
        let stress = entries!(|i: usize, j: usize| (h[i][j] + h[j][i]).scale(mu));
        let stress = plus_unit(&stress, trace(h).scale(lambda));
        let zero = h[0][0].like(0.0);
        Answer {
            stored: double(&stress, h).scale(0.5),
            stress,
            hardening: zero,
            dissipated: zero,
            positive: zero.like(1.0),
        }
    }
}
