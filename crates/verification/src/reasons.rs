//! Why combinations are refused.

use carom_dynamics::Refused;

use crate::Error;

/// Why a combination is refused; `None` of an error that is no refusal.
pub(crate) fn reason(error: &Error) -> Option<String> {
    match error {
        Error::Dynamics(error) => reason_of_run(error),
        Error::Zones(error) => reason_of_zones(error),
        Error::System(error) => reason_of(error),
        Error::Reduction(error) => Some(format!("reduced body: {error}")),
        _ => None,
    }
}

fn reason_of_zones(error: &carom_zones::Error) -> Option<String> {
    use carom_zones::Error as E;
    match error {
        E::Zone { cause, .. } => reason_of_run(cause),
        E::Dynamics(error) => reason_of_run(error),
        E::System(error) => reason_of(error),
        E::LinkScheme { cause, .. } => Some(format!("zones of unequal steps: {cause}")),
        E::AcrossZones { cause, .. } => Some(format!("between zones of unequal steps: {cause}")),
        _ => None,
    }
}

fn reason_of_run(error: &carom_dynamics::Error) -> Option<String> {
    use carom_dynamics::Error as E;
    match error {
        E::System(error) => reason_of(error),
        E::Body(carom_bodies::Error::NoBetween { .. }) => Some(NO_BETWEEN.to_owned()),
        _ => None,
    }
}

/// Why a material that dissipates has no scheme that conserves energy by its stress.
const NO_BETWEEN: &str = "the scheme conserves energy by a stress between the two ends of a step, which a material that dissipates does not have";

fn reason_of(error: &carom_system::Error) -> Option<String> {
    use carom_system::Error as E;
    let words = match error {
        E::DisplacementLaw { .. } => {
            "the displacement at the end of an explicit step does not depend on the contact force: the displacement law is impossible"
        }
        E::RateLaw { .. } => {
            "the contact forces of the scheme act on the displacement at the end of the step: it needs the displacement law"
        }
        E::GapLaw { .. } => {
            "the contact impulses of the scheme act on the velocity at the end of the step: it needs a law in the rate"
        }
        E::Projection { .. } => {
            "the projection at closure needs velocity, acceleration and force in balance at the end of the step: only Newmark's scheme has this balance"
        }
        E::Body(carom_bodies::Error::NoBetween { .. }) => NO_BETWEEN,
        E::ConsistentMass { .. } => {
            "explicit schemes divide by the mass of each node, and a reduced body has a matrix of mass"
        }
        E::Nonlinear { what, why } => {
            let of = match what {
                Refused::TurningLink(_) => "links that turn",
                Refused::FiniteRotations(_) => "finite rotations",
                _ => return None,
            };
            return Some(format!("{of}: {why}"));
        }
        E::MasslessContact { cause, .. } => return Some(format!("massless nodes: {cause}")),
        E::Massless { cause, .. } => return Some(format!("massless nodes: {cause}")),
        _ => return None,
    };
    Some(words.to_string())
}
