//! Where contacts are paired in a step, and what their laws constrain: maps of the scheme, without a driver.

use carom_contact::law::Level;
use carom_contact::{Contact, Law, Pairing, Places, Search, Sliding};

use crate::step_map::{Row, StepMap};
use crate::system::{Motion, System};

/// The configuration in which a contact is paired.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Paired {
    /// The newest known before the unknown, and a part of the way of the step on with its velocity.
    Captured(f64),
    /// The middle of the step.
    Middle,
    /// That in which laws in the gap hold.
    Gap,
    /// That in which laws with a compliance hold.
    Compliant,
}

impl Paired {
    /// As a row of a map.
    pub(crate) fn row(self, map: &StepMap) -> Row {
        match self {
            Paired::Captured(part) => Row {
                v: map.placed.v + part * map.moves,
                ..map.placed
            },
            Paired::Middle => {
                let end = &map.displacement;
                Row {
                    u: 0.5 + 0.5 * end.u,
                    v: 0.5 * end.v,
                    a: 0.5 * end.a,
                    x: 0.5 * end.x,
                    ..Row::default()
                }
            }
            Paired::Gap => map.gap,
            Paired::Compliant => map.compliant()[0],
        }
    }
}

/// How a contact is paired.
#[derive(Clone, Copy)]
pub(crate) struct PairingMode {
    /// The configuration in which it is.
    pub(crate) paired: Paired,
    /// Derivative of that configuration by the unknown; zero where all of it is known before the step.
    pub(crate) turning: f64,
}

/// Whether laws in the rate hold for a velocity on which contact forces act through the mass too: the interface problem then
/// sums the compliances of the step and of the mass.
pub(crate) fn sums_compliances(system: &System, map: &StepMap) -> bool {
    map.rate.c != 0.0 && system.scheme.get().takes(Level::Rate)
}

/// Gap and rate that a law constrains, and their factors of x over those of the map.
pub(crate) fn instant(map: &StepMap, law: &Law) -> ([Row; 2], [f64; 2]) {
    match law.get().level() {
        Level::GapAndRate => (map.compliant(), map.compliant_factors()),
        Level::Gap | Level::Rate => ([map.gap, map.rate], [1.0; 2]),
    }
}

/// Whether a contact is paired where the step is predicted to lead, for a law that looks ahead, and not where the present
/// velocity does. In a step much longer than a wave takes across an element the velocity of the shortest waves times dt/2
/// leads much further than any node gets, and the turning of the rows would be that of an explicit step of the mass m of the
/// surface nodes alone, unstable beyond dt² |P ∂²g/∂u²| = 4 m.
pub(crate) fn looks_ahead(map: &StepMap, contact: &Contact, law: &Law) -> bool {
    map.force.x != 0.0 && contact.turns() && law.get().capture() > 0.0
}

/// The gap by which a law tells whether a point is closed (S_d): at the captured instant, `gap`, or at the start, a `way`
/// (m) before it, whichever is less. A point that is closed and leaves stays with its law, which alone knows whether
/// the step turns it back.
pub(crate) fn least_gap(gap: f64, way: f64) -> f64 {
    gap - way.max(0.0)
}

/// The part of the way from the start of the step to `end` at which a law takes the geometry.
pub(crate) fn part_way(motion: &Motion, end: &[f64], law: &Law, out: &mut [f64]) {
    let part = law.get().capture();
    for (i, q) in out.iter_mut().enumerate() {
        *q = (1.0 - part) * motion.u[i] + part * end[i];
    }
}

/// Whether a point takes part, where its law says so before the forces. Gap (m) and rate (m/s): as the point is paired, where the
/// law captures it in a step that moves it for `moves` (s). `tolerance`: gap that counts as closed, m.
pub fn told(law: &Law, (gap, rate): (f64, f64), moves: f64, tolerance: f64) -> Option<bool> {
    if gap == f64::INFINITY {
        return Some(false);
    }
    let way = law.get().capture() * moves * rate;
    law.get().watches(least_gap(gap, way), tolerance)
}

/// Whether a point is closed, or closes within `dt` (s) at twice its rate.
pub fn approaches((gap, rate): (f64, f64), dt: f64, tolerance: f64) -> bool {
    gap + 2.0 * dt * rate.min(0.0) <= tolerance
}

/// Appends a contact at the configuration of `places`. With small sliding the points are paired at their reference places, once,
/// or with an obstacle that moves where it is now; gaps are then linear in the displacement, and rows and tangents do not turn
/// with the bodies. `still`: room for a displacement of nothing.
pub fn append(
    contact: &Contact,
    places: &Places,
    still: &mut [f64],
    (search, initial): (&mut Search, &mut Pairing),
    pairing: &mut Pairing,
) {
    if contact.sliding == Sliding::Finite {
        return contact.pair_fully(places, search, pairing);
    }
    if initial.is_empty() || contact.moves() {
        initial.clear();
        initial.span = pairing.span;
        still.fill(0.0);
        let reference = Places {
            u: still,
            ..*places
        };
        contact.pair_fully(&reference, search, initial);
    }
    pairing.append_moved(initial, places.u);
}
