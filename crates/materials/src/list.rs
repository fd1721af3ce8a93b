//! The list of materials.

use crate::{
    Elastic, J2Plasticity, Material, Maxwell, MooneyRivlin, NeoHooke, OutOfRange, Plane,
    StVenantKirchhoff,
};

/// A material, as chosen in the case file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Linear elasticity at small strain: no law at finite strain.
    Elastic(Elastic),
    /// St Venant-Kirchhoff elasticity.
    StVenantKirchhoff(StVenantKirchhoff),
    /// Compressible neo-Hookean elasticity.
    NeoHooke(NeoHooke),
    /// Compressible Mooney-Rivlin elasticity.
    MooneyRivlin(MooneyRivlin),
    /// J2 plasticity with linear isotropic hardening.
    J2Plasticity(J2Plasticity),
    /// Generalised Maxwell viscoelasticity.
    Maxwell(Maxwell),
}

impl From<Elastic> for Law {
    fn from(elastic: Elastic) -> Law {
        Law::Elastic(elastic)
    }
}

impl Law {
    /// The law at finite strain behind the choice; none for small strain.
    pub fn finite(&self) -> Option<&dyn Material> {
        match self {
            Law::Elastic(_) => None,
            Law::StVenantKirchhoff(law) => Some(law),
            Law::NeoHooke(law) => Some(law),
            Law::MooneyRivlin(law) => Some(law),
            Law::J2Plasticity(law) => Some(law),
            Law::Maxwell(law) => Some(law),
        }
    }

    /// Linear elasticity of the undeformed material.
    pub fn initial(&self) -> Elastic {
        match self {
            Law::Elastic(elastic) => *elastic,
            Law::StVenantKirchhoff(law) => law.initial,
            Law::NeoHooke(law) => law.initial,
            Law::MooneyRivlin(law) => Material::initial(law),
            Law::J2Plasticity(law) => law.initial,
            Law::Maxwell(law) => law.initial,
        }
    }

    /// Names a parameter outside its range.
    ///
    /// # Errors
    /// The first such parameter.
    pub fn check(&self) -> Result<(), OutOfRange> {
        match self {
            Law::Elastic(elastic) => elastic.check(),
            Law::StVenantKirchhoff(law) => law.initial.check(),
            Law::NeoHooke(law) => law.initial.check(),
            Law::MooneyRivlin(law) => law.check(),
            Law::J2Plasticity(law) => law.check(),
            Law::Maxwell(law) => law.check(),
        }
    }

    /// Equivalent plastic strain in the history of a point, without unit; none of a law without plasticity.
    pub fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        match self {
            Law::J2Plasticity(_) => Some(J2Plasticity::plastic_strain(history)),
            _ => None,
        }
    }

    /// Mass density in kg/m³.
    pub fn density(&self) -> f64 {
        self.initial().density
    }

    /// Speed of compression waves in the undeformed material, in m/s.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        self.initial().wave_speed(plane)
    }
}
