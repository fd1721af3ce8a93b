//! Compressible Mooney-Rivlin elasticity.

use carom_quantities::{Density, Modulus, Stress};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hyperelastic::{Hyperelastic, Potential};
use crate::range::{OutOfRange, require};
use crate::{Elastic, Material, Parameters};

/// Compressible Mooney-Rivlin elasticity, for rubber.
///
/// ψ = c_10 (I_1 - 3) + c_01 (I_2 - 3) - 2 (c_10 + 2 c_01) ln J + l/2 (ln J)², with the invariants of C = FᵀF and J = det F:
/// free of stress at F = I. There μ = 2 (c_10 + c_01) and the bulk modulus is κ = l + 4/3 c_10 + 16/3 c_01, which is given in the
/// place of l. With c_01 = 0 it is the neo-Hookean law. The invariants are those of C itself, not of its part of constant
/// volume. Ciarlet (1988), Mathematical Elasticity I, chapter 4, has the form with another function of J.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Mooney-Rivlin elasticity: shear modulus 2 (c10 + c01).", extend("additionalProperties" = false))]
pub struct MooneyRivlin {
    /// Mass density, kg/m³. The case file has it beside the law, not in it.
    #[serde(deserialize_with = "Density::si")]
    #[schemars(skip)]
    pub density: f64,
    /// c_10 in Pa.
    #[serde(deserialize_with = "Modulus::si")]
    #[schemars(with = "Modulus", description = "Factor of the first invariant.")]
    pub c10: f64,
    /// c_01 in Pa.
    #[serde(deserialize_with = "Stress::si")]
    #[schemars(with = "Stress", description = "Factor of the second invariant.")]
    pub c01: f64,
    /// Bulk modulus κ of the undeformed material in Pa, at least (4 c_10 + 16 c_01)/3: with less, the energy would have no
    /// bound below as J goes to zero.
    #[serde(deserialize_with = "Modulus::si")]
    #[schemars(
        with = "Modulus",
        description = "Bulk modulus of the undeformed material, at least (4 c10 + 16 c01)/3."
    )]
    pub bulk: f64,
}

impl Parameters for MooneyRivlin {
    fn finite(&self) -> Option<&dyn Material> {
        Some(self)
    }

    fn undeformed(&self) -> Elastic {
        Material::initial(self)
    }

    fn check(&self) -> Result<(), OutOfRange> {
        let accepted = "at least (4 c10 + 16 c01)/3";
        require("density", self.density, self.density > 0.0, "positive")?;
        require("c10", self.c10, self.c10 > 0.0, "positive")?;
        require("c01", self.c01, self.c01 >= 0.0, "zero or positive")?;
        require("bulk", self.bulk, self.volume() >= 0.0, accepted)
    }
}

impl MooneyRivlin {
    /// l, the coefficient of (ln J)²/2.
    fn volume(&self) -> f64 {
        self.bulk - (4.0 * self.c10 + 16.0 * self.c01) / 3.0
    }
}

impl Hyperelastic for MooneyRivlin {
    /// I_1 - 3 = 2 tr E and I_2 - 3 = 4 tr E + 2 (tr E)² - 2 E:E.
    fn potential(&self) -> Potential {
        Potential {
            trace: 4.0 * self.c01,
            square: -2.0 * self.c01,
            barrier: 2.0 * self.c10 + 4.0 * self.c01,
            volume: self.volume(),
        }
    }

    /// Young's modulus 9κμ/(3κ + μ), Poisson's ratio (3κ - 2μ)/(2 (3κ + μ)).
    fn initial(&self) -> Elastic {
        let (bulk, mu) = (self.bulk, 2.0 * (self.c10 + self.c01));
        Elastic {
            density: self.density,
            young: 9.0 * bulk * mu / (3.0 * bulk + mu),
            poisson: (3.0 * bulk - 2.0 * mu) / (2.0 * (3.0 * bulk + mu)),
        }
    }
}
