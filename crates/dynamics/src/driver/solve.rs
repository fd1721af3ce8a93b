//! The iterations of one attempt at a step.
//!
//! Where all is linear in the unknown, one iteration is all: free motion, interface problem, correction.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::Vec3;
use carom_algebra::unknowns::Kind;
use carom_contact::Search;

use super::Driver;
use super::mixing::{LARGEST, LARGEST_OF_FLOATING};
use super::owners::{Attempt, Contacts, Parts};
use super::pieces::Pieces;
use super::refine::WITHIN;
use super::residual::Standing;
use super::rigid::Rigid;
use crate::error::Error;
use crate::step_map::StepMap;

/// Residual before and after an iteration beyond which the motion of the iteration is halved.
const GROWTH: f64 = 4.0;

/// Halvings of the motion of one iteration.
const SHORTENINGS: u32 = 5;

/// Imbalance over that one iteration ago up to which the iteration was a gain.
const GAIN: f64 = 0.5;

/// Iterations that a fresh factor is counted to need.
const FRESH: f64 = 2.0;

/// Cost of a new tangent beside its factorisation, in iterations with the old one.
const TANGENT: f64 = 3.0;

/// Largest number of iterations of a step in which parts move on along motions that nothing holds, over that of others.
const MOVES: usize = 10;

/// Imbalance over what may be rounding from which on iterations are mixed: below, their changes are noise.
const NOISY: f64 = 10.0;

impl Driver {
    /// Finds x and the contact forces of the step.
    ///
    /// # Errors
    /// No equilibrium, an element or a matrix that fails.
    pub(super) fn solve(&mut self) -> Result<(), Error> {
        match self.solve_from_guesses() {
            Err(error)
                if !self.attempt.interrupt.is_set()
                    && self.parts.leaves_iterations(&self.attempt) =>
            {
                tracing::debug!(
                    "step {}: {error}; once more with factors",
                    self.attempt.state.step + 1
                );
                self.attempt.notices.factored.add(|| error.to_string());
                self.solve_from_guesses()
            }
            other => other,
        }
    }

    fn solve_from_guesses(&mut self) -> Result<(), Error> {
        let solved = self.iterate(false);
        match solved {
            // elements inside out: once more from another guess
            Err(Error::Body(_) | Error::OnRank { .. })
                if !self.attempt.maps.is_static() && !self.contacts.is_affine(&self.parts) =>
            {
                self.iterate(true)
            }
            other => other,
        }
    }

    /// The iterations from the motion of no acceleration, or from the rigid one.
    fn iterate(&mut self, rigidly: bool) -> Result<(), Error> {
        self.begin_iterations(rigidly)?;
        if self.contacts.is_affine(&self.parts) {
            return self.solve_at_once();
        }
        let passes = self.attempt.system.nonlinear.iteration.passes;
        let (mut limit, most) = (passes, MOVES * passes);
        let mut standing = self.standing();
        let (mut pass, mut before) = (0, None);
        while pass < limit {
            if self.attempt.interrupt.is_set() {
                return Err(Error::Interrupted);
            }
            let jumps = self.attempt.jumps();
            self.parts.residuals.push(standing.imbalance);
            if pass > 0 && !jumps && self.is_solved(&standing, before) {
                return self
                    .contacts
                    .check_held(&self.parts, &mut self.attempt, pass);
            }
            if self.parts.floats(&self.attempt) && !jumps && self.approach(standing.scale)? {
                self.parts.mixing.clear();
                standing = self.standing();
            }
            if self
                .contacts
                .wants_factor(&mut self.parts, &self.attempt, pass)
            {
                self.renew()?;
                (self.parts.pace.age, self.parts.pace.made) = (0, pass);
            }
            self.parts.pace.age += 1;
            self.parts.carried.keep(&self.attempt.next.interface);
            self.solve_interface()?;
            // a motion that contacts hardly hold is far above the noise of the forces
            // what is mixed of a motion would be mixed of the multipliers too
            if self.contacts.refines(&self.parts, &self.attempt) {
                self.refine()?;
            }
            let mixes = !jumps && !self.attempt.has_links();
            if mixes
                && (self.parts.floats(&self.attempt)
                    || standing.imbalance > NOISY * standing.rounding)
            {
                self.contacts.mix(&mut self.parts, &mut self.attempt);
            }
            if self.parts.floats(&self.attempt) && !jumps && self.restrain() {
                // the part has moved on: iterations begin anew
                limit = most.min(pass + passes);
            }
            before = Some(standing.excess);
            standing = self.go(&standing, jumps)?;
            pass += 1;
        }
        if self.is_solved(&standing, before) {
            return self
                .contacts
                .check_held(&self.parts, &mut self.attempt, limit);
        }
        Err(self.unbalanced(limit, standing.force))
    }

