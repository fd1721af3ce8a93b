//! The problem of an iteration with bodies alone linearised.
//!
//! The matrix A of an iteration is symmetric, and its contact forces act along the rows N of where the iteration begins. What it leaves
//! out (the weights of mortar and the directions of friction, which move with the points, and the part of the tangent that is not
//! symmetric) makes iterations converge at a rate, not quadratically. With K̂ the whole derivative of inertia, internal and
//! damping forces at x, the motion d and the forces P of the iteration are therefore sought of
//!
//! `r(x) - K̂ d + N(x + d)ᵀ P = 0,   laws at x + d,`
//!
//! whose only error is that of the bodies, of second order in d. Passes solve it with A as it is,
//!
//! `A δ - N(x)ᵀ P₊ = r - K̂ d + (N(x + d) - N(x))ᵀ P,   gap(x + d) + N(x) δ,   d₊ = d + δ,`
//!
//! which needs the columns of N(x) that are at hand, and neither forces of elements nor a factor; Anderson's mixing makes of them
//! what GMRES is for linear problems. These are Newton iterations with the symmetric factor as preconditioner.

use std::sync::Arc;

use carom_contact::Sliding;

use super::deletion::as_narrowed;
use super::mixing::LARGEST;
use super::owners::{Attempt, Contacts, Parts};
use super::refined::Refined;
use super::residual::Standing;
use super::{Driver, Vectors};
use crate::error::Error;
use crate::system::System;

/// Most passes of an iteration.
const PASSES: usize = 12;

/// Imbalance of the last pass over that of the first one, and over what the iteration will leave.
const LEFT: f64 = 0.1;

/// Imbalance of the last pass, and defects of contact laws, over the tolerances of the iterations.
pub(super) const WITHIN: f64 = 0.01;

/// Imbalance over that of the pass before from which on passes are of no use.
const STALLED: f64 = 0.9;

impl Driver {
    /// Makes the motion `dx` of the iteration and the contact forces after it those of the problem with bodies alone linearised.
    ///
    /// # Errors
    /// A contact problem without solution.
    pub(super) fn refine(&mut self) -> Result<(), Error> {
        // the motion has the jump of the supports
        let jumps = std::mem::take(&mut self.attempt.vectors.jumps);
        let mut refined = std::mem::take(&mut self.parts.refined);
        refined.x.clone_from(&self.attempt.vectors.x);
        refined.residual.clone_from(&self.attempt.vectors.residual);
        refined.motion.clone_from(&self.attempt.vectors.dx);
        refined.mixing.clear();
        self.parts.refined.holds_columns = true;
        let outcome = self.passes(&mut refined);
        let vectors = &mut self.attempt.vectors;
        vectors.jumps = jumps;
        vectors.x.copy_from_slice(&refined.x);
        vectors.residual.copy_from_slice(&refined.residual);
        vectors.dx.copy_from_slice(&refined.motion);
        self.parts.refined = refined;
        outcome
    }

    fn passes(&mut self, refined: &mut Refined) -> Result<(), Error> {
        let (mut enough, mut last) = (None, f64::INFINITY);
        for _ in 0..PASSES {
            let standing = self.stand_at(refined);
            let now = standing.imbalance;
            let enough = *enough.get_or_insert_with(|| self.parts.enough(&self.attempt, now));
            let obeys = standing.defect <= WITHIN;
            if obeys && (now <= enough.max(standing.rounding) || now > STALLED * last) {
                break;
            }
            if now > last {
                self.contacts.undo_pass(&mut self.attempt, refined);
                break;
            }
            last = now;
            refined.before.clone_from(&refined.motion);
            refined.interface.clone_from(&self.attempt.next.interface);
            refined.slips.clone_from(&self.contacts.slips);
            self.contacts.load_pass(&mut self.parts, &mut self.attempt);
            self.solve_with_columns()?;
            let way = (
                &self.attempt.vectors.x[..],
                &mut self.attempt.vectors.dx[..],
            );
            if refined
                .mixing
                .mix(way, &mut self.attempt.next.interface, LARGEST)
            {
                self.contacts.take_weak(&self.attempt);
            }
            for (motion, dx) in refined.motion.iter_mut().zip(&self.attempt.vectors.dx) {
                *motion += dx;
            }
        }
        Ok(())
    }

    /// Goes to x + d, with the residual of linear bodies there.
    fn stand_at(&mut self, refined: &mut Refined) -> Standing {
        let system = Arc::clone(&self.attempt.system);
        self.parts
            .effective
            .whole_product(&refined.motion, &mut refined.product);
        let vectors = &mut self.attempt.vectors;
        for (i, x) in vectors.x.iter_mut().enumerate() {
            *x = refined.x[i] + refined.motion[i];
            if !system.fixed[i] {
                vectors.residual[i] = refined.residual[i] - refined.product[i];
            }
        }
        self.contacts.pair_candidates(&mut self.attempt);
        self.standing()
    }
}

impl Parts {
    /// Whether it may be, by what the step has beside bodies and contacts.
    pub(super) fn may_refine(&self, attempt: &Attempt) -> bool {
        !self.floats(attempt) && !attempt.has_links() && attempt.vectors.push.is_empty()
    }

    /// Imbalance at which passes may end, the first of which leaves this one: a tenth of it, and of what the error of the bodies will be,
    /// c r² with the c of the iteration before.
    pub(super) fn enough(&self, attempt: &Attempt, first: f64) -> f64 {
        let bodies = match self.residuals[..] {
            [.., before, now] if now < before => now * (now / before).powi(2),
            _ => first,
        };
        let tolerance = attempt.system.nonlinear.iteration.tolerance;
        f64::max(LEFT * first.min(bodies), WITHIN * tolerance)
    }
}

impl Contacts {
    /// Undoes the last pass.
    pub(super) fn undo_pass(&mut self, attempt: &mut Attempt, refined: &mut Refined) {
        refined.motion.clone_from(&refined.before);
        attempt.next.interface.clone_from(&refined.interface);
        self.slips.clone_from(&refined.slips);
        self.take_weak(attempt);
    }

    /// Pairs the candidates at x; other points stay as they are.
    pub(super) fn pair_candidates(&mut self, attempt: &mut Attempt) {
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
    pub(super) fn refines(&self, parts: &Parts, attempt: &Attempt) -> bool {
        let turns = |&point: &u32| {
            let contact = attempt.system.contact_of(point as usize);
            self.turning(contact) != 0.0
                && attempt.system.contacts[contact].sliding == Sliding::Finite
        };
        parts.effective.has_whole_tangent()
            && parts.may_refine(attempt)
            && (attempt.between() || self.candidates.iter().any(turns))
    }

    /// Forces of a pass without those of its contacts along N(x), into `work`.
    pub(super) fn load_pass(&self, parts: &mut Parts, attempt: &mut Attempt) {
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
    pub(super) fn take_column_forces(&self, parts: &mut Parts, attempt: &mut Attempt, factor: f64) {
        let width = 1 + match self.rubs(attempt) {
            true => attempt.system.tangents() as u32,
            false => 0,
        };
        let Some((_, compliance)) = parts.effective.both() else {
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
