//! Why zones could not be built or an outer step not be taken.

use thiserror::Error as ThisError;

/// Errors of this crate.
#[derive(Debug, ThisError)]
pub enum Error {
    /// A driver of a zone failed, or the links of all.
    #[error(transparent)]
    Dynamics(#[from] carom_dynamics::Error),
    /// A model that no system is built from.
    #[error(transparent)]
    System(#[from] carom_system::Error),
    /// A beam and a solid that cannot be glued.
    #[error(transparent)]
    Overlap(#[from] carom_arlequin::Error),
    /// A body of an overlap that cannot be built.
    #[error(transparent)]
    Body(#[from] carom_bodies::Error),
    /// A zone that could not be built.
    #[error("zone '{zone}': {cause}")]
    Zone {
        /// Name of the zone.
        zone: String,
        /// Cause.
        cause: Box<carom_dynamics::Error>,
    },
    /// A contact whose sides are in different zones.
    #[error(
        "contact '{contact}': its two sides are in the zones '{one}' and '{other}', which step apart: {cause}"
    )]
    AcrossZones {
        /// Name of the contact.
        contact: String,
        /// Zone of the secondary side.
        one: String,
        /// Zone of the primary side.
        other: String,
        /// Why this contact cannot be between them.
        cause: &'static str,
    },
    /// A contact between zones without solution.
    #[error("step {step}, contact '{contact}' between zones: {cause}")]
    CrossZone {
        /// Number of the outer step.
        step: u64,
        /// Name of the contact.
        contact: String,
        /// Cause.
        cause: carom_nonsmooth::Unsolved,
    },
    /// Forces of contacts between zones that do not settle.
    #[error(
        "step {step}, contact '{contact}' between zones: its forces still change by {change} N after {passes} passes"
    )]
    Unsettled {
        /// Number of the outer step.
        step: u64,
        /// Name of the first contact that may carry a force.
        contact: String,
        /// Largest change of a force, N.
        change: f64,
        /// Passes so far.
        passes: usize,
    },
    /// Numbers of inner steps that do not go together.
    #[error("zone '{zone}' takes {found} steps per outer step: {accepted}")]
    Substeps {
        /// Name of the zone.
        zone: String,
        /// Steps given.
        found: u32,
        /// What would do.
        accepted: &'static str,
    },
    /// A scheme of a zone that no link to zones of other steps takes.
    #[error("zone '{zone}' does not take the scheme {scheme} with steps of its own: {cause}")]
    LinkScheme {
        /// Name of the zone.
        zone: String,
        /// Name of the scheme.
        scheme: &'static str,
        /// Why.
        cause: &'static str,
    },
    /// Multipliers of links that were not found.
    #[error(
        "step {step}: the velocities of the zones still differ by {defect:.1e} m/s at link '{link}' after {passes} passes over an outer step of {dt:.4e} s{cause}"
    )]
    Link {
        /// Number of the outer step.
        step: u64,
        /// Name of the link that is missed most.
        link: String,
        /// Passes made.
        passes: usize,
        /// Largest defect of a row per sum of its coefficients, m/s.
        defect: f64,
        /// Size of the outer step, s.
        dt: f64,
        /// Why, where that is known, and what would do.
        cause: &'static str,
    },
    /// Discrete elements in several zones that step apart.
    #[error(
        "`{element}`: its nodes are in the zones '{one}' and '{other}', which step apart: its force, of u_1(t) - u_2(t), is needed at instants t \
         that one of them does not have; give each zone elements of its own, or take equal steps"
    )]
    DiscreteInZones {
        /// Name of the element.
        element: String,
        /// Zone of one of its nodes.
        one: String,
        /// Zone of another.
        other: String,
    },
}

impl From<Error> for carom_dynamics::Error {
    fn from(error: Error) -> carom_dynamics::Error {
        match error {
            Error::Dynamics(error) => error,
            Error::System(error) => error.into(),
            own => carom_dynamics::Error::Stepper(Box::new(own)),
        }
    }
}
