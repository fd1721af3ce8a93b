//! Explicit steps at finite strain: elements that shorten take the critical step down as they deform.
//!
//! To find the frequencies of all elements costs many steps, so it is done anew where a length in an element may have changed by
//! [`CHANGE`]. That no length has is known without a look at the elements as long as `Σ dt 2 max |v_a - w| / l` is below it, with any
//! velocity w and the shortest length l; otherwise lengths are compared with those that had these frequencies, and frequencies found anew where
//! they differ by more than a part of it.

use carom_bodies::{Body, Looks, Seen};

use super::Driver;
use super::attempt::critical::{PART, changes, fastest};
use crate::error::Error;
use crate::shapes::Shape;

/// Largest change of the lengths in an element, relative, between looks at its frequencies.
const CHANGE: f64 = 0.1;

/// Part of this change from which on frequencies are found anew where lengths are compared: the less, the more frequencies; the more, the older they
/// are, and the sooner lengths are compared again.
const WORTH: f64 = 0.4;

/// Steps that are fractions of the critical step have so many sizes from one to its half: equal steps know the displacement ahead.
const RUNGS: f64 = 16.0;

/// Relative difference of steps that are equal but for rounding: far from the origin, places and so lengths in elements are rounded to
/// `1e-16 |x| / l`. A step that is the fraction [`PART`] of the critical one must not be halved for that.
const ROUNDING: f64 = 1e-6;

impl Driver {
    /// Looks at the critical step of an explicit scheme anew, before a step of `dt` (s), where elements have changed; what was
    /// found is kept in the state.
    ///
    /// # Errors
    /// An element without tangent.
    pub(super) fn renew_stable(&mut self, dt: f64) -> Result<(), Error> {
        let system = std::sync::Arc::clone(&self.attempt.system);
        let explicit = system
            .schemes
            .iter()
            .any(|scheme| scheme.get().is_explicit());
        if !explicit || self.attempt.is_static() || !system.bodies.iter().any(changes) {
            return Ok(());
        }
        let known = !self.attempt.state.shapes.bodies.is_empty();
        if known {
            self.attempt.state.shapes.changed += dt * self.rate_of_lengths();
            if self.attempt.state.shapes.changed <= CHANGE {
                return Ok(());
            }
        }
        // in the memory of the last look
        let mut bodies = std::mem::take(&mut self.attempt.state.shapes.bodies);
        bodies.clear();
        let mut all = Seen::default();
        self.look_at_bodies(|body, seen, velocity| {
            all = all.with(seen);
            let shortest = seen.shortest;
            bodies.push(changes(body).then_some(Shape { velocity, shortest }));
        })?;
        let shapes = &mut self.attempt.state.shapes;
        shapes.bodies = bodies;
        if all.is_renewed {
            self.attempt.state.control.stable = PART * system.critical_with(all.bound.frequency);
            shapes.by_compression = all.bound.by_compression;
        }
        shapes.changed = all.changed;
        Ok(())
    }

    /// Bound of the rate at which lengths in elements change, relative, 1/s.
    fn rate_of_lengths(&mut self) -> f64 {
        let (system, v) = (&*self.attempt.system, &self.attempt.state.motion.v);
        let (parts, bodies) = (&system.part_of_body, &self.attempt.state.shapes.bodies);
        // the last pass has found them
        if let Some(rate) = self.explicit.rate_of_pass(parts, bodies) {
            return rate;
        }
        match self.ranks.shared() {
            None => {
                let fastest = |part: usize, w: &[f64; 3]| fastest(system, part, (w, v));
                self.explicit.rates_mut().largest(parts, bodies, fastest)
            }
            Some(shared) => {
                self.explicit.rates_mut().refer(parts, bodies);
                let squares = shared.fastest(system, &self.explicit.rates().reference, v);
                self.explicit
                    .rates_mut()
                    .largest(parts, bodies, |part, _| squares[part])
            }
        }
    }

