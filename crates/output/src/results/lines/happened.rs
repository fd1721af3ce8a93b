//! What moved and what met: a run in which nothing happened that was asked about is not good.

use carom_pages::form::Form;

use crate::results::lines::crossing::when_and_where;
use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// Contacts that never closed. A stop that nothing reaches is a result; a run in which no contact closed says nothing of impacts.
pub(super) fn closed(evidence: &Evidence) -> Finding {
    let contacts = &evidence.system.contacts;
    if contacts.is_empty() || evidence.last.ledger.is_static {
        return Finding::Absent;
    }
    let records = contacts.iter().zip(&evidence.last.records.contacts);
    let open: Vec<&str> = records
        .filter(|(_, record)| record.first_closing.is_none())
        .map(|(contact, _)| &*contact.name)
        .collect();
    let count = contacts.len();
    let (quantity, value) = match open.len() == count {
        true => (
            format!("no contact ever closed, of {count}; contacts without a force"),
            1.0,
        ),
        false => (
            format!(
                "{} of {count} contacts closed; whether none did",
                count - open.len()
            ),
            0.0,
        ),
    };
    Finding::Line(Line::new(
        "closed",
        (&quantity, value, Form::Count),
        Bounds::Look(0.0),
        "check directions, units and the end of the run, if an impact was expected",
    ))
}

/// Bodies that met without a contact between them: what they did to each other is not in the result.
pub(super) fn met(evidence: &Evidence) -> Finding {
    let Some(findings) = &evidence.last.crossings else {
        return Finding::Absent;
    };
    let system = evidence.system;
    if !findings.looks(system) {
        return Finding::Absent;
    }
    let met = findings.told.those(|crossing| crossing.contact.is_none());
    let quantity = match met.first() {
        None => "pairs of bodies that met with nothing between them".to_owned(),
        Some(first) => format!(
            "pairs of bodies that met with no contact between them, the first {}",
            when_and_where(evidence, findings, first)
        ),
    };
    Finding::Line(Line::new(
        "met",
        (&quantity, met.len() as f64, Form::Count),
        Bounds::Bad(0.5),
        "give them a [contact.<name>], or take [general-contact]",
    ))
}
