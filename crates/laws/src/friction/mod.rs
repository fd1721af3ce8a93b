//! Friction laws: what part of its normal force a point carries along the surface.
//!
//! With P the normal force, t the force along the surface and q the sliding, a point sticks, q = 0, with |t| <= μ P, or slides with
//! |t| = μ P against q. A law gives the two coefficients: μ of a point that sticks, and that of one that slides, which is never larger.
//!
//! Adding a law: one file, and its lines here.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod coulomb;
mod law;
mod static_kinetic;

pub use coulomb::Coulomb;
pub use law::FrictionLaw;
pub use static_kinetic::StaticKinetic;

/// The list of friction laws: each with what the case file says of it.
macro_rules! friction_laws {
    ($($(#[$doc:meta])* $law:ident,)*) => {
        /// A friction law.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "kebab-case")]
        #[schemars(description = "Friction.")]
        pub enum Friction {
            $($(#[$doc])* $law($law),)*
        }

        impl Friction {
            /// The law behind the choice.
            pub fn get(&self) -> &dyn FrictionLaw {
                match self {
                    $(Friction::$law(law) => law,)*
                }
            }

            /// Whether there is any. Steps ask all contacts for it.
            #[inline]
            pub fn acts(&self) -> bool {
                match self {
                    $(Friction::$law(law) => law.sticks() > 0.0,)*
                }
            }
        }
    };
}

friction_laws! {
    /// Coulomb's coefficient of friction, one for sticking and sliding.
    Coulomb,
    /// A coefficient of sticking and a lower one of sliding, to which it may fall with the speed.
    StaticKinetic,
}

impl Friction {
    /// μ of points that slide fast, where it is below that of points that stick.
    pub fn kinetic(&self) -> Option<f64> {
        let law = self.get();
        Some(law.slides(f64::INFINITY)).filter(|kinetic| *kinetic < law.sticks())
    }
}

/// No friction.
impl Default for Friction {
    fn default() -> Friction {
        Friction::from(0.0)
    }
}

/// Coulomb's law.
impl From<f64> for Friction {
    fn from(coefficient: f64) -> Friction {
        Friction::Coulomb(Coulomb(coefficient))
    }
}
