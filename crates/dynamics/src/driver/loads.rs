//! Loads and damping forces of an iteration.

use carom_algebra::csr::Csr;
use carom_signals::Amplitude;

use super::Driver;
use crate::step_map::{Row, StepMap};
use crate::system::Maps;
use crate::system::{NumberedForce, System};

/// The velocity that forces depend on: at the instant of the internal forces, or of an explicit step the one that is known
/// before the forces; without what contact forces give by themselves.
pub(super) fn damping_rate(map: &StepMap) -> Row {
    let velocity = Row {
        c: 0.0,
        ..map.velocity
    };
    match map.force.x == 0.0 {
        true => Row { x: 0.0, ..velocity },
        // forces that are not on the way of the step stand between both velocities
        false => Row::MOVING.towards(&velocity, map.force_fraction.unwrap_or(0.5)),
    }
}

impl Driver {
    /// Loads in the balance of the step, which holds at an instant of its own in each zone, at the configuration in `place`, N.
    pub(super) fn evaluate_loads_of_step(&mut self) {
        let (start, dt) = (self.state.time, self.dt);
        let after = |zone: usize, maps: &Maps| maps.all()[zone].instant(dt);
        let first = after(0, &self.maps);
        let zones = self.maps.all().len();
        if (1..zones).all(|zone| after(zone, &self.maps) == first) {
            return self.evaluate_loads(start + first);
        }
        for zone in 0..zones {
            self.evaluate_loads(start + after(zone, &self.maps));
            let super::Vectors { load, work, .. } = &mut self.vectors;
            for (span, _) in self.system.spans.iter().filter(|(_, of)| *of == zone) {
                work[span.clone()].copy_from_slice(&load[span.clone()]);
            }
        }
        let super::Vectors { load, work, .. } = &mut self.vectors;
        load.copy_from_slice(work);
    }

    /// Loads at a time and at the configuration in `place`, N.
    pub(super) fn evaluate_loads(&mut self, time: f64) {
        let system = &*self.system;
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
                    given.add_force(factor * pressure, place, load);
                }
            }
        }
    }

    /// Forces of dashpots and of Rayleigh's damping at the velocity of the iteration, N.
    pub(super) fn evaluate_damping(&mut self) {
        let system = &*self.system;
        let vectors = &mut self.vectors;
        if !system.has_damping() {
            return;
        }
        vectors.damping.fill(0.0);
        if self.maps.is_static() {
            return;
        }
        for body in &system.bodies {
            body.add_damping_force(&vectors.rate, &mut vectors.damping);
        }
        vectors.work.copy_from_slice(&vectors.rate);
        for (k, damping) in system.nonlinear.damping.iter().enumerate() {
            if damping.mass != 0.0 {
                for &(node, m) in &system.body_masses[k] {
                    for unknown in system.unknowns.translations_of(node) {
                        vectors.damping[unknown] += damping.mass * m * vectors.work[unknown];
                    }
                }
            }
            if damping.stiffness != 0.0 {
                for v in vectors.work.iter_mut() {
                    *v *= damping.stiffness;
                }
                let scratch = &mut self.scratch[k];
                system.bodies[k].internal_force(&vectors.work, scratch, &mut vectors.damping);
                for v in vectors.work.iter_mut() {
                    *v /= damping.stiffness;
                }
            }
        }
    }
}

/// Adds to the effective matrix what loads that turn with the body take from it in this configuration, in a step from `start` of
/// `dt` (both s).
pub(super) fn add_tangent(
    system: &System,
    (maps, start, dt): (&Maps, f64, f64),
    u: &[f64],
    a: &mut Csr,
) {
    for given in &system.nonlinear.loads {
        let NumberedForce::Follower(load, pressure) = &given.force else {
            continue;
        };
        let zone = given
            .bodies
            .first()
            .map_or(0, |body| system.zone_of_body[*body]);
        let map = &maps.all()[zone];
        let time = start + map.instant(dt);
        let p = factor(&given.amplitude, system.nonlinear.ramp(time), time) * pressure;
        load.add_tangent(p, u, -map.force.x, a);
    }
}

/// Factor of a load: one without a course of its own grows with gravity over the static stage.
fn factor(amplitude: &Amplitude, ramp: f64, time: f64) -> f64 {
    match amplitude.is_constant() {
        true => ramp * amplitude.at(time),
        false => amplitude.at(time),
    }
}
