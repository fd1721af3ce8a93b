//! Whether and how an iteration is refined with bodies alone linearised.

use std::sync::Arc;

use carom_contact::Sliding;

use super::Contacts;
use super::deletion::as_narrowed;
use crate::driver::attempt::Attempt;
use crate::driver::attempt::vectors::Vectors;
use crate::driver::parts::Parts;
use crate::driver::parts::mixing::Refined;
use crate::system::System;

impl Contacts {
    /// Undoes the last pass.
    pub(crate) fn undo_pass(&mut self, attempt: &mut Attempt, refined: &mut Refined) {
        refined.motion.clone_from(&refined.before);
        attempt.next.interface.clone_from(&refined.interface);
        self.slips.clone_from(&refined.slips);
        self.take_weak(attempt);
    }

    /// Pairs the candidates at x; other points stay as they are.
    pub(crate) fn pair_candidates(&mut self, attempt: &mut Attempt) {
        let system = Arc::clone(&attempt.system);
        let plain = attempt.vectors.ahead.is_empty() && attempt.vectors.end.is_empty();
        if !plain || self.rows_stand || !self.far.is_empty() {
            return self.pair(attempt, false);
        }
        let (mut placed, mut own) = (None, Vec::new());
        for (number, contact) in system.contacts.iter().enumerate() {
            let range = system.points_of(number);
            let first = range.start;
            let points = self.candidates.iter().map(|&point| point as usize);
            own.clear();
            own.extend(
                points
                    .filter(|point| range.contains(point))
                    .map(|point| (point - first) as u32),
            );
            if own.is_empty() || self.turning(number) == 0.0 {
                continue;
            }
            let paired = self.paired_at(number);
            if placed.replace(paired) != Some(paired) {
                let Vectors { x, push, place, .. } = &mut attempt.vectors;
                attempt.maps.whole(
                    |map| paired.row(map),
                    &attempt.state.motion,
                    [x, push],
                    place,
                );
            }
            if contact.sliding == Sliding::Small {
                let initial = &self.initial[number].rows;
                self.pairing
                    .rows
                    .move_again(first, initial, &attempt.vectors.place);
                continue;
            }
            self.pairing.span = self.span(attempt, number);
            let time = attempt.state.time + self.paired_after(attempt, number);
            let mut places =
                system.places(time, &attempt.vectors.place, &attempt.state.motion.frames);
            places.frames.middle = attempt.between();
            let contact = as_narrowed(&self.narrowed, &system, number);
            let search = &mut self.search[number];
            contact.pair_again(&places, search, (&own, first), &mut self.pairing);
        }
        self.stack(attempt);
    }

    /// Whether the problem of an iteration is solved with bodies alone linearised.
    pub(crate) fn refines(&self, parts: &Parts, attempt: &Attempt) -> bool {
        let turns = |&point: &u32| {
            let contact = attempt.system.contact_of(point as usize);
            self.turning(contact) != 0.0
                && attempt.system.contacts[contact].sliding == Sliding::Finite
        };
        parts.effective().has_whole_tangent()
            && parts.may_refine(attempt)
            && (attempt.between() || self.candidates.iter().any(turns))
    }

    /// Forces of a pass without those of its contacts along N(x), into `work`.
    pub(crate) fn load_pass(&self, parts: &mut Parts, attempt: &mut Attempt) {
        let factor = attempt.maps.contact();
        let vectors = &mut attempt.vectors;
        for (work, (r, contact)) in vectors
            .work
            .iter_mut()
            .zip(vectors.residual.iter().zip(&vectors.contact))
        {
            *work = r + factor * contact;
        }
        self.take_column_forces(parts, attempt, -factor);
        let System { fixed, .. } = &*attempt.system;
        for (work, fixed) in attempt.vectors.work.iter_mut().zip(fixed) {
            if *fixed {
                *work = 0.0;
            }
        }
    }

    /// Adds the forces of the candidates along the rows of their columns, times `factor`, to `work`.
    fn take_column_forces(&self, parts: &mut Parts, attempt: &mut Attempt, factor: f64) {
        let width = 1 + match self.rubs(attempt) {
            true => attempt.system.tangents() as u32,
            false => 0,
        };
        let Some((_, compliance)) = parts.effective_mut().both() else {
            return;
        };
        let interface = &attempt.next.interface;
        for &point in &self.candidates {
            let at = point as usize;
            let t = interface.friction.get(at).copied().unwrap_or_default();
            let forces = [interface.force[at], t[0], t[1]];
            for (row, force) in (point * width..(point + 1) * width).zip(forces) {
                if force != 0.0 {
                    compliance.add_force(row, factor * force, &mut attempt.vectors.work);
                }
            }
        }
    }
}
