//! What bodies of explicit schemes have beside the model: hourglass control, mass scaling, deletion.

use carom_pages::form::Form;

use super::{Evidence, Finding, worst};
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

/// What no number of a run with deleted cells can tell.
pub(super) fn deleted_cells(evidence: &Evidence) -> Finding {
    let deleted = evidence.last.ledger.deleted;
    if deleted == 0 {
        return Finding::Absent;
    }
    let bodies = evidence.system.bodies.iter();
    let cells = bodies.filter(|body| body.has_deletion());
    let cells: usize = cells.map(|body| body.cells().len()).sum();
    Finding::Unchecked(format!(
        "whether the mesh decides what breaks: {deleted} of {cells} cells were deleted; vary `mesh.refine` with `carom study`"
    ))
}

/// What nodes without cells make of the forces of contacts.
pub(super) fn loose_nodes(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter();
    let records = contacts.zip(&evidence.last.records.contacts);
    let of_loose = records.filter(|(_, record)| record.loose_closings > 0);
    let named: Vec<String> = of_loose
        .map(|(contact, record)| format!("{} in contact `{}`", record.loose_closings, contact.name))
        .collect();
    if named.is_empty() {
        return Finding::Absent;
    }
    Finding::Unchecked(format!(
        "the force of nodes whose cells are all deleted: each strikes with its own mass, so that the mesh decides on blows and peaks ({}); read impulses and means over time",
        named.join(", ")
    ))
}
