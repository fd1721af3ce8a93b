//! Bolts that push.

use carom_pages::form::Form;
use carom_pages::plot::quantity;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// The largest compression of a bolt over its force at the end of the static stage: under compression the head of a bolt lifts off, which a bolt of the
/// model does not.
pub(super) fn compressed(evidence: &Evidence) -> Finding {
    let pushed = evidence.bolts.iter().filter_map(|(name, bolt)| {
        let ([force, _], start) = (bolt.smallest?, bolt.end_of_stage?);
        (force < 0.0).then_some((name.as_str(), -force / start))
    });
    let Some((name, compression)) = worst(pushed) else {
        return Finding::Absent;
    };
    let time = evidence.bolts.get(name).and_then(|bolt| bolt.smallest);
    let told = format!(
        "compression of the bolt `{name}` over its preload, largest at {}: the head of a bolt would lift off",
        quantity(time.map_or(f64::NAN, |[_, time]| time), "s"),
    );
    Finding::Line(Line::new(
        "compressed-bolt",
        (&told, compression, Form::Percent),
        Bounds::Look(0.0),
        "raise the preload, or put a contact between the head and what it presses",
    ))
}
