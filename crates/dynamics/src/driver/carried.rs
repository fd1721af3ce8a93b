//! Contact forces before an iteration: one that goes a part of its way takes that part of the change of the forces.

use crate::state::InterfaceState;

/// Contact forces of all points.
#[derive(Default)]
pub(super) struct Carried {
    force: Vec<f64>,
    friction: Vec<[f64; 2]>,
}

impl Carried {
    /// Keeps the forces before an iteration.
    pub(super) fn keep(&mut self, interface: &InterfaceState) {
        self.force.clone_from(&interface.force);
        self.friction.clone_from(&interface.friction);
    }

    /// Halves the change of the forces since they were kept.
    pub(super) fn halve(&self, interface: &mut InterfaceState) {
        for (force, before) in interface.force.iter_mut().zip(&self.force) {
            *force = 0.5 * (*force + before);
        }
        for (point, friction) in interface.friction.iter_mut().enumerate() {
            let before = self.friction.get(point).copied();
            for (t, before) in friction.iter_mut().zip(before.unwrap_or_default()) {
                *t = 0.5 * (*t + before);
            }
        }
    }
}
