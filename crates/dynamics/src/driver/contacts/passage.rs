//! Points that have passed what they face in a step, without a force that tells of it.

use crate::system::System;

/// Whether a step was so long that a point may pass what it faces.
#[derive(Default)]
pub(crate) struct Passage {
    /// Of each contact the depth up to which a point is seen behind what it faces, m.
    pub(crate) depths: Vec<f64>,
    /// The most that a node of each has moved in the step, m; infinite where pairing has not told.
    pub(crate) ways: Vec<f64>,
}

impl Passage {
    pub(crate) fn of(system: &System) -> Passage {
        let contacts = system.contacts.iter().enumerate();
        let depths =
            contacts.map(|(k, contact)| contact.depth_of_sight(system.depth_of_elements(k)));
        Passage {
            depths: depths.collect(),
            ways: vec![f64::INFINITY; system.contacts.len()],
        }
    }

    /// Takes note of the most that a node of a contact has moved in the step, m.
    pub(crate) fn know(&mut self, contact: usize, way: f64) {
        self.ways[contact] = way;
    }

    /// Forgets what nodes have moved.
    pub(crate) fn forget(&mut self) {
        self.ways.fill(f64::INFINITY);
    }
}
