//! The balance of momentum.

use crate::form::Form;
use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// Bound of the residual relative to the largest momentum. The balance is an identity of the linear step; what is left is
/// the rounding of the solves, some 1e-16 a step, summed over up to a million steps.
const RESIDUAL: f64 = 1e-9;

/// Change of the momentum without an impulse from outside.
pub(super) fn residual(evidence: &Evidence) -> Finding {
    Finding::Line(Line::new(
        "momentum-residual",
        (
            "momentum residual over the largest momentum",
            evidence.momentum.relative_residual,
            Form::Power,
        ),
        Bounds::Bad(RESIDUAL),
        "a smaller `time.newton.tolerance` where the run iterates; else a fault of the program",
    ))
}