    /// First guess, residual and pairing of the attempt.
    pub(super) fn begin_iterations(&mut self, rigidly: bool) -> Result<(), Error> {
        self.parts.residuals.clear();
        (self.parts.pace.age, self.parts.pace.fresh) = (0, self.attempt.state.control.pace);
        self.parts.pace.is_sized = false;
        self.parts.floating.begin();
        self.parts.mixing.clear();
        self.parts.take_matrices(&mut self.attempt)?;
        self.links.begin_links(&self.attempt);
        self.attempt.predict();
        if rigidly {
            self.attempt.predict_rigidly();
        }
        let interface = &mut self.attempt.next.interface;
        interface.follow(&self.attempt.state.interface);
        self.contacts.guess_slips(&mut self.attempt);
        self.contacts.take_weak(&self.attempt);
        if self.parts.prepared {
            self.links.add_link_force(&mut self.attempt);
            return Ok(());
        }
        self.evaluate(true)?;
        self.attempt.vectors.ahead.clear();
        self.contacts.search.iter_mut().for_each(Search::begin_step);
        self.contacts.begin_far(&self.attempt);
        self.contacts.forget_closings();
        self.contacts.pair(&mut self.attempt, true);
        if (0..self.attempt.system.contacts.len()).any(|k| self.attempt.looks_ahead(k)) {
            self.look_ahead()?;
            self.contacts.pair(&mut self.attempt, true);
        }
        self.contacts.find_closings(&mut self.attempt);
        Ok(())
    }

    /// The one iteration of a step that is linear in the unknown.
    fn solve_at_once(&mut self) -> Result<(), Error> {
        self.parts.residuals.push(0.0);
        self.solve_interface()?;
        let vectors = &mut self.attempt.vectors;
        for (x, dx) in vectors.x.iter_mut().zip(&vectors.dx) {
            *x += dx;
        }
        self.links.move_links(&self.attempt, 1.0);
        self.stages.spread(&self.contacts, &mut self.attempt);
        self.parts.left_over = match self.attempt.system.is_nonlinear() {
            true => {
                self.links.scale_of_forces(&mut self.parts, &self.attempt)
                    * self.attempt.system.nonlinear.iteration.tolerance
            }
            false => 0.0,
        };
        Ok(())
    }

    /// Whether iterations may end. `before`: the excess one iteration ago. Within what rounding leaves they end where they
    /// gain no more, not where they get there: what is left would be of one sign step after step, and add up. Not so under the
    /// forces of links, whose passes need answers that are smooth in them.
    fn is_solved(&self, standing: &Standing, before: Option<f64>) -> bool {
        let gains = before.is_none_or(|before| standing.excess < GAIN * before);
        let gains = gains && self.links.force.is_empty();
        // the last iteration of those that converge quadratically is long: points that stick would slip by its square
        let most = if self.contacts.refines(&self.parts, &self.attempt) {
            WITHIN
        } else {
            1.0
        };
        (standing.excess <= 1.0 || standing.is_rounding && !gains) && standing.defect <= most
    }

    /// Goes the way of the iteration, or as much of it as does not make things much worse.
    fn go(&mut self, before: &Standing, jumps: bool) -> Result<Standing, Error> {
        self.attempt
            .vectors
            .before
            .copy_from_slice(&self.attempt.vectors.x);
        let mut share = 1.0;
        let (mut last, mut gains) = (None, false);
        for shortening in 0..=SHORTENINGS {
            let vectors = &mut self.attempt.vectors;
            for (i, x) in vectors.x.iter_mut().enumerate() {
                *x = vectors.before[i] + share * vectors.dx[i];
            }
            if self.parts.floats(&self.attempt) {
                self.parts.turn(&mut self.attempt, share);
            }
            self.links.move_links(&self.attempt, share);
            match self.evaluate(false) {
                Ok(()) => {
                    self.contacts.pair(&mut self.attempt, false);
                    let standing = self.standing();
                    let grows = standing.imbalance > GROWTH * before.imbalance.max(1e-6);
                    if jumps || !grows || self.contacts.is_affine(&self.parts) {
                        (last, gains) = (Some(Ok(standing)), true);
                        break;
                    }
                    last = Some(Ok(standing));
                }
                Err(error) => last = Some(Err(error)),
            }
            if shortening < SHORTENINGS {
                share *= 0.5;
                self.parts.carried.halve(&mut self.attempt.next.interface);
                self.contacts.take_weak(&self.attempt);
            }
        }
        if jumps {
            self.attempt.shorten_jump(1.0 - share);
        }
        match last {
            Some(Ok(standing)) => {
                if !gains {
                    let place = self.attempt.place_of_imbalance();
                    self.attempt.notices.worse.add(|| place);
                }
                // a part that rolls far in one iteration deforms until the next: what is known of the way it rolls is as
                // good as before
                if share < 1.0 {
                    self.parts.mixing.clear();
                } else if standing.imbalance > before.imbalance && !self.parts.floats(&self.attempt)
                {
                    self.parts.mixing.keep_last();
                }
                Ok(standing)
            }
            Some(outcome) => outcome,
            None => Err(self.contacts.no_equilibrium(&self.parts, &self.attempt, 0)),
        }
    }
}

