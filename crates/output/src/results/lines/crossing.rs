//! Contacts whose sides have changed sides without a force, within a step or between the points that carry forces.

use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Grade, Line};

/// Depth over the size of an element normal to the surface, as of a point that carries a force: between points that do, nothing keeps the
/// other side out.
const BETWEEN: Bounds = Bounds::Both(0.1, 1.0);

/// The contact whose primary side is deepest behind its secondary one, where that is worth a look: a little of it is what two meshes that do
/// not match leave.
pub(super) fn between(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter().enumerate();
    let records = contacts.zip(&evidence.last.records.contacts);
    let depths = records
        .filter(|((_, contact), _)| !contact.law.get().is_of_the_whole())
        .map(|((k, contact), record)| {
            let depth = record.between.value / evidence.system.depth_of_elements(k);
            (&*contact.name, depth)
        });
    match worst(depths) {
        Some((name, value)) if BETWEEN.grade(value) != Grade::Good => Finding::Line(Line::new(
            "penetration-between",
            (
                &format!(
                    "largest depth of a node of the primary side of contact `{name}` behind its secondary side, between the points of that, relative to the smallest element size normal to its surfaces"
                ),
                value,
                Form::Percent,
            ),
            BETWEEN,
            "exchange `secondary` and `primary`, or refine the secondary surface: of two sides the one with the smaller faces is to be secondary",
        )),
        _ => Finding::Absent,
    }
}

/// One point is enough: what it met is not in the result.
const BOUNDS: Bounds = Bounds::Bad(0.5);

/// The contact of which most points passed what they face in a step, where any did.
pub(super) fn of_contacts(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter();
    let records = contacts.zip(&evidence.last.records.contacts);
    let passed = records.filter(|(_, record)| record.passed > 0);
    let counts = passed.map(|(contact, record)| (&*contact.name, record.passed as f64));
    let Some((name, value)) = worst(counts) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "crossing",
        (
            &format!(
                "points of contact `{name}` that passed what they face within a step, without a force"
            ),
            value,
            Form::Count,
        ),
        BOUNDS,
        "use a smaller step, in which bodies come closer by less than half the thickness of what they meet",
    ))
}
