//! What bodies of explicit schemes have beside the model: hourglass control, mass scaling.

use super::{Evidence, Finding, worst};
use crate::form::Form;
use crate::verdict::{Bounds, Line};

/// Bounds of the largest energy of hourglass modes relative to the largest energy that the materials took. The control resists motions
/// that one point does not see; up to a tenth is the rule of practice, and from a twentieth on it is worth a look.
const HOURGLASS: Bounds = Bounds::Both(0.05, 0.1);

/// Bounds of the added mass relative to that of the body's material: from a twentieth on it is worth a look; as much mass again changes
/// momenta and frequencies by the factor that is asked about.
const ADDED: Bounds = Bounds::Both(0.05, 1.0);

/// Energy of hourglass modes.
pub(super) fn hourglass(evidence: &Evidence) -> Finding {
    let ledger = &evidence.last.ledger;
    if ledger.largest_hourglass == 0.0 {
        return Finding::Absent;
    }
    Finding::Line(Line::new(
        "hourglass",
        (
            "largest energy of hourglass modes, relative to the largest energy that the materials took",
            ledger.largest_hourglass / ledger.largest_internal,
            Form::Percent,
        ),
        HOURGLASS,
        "use a finer mesh, another factor `hourglass`, or another `formulation`",
    ))
}

/// Mass that mass scaling has added.
pub(super) fn added_mass(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let bodies = system.bodies.iter().enumerate();
    let scaled = bodies.filter(|(_, body)| body.added_mass() != 0.0);
    let shares = scaled.map(|(number, body)| {
        let added = body.added_mass();
        (body.name(), added / (system.body_mass(number) - added))
    });
    let Some((name, share)) = worst(shares) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "added-mass",
        (
            &format!("mass that mass scaling adds to body `{name}`, relative to its own"),
            share,
            Form::Percent,
        ),
        ADDED,
        "use less of it, or see by `carom study` what it changes",
    ))
}
