//! Contact forces before an iteration: one that goes a part of its way takes that part of the change of the forces.

use super::Driver;

/// Contact forces of all points.
#[derive(Default)]
pub(super) struct Carried {
    force: Vec<f64>,
    friction: Vec<[f64; 2]>,
}

impl Driver {
    /// Keeps the forces before an iteration.
    pub(super) fn keep_forces(&mut self) {
        let interface = &self.next.interface;
        self.carried.force.clone_from(&interface.force);
        self.carried.friction.clone_from(&interface.friction);
    }

    /// Halves the change of the forces since they were kept.
    pub(super) fn halve_forces(&mut self) {
        let interface = &mut self.next.interface;
        for (force, before) in interface.force.iter_mut().zip(&self.carried.force) {
            *force = 0.5 * (*force + before);
        }
        for (point, friction) in interface.friction.iter_mut().enumerate() {
            let before = self.carried.friction.get(point).copied();
            for (t, before) in friction.iter_mut().zip(before.unwrap_or_default()) {
                *t = 0.5 * (*t + before);
            }
        }
        self.take_weak();
    }
}
