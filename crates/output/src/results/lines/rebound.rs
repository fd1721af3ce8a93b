//! Whether impacts of rigid bodies lose what their law takes.

use carom_contact::Law;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};
use carom_pages::form::Form;

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
        let (Some(rebound), Some(law)) = (impact.restitution, restitution(evidence, contact))
        else {
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

/// The coefficient of restitution that the law of a contact has, where it has one and all bodies are rigid.
fn restitution(evidence: &Evidence, contact: usize) -> Option<f64> {
    let system = evidence.system;
    let pair = &system.contacts[contact];
    let mut bodies = pair.bodies.iter();
    if !bodies.all(|&body| system.bodies[body].as_rigid().is_some()) {
        return None;
    }
    match &pair.law {
        Law::Velocity(_) => Some(0.0),
        Law::Restitution(law) => Some(law.coefficient),
        _ => None,
    }
}
