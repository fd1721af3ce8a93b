//! St Venant-Kirchhoff elasticity.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hyperelastic::{Hyperelastic, Potential};
use crate::{Elastic, Material, OutOfRange, Parameters, Plane};

/// St Venant-Kirchhoff elasticity: linear in the Green-Lagrange strain E.
///
/// ψ = λ/2 (tr E)² + μ E:E, S = λ tr(E) I + 2 μ E. For large rotations and moderate strains: under compression it softens,
/// and nothing keeps a cell from being pressed flat (uniaxial: the force has its extreme at the stretch 1/√3).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
#[schemars(inline)]
pub struct StVenantKirchhoff {
    /// The law at small strain, with the density.
    pub initial: Elastic,
}

impl Parameters for StVenantKirchhoff {
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

impl Hyperelastic for StVenantKirchhoff {
    fn potential(&self) -> Potential {
        Potential {
            trace: self.initial.lame_1(Plane::Full),
            square: self.initial.shear_modulus(),
            barrier: 0.0,
            volume: 0.0,
        }
    }

    fn initial(&self) -> Elastic {
        self.initial
    }
}
