//! Rigid bodies that land: the instant at which a contact out of flight closes.
//!
//! A rigid body meets what it falls on in one point, or in a few at once. Its other points come down later, if the motion after the
//! impact still brings them there. A configuration that lies a part of a step behind the impact has other points inside as well,
//! with the approach rates that they had before it: a disc of radius R that spins at ω and falls at v has `√(2 R v dt)` of its rim
//! inside, which approaches at up to `v + ω √(2 R v dt)`, and restitution of that would turn the spin into flight.
//!
//! So a contact of rigid bodies without a force in the step before is paired at the instant t* at which the first of its points
//! closes,
//!
//! `min gap(u + (t* - t_k) v) = 0`,
//!
//! and the points that are closed there take part, at their rates there. t* is sought from a step before the instant at which the law
//! tests closure on: a closing after it in the step before counts for this one. Points that the motion after the impact brings down are
//! found in the steps to come, at the rates that they then have.
//!
//! A theta scheme moves the body by the mean of the velocities before and after, as if the impact were at θ of the step. It lands by
//! up to `v dt/2` too deep. That depth stays with the contact until it is open, and points count as closed from it on: otherwise all of
//! the rim above it would be inside, as before.

use std::sync::Arc;

use super::Contacts;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::vectors::Vectors;
use crate::driver::paired::Paired;

/// Steps before the instant at which the law tests closure from which on the closing is sought: those of the step before, and as much
/// again for the difference of its velocity.
const BEFORE: f64 = 1.5;

/// Configurations that are looked at for one closing: Newton's method takes three or four, halving gets to rounding.
const LOOKS: usize = 60;

/// Points of one contact at one configuration.
pub(crate) struct Look {
    /// The least gap, m; infinite where nothing is near.
    gap: f64,
    /// The next time at which one of them is closed at its rate, after the configuration, s; infinite where none comes closer.
    next: f64,
}

impl Contacts {
    /// The instant of a step at which the points of a contact are paired for a law in the rate, over the time by which they move.
    pub(crate) fn captured(&self, attempt: &Attempt, contact: usize) -> f64 {
        let own = self.closings.instant(contact);
        own.unwrap_or_else(|| {
            attempt
                .law(&attempt.system.contacts[contact])
                .get()
                .capture()
        })
    }

    /// Finds the contacts that close out of flight, which are paired as the step begins, and pairs them where they do.
    pub(crate) fn find_closings(&mut self, attempt: &mut Attempt) {
        let system = Arc::clone(&attempt.system);
        let mut any = false;
        for number in 0..system.contacts.len() {
            if self.closings.rigid[number] && self.flies(attempt, number) {
                self.closings.instant[number] = self.closing(attempt, number);
                any |= self.closings.instant[number].is_some();
            }
        }
        if any {
            self.pair(attempt, true);
        }
    }

    /// Forgets those of the step before.
    pub(crate) fn forget_closings(&mut self) {
        self.closings.instant.fill(None);
    }

    /// Whether a contact has had no force in the step before and has not landed since it was last open, and where it is paired a
    /// point of it is closed.
    pub(crate) fn flies(&self, attempt: &Attempt, number: usize) -> bool {
        let map = attempt.map_of(number);
        let steps = !attempt.maps.is_static() && !attempt.between() && map.displacement.x != 0.0;
        if !steps || map.moves == 0.0 {
            return false;
        }
        let before = &attempt.state.interface;
        let free = |point: usize| before.force[point] == 0.0 && before.landed[point] == 0.0;
        let closed = |point: usize| {
            self.pairing.rows.gap(point) <= attempt.system.contacts[number].tolerance
        };
        attempt.system.points_of(number).all(free) && attempt.system.points_of(number).any(closed)
    }

    /// When the first point of a contact that flies closes, over the time by which its points move; none where it was closed all the
    /// time.
    pub(crate) fn closing(&mut self, attempt: &mut Attempt, number: usize) -> Option<f64> {
        let (tolerance, moves) = (
            attempt.system.contacts[number].tolerance,
            attempt.map_of(number).moves,
        );
        let mut closed = self.captured(attempt, number);
        let mut open = closed - BEFORE;
        if self.look_at(attempt, number, open).gap <= tolerance {
            return None;
        }
        let mut look = self.look_at(attempt, number, closed);
        let mut at = closed;
        for _ in 0..LOOKS {
            if look.gap <= tolerance {
                closed = at;
                if look.gap >= -tolerance {
                    break;
                }
            } else {
                open = at;
            }
            let next = at + look.next / moves;
            at = match next > open && next < closed {
                true => next,
                false => 0.5 * (open + closed),
            };
            if at <= open || at >= closed {
                break;
            }
            look = self.look_at(attempt, number, at);
        }
        Some(closed)
    }

    /// Pairs one contact a part of the time by which points move after the start of the step.
    pub(crate) fn look_at(&mut self, attempt: &mut Attempt, number: usize, instant: f64) -> Look {
        let moves = attempt.map_of(number).moves;
        let Vectors { x, push, place, .. } = &mut attempt.vectors;
        let captured = Paired::Captured(instant);
        let motion = &attempt.state.motion;
        attempt
            .maps
            .whole(|map| captured.row(map), motion, [x, push], place);
        self.far.forget_places();
        std::mem::swap(&mut self.pairing, &mut self.closings.room);
        self.pairing.clear();
        self.append(attempt, number, attempt.state.time + instant * moves);
        let rows = &self.pairing.rows;
        let mut look = Look {
            gap: f64::INFINITY,
            next: f64::INFINITY,
        };
        for point in (0..rows.len()).filter(|&point| rows.gap(point).is_finite()) {
            let gap = rows.gap(point);
            let rate = rows.product(point, &attempt.state.motion.v) + rows.rate(point);
            look.gap = look.gap.min(gap);
            if rate < 0.0 {
                look.next = look.next.min(gap / -rate);
            }
        }
        std::mem::swap(&mut self.pairing, &mut self.closings.room);
        look
    }

    /// How deep the contacts of rigid bodies have landed, once the gaps at the end of the step are known.
    pub(super) fn note_landings(&self, attempt: &mut Attempt) {
        for number in 0..attempt.system.contacts.len() {
            if !self.closings.rigid[number] {
                continue;
            }
            let interface = &mut attempt.next.interface;
            let points = attempt.system.points_of(number);
            let depth = match self.closings.instant(number) {
                Some(_) => {
                    let pressed = points
                        .clone()
                        .filter(|&point| interface.force[point] != 0.0);
                    pressed.fold(0.0, |most, point| f64::max(most, -interface.gap[point]))
                }
                None => {
                    let touches =
                        |point| interface.gap[point] <= attempt.system.contacts[number].tolerance;
                    match points.clone().any(touches) {
                        true => continue,
                        false => 0.0,
                    }
                }
            };
            interface.landed[points].fill(depth);
        }
    }
}
