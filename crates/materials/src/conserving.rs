//! The algorithmic stress of a hyperelastic law in a step that does exactly the work of the energy difference: Gonzalez' discrete
//! gradient.
//!
//! With D = E_1 - E_0,
//!
//! S_alg = S(E_m) + x/(D:D) D,   x = ψ(E_1) - ψ(E_0) - S(E_m):D,
//!
//! so that S_alg : D = ψ(E_1) - ψ(E_0). x is of third order in D; taken from [`Potential::excess`] and not from the
//! difference of energies it brings no noise into small steps.
//!
//! ∂S_alg/∂E_1 = (∂S/∂E)_m/2 + x/(D:D) 𝕀 + D⊗w,   w = (S_1 - S_m - (∂S/∂E)_m:D/2)/(D:D) - 2x/(D:D)² D.
//!
//! The stress is that of Gonzalez (2000), Comput. Methods Appl. Mech. Eng. 190, 1763, after Simo and Tarnow (1992), ZAMP 43,
//! 757; the derivative is derived here.

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;

use crate::hyperelastic::{NEAR, Potential, State, atanh_series};
use crate::lagrange::{Derivative, Moduli};
use crate::material::positive;
use crate::tensor::{
    Tensor, cofactor, determinant, double, green_lagrange, matrix, plus, plus_unit, product, rows,
    scaled, symmetric_entries, transposed_product,
};
use crate::{Answer, Conserving, Failure, Response, Want};

/// The discrete gradient of a step.
struct Algorithmic<T> {
    /// S_alg in Pa.
    stress: Tensor<T>,
    /// x/(D:D).
    rate: T,
    middle: State<T>,
    end: State<T>,
}

/// A step between two deformation gradients.
struct Path<T> {
    /// F_m = (F_0 + F_1)/2.
    f_m: Tensor<T>,
    /// (E_0 + E_1)/2 and E_1.
    e_m: Tensor<T>,
    e_1: Tensor<T>,
    /// D.
    d: Tensor<T>,
}

impl<T: Number> Path<T> {
    /// D = sym(F_mᵀ (F_1 - F_0)): small steps keep their digits.
    #[inline(always)]
    fn new([h_0, h_1]: [&Tensor<T>; 2]) -> Path<T> {
        let one = h_0[0][0].like(1.0);
        let (half, e_1) = (one.scale(0.5), green_lagrange(h_1));
        let f_m = plus_unit(&scaled(&plus(h_1, one, h_0), half), one);
        let square = transposed_product(&f_m, &plus(h_1, -one, h_0));
        Path {
            d: symmetric_entries!(|i: usize, j: usize| (square[i][j] + square[j][i]).scale(0.5)),
            e_m: scaled(&plus(&green_lagrange(h_0), one, &e_1), half),
            f_m,
            e_1,
        }
    }
}

/// atanh(t) - t, to its last digits for small t; of use for |t| < 1.
#[inline(always)]
fn atanh_rest<T: Number>(t: T) -> T {
    let one = t.like(1.0);
    let far = ((t + t) / (one - t)).ln_1p().scale(0.5) - t;
    t.abs().if_below(t.like(NEAR), atanh_series(t), far)
}

impl Potential {
    /// P_alg = F_m S_alg, so that P_alg : (F_1 - F_0) = S_alg : D.
    #[inline(always)]
    pub(crate) fn answer_between<T: Number>(&self, h: [&Tensor<T>; 2]) -> Answer<T> {
        let path = Path::new(h);
        let algorithmic = self.conserving((path.e_m, path.e_1), &path.d);
        self.answer_on(&path, h, &algorithmic)
    }

    #[inline(always)]
    fn answer_on<T: Number>(
        &self,
        path: &Path<T>,
        h: [&Tensor<T>; 2],
        algorithmic: &Algorithmic<T>,
    ) -> Answer<T> {
        let one = path.f_m[0][0].like(1.0);
        let [begin, end] = h.map(|h| determinant(&plus_unit(h, one)));
        let answer = self.answer_of(algorithmic);
        Answer {
            stress: product(&path.f_m, &answer.stress),
            positive: begin.least(end).least(answer.positive),
            ..answer
        }
    }

    /// S_alg of a step to a strain that changes it by D.
    #[inline(always)]
    pub(crate) fn answer_between_strains<T: Number>(
        &self,
        e_1: &Tensor<T>,
        d: &Tensor<T>,
    ) -> Answer<T> {
        let e_m = plus(e_1, d[0][0].like(-0.5), d);
        self.answer_of(&self.conserving((e_m, *e_1), d))
    }

    #[inline(always)]
    fn answer_of<T: Number>(&self, algorithmic: &Algorithmic<T>) -> Answer<T> {
        let Algorithmic { middle, end, .. } = algorithmic;
        let zero = end.det.like(0.0);
        Answer {
            stress: algorithmic.stress,
            stored: self.energy(end),
            hardening: zero,
            dissipated: zero,
            positive: middle.det.least(end.det),
        }
    }

    /// S_alg, where there is one.
    #[inline(always)]
    fn conserving<T: Number>(
        &self,
        (e_m, e_1): (Tensor<T>, Tensor<T>),
        d: &Tensor<T>,
    ) -> Algorithmic<T> {
        let (middle, end) = (self.state(e_m), self.state(e_1));
        let (length, zero) = (double(d, d), d[0][0].like(0.0));
        // an energy quadratic in E has no excess
        let rate = match self.has_volume() {
            true => zero.if_below(length, self.excess(&middle, d) / length, zero),
            false => zero,
        };
        Algorithmic {
            stress: plus(&self.stress(&middle), rate, d),
            rate,
            middle,
            end,
        }
    }

