//! Metal plasticity at finite strain.

use carom_algebra::number::Number;
use carom_algebra::tensor::Mat3;
use carom_quantities::{Modulus, Stress};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::lagrange::positive;
use crate::range::{OutOfRange, require};
use crate::spectral::spectral;
use crate::tensor::{
    Tensor, cofactor, determinant, entries, pack, plus_unit, product, product_transposed, rows,
    scaled, symmetric_entries, transposed_product, unpack,
};
use crate::{
    Answer, Conserving, Elastic, Failure, Material, Parameters, Plane, Pointwise, Response,
    Tangent, Want,
};

/// J2 (von Mises) plasticity with linear isotropic hardening, in logarithmic strain.
///
/// F = F_e F_p, b_e = F_e F_eᵀ, ε = ln(b_e)/2; Hencky energy ψ = κ/2 (tr ε)² + μ |dev ε|², with κ the bulk modulus;
/// Kirchhoff stress τ = κ tr(ε) I + 2 μ dev ε; yield at sqrt(3/2) |dev τ| = σ_y + H ε_p; associated flow, which keeps the
/// volume. The flow over a step is integrated by the exponential map, so that the return is the one of small strain on the
/// logarithmic strain of the trial state b_e = F C_p⁻¹ Fᵀ, in closed form for linear hardening:
///
/// Δε_p = (q - σ_y - H ε_p)/(3μ + H), q = sqrt(3/2) 2μ |dev ε|, dev ε ← (1 - 3μ Δε_p/q) dev ε.
///
/// Stored: ψ; in hardening H ε_p²/2; dissipated in a step σ_y Δε_p. The history is C_p⁻¹ - I (11, 22, 33, 12, 23, 13) and ε_p.
/// The method is that of Simo (1992), Comput. Methods Appl. Mech. Eng. 99, 61, and of de Souza Neto, Perić and Owen (2008),
/// Computational Methods for Plasticity, chapters 7 and 14; the formulas here are derived from it, not taken over.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Von Mises plasticity.", extend("additionalProperties" = false))]
pub struct J2Plasticity {
    /// The law at small elastic strain, with the density.
    #[serde(flatten)]
    pub initial: Elastic,
    /// Yield stress σ_y of the virgin material, Pa.
    #[serde(deserialize_with = "Modulus::si")]
    #[schemars(with = "Modulus", description = "Yield stress of the virgin material.")]
    pub yield_stress: f64,
    /// Hardening modulus H in Pa: slope of the yield stress over the plastic strain.
    #[serde(deserialize_with = "Stress::si")]
    #[schemars(
        with = "Stress",
        description = "Yield stress gained per unit of plastic strain."
    )]
    pub hardening: f64,
}

impl Parameters for J2Plasticity {
    fn finite(&self) -> Option<&dyn Material> {
        Some(self)
    }

    fn undeformed(&self) -> Elastic {
        self.initial
    }

    fn check(&self) -> Result<(), OutOfRange> {
        self.initial.check()?;
        require(
            "yield-stress",
            self.yield_stress,
            self.yield_stress > 0.0,
            "positive",
        )?;
        require(
            "hardening",
            self.hardening,
            self.hardening >= 0.0,
            "zero or positive",
        )
    }

    fn dissipates(&self) -> bool {
        true
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        Some(J2Plasticity::plastic_strain(history))
    }
}

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
    /// What the return leaves of the deviator, 1 - 3μ Δε_p/q.
    left: T,
    /// Principal Kirchhoff stresses.
    tau: [T; 3],
}

impl J2Plasticity {
    /// ε_p of the history of a point.
    pub fn plastic_strain(history: &[f64]) -> f64 {
        history[6]
    }

    fn bulk_modulus(&self) -> f64 {
        self.initial.lame_1(Plane::Full) + 2.0 / 3.0 * self.initial.shear_modulus()
    }

    /// Return from the trial state of F = I + `h`, whose b_e - I = F (C_p⁻¹ - I) Fᵀ + H + Hᵀ + H Hᵀ: no digit is lost where all
    /// strains are small. Of use where all its eigenvalues `beta` are positive.
    #[inline(always)]
    fn returned<T: Number>(&self, h: &Tensor<T>, old: &[T]) -> Return<T> {
        let f = plus_unit(h, h[0][0].like(1.0));
        let pushed = product_transposed(&product(&f, &unpack(old)), &f);
        let square = product_transposed(h, h);
        let beyond = symmetric_entries!(|i: usize, j: usize| {
            pushed[i][j] + (h[i][j] + h[j][i]) + square[i][j]
        });
        let (lambda, n) = spectral(&beyond);
        self.in_axes(lambda, n, old[6])
    }

