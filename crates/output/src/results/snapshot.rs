//! What the fields of an instant are made of.

use carom_dynamics::{InterfaceState, Motion, State};

use crate::results::Fields;

/// What the thread needs of a state, and the names of the files it makes of it: the bodies, then each contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Snapshot {
    pub(super) time: f64,
    pub(super) first: bool,
    pub(super) names: Vec<String>,
    pub(super) motion: Motion,
    pub(super) interface: InterfaceState,
}

impl Snapshot {
    /// Copies what is needed, into the memory of the time before.
    pub(super) fn fill(&mut self, fields: &Fields, state: &State) {
        let State {
            motion, interface, ..
        } = state;
        self.time = state.time;
        copy(&mut self.motion.u, &motion.u);
        copy(&mut self.motion.frames, &motion.frames);
        if fields.velocity || fields.acceleration {
            copy(&mut self.motion.v, &motion.v);
        }
        if fields.acceleration {
            copy(&mut self.motion.a, &motion.a);
        }
        copy(&mut self.motion.history, &motion.history);
        copy(&mut self.interface.force, &interface.force);
        copy(&mut self.interface.friction, &interface.friction);
        copy(&mut self.interface.gap, &interface.gap);
        copy(&mut self.interface.rate, &interface.rate);
        copy(&mut self.interface.status, &interface.status);
        copy(&mut self.interface.watched, &interface.watched);
    }
}

fn copy<T: Copy>(to: &mut Vec<T>, from: &[T]) {
    to.clear();
    to.extend_from_slice(from);
}
