//! Factors of loads in time, the tangent of loads that turn with a body, and the velocity that damping acts on.

use carom_algebra::csr::Csr;
use carom_signals::Amplitude;

use crate::step_map::{Row, StepMap};
use crate::system::{Maps, NumberedForce, System};

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

/// Adds to the effective matrix what loads that turn with the body take from it in this configuration, in a step from `start` of
/// `dt` (both s). `from`: where the way begins on which forces are means.
pub(super) fn add_tangent(
    system: &System,
    (maps, start, dt): (&Maps, f64, f64),
    (from, u): (Option<&[f64]>, &[f64]),
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
        match from {
            None => load.add_tangent(p, u, -map.force.x, a),
            Some(from) => load.add_mean_tangent(p, [from, u], -map.force.x, a),
        }
    }
}

/// Factor of a load: one without a course of its own grows with gravity over the static stage.
pub(crate) fn factor(amplitude: &Amplitude, ramp: f64, time: f64) -> f64 {
    match amplitude.is_constant() {
        true => ramp * amplitude.at(time),
        false => amplitude.at(time),
    }
}
