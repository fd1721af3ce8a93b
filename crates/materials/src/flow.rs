//! Von Mises flow at finite strain, with any hardening.
//!
//! F = F_e F_p, b_e = F_e F_eᵀ, ε = ln(b_e)/2; Hencky energy ψ = κ/2 (tr ε)² + μ |dev ε|², with κ the bulk modulus;
//! Kirchhoff stress τ = κ tr(ε) I + 2 μ dev ε; yield at q = sqrt(3/2) |dev τ| = σ_y; associated flow, which keeps the
//! volume. The flow over a step is integrated by the exponential map, so that the return is the one of small strain on the
//! logarithmic strain of the trial state b_e = F C_p⁻¹ Fᵀ:
//!
//! q - 3μ Δε_p = σ_y(Δε_p), q = sqrt(3/2) 2μ |dev ε|, dev ε ← (1 - 3μ Δε_p/q) dev ε.
//!
//! The history is C_p⁻¹ - I (11, 22, 33, 12, 23, 13), ε_p, and what the hardening keeps beside it.
//! The method is that of Simo (1992), Comput. Methods Appl. Mech. Eng. 99, 61, and of de Souza Neto, Perić and Owen (2008),
//! Computational Methods for Plasticity, chapters 7 and 14; the formulas here are derived from it, not taken over.

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;

use crate::hardening::Hardening;
use crate::material::positive;
use crate::spectral::spectral;
use crate::tensor::{
    Tensor, cofactor, determinant, entries, pack, plus_unit, product, product_transposed, rows,
    scaled, symmetric_entries, transposed_product, unpack,
};
use crate::{Answer, Failure, Plane, Response, Tangent, Want};

/// Place of ε_p in the history.
pub(crate) const PLASTIC: usize = 6;

/// The state at the end of a step, in the principal axes of the trial b_e.
struct Return<T> {
    /// Eigenvalues of the trial b_e.
    beta: [T; 3],
    /// Trial logarithmic strains ln(β)/2.
    epsilon: [T; 3],
    /// Principal axes, as columns.
    n: Tensor<T>,
    /// Unit deviator of ε, and of the flow; zero where ε has none.
    flow: [T; 3],
    /// Norm of the trial deviator.
    norm: T,
    /// Increment of ε_p.
    slip: T,
    /// Slope of the yield stress there, Pa.
    slope: T,
    /// Von Mises stress at the end, Pa.
    stress: T,
    /// What the return leaves of the deviator, 1 - 3μ Δε_p/q.
    left: T,
    /// Principal Kirchhoff stresses.
    tau: [T; 3],
}

/// Von Mises flow with a hardening.
pub(crate) struct Flow<'a, H>(pub(crate) &'a H);