    /// ψ(E_m + D/2) - ψ(E_m - D/2) - S(E_m):D without cancellation. The part quadratic in E has none. With
    ///
    /// det(C_m ± D)/det C_m = 1 ± a + b ± c,   a = B:D, b = C_m:cof(D)/det C_m, c = det(D)/det C_m,
    ///
    /// ln J_1 - ln J_0 = atanh t, t = (a + c)/(1 + b), and the mean of ln J_0 and ln J_1 is
    /// ln J_m + ln((1 + b)² - (a + c)²)/4.
    #[inline(always)]
    fn excess<T: Number>(&self, middle: &State<T>, d: &Tensor<T>) -> T {
        let (one, two) = (middle.det.like(1.0), middle.det.like(2.0));
        let c_m = plus_unit(&scaled(&middle.e, two), one);
        let a = double(&middle.b, d);
        let b = double(&c_m, &cofactor(d)) / middle.det;
        let c = determinant(d) / middle.det;
        let (sum, mean) = (a + c, one / (one + b));
        let beyond = atanh_rest(sum * mean) + (c - a * b) * mean;
        let shift = (b * (two + b) - sum * sum).ln_1p().scale(0.25);
        let volume = shift.like(self.volume);
        (volume * (middle.ln_j + shift) - shift.like(self.barrier)) * beyond + volume * shift * a
    }

    /// [`Potential::answer_between`] with its derivative: ∂P_alg/∂F_1 = S_alg/2 on each row, and F_m (∂S_alg/∂E_1) F_1.
    pub(crate) fn between(&self, f: [&Mat3; 2], want: Want) -> Result<Response, Failure> {
        for f in f {
            positive(f.determinant())?;
        }
        let [h_0, h_1] = f.map(|f| rows(&(f - Mat3::identity())));
        let path = Path::new([&h_0, &h_1]);
        let algorithmic = self.conserving((path.e_m, path.e_1), &path.d);
        let answer = self.answer_on(&path, [&h_0, &h_1], &algorithmic);
        positive(answer.positive)?;
        let tangent = want.has_tangent().then(|| {
            let sides = [path.f_m, rows(f[1])];
            self.derivative_on(&algorithmic, (sides, &path.d)).tangent()
        });
        Ok(Response::of(&answer, tangent))
    }

    /// [`Potential::answer_between_strains`] with its derivative.
    pub(crate) fn between_strains(
        &self,
        e_1: &Mat3,
        d: &Mat3,
        want: Want,
    ) -> Result<Conserving, Failure> {
        for e in [e_1, &(e_1 - d * 0.5)] {
            positive((Mat3::identity() + e * 2.0).determinant())?;
        }
        let (strain, change) = (rows(e_1), rows(d));
        let algorithmic = self.conserving((rows(&(e_1 - d * 0.5)), strain), &change);
        let answer = self.answer_of(&algorithmic);
        let moduli = want.has_tangent().then(|| {
            let unit = rows(&Mat3::identity());
            let derivative = self.derivative_on(&algorithmic, ([unit, unit], &change));
            let of_strain = Derivative {
                stress: [[0.0; 3]; 3],
                ..derivative
            };
            of_strain.tangent()
        });
        Ok(Conserving {
            stress: matrix(&answer.stress),
            moduli,
            stored: answer.stored,
        })
    }

    /// Derivative of the stress of [`Potential::answer_between`] by F_1: S_alg/2 on each row, and F_m (∂S_alg/∂E_1) F_1.
    #[inline(always)]
    pub(crate) fn derivative_between<T: Number>(&self, h: [&Tensor<T>; 2]) -> Derivative<T> {
        let path = Path::new(h);
        let one = path.f_m[0][0].like(1.0);
        let algorithmic = self.conserving((path.e_m, path.e_1), &path.d);
        let [f_0, f_1] = h.map(|h| plus_unit(h, one));
        let ends = determinant(&f_0).least(determinant(&f_1));
        let derivative = self.derivative_on(&algorithmic, ([path.f_m, f_1], &path.d));
        Derivative {
            positive: ends.least(derivative.positive),
            ..derivative
        }
    }

    /// The parts of the derivative of L S_alg with these sides L and R.
    #[inline(always)]
    fn derivative_on<T: Number>(
        &self,
        of: &Algorithmic<T>,
        (sides, d): ([Tensor<T>; 2], &Tensor<T>),
    ) -> Derivative<T> {
        let (moduli, w) = self.moduli_between(of, d);
        let [left, right] = &sides;
        Derivative {
            bent: Some([product(left, d), product(right, &w)]),
            sides,
            moduli,
            stress: scaled(&of.stress, of.rate.like(0.5)),
            positive: of.middle.det.least(of.end.det),
        }
    }

    /// ∂S_alg/∂E_1 without D⊗w, and w, nothing where it is too small.
    #[inline(always)]
    fn moduli_between<T: Number>(
        &self,
        of: &Algorithmic<T>,
        d: &Tensor<T>,
    ) -> (Moduli<T>, Tensor<T>) {
        let (length, zero) = (double(d, d), of.rate.like(0.0));
        let mut moduli = self.moduli(&of.middle).half();
        let change = plus(
            &self.stress(&of.end),
            zero.like(-1.0),
            &self.stress(&of.middle),
        );
        let bent = plus(&change, zero.like(-1.0), &moduli.times(d));
        let bent = plus(&bent, of.rate.scale(-2.0), d);
        // below, D⊗w is smaller than the round-off of its parts
        let least = length.like(1e-16);
        let inverse = least.if_below(length, length.like(1.0) / length, zero);
        moduli.identity += of.rate;
        (moduli, scaled(&bent, inverse))
    }
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
