//! The balance of momentum.

use carom_pages::form::Form;

use crate::results::lines::energy::{MOST_TOLERATED, of_tolerance, permitted, residual_remedy};
use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// Bound of the residual relative to the largest momentum. The balance is an identity of the linear step; what is left is
/// the rounding of the solves, some 1e-16 a step, summed over up to a million steps.
const RESIDUAL: f64 = 1e-9;

/// What the iterations may leave, and what rounding may, relative to the largest momentum.
fn left(evidence: &Evidence) -> [f64; 2] {
    let ledger = &evidence.last.ledger;
    [&ledger.tolerated, &ledger.rounding].map(|left| match evidence.momentum.size > 0.0 {
        true => left.momentum / evidence.momentum.size,
        false => 0.0,
    })
}

/// Change of the momentum without an impulse from outside.
pub(super) fn residual(evidence: &Evidence) -> Finding {
    let left = left(evidence);
    let quantity = "momentum residual relative to the largest momentum";
    let (quantity, bounds) = permitted(quantity, left);
    Finding::Line(Line::new(
        "momentum-residual",
        (&quantity, evidence.momentum.relative_residual, Form::Power),
        bounds,
        residual_remedy(evidence, left[0]),
    ))
}

/// Change of the angular momentum without a moment from outside, where all bodies have small displacements: moments are then about
/// undeformed places, and the balance is an identity. In large rotations few schemes conserve it.
pub(super) fn angular(evidence: &Evidence) -> Finding {
    let small = evidence.system.undeformed.iter().all(|small| *small);
    let Some(angular) = evidence.momentum.angular.as_ref().filter(|_| small) else {
        return Finding::Absent;
    };
    // its size is at least the momentum times the largest arm, the tolerated forces have this arm too
    let left = left(evidence);
    let quantity = "residual of the angular momentum relative to the largest";
    let (quantity, bounds) = permitted(quantity, left);
    Finding::Line(Line::new(
        "angular-momentum-residual",
        (&quantity, angular.relative_residual, Form::Power),
        bounds,
        residual_remedy(evidence, left[0]),
    ))
}

/// What the contacts give to each body by the forces and impulses that they report, against what its momentum changes by. Between
/// bodies the contact forces cancel in the sum.
pub(super) fn exchange(evidence: &Evidence) -> Finding {
    if evidence.system.contacts.is_empty() {
        return Finding::Absent;
    }
    let Some([residual, momentum]) = evidence.last.exchange else {
        return Finding::Absent;
    };
    let tolerated = evidence.last.ledger.tolerated.momentum / momentum;
    let quantity = "difference between the reported impulse of the contacts and the momentum that the bodies received, relative to the largest momentum";
    Finding::Line(Line::new(
        "contact-impulse",
        (
            &of_tolerance(quantity, tolerated),
            residual / momentum,
            Form::Power,
        ),
        Bounds::Bad((RESIDUAL + tolerated).min(MOST_TOLERATED)),
        residual_remedy(evidence, tolerated),
    ))
}

/// Part of the impulse that forces times steps may miss where sizes change: a force that begins with one size of step and ends
/// with the double one misses half a step in the hundreds of an impact.
const RESIZING: f64 = 1e-3;

/// The same where the history of the forces is no measure of the impulse.
const MISSED: f64 = 0.05;

/// What the sum of force times step misses of the impulse because the step changed its size in contact.
pub(super) fn resizing(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    if system.adaptive.is_none() && system.critical_fraction.is_none() {
        return Finding::Absent;
    }
    let records = evidence.last.records.contacts.iter();
    let parts = records
        .filter(|record| record.impulse() != 0.0)
        .map(|record| (record.impulse_of_resizing() / record.impulse()).abs());
    match parts.reduce(f64::max) {
        Some(part) => Finding::Line(Line::new(
            "resizing",
            (
                "impulse that the sum of force times step lacks because the step changed its size in contact, relative to the impulse",
                part,
                Form::Percent,
            ),
            Bounds::Both(RESIZING, MISSED),
            "use a scheme and a law without chatter, because each new size of the step in contact counts; or a fixed step",
        )),
        None => Finding::Absent,
    }
}