impl<H: Hardening> Flow<'_, H> {
    fn bulk_modulus(&self) -> f64 {
        self.0.elastic().lame_1(Plane::Full) + 2.0 / 3.0 * self.0.elastic().shear_modulus()
    }

    /// Return from the trial state of F = I + `h`, whose b_e - I = F (C_p⁻¹ - I) Fᵀ + H + Hᵀ + H Hᵀ: no digit is lost where all
    /// strains are small. Of use where all its eigenvalues `beta` are positive.
    #[inline(always)]
    fn returned<T: Number>(&self, h: &Tensor<T>, old: &[T], dt: f64) -> Return<T> {
        let f = plus_unit(h, h[0][0].like(1.0));
        let pushed = product_transposed(&product(&f, &unpack(old)), &f);
        let square = product_transposed(h, h);
        let beyond = symmetric_entries!(|i: usize, j: usize| {
            pushed[i][j] + (h[i][j] + h[j][i]) + square[i][j]
        });
        let (lambda, n) = spectral(&beyond);
        self.in_axes(lambda, n, (old, dt))
    }

    #[inline(always)]
    fn in_axes<T: Number>(
        &self,
        lambda: [T; 3],
        n: Tensor<T>,
        (old, dt): (&[T], f64),
    ) -> Return<T> {
        let mu = self.0.elastic().shear_modulus();
        let one = lambda[0].like(1.0);
        let [x, y, z] = lambda;
        let beta = [x + one, y + one, z + one];
        // no closure: it would not be inlined, and have no instruction set
        let epsilon = [
            x.ln_1p().scale(0.5),
            y.ln_1p().scale(0.5),
            z.ln_1p().scale(0.5),
        ];
        let sum = epsilon[0] + epsilon[1] + epsilon[2];
        let deviator = |a: usize| sum.mul_add(sum.like(-1.0 / 3.0), epsilon[a]);
        let deviator = [deviator(0), deviator(1), deviator(2)];
        let [x, y, z] = deviator;
        let square = x * x + y * y + z * z;
        let norm = square.sqrt();
        let q = norm.scale(6_f64.sqrt() * mu);
        let tiny = q.like(f64::MIN_POSITIVE);
        let [slip, slope] = self.0.slip(q, 3.0 * mu, &old[PLASTIC..], dt);
        let left = one - slip.scale(3.0 * mu) / q.most(tiny);
        let pressure = sum.scale(self.bulk_modulus());
        let kept = left.scale(2.0 * mu);
        let unit = one / norm.most(tiny);
        let tau = |x: T| x.mul_add(kept, pressure);
        let tau = [tau(x), tau(y), tau(z)];
        let flow = [x * unit, y * unit, z * unit];
        Return {
            beta,
            epsilon,
            n,
            flow,
            norm,
            slip,
            slope,
            stress: q * left,
            left,
            tau,
        }
    }

    /// ∂P/∂F. With the rate l = dF F⁻¹ in the principal axes,
    /// dP Fᵀ = dτ - τ lᵀ,   dτ_aa = Σ_c a_ac l_cc,   dτ_ab = w_ab (l_ab β_b + β_a l_ba) for a ≠ b,
    ///
    /// a = κ + 2μ left (δ - 1/3) + 6μ² (Δε_p/q - 1/(3μ + dσ_y/dΔε_p)) flow flow the consistent modulus of the return at small strain, and
    /// w_ab = (τ_a - τ_b)/(β_a - β_b) = 2μ left (ε_a - ε_b)/(β_a - β_b), whose limit at equal eigenvalues is 1/(2β):
    /// the return scales the deviator, so that only the logarithm is left to divide.
    /// `g` is Nᵀ F⁻ᵀ; where nothing `flows` further, a is that without the last term.
    fn tangent(&self, at: &Return<f64>, g: &Tensor<f64>, flows: bool) -> Box<Tangent> {
        let (mu, bulk) = (self.0.elastic().shear_modulus(), self.bulk_modulus());
        let two_mu = 2.0 * mu * at.left;
        let softer = if flows {
            let q = 6_f64.sqrt() * mu * at.norm;
            6.0 * mu * mu * (at.slip / q - 1.0 / (3.0 * mu + at.slope))
        } else {
            0.0
        };
        // dyads[3 a + b] = n_a ⊗ (row b of g): what l_ab is taken from, and what the stress ab goes to
        let dyads: [[f64; 9]; 9] = std::array::from_fn(|ab| {
            std::array::from_fn(|ij| at.n[ij / 3][ab / 3] * g[ab % 3][ij % 3])
        });
        let mut tangent = Box::new([[0.0; 9]; 9]);
        for a in 0..3 {
            for b in 0..3 {
                let mut row = [0.0; 9];
                let mut add = |factor: f64, dyad: &[f64; 9]| {
                    for (x, y) in row.iter_mut().zip(dyad) {
                        *x += factor * y;
                    }
                };
                if a == b {
                    for c in 0..3 {
                        let plain = bulk - two_mu / 3.0 + softer * at.flow[a] * at.flow[c];
                        let own = if a == c { two_mu - at.tau[a] } else { 0.0 };
                        add(plain + own, &dyads[4 * c]);
                    }
                } else {
                    let w = two_mu * log_quotient(at, a, b);
                    add(w * at.beta[b], &dyads[3 * a + b]);
                    add(w * at.beta[a] - at.tau[a], &dyads[3 * b + a]);
                }
                for (line, x) in tangent.iter_mut().zip(&dyads[3 * a + b]) {
                    for (entry, y) in line.iter_mut().zip(&row) {
                        *entry += x * y;
                    }
                }
            }
        }
        tangent
    }
}

/// (ε_a - ε_b)/(β_a - β_b), to round-off however near the eigenvalues are.
fn log_quotient(at: &Return<f64>, a: usize, b: usize) -> f64 {
    let z = (at.beta[a] - at.beta[b]) / at.beta[b];
    if z == 0.0 {
        0.5 / at.beta[b]
    } else if z.abs() < 0.5 {
        0.5 * z.ln_1p() / z / at.beta[b]
    } else {
        (at.epsilon[a] - at.epsilon[b]) / (at.beta[a] - at.beta[b])
    }
}

