//! `[material]`: density and law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::quantity::{Density, Duration, Modulus, Stress};

/// A material: one law. Only `elastic` is for small strain; the others are for large displacements, rotations and strains, in plane
/// strain, axisymmetric and solid bodies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(extend("oneOf" = [
    { "required": ["elastic"] },
    { "required": ["st-venant-kirchhoff"] },
    { "required": ["neo-hooke"] },
    { "required": ["mooney-rivlin"] },
    { "required": ["j2"] },
    { "required": ["maxwell"] },
]))]
pub struct Material {
    /// Mass density.
    pub density: Density,
    /// Linear isotropic elasticity, small strain.
    pub elastic: Option<Elastic>,
    /// St Venant-Kirchhoff elasticity: linear between second Piola-Kirchhoff stress and Green-Lagrange strain. Large rotations,
    /// moderate strains; it softens in compression.
    pub st_venant_kirchhoff: Option<Elastic>,
    /// Compressible neo-Hookean elasticity.
    pub neo_hooke: Option<Elastic>,
    /// Compressible Mooney-Rivlin elasticity.
    pub mooney_rivlin: Option<MooneyRivlin>,
    /// Von Mises plasticity in logarithmic strain, with linear isotropic hardening.
    pub j2: Option<J2>,
    /// Linear viscoelasticity: a spring beside branches of spring and dashpot in shear. Moderate strains.
    pub maxwell: Option<Maxwell>,
}

/// Moduli of isotropic elasticity; for laws at finite strain those of the undeformed material.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Elastic {
    /// Young's modulus.
    pub young: Modulus,
    /// Poisson's ratio. It does not matter for bars, whose sides are free.
    #[schemars(extend("exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson: f64,
}

/// Mooney-Rivlin elasticity: shear modulus 2 (c10 + c01).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct MooneyRivlin {
    /// Factor of the first invariant.
    pub c10: Modulus,
    /// Factor of the second invariant.
    pub c01: Stress,
    /// Bulk modulus of the undeformed material, at least (4 c10 + 16 c01)/3.
    pub bulk: Modulus,
}

/// Von Mises plasticity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct J2 {
    /// Young's modulus.
    pub young: Modulus,
    /// Poisson's ratio.
    #[schemars(extend("exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson: f64,
    /// Yield stress of the virgin material.
    pub yield_stress: Modulus,
    /// Yield stress gained per unit of plastic strain.
    pub hardening: Stress,
}

/// Linear viscoelasticity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Maxwell {
    /// Instantaneous Young's modulus, before relaxation.
    pub young: Modulus,
    /// Instantaneous Poisson's ratio.
    #[schemars(extend("exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson: f64,
    /// Branches; the sum of their ratios is less than 1.
    #[schemars(extend("minItems" = 1, "maxItems" = 4))]
    pub branches: Vec<Branch>,
}

/// A spring and a dashpot in series.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Branch {
    /// Fraction of the shear modulus that relaxes in this branch.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))]
    pub ratio: f64,
    /// Relaxation time.
    pub time: Duration,
}
