//! Isotropic linear elasticity at small strain.

use carom_algebra::tensor::Mat3;
use carom_quantities::{Density, Modulus};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::range::{OutOfRange, require};

/// How the directions outside the plane (or beside the axis) of a model behave.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// No restriction: solids, axisymmetry, and plane strain, whose out-of-plane strain is zero by its kinematics.
    Full,
    /// The stress normal to the plane is zero (third direction).
    Stress,
    /// Only the stress along the axis is not zero: bars.
    Uniaxial,
}

/// Isotropic linear elastic material, σ = λ tr(ε) I + 2 μ ε.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Moduli of isotropic elasticity; for laws at finite strain those of the undeformed material.", extend("additionalProperties" = false))]
pub struct Elastic {
    /// Mass density, kg/m³. The case file has it beside the law, not in it.
    #[serde(deserialize_with = "Density::si")]
    #[schemars(skip)]
    pub density: f64,
    /// Young's modulus E, Pa.
    #[serde(deserialize_with = "Modulus::si")]
    #[schemars(with = "Modulus", description = "Young's modulus.")]
    pub young: f64,
    /// Poisson's ratio. It does not matter for bars, whose sides are free.
    #[schemars(extend("exclusiveMinimum" = -1.0, "exclusiveMaximum" = 0.5))]
    pub poisson: f64,
}

impl Elastic {
    /// Names a parameter outside its range.
    ///
    /// # Errors
    /// The first such parameter.
    pub fn check(&self) -> Result<(), OutOfRange> {
        let nu = self.poisson;
        require("density", self.density, self.density > 0.0, "positive")?;
        require("young", self.young, self.young > 0.0, "positive")?;
        require(
            "poisson",
            nu,
            -1.0 < nu && nu < 0.5,
            "greater than -1 and less than 0.5",
        )
    }

    /// Shear modulus μ = E / (2 (1 + ν)), in Pa.
    pub fn shear_modulus(&self) -> f64 {
        self.young / (2.0 * (1.0 + self.poisson))
    }

    /// First Lamé constant in Pa: λ = E ν / ((1 + ν)(1 - 2ν)); in plane stress the reduced 2λμ/(λ + 2μ) = E ν/(1 - ν²),
    /// with which the in-plane law keeps its form.
    pub fn lame_1(&self, plane: Plane) -> f64 {
        let (e, nu) = (self.young, self.poisson);
        match plane {
            Plane::Full => e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            Plane::Stress => e * nu / (1.0 - nu * nu),
            Plane::Uniaxial => 0.0,
        }
    }

    /// Modulus of a plane compression wave in Pa: λ + 2μ, with the reduced λ in plane stress; E for a bar.
    pub fn wave_modulus(&self, plane: Plane) -> f64 {
        match plane {
            Plane::Uniaxial => self.young,
            Plane::Full | Plane::Stress => self.lame_1(plane) + 2.0 * self.shear_modulus(),
        }
    }

    /// Speed of compression waves c = sqrt(wave modulus / ρ), in m/s.
    pub fn wave_speed(&self, plane: Plane) -> f64 {
        (self.wave_modulus(plane) / self.density).sqrt()
    }

    /// Cauchy stress in Pa of a small strain (symmetric, dimensionless). In plane stress the third normal stress is zero.
    pub fn stress(&self, plane: Plane, strain: &Mat3) -> Mat3 {
        let two_mu = 2.0 * self.shear_modulus();
        match plane {
            Plane::Full => {
                strain * two_mu + Mat3::identity() * (self.lame_1(plane) * strain.trace())
            }
            Plane::Stress => {
                let trace = strain[(0, 0)] + strain[(1, 1)];
                let mut stress = strain * two_mu + Mat3::identity() * (self.lame_1(plane) * trace);
                stress[(2, 2)] = 0.0;
                stress
            }
            Plane::Uniaxial => {
                let mut stress = Mat3::zeros();
                stress[(0, 0)] = self.young * strain[(0, 0)];
                stress
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEEL: Elastic = Elastic {
        density: 7800.0,
        young: 2e11,
        poisson: 0.3,
    };

    #[test]
    fn uniaxial_stress_in_three_dimensions_gives_young_and_poisson() {
        let strain = Mat3::from_diagonal(&[1e-3, -0.3e-3, -0.3e-3].into());
        let stress = STEEL.stress(Plane::Full, &strain);
        assert!((stress[(0, 0)] - 2e8).abs() < 1e-6 * 2e8);
        assert!(stress[(1, 1)].abs() < 1.0 && stress[(2, 2)].abs() < 1.0);
    }

    #[test]
    fn plane_stress_is_the_solid_with_a_free_third_direction() {
        let (e1, e2) = (1e-3, 2e-4);
        let e3 = -STEEL.poisson / (1.0 - STEEL.poisson) * (e1 + e2);
        let solid = STEEL.stress(Plane::Full, &Mat3::from_diagonal(&[e1, e2, e3].into()));
        let plane = STEEL.stress(Plane::Stress, &Mat3::from_diagonal(&[e1, e2, 0.0].into()));
        assert!((solid - plane).norm() < 1e-12 * solid.norm());
    }

    #[test]
    fn confined_wave_speed_is_that_of_the_reference_problem() {
        let nu = STEEL.poisson;
        let c = (2e11 * (1.0 - nu) / (7800.0 * (1.0 + nu) * (1.0 - 2.0 * nu))).sqrt();
        assert!((STEEL.wave_speed(Plane::Full) - c).abs() < 1e-12 * c);
    }
}
