//! Contacts that switch on and off.

use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Changes of status to a closing that is due: a sound contact has two. Above three every second point closes once more than
/// it should. Above seven the force is a row of blows whose sizes are the step's: of two bars of 20 to 200 elements under all
/// schemes and laws those with eight and more have a force error of 88 % at least, those with six and less of 57 % at most.
const BOUNDS: Bounds = Bounds::Both(3.0, 7.0);

/// The contact that chatters most.
pub(super) fn of_contacts(evidence: &Evidence) -> Finding {
    let contacts = evidence.system.contacts.iter();
    let records = contacts.zip(&evidence.last.records.contacts);
    let closed = records.filter(|(_, record)| record.closings > 0);
    let Some((name, value)) = worst(closed.map(|(c, record)| (&*c.name, record.chatter()))) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "chatter",
        (
            &format!(
                "changes of status of a point of contact `{name}` per expected closing (2 without chatter)"
            ),
            value,
            Form::Number,
        ),
        BOUNDS,
        "use the velocity law with the theta scheme, or numerical damping; `carom check` warns of pairs of scheme and law that chatter",
    ))
}
