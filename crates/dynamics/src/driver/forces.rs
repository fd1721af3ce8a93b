//! Forces of an iteration: loads, damping, internal forces.

use std::time::Instant;

use carom_algebra::rotation::Rotation;
use carom_bodies::{Placement, Scratch, Stored};

use super::loads::factor;
use super::owners::{Attempt, Parts};
use super::{Configuration, Vectors};
use crate::error::Error;
use crate::step_map::StepMap;
use crate::system::{Maps, NumberedForce, System};

/// Where the internal forces of all bodies are taken.
pub(super) struct Bodies<'a> {
    /// Displacement, m, and velocity, m/s.
    pub(super) u: &'a [f64],
    pub(super) v: &'a [f64],
    /// Displacement at the start, m, for forces between the two.
    pub(super) from: Option<&'a [f64]>,
    /// Rotations and histories at the start.
    pub(super) frames: &'a [Rotation],
    pub(super) history: &'a [f64],
}

/// Adds the internal forces of all bodies (N) and writes their histories. `dt`: time since the start of the step, by body, s.
///
/// # Errors
/// An element turned inside out, a material without stress.
pub(super) fn add_up(
    system: &System,
    of: &Bodies,
    dt: impl Fn(usize) -> f64,
    (history, internal): (&mut [f64], &mut [f64]),
    scratch: &mut [Scratch],
) -> Result<Stored, Error> {
    let mut sum = Stored::default();
    for (k, body) in system.bodies.iter().enumerate() {
        let range = system.nonlinear.histories[k].clone();
        let at = Placement {
            u: of.u,
            v: of.v,
            from: of.from,
            frames: of.frames,
            dt: dt(k),
            old: &of.history[range.clone()],
        };
        let stored = body.force(&at, &mut history[range], &mut scratch[k], internal)?;
        sum.include(&stored);
    }
    Ok(sum)
}

impl Attempt {
    /// Loads in the balance of the step, which holds at an instant of its own in each zone, at the configuration in `place`, N.
    pub(super) fn evaluate_loads_of_step(&mut self) {
        let (start, dt) = (self.state.time, self.dt);
        let after = |zone: usize, maps: &Maps| maps.all()[zone].instant(dt);
        let first = after(0, &self.maps);
        let zones = self.maps.all().len();
        if (1..zones).all(|zone| after(zone, &self.maps) == first) {
            return self.evaluate_loads_over(start + first, self.between());
        }
        for zone in 0..zones {
            self.evaluate_loads_over(start + after(zone, &self.maps), self.between());
            let Vectors { load, work, .. } = &mut self.vectors;
            for (span, _) in self.system.spans.iter().filter(|(_, of)| *of == zone) {
                work[span.clone()].copy_from_slice(&load[span.clone()]);
            }
        }
        let Vectors { load, work, .. } = &mut self.vectors;
        load.copy_from_slice(work);
    }

    /// Loads at a time and at the configuration in `place`, N.
    pub(super) fn evaluate_loads(&mut self, time: f64) {
        self.evaluate_loads_over(time, false);
    }

    /// The same, of pressures the mean on the way of the step to `place` if `between`.
    pub(super) fn evaluate_loads_over(&mut self, time: f64, between: bool) {
        let system = &*self.system;
        let from = between.then_some(&self.state.motion.u[..]);
        let ramp = system.nonlinear.ramp(time);
        let (load, place) = (&mut self.vectors.load, &self.vectors.place);
        for (sum, dead) in load.iter_mut().zip(&system.load) {
            *sum = ramp * dead;
        }
        for given in &system.nonlinear.loads {
            let factor = factor(&given.amplitude, ramp, time);
            match &given.force {
                NumberedForce::Dead(forces) => {
                    for &(unknown, force) in forces {
                        load[unknown as usize] += factor * force;
                    }
                }
                NumberedForce::Follower(given, pressure) => {
                    let p = factor * pressure;
                    match from {
                        None => given.add_force(p, place, load),
                        Some(from) => given.add_mean_force(p, [from, place], load),
                    }
                }
            }
        }
        self.add_bolts(time);
    }
}

impl Parts {
    /// Forces of dashpots and of Rayleigh's damping at the velocity of the iteration, N.
    pub(super) fn evaluate_damping(&mut self, attempt: &mut Attempt) {
        let system = &*attempt.system;
        let vectors = &mut attempt.vectors;
        if !system.has_damping() {
            return;
        }
        if attempt.maps.is_static() {
            vectors.damping.fill(0.0);
            return;
        }
        match &system.damping_mass {
            Some(mass) => mass.multiply(&vectors.rate, &mut vectors.damping),
            None => vectors.damping.fill(0.0),
        }
        for body in &system.bodies {
            body.add_damping_force(&vectors.rate, &mut vectors.damping);
        }
        for modal in &system.modal {
            modal.add_force(&vectors.rate, &mut vectors.damping);
        }
        for (k, damping) in system.nonlinear.damping.iter().enumerate() {
            if damping.stiffness != 0.0 {
                for (scaled, rate) in vectors.work.iter_mut().zip(&vectors.rate) {
                    *scaled = damping.stiffness * rate;
                }
                let scratch = &mut self.scratch[k];
                system.bodies[k].internal_force(&vectors.work, scratch, &mut vectors.damping);
            }
        }
    }

    /// Internal forces of all bodies where `place` says, into `internal`; histories into the scratch history. `dt`: time since
    /// the start of the step, s.
    ///
    /// # Errors
    /// An element turned inside out, a material without stress.
    pub(super) fn internal(
        &mut self,
        attempt: &mut Attempt,
        (place, from): (Configuration, bool),
        dt: impl Fn(&StepMap) -> f64,
    ) -> Result<Stored, Error> {
        let begin = Instant::now();
        let system = &*attempt.system;
        let Vectors {
            place: configuration,
            rate,
            internal,
            history,
            ..
        } = &mut attempt.vectors;
        let (u, v, frames) = match place {
            Configuration::Place => (&configuration[..], &rate[..], &attempt.state.motion.frames),
            Configuration::Next => {
                let next = &attempt.next.motion;
                (&next.u[..], &next.v[..], &next.frames)
            }
        };
        let from = from.then_some(&attempt.state.motion.u[..]);
        internal.fill(0.0);
        self.force_sweeps += 1;
        let at = Bodies {
            u,
            v,
            from,
            frames,
            history: &attempt.state.motion.history,
        };
        let maps = &attempt.maps;
        let dt = |body: usize| dt(&maps.all()[system.zone_of_body[body]]);
        let sum = add_up(system, &at, dt, (history, internal), &mut self.scratch)?;
        attempt.phases.forces += begin.elapsed();
        Ok(sum)
    }

    /// Strain energy U(u), J, of linear bodies, and f(u), N, into `work`. `u`: in `place`.
    pub(super) fn linear_forces(&mut self, attempt: &mut Attempt) -> f64 {
        let Vectors { place, work, .. } = &mut attempt.vectors;
        work.fill(0.0);
        self.force_sweeps += 1;
        let bodies = attempt.system.bodies.iter().zip(&mut self.scratch);
        bodies
            .map(|(body, scratch)| body.internal_force(place, scratch, work))
            .sum()
    }
}
