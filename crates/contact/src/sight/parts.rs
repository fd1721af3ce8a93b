//! Parts of the surfaces of one contact that do not touch each other.

use std::collections::BTreeSet;

/// The parts that the faces of a contact belong to, as bodies of a general contact, and which of them do not touch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Of each face of the secondary surface.
    pub secondary: Vec<u32>,
    /// Of each face of the target.
    pub primary: Vec<u32>,
    /// Pairs of parts that do not touch, each with the lower number first; twice the same for a part that does not touch itself.
    pub apart: BTreeSet<[u32; 2]>,
}

impl Parts {
    /// Whether a point with these secondary faces around it never touches a face of the target.
    pub(super) fn keep_apart(&self, around: &[u32], item: u32) -> bool {
        // lines that were added to the target are of no part
        let Some(&other) = self.primary.get(item as usize) else {
            return false;
        };
        let mut own = around.iter().map(|&face| self.secondary[face as usize]);
        own.all(|own| self.apart.contains(&[own.min(other), own.max(other)]))
    }
}
