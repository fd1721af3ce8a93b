//! Compressible neo-Hookean elasticity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hyperelastic::{Hyperelastic, Potential};
use crate::{Elastic, Material, OutOfRange, Parameters, Plane};

/// Compressible neo-Hookean elasticity.
///
/// ψ = μ/2 (I_1 - 3) - μ ln J + λ/2 (ln J)², with I_1 = tr(FᵀF) and J = det F;
/// P = μ (F - F⁻ᵀ) + λ ln(J) F⁻ᵀ. With Poisson's ratio not negative, ψ grows without bound as J goes to zero.
/// Bonet and Wood (2008), Nonlinear Continuum Mechanics for Finite Element Analysis, 6.4.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline)]
pub struct NeoHooke {
    /// The law at small strain, with the density.
    pub initial: Elastic,
}

impl Parameters for NeoHooke {
    fn finite(&self) -> Option<&dyn Material> {
        Some(self)
    }

    fn undeformed(&self) -> Elastic {
        self.initial
    }

    fn check(&self) -> Result<(), OutOfRange> {
        self.initial.check()
    }
}

impl Hyperelastic for NeoHooke {
    /// (I_1 - 3)/2 = tr E.
    fn potential(&self) -> Potential {
        Potential {
            trace: 0.0,
            square: 0.0,
            barrier: self.initial.shear_modulus(),
            volume: self.initial.lame_1(Plane::Full),
        }
    }

    fn initial(&self) -> Elastic {
        self.initial
    }
}
