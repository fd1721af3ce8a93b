//! The choice of a material.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{Elastic, Material, OutOfRange, Parameters, Plane, PlaneStress, Uniaxial};

macro_rules! declare {
    ([] $($(#[$doc:meta])* $law:ident $key:literal,)*) => {
        /// A material, as chosen in the case file.
        #[expect(
            clippy::large_enum_variant,
            reason = "a plain value, one to a body: a table of hardening is an array"
        )]
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        pub enum Law {
            $($(#[$doc])* #[serde(rename = $key)] $law(crate::$law),)*
        }

        impl Law {
            /// Key in the case file.
            pub fn key(&self) -> &'static str {
                match self {
                    $(Law::$law(_) => $key,)*
                }
            }

            fn parameters(&self) -> &dyn Parameters {
                match self {
                    $(Law::$law(law) => law,)*
                }
            }
        }
    };
}

materials!(declare);

impl From<Elastic> for Law {
    fn from(elastic: Elastic) -> Law {
        Law::Elastic(elastic)
    }
}

impl Law {
    /// The law at finite strain behind the choice; none for small strain.
    pub fn finite(&self) -> Option<&dyn Material> {
        self.parameters().finite()
    }

    /// The law under uniaxial stress at small strain where it is not linear elasticity alone: of a metal that flows.
    pub fn uniaxial(&self) -> Option<Box<dyn Uniaxial>> {
        self.parameters().uniaxial()
    }

    /// The law under plane stress at small strain where it is not linear elasticity alone: of a metal that flows.
    pub fn plane_stress(&self) -> Option<Box<dyn PlaneStress>> {
        self.parameters().plane_stress()
    }

    /// Linear elasticity of the undeformed material.
    pub fn initial(&self) -> Elastic {
        self.parameters().undeformed()
    }

    /// Names a parameter outside its range.
    ///
    /// # Errors
    /// The first such parameter.
    pub fn check(&self) -> Result<(), OutOfRange> {
        self.parameters().check()
    }

    /// Whether it dissipates: its stress is then not the derivative of a stored energy alone.
    pub fn dissipates(&self) -> bool {
        self.parameters().dissipates()
    }

    /// Equivalent plastic strain in the history of a point, without unit; none of a law without plasticity.
    pub fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        self.parameters().plastic_strain(history)
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
