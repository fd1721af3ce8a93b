//! What the parameters of any material answer.

use crate::{Elastic, Material, OutOfRange, PlaneStress, Uniaxial};

/// The parameters of a material, as the case file gives them.
pub trait Parameters {
    /// The law at finite strain; none for small strain.
    fn finite(&self) -> Option<&dyn Material>;
    /// The law under uniaxial stress at small strain, of bars and of the fibres of beams; none of a law that has none but elasticity.
    fn uniaxial(&self) -> Option<Box<dyn Uniaxial>> {
        None
    }
    /// The law under plane stress at small strain, of shells; none of a law that has none but elasticity.
    fn plane_stress(&self) -> Option<Box<dyn PlaneStress>> {
        None
    }
    /// Linear elasticity of the undeformed material.
    fn undeformed(&self) -> Elastic;
    /// Names a parameter outside its range.
    ///
    /// # Errors
    /// The first such parameter.
    fn check(&self) -> Result<(), OutOfRange>;
    /// Whether it dissipates: its stress is then not the derivative of a stored energy alone.
    fn dissipates(&self) -> bool {
        false
    }
    /// Equivalent plastic strain in the history of a point, without unit; none of a law without plasticity.
    fn plastic_strain(&self, _history: &[f64]) -> Option<f64> {
        None
    }
}

/// Small strain: no law at finite strain.
impl Parameters for Elastic {
    fn finite(&self) -> Option<&dyn Material> {
        None
    }

    fn undeformed(&self) -> Elastic {
        *self
    }

    fn check(&self) -> Result<(), OutOfRange> {
        Elastic::check(self)
    }
}