impl Parts {
    pub(super) fn leaves_iterations(&mut self, attempt: &Attempt) -> bool {
        let between = attempt.between();
        let (system, maps) = (&attempt.system, &attempt.maps);
        self.effective.leave_iterations(system, maps, between)
    }

    /// Whether an iteration whose error is that of the bodies alone needs their derivative anew: with it residuals go on as r₊ = c r²
    /// with the c of the last iteration, else at its rate. A tangent with its factor was measured to cost about what the
    /// passes that it saves, with 888 unknowns and with 2304 (decision 019).
    pub(super) fn wants_tangent(&self, attempt: &Attempt) -> bool {
        let [.., before, now] = self.residuals[..] else {
            return false;
        };
        let ratio = now / before;
        if ratio.is_nan() || ratio >= 0.5 {
            return true;
        }
        let tolerance = attempt.system.nonlinear.iteration.tolerance;
        let kept = (tolerance / now).ln() / ratio.ln();
        let (mut left, mut newer) = (now, 0.0);
        while left > tolerance {
            left *= ratio * (left / before);
            newer += 1.0;
        }
        let renewed = kept > newer;
        tracing::debug!(
            "step {}, iteration {}: residual {now:e}, {ratio} times the one before; the factor is {}: {kept:.1} iterations \
             with it against {newer} with a new one",
            attempt.state.step + 1,
            self.residuals.len() - 1,
            if renewed { "renewed" } else { "kept" },
        );
        renewed
    }
}

impl Attempt {
    /// Begins with the motion of no acceleration, or with the one before it; motions that are prescribed come as a jump in
    /// the first iteration, so that the inside of the body goes along.
    pub(super) fn predict(&mut self) {
        let system = Arc::clone(&self.system);
        let motion = &self.state.motion;
        let vectors = &mut self.vectors;
        if self.maps.is_static() {
            vectors.x.fill(0.0);
        } else {
            self.maps.known(|map| map.inertia, motion, &mut vectors.x);
            for (span, map) in self.maps.spans() {
                for x in &mut vectors.x[span] {
                    *x *= -1.0 / map.inertia.x;
                }
            }
        }
        vectors.jump.fill(0.0);
        vectors.jumps = false;
        if self.maps.all().iter().all(|map| map.displacement.x == 0.0) {
            return;
        }
        let place = &mut vectors.place;
        self.maps.known(|map| map.displacement, motion, place);
        vectors.work.fill(0.0);
        let time = [self.state.time, self.state.time + self.dt];
        system.nonlinear.prescribe(time, &mut vectors.work);
        let maps = &self.maps;
        let held = |(span, map): (Range<usize>, &StepMap)| {
            let x = map.displacement.x;
            let fixed = &system.fixed;
            let held = span.filter(move |&i| x != 0.0 && fixed[i]);
            held.map(move |i| (i, x))
        };
        for (i, x) in maps.spans().flat_map(held) {
            vectors.x[i] = (motion.u[i] - vectors.place[i]) / x;
            vectors.jump[i] = (vectors.work[i] - motion.u[i]) / x;
            vectors.jumps |= vectors.jump[i] != 0.0;
        }
    }

    /// Leaves this part of the jump of the supports to the iterations to come.
    pub(super) fn shorten_jump(&mut self, rest: f64) {
        let vectors = &mut self.vectors;
        for jump in &mut vectors.jump {
            *jump *= rest;
        }
        vectors.jumps = vectors.jump.iter().any(|jump| *jump != 0.0);
    }

