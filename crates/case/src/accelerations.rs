//! How dead loads accelerate the bodies of a case as it begins.

use carom_algebra::unknowns::Kind;
use carom_dynamics::System;

/// Mean acceleration of each body under the dead loads, by unknown, m/s²; zero in directions in which a support holds it, and
/// before the end of a static stage, in which loads make no motion.
pub(crate) fn accelerations(system: &System) -> Vec<f64> {
    let mut accelerations = vec![0.0; system.unknowns()];
    if system.static_steps() > 0 {
        return accelerations;
    }
    for number in 0..system.bodies.len() {
        let mass = system.body_mass(number);
        for axis in 0..system.dim {
            let motion = translation(system, number, axis);
            // radial forces move no ring as a whole
            if is_held(system, (number, axis), &motion) || system.axisymmetric && axis == 0 {
                continue;
            }
            let forces = motion
                .iter()
                .map(|(unknown, part)| system.load[*unknown] * part);
            let force: f64 = forces.sum();
            for (unknown, part) in motion {
                match system.unknowns.kind(unknown) {
                    Kind::Amplitude(_) => accelerations[unknown] += force / mass * part,
                    _ => accelerations[unknown] = force / mass * part,
                }
            }
        }
    }
    accelerations
}

/// The unknowns of a body that a unit translation along an axis moves, and by how much: nodes that a reduced body has not retained have none, its
/// amplitudes move in their stead.
fn translation(system: &System, body: usize, axis: usize) -> Vec<(usize, f64)> {
    let nodes = system.body_masses[body].iter();
    let of_node = |&(node, _): &(u32, f64)| system.unknowns.translations_of(node).nth(axis);
    let mut motion: Vec<(usize, f64)> = nodes
        .filter_map(of_node)
        .map(|unknown| (unknown, 1.0))
        .collect();
    if let Some(reduced) = system.bodies[body].as_reduced() {
        let mut along = [0.0; 3];
        along[axis] = 1.0;
        motion.extend(reduced.uniform(along));
    }
    motion
}

/// Whether supports hold a body along an axis.
fn is_held(system: &System, (body, axis): (usize, usize), motion: &[(usize, f64)]) -> bool {
    let reduced = system.bodies[body].as_reduced();
    let inside = reduced.is_some_and(|reduced| {
        let mut held = reduced.reduction().held.iter();
        held.any(|(_, kind)| *kind == Kind::Translation(axis))
    });
    inside || motion.iter().any(|(unknown, _)| system.fixed[*unknown])
}
