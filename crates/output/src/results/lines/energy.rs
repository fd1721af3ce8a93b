//! The balance of energy.

use carom_dynamics::Ledger;

use crate::form::Form;
use crate::results::lines::{Evidence, Finding};
use crate::verdict::{Bounds, Line};

/// Bound of the residual relative to the largest energy. The balance is an identity of the linear step; what is left is
/// the rounding of the solves, some 1e-16 a step, summed over up to a million steps.
const RESIDUAL: f64 = 1e-9;

/// Bound of the energy that appears without work of the loads, relative to the largest energy. No law and no scheme has
/// a right to any; what the residual cannot show is a contact that makes energy with its ledger closed, as the
/// trapezoid with the displacement law does.
const GAIN: f64 = 0.01;

/// What the terms of the balance leave over.
pub(super) fn residual(evidence: &Evidence) -> Finding {
    if let Some(scheme) = without_identity(evidence) {
        return Finding::Unchecked(format!(
            "the balance of energy: no energy identity is known of the scheme {scheme}, so the residual holds what the scheme dissipates"
        ));
    }
    Finding::Line(Line::new(
        "energy-residual",
        (
            "energy residual over the largest energy",
            evidence.energy.relative_residual,
            Form::Power,
        ),
        Bounds::Bad(RESIDUAL),
        "a smaller `time.newton.tolerance` where the run iterates; else a fault of the program",
    ))
}

/// Energy from nowhere.
pub(super) fn gain(evidence: &Evidence) -> Finding {
    Finding::Line(Line::new(
        "energy-gain",
        (
            "energy gained without work of loads and supports over the largest energy",
            gained(evidence),
            Form::Percent,
        ),
        Bounds::Bad(GAIN),
        "another scheme or contact law, or a smaller step",
    ))
}

/// Kinetic and strain energy that loads, supports and moving obstacles have not given, relative to the largest; zero for a
/// loss.
fn gained(evidence: &Evidence) -> f64 {
    let Ledger {
        initial,
        balance,
        largest_energy,
        ..
    } = &evidence.last.ledger;
    let mut contacts = evidence.system.contacts.iter();
    let obstacles = match contacts.any(|contact| contact.moves()) {
        true => balance.work_contact.max(0.0),
        false => 0.0,
    };
    let given = balance.work_loads + balance.work_supports + obstacles;
    let gain = balance.energy() - initial.energy() - given;
    gain.max(0.0) / largest_energy.max(f64::MIN_POSITIVE)
}

/// A scheme of the run whose energy residual says nothing.
fn without_identity<'a>(evidence: &'a Evidence) -> Option<&'a str> {
    let scheme = evidence.system.scheme.get();
    match evidence.zones {
        Some(zones) => {
            let mut zones = zones.zones.iter();
            zones
                .find(|zone| !zone.has_identity)
                .map(|zone| zone.scheme.as_str())
        }
        None if scheme.energy_identity(evidence.system.dt).is_some() => None,
        None => Some(scheme.name()),
    }
}
