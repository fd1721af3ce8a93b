//! The exact solution beside the run.

use crate::results::lines::{Evidence, Finding};
use crate::verdict;

/// Error of the force.
pub(super) fn force(evidence: &Evidence) -> Finding {
    let exact = evidence.exact;
    match exact.and_then(|exact| Some((exact, exact.force_error?))) {
        Some((exact, error)) => {
            let of = format!("the exact solution `{}`", exact.name);
            Finding::Line(verdict::force_error(&of, error))
        }
        None => Finding::Absent,
    }
}
