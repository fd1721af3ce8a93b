//! Internal forces of an iteration.

use std::time::Instant;

use carom_algebra::rotation::Rotation;
use carom_bodies::{Placement, Scratch};

use super::Parts;
use crate::body_energies::BodyEnergies;
use crate::driver::attempt::vectors::Vectors;
use crate::driver::attempt::{Attempt, Configuration};
use crate::error::Error;
use crate::step_map::StepMap;
use crate::system::System;

/// Where the internal forces of all bodies are taken.
pub(crate) struct Bodies<'a> {
    /// Displacement, m, and velocity, m/s.
    pub(crate) u: &'a [f64],
    pub(crate) v: &'a [f64],
    /// Displacement at the start, m, for forces between the two.
    pub(crate) from: Option<&'a [f64]>,
    /// Rotations and histories at the start.
    pub(crate) frames: &'a [Rotation],
    pub(crate) history: &'a [f64],
}

/// Adds the internal forces of all bodies (N) and writes their histories and energies. `dt`: time since the start of the step, by body, s.
///
/// # Errors
/// An element turned inside out, a material without stress.
pub(crate) fn add_up(
    system: &System,
    of: &Bodies,
    dt: impl Fn(usize) -> f64,
    (history, internal): (&mut [f64], &mut [f64]),
    (scratch, energies): (&mut [Scratch], &mut BodyEnergies),
) -> Result<(), Error> {
    energies.begin(system.bodies.len());
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
        energies.include(k, &stored);
    }
    Ok(())
}

impl Parts {
    /// Forces of dashpots and of Rayleigh's damping at the velocity of the iteration, N.
    pub(crate) fn evaluate_damping(&mut self, attempt: &mut Attempt) {
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

    /// Internal forces of all bodies where `place` says, into `internal`; histories into the scratch history; the energies are kept. `dt`: time since
    /// the start of the step, s.
    ///
    /// # Errors
    /// An element turned inside out, a material without stress.
    pub(crate) fn internal(
        &mut self,
        attempt: &mut Attempt,
        (place, from): (Configuration, bool),
        dt: impl Fn(&StepMap) -> f64,
    ) -> Result<(), Error> {
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
        let own = (&mut self.scratch[..], &mut self.energies);
        add_up(system, &at, dt, (history, internal), own)?;
        attempt.phases.forces += begin.elapsed();
        Ok(())
    }

    /// Strain energy U(u), J, of linear bodies, and f(u), N, into `work`. `u`: in `place`.
    pub(crate) fn linear_forces(&mut self, attempt: &mut Attempt) -> f64 {
        let Vectors { place, work, .. } = &mut attempt.vectors;
        work.fill(0.0);
        self.force_sweeps += 1;
        let bodies = attempt.system.bodies.iter().zip(&mut self.scratch);
        bodies
            .map(|(body, scratch)| body.internal_force(place, scratch, work))
            .sum()
    }
}
