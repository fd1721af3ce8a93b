//! The choice of a time scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{StepMap, TimeScheme};

macro_rules! declare {
    ($($(#[$doc:meta])* $scheme:ident,)*) => {
        /// A time scheme. Any contact law may be named with it; a pair that makes no sense is refused with the reason.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "kebab-case")]
        pub enum Scheme {
            $($(#[$doc])* $scheme(crate::$scheme),)*
        }

        impl Scheme {
            /// The scheme behind the choice.
            pub fn get(&self) -> &dyn TimeScheme {
                match self {
                    $(Scheme::$scheme(scheme) => scheme,)*
                }
            }

            /// Length (s) and map of each stage of a step of `dt` (s).
            pub fn stage_maps(&self, dt: f64) -> Vec<(f64, StepMap)> {
                let scheme = self.get();
                let lengths = scheme.stages().into_iter().enumerate();
                let stage = |(k, length)| (length * dt, scheme.stage_map(k, dt));
                lengths.map(stage).collect()
            }

            /// All but those with forces between two states, with usual parameters: what the batteries run over.
            pub fn registered() -> Vec<Scheme> {
                let mut all = Vec::new();
                $(all.extend(crate::$scheme::usual().into_iter().map(Scheme::$scheme));)*
                all.retain(|scheme| !scheme.get().is_between());
                all
            }
        }
    };
}

schemes!(declare);
