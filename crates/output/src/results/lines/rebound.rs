//! Whether impacts of rigid bodies lose what their law takes.

use carom_contact::Law;
use carom_dynamics::{ContactPair, System};
use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Part of the loss of the law that an impact loses at least. A blow beside the centre of mass takes from what moves at the point alone, which of a
/// cube that falls on a corner is a fifth.
const LEAST: f64 = 0.05;

/// Excess of the coefficient of restitution, of the motion of the centres of mass, that is no rounding.
const MORE: f64 = 0.05;

/// The contact of rigid bodies of which most impacts have rebounded as if its law took nothing, where any did. Nothing in rigid bodies could store the energy.
pub(super) fn of_rigid_bodies(evidence: &Evidence) -> Finding {
    let (system, records) = (evidence.system, &evidence.last.records);
    let mut counts = vec![0.0; system.contacts.len()];
    for impact in records.ended() {
        let contact = impact.contact as usize;
        let (Some(rebound), Some(law)) = (impact.restitution, restitution(system, contact)) else {
            continue;
        };
        let taken = LEAST * (1.0 - law * law) * impact.energy_given;
        if rebound > law + MORE && impact.energy_lost < taken {
            counts[contact] += 1.0;
        }
    }
    let contacts = system.contacts.iter().zip(counts);
    let counts = contacts.filter(|(_, count)| *count > 0.0);
    let Some((name, value)) = worst(counts.map(|(contact, count)| (&*contact.name, count))) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "rebound",
        (
            &format!(
                "impacts of contact `{name}`, whose bodies are rigid, that lost less than a twentieth of the energy that its law takes"
            ),
            value,
            Form::Count,
        ),
        Bounds::Bad(0.5),
        "take a scheme that sees the law in the rate at the end of a step: `carom compare` shows which do",
    ))
}

/// The contact of rigid bodies under the law in the gap that part fastest, over the speed of their approach: the law leaves this speed to the scheme.
pub(super) fn under_the_law_in_the_gap(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let impacts = evidence.last.records.ended();
    let parted = impacts.filter_map(|impact| {
        let pair = &system.contacts[impact.contact as usize];
        let open = matches!(pair.law, Law::Displacement(_)) && has_rigid_bodies(system, pair);
        Some((&*pair.name, impact.restitution.filter(|_| open)?))
    });
    match worst(parted) {
        Some((name, part)) => Finding::Unchecked(format!(
            "the speed at which the rigid bodies of contact `{name}` part, up to {part:.2} of that of their approach: `law.displacement` leaves it to \
             the scheme; take `law.velocity` or `law.restitution`"
        )),
        None => Finding::Absent,
    }
}

/// Contacts of many rigid bodies that closed: what two of them do to each other is not told apart, nor whether the law took what it takes.
pub(super) fn of_many_rigid_bodies(evidence: &Evidence) -> Finding {
    let (system, records) = (evidence.system, &evidence.last.records);
    let mut contacts = system.contacts.iter().zip(&records.contacts).enumerate();
    let open = contacts.find(|(number, (pair, record))| {
        pair.is_of_many && record.first_closing.is_some() && restitution(system, *number).is_some()
    });
    match open {
        Some((_, (pair, _))) => Finding::Unchecked(format!(
            "the speeds at which the rigid bodies of contact `{}` part: it is of many bodies, and no two are told apart; [general-contact] with by = \"bodies\" or contacts by name tell",
            pair.name
        )),
        None => Finding::Absent,
    }
}

/// The coefficient of restitution that the law of a contact has, where it has one and all bodies are rigid.
fn restitution(system: &System, contact: usize) -> Option<f64> {
    let pair = &system.contacts[contact];
    match &pair.law {
        _ if !has_rigid_bodies(system, pair) => None,
        Law::Velocity(_) => Some(0.0),
        Law::Restitution(law) => Some(law.coefficient),
        _ => None,
    }
}

fn has_rigid_bodies(system: &System, pair: &ContactPair) -> bool {
    let mut bodies = pair.bodies.iter();
    bodies.all(|&body| system.bodies[body].as_rigid().is_some())
}
