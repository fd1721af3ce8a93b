//! Metal plasticity at finite strain.

use carom_algebra::tensor::Mat3;
use carom_quantities::{Modulus, Stress};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::lagrange::{cofactor, pack, positive, unpack};
use crate::range::{OutOfRange, require};
use crate::spectral::spectral;
use crate::{Conserving, Elastic, Failure, Material, Parameters, Plane, Response, Tangent, Want};

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
struct Return {
    /// Eigenvalues of the trial b_e.
    beta: [f64; 3],
    /// Trial logarithmic strains ln(β)/2.
    epsilon: [f64; 3],
    /// Principal axes, as columns.
    n: Mat3,
    /// Unit deviator of ε, and of the flow; zero where ε has none.
    flow: [f64; 3],
    /// Norm of the trial deviator.
    norm: f64,
    /// Increment of ε_p.
    slip: f64,
    /// What the return leaves of the deviator, 1 - 3μ Δε_p/q.
    left: f64,
    /// Principal Kirchhoff stresses.
    tau: [f64; 3],
}

impl J2Plasticity {
    /// ε_p of the history of a point.
    pub fn plastic_strain(history: &[f64]) -> f64 {
        history[6]
    }

    fn bulk_modulus(&self) -> f64 {
        self.initial.lame_1(Plane::Full) + 2.0 / 3.0 * self.initial.shear_modulus()
    }

    /// Return from the trial state, whose elastic left Cauchy-Green tensor is I + `beyond`. `None` where round-off has made an
    /// eigenvalue of it negative.
    fn returned(&self, beyond: &Mat3, plastic: f64) -> Option<Return> {
        let mu = self.initial.shear_modulus();
        let (lambda, n) = spectral(beyond);
        if !lambda.iter().all(|&x| x > -1.0) {
            return None;
        }
        let epsilon = lambda.map(|x| 0.5 * x.ln_1p());
        let trace = epsilon[0] + epsilon[1] + epsilon[2];
        let dev = epsilon.map(|x| x - trace / 3.0);
        let norm = (dev[0] * dev[0] + dev[1] * dev[1] + dev[2] * dev[2]).sqrt();
        let q = 6_f64.sqrt() * mu * norm;
        let beyond_yield = q - self.yield_stress - self.hardening * plastic;
        let (slip, left) = if beyond_yield > 0.0 {
            let slip = beyond_yield / (3.0 * mu + self.hardening);
            (slip, 1.0 - 3.0 * mu * slip / q)
        } else {
            (0.0, 1.0)
        };
        let pressure = self.bulk_modulus() * trace;
        Some(Return {
            beta: lambda.map(|x| 1.0 + x),
            flow: if norm > 0.0 {
                dev.map(|x| x / norm)
            } else {
                dev
            },
            tau: dev.map(|x| pressure + 2.0 * mu * left * x),
            epsilon,
            n,
            norm,
            slip,
            left,
        })
    }

    /// ∂P/∂F. With the rate l = dF F⁻¹ in the principal axes,
    /// dP Fᵀ = dτ - τ lᵀ,   dτ_aa = Σ_c a_ac l_cc,   dτ_ab = w_ab (l_ab β_b + β_a l_ba) for a ≠ b,
    ///
    /// a = κ + 2μ left (δ - 1/3) + 6μ² (Δε_p/q - 1/(3μ + H)) flow flow the consistent modulus of the return at small strain, and
    /// w_ab = (τ_a - τ_b)/(β_a - β_b) = 2μ left (ε_a - ε_b)/(β_a - β_b), whose limit at equal eigenvalues is 1/(2β):
    /// the return scales the deviator, so that only the logarithm is left to divide.
    /// `g` is Nᵀ F⁻ᵀ.
    fn tangent(&self, at: &Return, g: &Mat3) -> Box<Tangent> {
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
            std::array::from_fn(|ij| at.n[(ij / 3, ab / 3)] * g[(ab % 3, ij % 3)])
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
fn log_quotient(at: &Return, a: usize, b: usize) -> f64 {
    let z = (at.beta[a] - at.beta[b]) / at.beta[b];
    if z == 0.0 {
        0.5 / at.beta[b]
    } else if z.abs() < 0.5 {
        0.5 * z.ln_1p() / z / at.beta[b]
    } else {
        (at.epsilon[a] - at.epsilon[b]) / (at.beta[a] - at.beta[b])
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
        let determinant = positive(f.determinant())?;
        let (plastic_metric, plastic) = (unpack(&old[..6]), old[6]);
        let h = f - Mat3::identity();
        // b_e - I, from H and C_p⁻¹ - I: no digit is lost where all strains are small
        let beyond = f * plastic_metric * f.transpose() + h + h.transpose() + h * h.transpose();
        let at = self
            .returned(&beyond, plastic)
            .ok_or(Failure::Inverted { determinant })?;
        let inverse_transposed = cofactor(f) / determinant;
        let g = at.n.tr_mul(&inverse_transposed);
        new.copy_from_slice(old);
        if at.slip > 0.0 {
            // the flow sqrt(3/2) Δε_p of ε changes β by the factor exp(-2 flow); F⁻¹ pulls the change back to C_p⁻¹
            let change = std::array::from_fn::<f64, 3, _>(|a| {
                at.beta[a] * (-6_f64.sqrt() * at.slip * at.flow[a]).exp_m1()
            });
            let pulled = g.transpose() * Mat3::from_diagonal(&change.into()) * g;
            pack(&(plastic_metric + pulled), &mut new[..6]);
            new[6] = plastic + at.slip;
        }
        let trace = at.epsilon[0] + at.epsilon[1] + at.epsilon[2];
        let deviator = at.left * at.norm;
        Ok(Response {
            stress: at.n * Mat3::from_diagonal(&at.tau.into()) * g,
            tangent: (want == Want::Tangent).then(|| self.tangent(&at, &g)),
            stored: 0.5 * self.bulk_modulus() * trace * trace
                + self.initial.shear_modulus() * deviator * deviator,
            hardening: 0.5 * self.hardening * new[6] * new[6],
            dissipated: self.yield_stress * at.slip,
        })
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
