//! The choice of a contact law.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ContactLaw, CurveError, Defaults};

macro_rules! declare {
    ($($(#[$doc:meta])* $law:ident $given:ident,)*) => {
        /// A contact law, complete.
        #[expect(
            clippy::large_enum_variant,
            reason = "laws are plain values that are copied; only the curve of a stop is large"
        )]
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum Law {
            $($(#[$doc])* $law(crate::$law),)*
        }

        /// A contact law, as chosen in the case file: what it leaves out comes from its surroundings.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(rename_all = "kebab-case")]
        #[schemars(
            rename = "Law",
            description = "A contact law. Gap g is positive when open, pressure p positive in compression, gap rate positive when opening."
        )]
        pub enum GivenLaw {
            $($(#[$doc])* $law(crate::$given),)*
        }

        impl Law {
            /// The law behind the choice.
            pub fn get(&self) -> &dyn ContactLaw {
                match self {
                    $(Law::$law(law) => law,)*
                }
            }
        }

        impl GivenLaw {
            /// The law with its defaults.
            ///
            /// # Errors
            /// A curve that does not increase, or that is too steep.
            pub fn law(&self, defaults: &Defaults) -> Result<Law, CurveError> {
                match self {
                    $(GivenLaw::$law(given) => given.law(defaults).map(Law::$law),)*
                }
            }
        }
    };
}

laws!(declare);

impl Law {
    /// [`ContactLaw::projects`].
    pub fn projects(&self) -> bool {
        self.get().projects()
    }

    /// [`ContactLaw::needs_free_gap`].
    pub fn needs_free_gap(&self) -> bool {
        self.get().needs_free_gap()
    }

    /// [`ContactLaw::crushed`].
    pub fn crushed(&self, before: f64, gap: f64) -> f64 {
        self.get().crushed(before, gap)
    }

    /// [`ContactLaw::crush_energy`].
    pub fn crush_energy(&self, crush: f64) -> f64 {
        self.get().crush_energy(crush)
    }

    /// [`ContactLaw::stays`].
    pub fn stays(&self, crush: f64) -> f64 {
        self.get().stays(crush)
    }

    /// [`ContactLaw::has_weak_form`].
    pub fn has_weak_form(&self) -> bool {
        self.get().has_weak_form()
    }

    /// [`ContactLaw::is_function`].
    pub fn is_function(&self) -> bool {
        self.get().is_function()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Adhesion, Capture, Damped, Displacement, End, Local, Reading, Relation, Status, Velocity,
    };

    const LOCAL: Local = Local {
        area: 0.5,
        share: 1.0,
        gap: 0.0,
        rate: 0.0,
        start: 0.0,
        gap_free: 0.0,
        dt: 1.0,
        tolerance: 0.0,
        crush: 0.0,
        at: [0.0; 2],
    };

    fn end(gap: f64, rate: f64, force: f64) -> End {
        End {
            gap_released: gap,
            gap,
            rate,
            force,
        }
    }

    #[test]
    fn displacement_signs_close_on_penetration_and_open_on_tension() {
        let law = Displacement::default();
        assert_eq!(
            law.status(Status::Open, &end(1e-3, -1.0, 0.0), &LOCAL, 0),
            Status::Open
        );
        assert_eq!(
            law.status(Status::Open, &end(-1e-3, -1.0, 0.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 5.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, -5.0), &LOCAL, 0),
            Status::Open
        );
        // at rest on the surface without force: the strict sign leaves it free
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 0.0), &LOCAL, 0),
            Status::Open
        );
    }

    #[test]
    fn velocity_signs_watch_the_closed_gap_and_the_approach() {
        let law = Velocity {
            capture: Capture::Half,
            reading: Reading::Closed,
        };
        assert_eq!(law.watches(-1e-6, 1e-12), Some(true));
        assert_eq!(law.watches(0.0, 1e-12), Some(true));
        assert_eq!(law.watches(1e-6, 1e-12), Some(false));
        assert_eq!(
            law.status(Status::Open, &end(0.0, -1.0, 0.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Open, &end(0.0, 1.0, 0.0), &LOCAL, 0),
            Status::Open
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 5.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, -5.0), &LOCAL, 0),
            Status::Open
        );
        let printed = Velocity {
            reading: Reading::AsPrinted,
            ..law
        };
        assert_eq!(printed.watches(1e-6, 1e-12), Some(true));
        assert_eq!(printed.watches(-1e-6, 1e-12), Some(false));
    }

    #[test]
    fn damped_law_takes_the_corner_when_closing_would_open() {
        let law = Damped {
            stiffness: 2.0,
            damping: 3.0,
            adhesion: Adhesion::Clip,
        };
        assert_eq!(
            law.relation(Status::Closed, &LOCAL),
            Relation {
                gap: 1.0,
                rate: 1.5,
                compliance: 1.0,
                offset: 0.0
            }
        );
        assert_eq!(
            law.status(Status::Open, &end(-1.0, 0.0, 0.0), &LOCAL, 0),
            Status::Closed
        );
        let opened = End {
            gap_released: -1.0,
            gap: 0.1,
            rate: 0.0,
            force: 4.0,
        };
        assert_eq!(
            law.status(Status::Closed, &opened, &LOCAL, 1),
            Status::Corner
        );
        let free = End {
            gap_released: 1.0,
            gap: 1.1,
            rate: 0.0,
            force: 4.0,
        };
        assert_eq!(law.status(Status::Closed, &free, &LOCAL, 1), Status::Open);
    }
}