    /// Begins with the rigid motion of each part that is nearest to its velocity. The motion of no acceleration may turn elements
    /// inside out where velocities alternate from step to step, as a trapezoidal rule leaves them in stiff modes: the
    /// displacements of these modes stay what they are.
    pub(super) fn predict_rigidly(&mut self) {
        let system = Arc::clone(&self.system);
        let motion = &self.state.motion;
        // explicit zones have their place already
        let factor = |i: usize| self.maps.of(i).displacement.x;
        let parts = Pieces::of_parts(&system);
        let rigid = Rigid::new(&system, &parts, (&motion.u, None));
        let mut c = rigid.nearest(&motion.v);
        c.iter_mut().for_each(|c| *c *= self.dt);
        let vectors = &mut self.vectors;
        let place = &mut vectors.place;
        self.maps.known(|map| map.displacement, motion, place);
        let moved = |i: usize| !system.fixed[i] && factor(i) != 0.0;
        for i in (0..motion.u.len()).filter(|&i| moved(i)) {
            vectors.x[i] = (motion.u[i] - vectors.place[i]) / factor(i);
        }
        for (i, u) in rigid.motion(&c).chain(rigid.arc(&c)) {
            if moved(i) {
                vectors.x[i] += u / factor(i);
            }
        }
        for (node, angle) in rigid.turns(&c).filter(|(node, _)| system.bends_at(*node)) {
            let frame = system.unknowns.frame(node);
            let start = frame.map_or(Rotation::IDENTITY, |frame| motion.frames[frame]);
            let turn = start.matrix().tr_mul(&Vec3::from(angle));
            for i in system.unknowns.rotations_of(node).filter(|&i| moved(i)) {
                if let Kind::Rotation(axis) = system.unknowns.kind(i) {
                    vectors.x[i] += turn[axis] / factor(i);
                }
            }
        }
    }
}

impl Contacts {
    /// Whether this iteration needs a new factor.
    pub(super) fn wants_factor(&self, parts: &mut Parts, attempt: &Attempt, pass: usize) -> bool {
        if !parts.effective.iterates() {
            return false;
        }
        if self.refines(parts, attempt) && parts.pace.age > 0 {
            return parts.wants_tangent(attempt);
        }
        let (Some(&now), Some(price)) = (parts.residuals.last(), parts.effective.price()) else {
            return true;
        };
        let Some(ratio) = self.contraction(parts, attempt) else {
            return parts.pace.age == 0;
        };
        let least = if self.alternates(parts, attempt) {
            1.0
        } else {
            0.5
        };
        if ratio.is_nan() || ratio >= least {
            return true;
        }
        let left = (attempt.system.nonlinear.iteration.tolerance / now).ln();
        let needed = left / ratio.ln();
        if self.alternates(parts, attempt) && parts.pace.age == 2 && parts.pace.made > 0 {
            parts.pace.fresh = ratio;
        }
        let fresh = match parts.pace.fresh > 0.0 {
            true => (left / parts.pace.fresh.ln()).max(FRESH),
            false => FRESH,
        };
        let keeps = needed <= fresh + TANGENT + price;
        tracing::debug!(
            "step {}, iteration {pass}: residual {now:e}, {} times the one before; the factor is {}: \
             {needed:.1} iterations with it against {fresh:.1} with a new one that costs {:.1}",
            attempt.state.step + 1,
            ratio,
            if keeps { "kept" } else { "renewed" },
            TANGENT + price,
        );
        !keeps
    }

    /// Whether residuals fall by turns fast and slowly.
    pub(super) fn alternates(&self, parts: &Parts, attempt: &Attempt) -> bool {
        attempt.between() && !self.refines(parts, attempt)
    }

    /// Factor by which an iteration with the factor at hand shrinks the residual, if that is known. The matrix of forces
    /// between two states is the symmetric part of their derivative, with which residuals fall by turns fast and slowly:
    /// two iterations are looked at.
    pub(super) fn contraction(&self, parts: &Parts, attempt: &Attempt) -> Option<f64> {
        match (&parts.residuals[..], parts.pace.age) {
            (_, 0) => None,
            ([.., before, now], 1) if !self.alternates(parts, attempt) => Some(now / before),
            (_, 1) => None,
            ([.., before, _, now], _) if self.alternates(parts, attempt) => {
                Some((now / before).sqrt())
            }
            ([.., before, now], _) => Some(now / before),
            _ => None,
        }
    }

    /// Mixes the iteration that has been computed with those before it.
    pub(super) fn mix(&mut self, parts: &mut Parts, attempt: &mut Attempt) {
        let largest = match parts.floats(attempt) {
            true => LARGEST_OF_FLOATING,
            false => LARGEST,
        };
        let way = (&attempt.vectors.x[..], &mut attempt.vectors.dx[..]);
        if parts.mixing.mix(way, &mut attempt.next.interface, largest) {
            self.take_weak(attempt);
        }
    }
}