    /// Looks at each body, and tells `take` what is seen of it and its mean velocity, m/s.
    ///
    /// # Errors
    /// An element without tangent.
    fn look_at_bodies(
        &mut self,
        mut take: impl FnMut(&Body, &Seen, [f64; 3]),
    ) -> Result<(), Error> {
        let (system, motion) = (&*self.attempt.system, &self.attempt.state.motion);
        if let Some(shared) = self.ranks.shared_mut() {
            let found = shared.look(system, motion, WORTH * CHANGE)?;
            for (body, (seen, velocity)) in system.bodies.iter().zip(&found) {
                take(body, seen, *velocity);
            }
            return Ok(());
        }
        let looks = &mut self.attempt.state.shapes.looks;
        looks.resize_with(system.bodies.len(), Looks::default);
        for (k, (body, looks)) in system.bodies.iter().zip(looks).enumerate() {
            let mut seen = Seen::default();
            if system.is_bound_by(k) {
                seen = body.look(&system.placement(k, motion), looks, WORTH * CHANGE)?;
            }
            take(body, &seen, system.mean_velocity(k, &motion.v));
        }
        Ok(())
    }

    /// How many times a step of `dt` (s) is halved for its parts to be below the critical step.
    ///
    /// # Errors
    /// A critical step below the smallest part.
    pub(super) fn stable_level(&self, dt: f64) -> Result<u32, Error> {
        let stable = self.attempt.stable_step();
        let halvings = self.attempt.system.nonlinear.iteration.halvings;
        let mut levels = 0..=halvings;
        let whole = dt * (1.0 - ROUNDING);
        let level = levels.find(|&level| whole <= stable * (1u64 << level) as f64);
        level.ok_or_else(|| self.shortened(dt, stable))
    }

    /// The step of the model, or where it is a fraction of the critical step and elements have changed, the largest of the ladder
    /// `dt 2^(-k/RUNGS)` that is no larger a fraction of the present one, s.
    ///
    /// # Errors
    /// A critical step below the smallest part.
    pub(super) fn followed_step(&self) -> Result<f64, Error> {
        let dt = self.attempt.system.dt;
        let Some(fraction) = self.attempt.system.critical_fraction else {
            return Ok(dt);
        };
        let most = f64::min(1.0, fraction / PART) * self.attempt.stable_step();
        // a step much larger than the last feeds energy to the fastest waves: one rung at a time; those of a static stage move none
        let last = match self.attempt.state.step > self.attempt.system.static_steps() {
            true => (RUNGS * (dt / self.attempt.state.control.taken).log2()).round(),
            false => 0.0,
        };
        let rungs = (RUNGS * ((dt / most).log2() - ROUNDING))
            .ceil()
            .max(last - 1.0)
            .max(0.0);
        if rungs > RUNGS * f64::from(self.attempt.system.nonlinear.iteration.halvings) {
            return Err(self.shortened(dt, most));
        }
        Ok(match rungs > 0.0 {
            true => f64::min(most, dt * f64::exp2(-rungs / RUNGS)),
            false => f64::min(most, dt),
        })
    }

    /// That the smallest part of a step of `dt` (s) is larger than the one that fits, `fitting` (s).
    fn shortened(&self, dt: f64, fitting: f64) -> Error {
        let (system, state) = (&*self.attempt.system, &self.attempt.state);
        let halvings = system.nonlinear.iteration.halvings;
        // of several ranks none has all elements as they are now
        let whole = !self.is_shared();
        let bound = whole.then(|| system.critical_step_at(&state.motion).ok());
        let cell = bound.flatten().and_then(|(_, bound)| bound.cell);
        let owns = |body: &&Body| cell.is_some_and(|cell| body.cells().contains(&cell));
        let body = system.bodies.iter().find(owns);
        Error::Shortened {
            step: state.step + 1,
            time: state.time,
            dt: dt / (1u64 << halvings) as f64,
            critical: self.attempt.stable_step() / PART,
            fitting,
            place: match (body, cell) {
                (Some(body), Some(cell)) => {
                    let [x, y, z] = system.mesh.middle(cell);
                    format!(
                        "cell {} of block {} in body '{}', whose middle was at ({x:.4e}, {y:.4e}, {z:.4e}) m",
                        cell.index,
                        cell.block,
                        body.name()
                    )
                    .into()
                }
                _ => "an element".into(),
            },
        }
    }

    /// Makes the attempt the state; what is known of the shapes goes along.
    pub(super) fn swap_states(&mut self) {
        self.attempt
            .next
            .motion
            .compose(&self.attempt.system.unknowns);
        std::mem::swap(
            &mut self.attempt.state.shapes,
            &mut self.attempt.next.shapes,
        );
        std::mem::swap(&mut self.attempt.state, &mut self.attempt.next);
        self.contacts.accept();
        self.explicit.accept();
    }
}