impl<H: Hardening> Flow<'_, H> {
    /// Stress, energies and history of a return, and Nᵀ F⁻ᵀ.
    #[inline(always)]
    fn answered<T: Number>(
        &self,
        (at, h): (&Return<T>, &Tensor<T>),
        old: &[T],
        new: &mut [T],
    ) -> (Answer<T>, Tensor<T>) {
        let f = plus_unit(h, h[0][0].like(1.0));
        let det = determinant(&f);
        let g = transposed_product(&at.n, &scaled(&cofactor(&f), det.like(1.0) / det));
        // the flow sqrt(3/2) Δε_p of ε changes β by the factor exp(-2 flow); F⁻¹ pulls the change back to C_p⁻¹
        let change = [
            at.beta[0] * shrink(at.slip, at.flow[0]),
            at.beta[1] * shrink(at.slip, at.flow[1]),
            at.beta[2] * shrink(at.slip, at.flow[2]),
        ];
        let turned = entries!(|a: usize, j: usize| g[a][j] * change[a]);
        let weighted = entries!(|a: usize, j: usize| g[a][j] * at.tau[a]);
        let positive = det.least(at.beta[0]).least(at.beta[1]).least(at.beta[2]);
        let pulled = transposed_product(&g, &turned);
        let metric = unpack(old);
        let updated = entries!(|i: usize, j: usize| metric[i][j] + pulled[i][j]);
        pack(&updated, new);
        new[PLASTIC] = old[PLASTIC] + at.slip;
        let kept = (&old[PLASTIC..], &mut new[PLASTIC..]);
        let [hardening, dissipated] = self.0.spent(at.slip, at.stress, kept);
        let sum = at.epsilon[0] + at.epsilon[1] + at.epsilon[2];
        let deviator = at.left * at.norm;
        let stored = (sum * sum).scale(0.5 * self.bulk_modulus())
            + (deviator * deviator).scale(self.0.elastic().shear_modulus());
        let answer = Answer {
            stress: product(&at.n, &weighted),
            stored,
            hardening,
            dissipated,
            positive,
        };
        (answer, g)
    }

    /// As [`Pointwise::answer`](crate::Pointwise).
    #[inline(always)]
    pub(crate) fn answer<T: Number>(
        &self,
        h: &Tensor<T>,
        dt: f64,
        (old, new): (&[T], &mut [T]),
    ) -> Answer<T> {
        let at = self.returned(h, old, dt);
        self.answered((&at, h), old, new).0
    }

    /// As [`Material::update`](crate::Material).
    pub(crate) fn update(
        &self,
        f: &Mat3,
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
        want: Want,
    ) -> Result<Response, Failure> {
        positive(f.determinant())?;
        let h = rows(&(f - Mat3::identity()));
        let at = self.returned(&h, old, dt);
        let (answer, g) = self.answered((&at, &h), old, new);
        positive(answer.positive)?;
        let flows = want == Want::Tangent && at.slip > 0.0;
        let tangent = want.has_tangent().then(|| self.tangent(&at, &g, flows));
        Ok(Response::of(&answer, tangent))
    }
}

/// The laws of parameters with a hardening, at finite strain, under uniaxial and under plane stress; they have no stored energy alone.
macro_rules! flows {
    ($law:ident) => {
        impl $crate::Pointwise for $law {
            #[inline(always)]
            fn answer<T: carom_algebra::number::Number>(
                &self,
                h: &$crate::Tensor<T>,
                dt: f64,
                old: &[T],
                new: &mut [T],
            ) -> $crate::Answer<T> {
                $crate::flow::Flow(self).answer(h, dt, (old, new))
            }
        }

        impl $crate::Material for $law {
            fn history_len(&self) -> usize {
                $crate::flow::PLASTIC + 1 + $crate::hardening::Hardening::further(self)
            }

            fn start(&self, history: &mut [f64]) {
                history.fill(0.0);
            }

            fn update(
                &self,
                f: &carom_algebra::tensor::Mat3,
                dt: f64,
                history: (&[f64], &mut [f64]),
                want: $crate::Want,
            ) -> Result<$crate::Response, $crate::Failure> {
                $crate::flow::Flow(self).update(f, dt, history, want)
            }

            fn between(
                &self,
                _f_0: &carom_algebra::tensor::Mat3,
                _f_1: &carom_algebra::tensor::Mat3,
                _want: $crate::Want,
            ) -> Option<Result<$crate::Response, $crate::Failure>> {
                None
            }

            fn between_strains(
                &self,
                _e_1: &carom_algebra::tensor::Mat3,
                _d: &carom_algebra::tensor::Mat3,
                _want: $crate::Want,
            ) -> Option<Result<$crate::Conserving, $crate::Failure>> {
                None
            }

            fn initial(&self) -> $crate::Elastic {
                self.initial
            }
        }

        impl $crate::Uniaxial for $law {
            fn history_len(&self) -> usize {
                $crate::uniaxial::PLASTIC + 1 + $crate::hardening::Hardening::further(self)
            }

            fn young(&self) -> f64 {
                self.initial.young
            }

            fn update(
                &self,
                strain: f64,
                dt: f64,
                history: (&[f64], &mut [f64]),
            ) -> $crate::UniaxialResponse {
                $crate::uniaxial::update(self, strain, dt, history)
            }
        }

        impl $crate::PlaneStress for $law {
            fn history_len(&self) -> usize {
                $crate::plane_points::PLASTIC + 1 + $crate::hardening::Hardening::further(self)
            }

            fn stress(&self, strain: &[f64; 3], history: &[f64]) -> [f64; 3] {
                $crate::plane_stress::stress(self, strain, history)
            }

            fn update(
                &self,
                strain: &[f64; 3],
                dt: f64,
                history: (&[f64], &mut [f64]),
            ) -> $crate::PlaneStressResponse {
                $crate::plane_stress::update(self, strain, dt, history)
            }

            fn side_by_side(&self, dt: f64, points: &mut $crate::PlaneStressPoints) {
                $crate::side_by_side::update(self, dt, points);
            }
        }
    };
}
pub(crate) use flows;

/// exp(-2 flow) - 1.
#[inline(always)]
fn shrink<T: Number>(slip: T, flow: T) -> T {
    (slip * flow).scale(-6_f64.sqrt()).exp_m1()
}
