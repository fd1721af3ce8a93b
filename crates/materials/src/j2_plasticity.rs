//! Metal plasticity with linear hardening.

use carom_algebra::number::Number;
use carom_quantities::{Modulus, Stress};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::flow::{PLASTIC, flows};
use crate::hardening::Hardening;
use crate::range::{OutOfRange, require};
use crate::{Elastic, Material, Parameters, PlaneStress, Uniaxial};

/// J2 (von Mises) plasticity with linear isotropic hardening, in logarithmic strain: σ_y + H ε_p.
///
/// The return is in closed form, Δε_p = (q - σ_y - H ε_p)/(3μ + H), with the trial von Mises stress q. Stored in hardening:
/// H ε_p²/2; dissipated in a step: σ_y Δε_p. Elastic law, flow and history: those of all metals here, theory/materials.
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

    fn uniaxial(&self) -> Option<Box<dyn Uniaxial>> {
        Some(Box::new(*self))
    }

    fn plane_stress(&self) -> Option<Box<dyn PlaneStress>> {
        Some(Box::new(*self))
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        Some(J2Plasticity::plastic_strain(history))
    }
}

impl J2Plasticity {
    /// ε_p of the history of a point.
    pub fn plastic_strain(history: &[f64]) -> f64 {
        history[PLASTIC]
    }
}

impl Hardening for J2Plasticity {
    fn elastic(&self) -> &Elastic {
        &self.initial
    }

    #[inline(always)]
    fn slip<T: Number>(&self, q: T, stiffness: f64, old: &[T], _dt: f64) -> [T; 2] {
        let plastic = old[0];
        let beyond_yield = q - plastic.mul_add(q.like(self.hardening), q.like(self.yield_stress));
        let stiffness = stiffness + self.hardening;
        let slip = beyond_yield.most(q.like(0.0)).scale(1.0 / stiffness);
        [slip, q.like(self.hardening)]
    }

    #[inline(always)]
    fn spent<T: Number>(&self, slip: T, _q: T, (_, new): (&[T], &mut [T])) -> [T; 2] {
        let hardening = (new[0] * new[0]).scale(0.5 * self.hardening);
        [hardening, slip.scale(self.yield_stress)]
    }
}

flows!(J2Plasticity);
