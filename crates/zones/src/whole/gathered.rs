//! The model as a whole from its parts: motion, forces and contact points.

use crate::places::Places;
use carom_dynamics::state::InterfaceState;
use carom_system::Motion;

/// Makes the motion of the whole that of a part where it has its own unknowns.
pub(super) fn take_motion(whole: &mut Motion, (motion, places): (&Motion, &Places)) {
    for &(from, to) in &places.own {
        let (from, to) = (from as usize, to as usize);
        whole.u[to] = motion.u[from];
        whole.v[to] = motion.v[from];
        whole.a[to] = motion.a[from];
    }
    for &(from, to) in &places.frames {
        whole.frames[to] = motion.frames[from];
    }
    for (from, to) in &places.histories {
        whole.history[to.clone()].copy_from_slice(&motion.history[from.clone()]);
    }
}

/// Adds the forces of a part to those of the whole.
pub(super) fn add_forces(whole: &mut Motion, (motion, places): (&Motion, &Places)) {
    let forces = [
        &motion.internal_force,
        &motion.contact_force,
        &motion.link_force,
    ];
    for (whole, force) in forces_mut(whole).into_iter().zip(forces) {
        // a part without links has no link forces
        for &(from, to) in places.unknowns.iter().filter(|_| !force.is_empty()) {
            whole[to as usize] += force[from as usize];
        }
    }
}

/// Makes the points of the whole what they are in a part.
pub(super) fn take_points(
    whole: &mut InterfaceState,
    (interface, places): (&InterfaceState, &Places),
) {
    if !interface.friction.is_empty() {
        whole.friction.resize(whole.force.len(), [0.0; 2]);
    }
    for &(from, to) in &places.points {
        whole.take_point(to as usize, (interface, from as usize));
    }
}

pub(super) fn forces_mut(motion: &mut Motion) -> [&mut Vec<f64>; 3] {
    [
        &mut motion.internal_force,
        &mut motion.contact_force,
        &mut motion.link_force,
    ]
}