    #[inline(always)]
    fn in_axes<T: Number>(&self, lambda: [T; 3], n: Tensor<T>, plastic: T) -> Return<T> {
        let mu = self.initial.shear_modulus();
        let (zero, one) = (plastic.like(0.0), plastic.like(1.0));
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
        let beyond_yield = q - plastic.mul_add(q.like(self.hardening), q.like(self.yield_stress));
        let tiny = q.like(f64::MIN_POSITIVE);
        let slip = beyond_yield
            .most(zero)
            .scale(1.0 / (3.0 * mu + self.hardening));
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
            left,
            tau,
        }
    }

    /// ∂P/∂F. With the rate l = dF F⁻¹ in the principal axes,
    /// dP Fᵀ = dτ - τ lᵀ,   dτ_aa = Σ_c a_ac l_cc,   dτ_ab = w_ab (l_ab β_b + β_a l_ba) for a ≠ b,
    ///
    /// a = κ + 2μ left (δ - 1/3) + 6μ² (Δε_p/q - 1/(3μ + H)) flow flow the consistent modulus of the return at small strain, and
    /// w_ab = (τ_a - τ_b)/(β_a - β_b) = 2μ left (ε_a - ε_b)/(β_a - β_b), whose limit at equal eigenvalues is 1/(2β):
    /// the return scales the deviator, so that only the logarithm is left to divide.
    /// `g` is Nᵀ F⁻ᵀ.
    fn tangent(&self, at: &Return<f64>, g: &Tensor<f64>) -> Box<Tangent> {
        let (mu, bulk) = (self.initial.shear_modulus(), self.bulk_modulus());
        let two_mu = 2.0 * mu * at.left;
        let softer = if at.slip > 0.0 {
            let q = 6_f64.sqrt() * mu * at.norm;
            6.0 * mu * mu * (at.slip / q - 1.0 / (3.0 * mu + self.hardening))
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

impl J2Plasticity {
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
        new[6] = old[6] + at.slip;
        let sum = at.epsilon[0] + at.epsilon[1] + at.epsilon[2];
        let deviator = at.left * at.norm;
        let stored = (sum * sum).scale(0.5 * self.bulk_modulus())
            + (deviator * deviator).scale(self.initial.shear_modulus());
        let answer = Answer {
            stress: product(&at.n, &weighted),
            stored,
            hardening: (new[6] * new[6]).scale(0.5 * self.hardening),
            dissipated: at.slip.scale(self.yield_stress),
            positive,
        };
        (answer, g)
    }
}

/// exp(-2 flow) - 1.
#[inline(always)]
fn shrink<T: Number>(slip: T, flow: T) -> T {
    (slip * flow).scale(-6_f64.sqrt()).exp_m1()
}

impl Pointwise for J2Plasticity {
    #[inline(always)]
    fn answer<T: Number>(&self, h: &Tensor<T>, _dt: f64, old: &[T], new: &mut [T]) -> Answer<T> {
        let at = self.returned(h, old);
        self.answered((&at, h), old, new).0
    }
}

impl Material for J2Plasticity {
    fn history_len(&self) -> usize {
        7
    }

    fn start(&self, history: &mut [f64]) {
        history.fill(0.0);
    }

    fn update(
        &self,
        f: &Mat3,
        _dt: f64,
        (old, new): (&[f64], &mut [f64]),
        want: Want,
    ) -> Result<Response, Failure> {
        positive(f.determinant())?;
        let h = rows(&(f - Mat3::identity()));
        let at = self.returned(&h, old);
        let (answer, g) = self.answered((&at, &h), old, new);
        positive(answer.positive)?;
        let tangent = (want == Want::Tangent).then(|| self.tangent(&at, &g));
        Ok(Response::of(&answer, tangent))
    }

    fn between(&self, _f_0: &Mat3, _f_1: &Mat3, _want: Want) -> Option<Result<Response, Failure>> {
        None
    }

    fn between_strains(
        &self,
        _e_1: &Mat3,
        _d: &Mat3,
        _want: Want,
    ) -> Option<Result<Conserving, Failure>> {
        None
    }

    fn initial(&self) -> Elastic {
        self.initial
    }
}
