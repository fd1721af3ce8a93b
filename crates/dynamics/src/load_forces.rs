//! Total forces of the loads that a model names.

use carom_algebra::unknowns::Kind;

use crate::driver::loads::factor;
use crate::system::{NumberedForce, System};

/// Total force of each load of [`NumberedNonlinear::load_names`](carom_system::NumberedNonlinear::load_names) at a time (s) and at the
/// displacements `u` (m), into `forces`, N. Moments at nodes are no part of it; in axisymmetry only the axial force is one.
///
/// `nodal`: room for nodal forces.
pub fn load_forces(
    system: &System,
    (time, u): (f64, &[f64]),
    nodal: &mut Vec<f64>,
    forces: &mut Vec<[f64; 3]>,
) {
    let given = &system.nonlinear;
    forces.clear();
    forces.resize(given.load_names.len(), [0.0; 3]);
    let ramp = given.ramp(time);
    let unknowns = &system.unknowns;
    for load in &given.loads {
        let Some(sum) = load.named.and_then(|name| forces.get_mut(name)) else {
            continue;
        };
        let factor = factor(&load.amplitude, ramp, time);
        let mut add = |unknown: usize, force: f64| {
            if let Kind::Translation(axis) = unknowns.kind(unknown) {
                sum[axis] += force;
            }
        };
        match &load.force {
            NumberedForce::Dead(dead) => {
                for &(unknown, force) in dead {
                    add(unknown as usize, factor * force);
                }
            }
            NumberedForce::Follower(pressed, pressure) => {
                nodal.clear();
                nodal.resize(u.len(), 0.0);
                pressed.add_force(factor * pressure, u, nodal);
                for (unknown, force) in nodal.iter().enumerate().filter(|(_, f)| **f != 0.0) {
                    add(unknown, *force);
                }
            }
        }
    }
    if system.axisymmetric {
        forces.iter_mut().for_each(|force| force[0] = 0.0);
    }
}
