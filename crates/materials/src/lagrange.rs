//! The way from the stress and the moduli that belong to the Green-Lagrange strain to those that belong to F.

use carom_algebra::number::Number;

use crate::tensor::{Tensor, double, plus, plus_unit, product, product_transposed, scaled, trace};

/// Moduli ∂S/∂E = trace I⊗I + identity 𝕀 + product B⊗B + cross B⊙B, with a symmetric tensor B, the identity
/// 𝕀 of symmetric tensors and (B⊙B)_IJKL = (B_IK B_JL + B_IL B_JK)/2. Coefficients in Pa.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moduli<T> {
    pub(crate) trace: T,
    pub(crate) identity: T,
    pub(crate) product: T,
    pub(crate) cross: T,
    pub(crate) b: Tensor<T>,
}

impl<T: Number> Moduli<T> {
    /// The moduli times a symmetric tensor, ∂S/∂E : D.
    #[inline(always)]
    pub(crate) fn times(&self, d: &Tensor<T>) -> Tensor<T> {
        let b = &self.b;
        let crossed = product(&product(b, d), b);
        let sum = plus(&scaled(d, self.identity), self.product * double(b, d), b);
        plus_unit(&plus(&sum, self.cross, &crossed), self.trace * trace(d))
    }

    /// Half of the moduli.
    #[inline(always)]
    pub(crate) fn half(self) -> Moduli<T> {
        Moduli {
            trace: self.trace.scale(0.5),
            identity: self.identity.scale(0.5),
            product: self.product.scale(0.5),
            cross: self.cross.scale(0.5),
            b: self.b,
        }
    }
}

/// The derivative ∂P/∂F of a stress P = L S, where dE = sym(Rᵀ dF), by its parts:
///
/// ∂P_iJ/∂F_kL = L_iM (∂S/∂E)_MJNL R_kN + δ_ik T_JL + U_iJ V_kL.
///
/// At one displacement L = R = F, T = S, and there is no U⊗V.
#[derive(Clone, Copy, Debug)]
pub struct Derivative<T> {
    /// L and R.
    pub(crate) sides: [Tensor<T>; 2],
    pub(crate) moduli: Moduli<T>,
    /// T in Pa.
    pub(crate) stress: Tensor<T>,
    /// U and V.
    pub(crate) bent: Option<[Tensor<T>; 2]>,
    /// Positive only as long as there is a derivative.
    pub positive: T,
}

impl<T: Number> Derivative<T> {
    /// Writes ∂P_iJ/∂F_kL to entry `[3 i + J][3 k + L]` where i, J, k and L are below D. `ring`: in the plane also where the first
    /// pair, the second one or both are (3, 3).
    #[inline(always)]
    pub fn write<const D: usize>(&self, ring: bool, out: &mut [[T; 9]; 9]) {
        let Derivative { sides, moduli, .. } = self;
        let [left, right] = sides;
        let b = &moduli.b;
        let (lb, rb) = (product(left, b), product(right, b));
        let (half, crossed) = (moduli.identity.scale(0.5), moduli.cross.scale(0.5));
        let parts = Parts {
            along: scaled(left, moduli.trace),
            across: scaled(&lb, moduli.product),
            turned: scaled(right, half),
            crossed: scaled(&rb, crossed),
            lr: scaled(&product_transposed(left, right), half),
            lbr: scaled(&product_transposed(&lb, right), crossed),
            lb,
            rb,
        };
        for i in 0..D {
            for j in 0..D {
                for k in 0..D {
                    for l in 0..D {
                        out[3 * i + j][3 * k + l] = self.entry(&parts, [i, j, k, l]);
                    }
                }
                if ring {
                    out[3 * i + j][8] = self.entry(&parts, [i, j, 2, 2]);
                    out[8][3 * i + j] = self.entry(&parts, [2, 2, i, j]);
                }
            }
        }
        if ring {
            out[8][8] = self.entry(&parts, [2; 4]);
        }
    }

    #[inline(always)]
    fn entry(&self, parts: &Parts<T>, [i, j, k, l]: [usize; 4]) -> T {
        let [left, right] = &self.sides;
        let mut sum = parts.along[i][j] * right[k][l];
        sum = parts.across[i][j].mul_add(parts.rb[k][l], sum);
        sum = parts.turned[k][j].mul_add(left[i][l], sum);
        sum = parts.crossed[k][j].mul_add(parts.lb[i][l], sum);
        sum = parts.lbr[i][k].mul_add(self.moduli.b[j][l], sum);
        if let Some([u, v]) = &self.bent {
            sum = u[i][j].mul_add(v[k][l], sum);
        }
        if j == l {
            sum += parts.lr[i][k];
        }
        if i == k {
            sum += self.stress[j][l];
        }
        sum
    }
}

impl Derivative<f64> {
    /// All entries.
    pub(crate) fn tangent(&self) -> Box<[[f64; 9]; 9]> {
        let mut tangent = Box::new([[0.0; 9]; 9]);
        self.write::<3>(false, &mut tangent);
        tangent
    }
}

/// Products of which the entries of a derivative are made.
struct Parts<T> {
    /// trace L.
    along: Tensor<T>,
    /// product L B.
    across: Tensor<T>,
    /// identity/2 R.
    turned: Tensor<T>,
    /// cross/2 R B.
    crossed: Tensor<T>,
    /// identity/2 L Rᵀ.
    lr: Tensor<T>,
    /// cross/2 L B Rᵀ.
    lbr: Tensor<T>,
    /// L B and R B.
    lb: Tensor<T>,
    rb: Tensor<T>,
}
