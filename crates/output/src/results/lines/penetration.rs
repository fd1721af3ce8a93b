//! Bodies that go into each other, and through each other.

use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Penetration over the size of an element normal to the surface: spread over that element it is a strain that the result lacks.
/// A tenth is more than any small strain; a whole element is deeper than the layer that carries the surface.
const BOUNDS: Bounds = Bounds::Both(0.1, 1.0);

/// The contact with the deepest penetration; stops and other laws of the contact as a whole are given theirs.
pub(super) fn of_contacts(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter().enumerate();
    let records = contacts.zip(&evidence.last.records.contacts);
    let depths = records
        .filter(|((_, contact), _)| !contact.law.get().is_of_the_whole())
        .map(|((k, contact), record)| {
            let depth = record.penetration / evidence.system.depth_of_elements(k);
            (&*contact.name, depth)
        });
    let Some((name, value)) = worst(depths) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "penetration",
        (
            &format!(
                "largest penetration of contact `{name}` relative to the smallest element size normal to its surfaces"
            ),
            value,
            Form::Percent,
        ),
        BOUNDS,
        "use a smaller step, `sliding = \"finite\"` if bodies move far, or a stiffer law if it is a spring",
    ))
}

/// Depth behind what a point faced in a step, over that from which it is not pushed back. From there on it has passed what it faced, and no
/// force has told; half of it is as close to that as a run should come.
const PASSING: Bounds = Bounds::Both(0.5, 1.0);

/// The contact whose sides came closest to passing through each other.
pub(super) fn of_passing(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter();
    let records = contacts.zip(&evidence.last.records.contacts);
    let ways = records.filter_map(|(contact, record)| {
        let depth = record.passing.value / contact.depth_of_hold()?;
        Some((&*contact.name, depth))
    });
    let Some((name, value)) = worst(ways) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "passing",
        (
            &format!(
                "largest depth of a point of contact `{name}` at the start or end of a step, seen from the side it faced, relative to the depth from which it is not pushed back (above 1 the sides passed through each other)"
            ),
            value,
            Form::Percent,
        ),
        PASSING,
        "use a smaller step, in which the sides come closer by less than the thickness of what they meet",
    ))
}
