//! Numbers that are none.

use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// States with an energy or a force that is not finite.
pub(super) fn states(evidence: &Evidence) -> Finding {
    Finding::Line(Line::new(
        "not-finite",
        (
            "states with a number that is not finite",
            evidence.totals.not_finite as f64,
            Form::Count,
        ),
        Bounds::Bad(0.0),
        "use a smaller step, or a scheme that is stable with this step",
    ))
}
