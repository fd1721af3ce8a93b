//! Loads, damping and forces at given unknowns of an attempt.

use carom_algebra::Error as AlgebraError;
use rayon::prelude::*;

use super::Attempt;
use super::vectors::Vectors;
use crate::driver::explicit::leapfrog::Direct;
use crate::driver::loads::factor;
use crate::error::{Error, MeshNode};
use crate::interface::Failure;
use crate::step_map::Known;
use crate::system::{Maps, NumberedForce};

impl Attempt {
    /// The error of iterations that do not end. `unknown`: the one with the largest residual.
    pub(crate) fn not_solved(&self, unknown: usize, cause: AlgebraError) -> Error {
        let system = &*self.system;
        Error::Factor {
            matrix: "effective matrix",
            node: MeshNode::of(system, system.unknowns.node(unknown)),
            cause,
        }
    }

    /// The error behind a failure of the interface problem of some points.
    pub(crate) fn interface_error(&self, failure: Failure, candidates: &[u32]) -> Error {
        let step = self.state.step + 1;
        match failure {
            Failure::Singular { points, cause } => Error::Interface {
                step,
                points,
                cause,
            },
            Failure::Cycling { passes, candidate } => {
                let (contact, point) = self.system.point(candidates[candidate] as usize);
                Error::Statuses {
                    step,
                    passes,
                    contact: contact.name.clone(),
                    point,
                }
            }
            Failure::Interrupted { .. } => Error::Interrupted,
        }
    }

    /// Loads in the balance of the step, which holds at an instant of its own in each zone, at the configuration in `place`, N.
    pub(crate) fn evaluate_loads_of_step(&mut self) {
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
    pub(crate) fn evaluate_loads(&mut self, time: f64) {
        self.evaluate_loads_over(time, false);
    }

    /// The same, of pressures the mean on the way of the step to `place` if `between`.
    fn evaluate_loads_over(&mut self, time: f64, between: bool) {
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

    /// Displacements of the end: those found ahead, if the step is as long as it was taken to be.
    pub(crate) fn place_end(&mut self, direct: &mut Direct) {
        let (row, motion) = (self.maps.first().displacement, &self.state.motion);
        direct.pending = None;
        if direct.ready.take() == Some(row) {
            std::mem::swap(&mut self.next.motion.u, &mut direct.ahead);
            self.next.motion.frames.clone_from(&motion.frames);
            return;
        }
        let start = Known::from(motion);
        let ends = self.next.motion.u.par_chunks_mut(UNKNOWNS).enumerate();
        ends.for_each(|(chunk, end)| {
            let first = chunk * UNKNOWNS;
            row.known(start.within(first..first + end.len()), end);
        });
        self.next.motion.frames.clone_from(&motion.frames);
    }

    /// Loads at the end: those of `load` where they vary, otherwise what the dead loads are multiplied with.
    pub(crate) fn loads_of_end(&mut self, loaded: bool) -> Loads {
        if !self.system.nonlinear.loads.is_empty() {
            self.vectors.place.clone_from(&self.next.motion.u);
            self.vectors.load.resize(self.system.unknowns(), 0.0);
            self.evaluate_loads_of_step();
            return Loads::Varying;
        }
        let time = self.state.time;
        let ramp = [time, time + self.dt].map(|time| self.system.nonlinear.ramp(time));
        if loaded {
            Loads::Dead(ramp)
        } else {
            Loads::None
        }
    }

    /// What loads, internal forces and those beside them leave at the end on an unknown, N; zero on held ones.
    pub(crate) fn left(&self, loads: Loads, i: usize) -> f64 {
        let damping = self.vectors.damping.get(i).unwrap_or(&0.0);
        let inside = self.next.motion.internal_force[i] + damping;
        match loads {
            _ if self.system.fixed[i] => 0.0,
            Loads::None => -inside,
            Loads::Dead([_, factor]) => factor * self.system.load[i] - inside,
            Loads::Varying => self.vectors.load[i] - inside,
        }
    }

    /// Whether forces beside the internal ones depend on the motion: damping, less the forces of links.
    pub(crate) fn has_forces_beside(&self) -> bool {
        self.system.has_damping() || self.has_links()
    }
}

/// Unknowns of which one thread writes the displacement, at least.
pub(crate) const UNKNOWNS: usize = 8192;

/// Loads of such a step.
#[derive(Clone, Copy)]
pub(crate) enum Loads {
    None,
    /// The dead loads, times these factors at start and end.
    Dead([f64; 2]),
    /// Those in the vector of loads.
    Varying,
}
