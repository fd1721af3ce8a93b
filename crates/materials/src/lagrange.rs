//! The way from the stress and the moduli that belong to the Green-Lagrange strain to those that belong to F.

use carom_algebra::tensor::Mat3;

use crate::{Failure, Tangent};

/// A determinant, which must be positive.
pub(crate) fn positive(determinant: f64) -> Result<f64, Failure> {
    if determinant > 0.0 {
        Ok(determinant)
    } else {
        Err(Failure::Inverted { determinant })
    }
}

/// Moduli ∂S/∂E = trace I⊗I + identity 𝕀 + product B⊗B + cross B⊙B, with a symmetric tensor B, the identity
/// 𝕀 of symmetric tensors and (B⊙B)_IJKL = (B_IK B_JL + B_IL B_JK)/2. Coefficients in Pa.
pub(crate) struct Moduli {
    pub(crate) trace: f64,
    pub(crate) identity: f64,
    pub(crate) product: f64,
    pub(crate) cross: f64,
    pub(crate) b: Mat3,
}

impl Moduli {
    /// The moduli times a symmetric tensor, ∂S/∂E : D.
    pub(crate) fn times(&self, d: &Mat3) -> Mat3 {
        let b = &self.b;
        Mat3::identity() * (self.trace * d.trace())
            + d * self.identity
            + b * (self.product * b.dot(d))
            + b * d * b * self.cross
    }

    /// Half of the moduli.
    pub(crate) fn half(self) -> Moduli {
        Moduli {
            trace: 0.5 * self.trace,
            identity: 0.5 * self.identity,
            product: 0.5 * self.product,
            cross: 0.5 * self.cross,
            b: self.b,
        }
    }

    /// L_iM (∂S/∂E)_MJNL R_kN: the part of ∂P/∂F that the moduli make, where P = L S and dE = sym(Rᵀ dF).
    pub(crate) fn pushed(&self, left: &Mat3, right: &Mat3) -> Box<Tangent> {
        let (lb, rb) = (left * self.b, right * self.b);
        let lr = left * right.transpose() * (0.5 * self.identity);
        let lbr = lb * right.transpose() * (0.5 * self.cross);
        let mut tangent = Box::new([[0.0; 9]; 9]);
        for i in 0..3 {
            for k in 0..3 {
                for j in 0..3 {
                    let (along, across) = (self.trace * left[(i, j)], self.product * lb[(i, j)]);
                    let (turned, crossed) = (
                        0.5 * self.identity * right[(k, j)],
                        0.5 * self.cross * rb[(k, j)],
                    );
                    let row = &mut tangent[3 * i + j];
                    for l in 0..3 {
                        row[3 * k + l] = along * right[(k, l)]
                            + across * rb[(k, l)]
                            + turned * left[(i, l)]
                            + crossed * lb[(i, l)]
                            + lbr[(i, k)] * self.b[(j, l)];
                    }
                    row[3 * k + j] += lr[(i, k)];
                }
            }
        }
        tangent
    }
}

/// Adds δ_ik S_JL, the part of ∂P/∂F that the stress makes, P = F S.
pub(crate) fn add_geometric(tangent: &mut Tangent, s: &Mat3) {
    for i in 0..3 {
        for j in 0..3 {
            for l in 0..3 {
                tangent[3 * i + j][3 * i + l] += s[(j, l)];
            }
        }
    }
}

/// Adds the product U_iJ V_kL.
pub(crate) fn add_product(tangent: &mut Tangent, u: &Mat3, v: &Mat3) {
    for i in 0..3 {
        for j in 0..3 {
            let row = &mut tangent[3 * i + j];
            for k in 0..3 {
                for l in 0..3 {
                    row[3 * k + l] += u[(i, j)] * v[(k, l)];
                }
            }
        }
    }
}
