//! Whether the steps resolve the forces of the impacts.

use carom_contact::law::Level;
use carom_dynamics::{Impact, System};
use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// The step over the duration of a contact. Of half a sine in n steps the trapezoid has the duration too long by (π/n)²/12, and
/// meets the closing to within a step: some percent of the peak at ten steps. Impulses and energies may be right all the same.
const BOUNDS: Bounds = Bounds::Look(0.1);

/// Peak over the largest around its bodies, below which nobody relies on it.
pub(super) const LESSER: f64 = 0.1;

/// The contact whose largest force lasts the fewest steps.
pub(super) fn of_peaks(evidence: &Evidence) -> Finding {
    let peaks = peaks(evidence);
    let resolved = peaks
        .iter()
        .filter(|impact| has_duration(evidence.system, impact.contact as usize));
    let named = resolved.map(|impact| (name(evidence, impact), 1.0 / impact.peak_steps as f64));
    let Some((name, value)) = worst(named) else {
        return Finding::Absent;
    };
    Finding::Line(Line::new(
        "step-in-contact",
        (
            &format!(
                "step relative to the time that contact `{name}` was closed around its largest force"
            ),
            value,
            Form::Percent,
        ),
        BOUNDS,
        "use a smaller `time.step`, or judge by impulses and energies: peaks of so few steps are those of the step",
    ))
}

/// Contacts whose forces have no duration of their own.
pub(super) fn of_impulses(evidence: &Evidence) -> Finding {
    let peaks = peaks(evidence);
    let found = peaks
        .iter()
        .find(|impact| !has_duration(evidence.system, impact.contact as usize));
    match found {
        Some(impact) => Finding::Unchecked(format!(
            "peak forces of contact `{}`: neither its bodies nor its law give an impact a duration; its force is an impulse over the step, and only the impulse means something",
            name(evidence, impact)
        )),
        None => Finding::Absent,
    }
}

/// Relative difference of two peaks up to which neither is the largest: rounding must not choose.
const TIE: f64 = 1e-6;

/// Whether a peak is judged before another of the same contact: the larger one, and of equal ones that of fewer steps.
fn comes_first(impact: &Impact, other: &Impact) -> bool {
    let [own, others] = [impact, other].map(|impact| impact.peak_force);
    own > others * (1.0 + TIE)
        || own >= others * (1.0 - TIE) && impact.peak_steps < other.peak_steps
}

/// The impact of the largest force of each contact that comes near the largest of the run; those that have ended.
fn peaks(evidence: &Evidence) -> Vec<Impact> {
    let records = &evidence.last.records;
    let mut largest: Vec<Option<Impact>> = vec![None; records.contacts.len()];
    for impact in records.ended().filter(|impact| impact.peak_steps > 0) {
        let of_contact = &mut largest[impact.contact as usize];
        if of_contact
            .as_ref()
            .is_none_or(|other| comes_first(&impact, other))
        {
            *of_contact = Some(impact);
        }
    }
    let force = |contact: usize| largest[contact].as_ref().map_or(0.0, |one| one.peak_force);
    let matters = |impact: &&Impact| {
        let most = evidence.largest_beside(impact.contact as usize, force);
        impact.peak_force >= LESSER * most
    };
    largest.iter().flatten().filter(matters).cloned().collect()
}

/// Whether something gives an impact of this contact a duration: waves in a body, or the stiffness of the law.
fn has_duration(system: &System, contact: usize) -> bool {
    system.contacts[contact].law.get().level() == Level::GapAndRate || has_waves(system, contact)
}

/// Whether waves run in a body of a contact.
pub(super) fn has_waves(system: &System, contact: usize) -> bool {
    let mut bodies = system.contacts[contact].bodies.iter();
    bodies.any(|&body| system.bodies[body].wave_speed().is_some())
}

fn name<'a>(evidence: &'a Evidence, impact: &Impact) -> &'a str {
    &evidence.system.contacts[impact.contact as usize].name
}
