//! The balance of momentum.

use crate::form::Form;
use crate::results::lines::energy::{MOST_TOLERATED, of_tolerance, residual_remedy};
use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// Bound of the residual relative to the largest momentum. The balance is an identity of the linear step; what is left is
/// the rounding of the solves, some 1e-16 a step, summed over up to a million steps.
const RESIDUAL: f64 = 1e-9;

/// Change of the momentum without an impulse from outside.
pub(super) fn residual(evidence: &Evidence) -> Finding {
    let tolerated = match evidence.momentum.size > 0.0 {
        true => evidence.last.ledger.tolerated.momentum / evidence.momentum.size,
        false => 0.0,
    };
    Finding::Line(Line::new(
        "momentum-residual",
        (
            &of_tolerance("momentum residual over the largest momentum", tolerated),
            evidence.momentum.relative_residual,
            Form::Power,
        ),
        Bounds::Bad((RESIDUAL + tolerated).min(MOST_TOLERATED)),
        residual_remedy(tolerated),
    ))
}
