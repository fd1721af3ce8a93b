//! Faces across the edges of those that a point sees.
//!
//! The closest place of the faces in view may be on an edge whose other face is out of view: of a block of which a point sees the top alone,
//! the edge between top and side. A point below the plane of the top is then beside the block where it is before the side, and inside it
//! where it is behind both.

use carom_mesh::{Face, across};

/// Of each face of the target the faces across its edges, by number.
#[derive(Clone, Debug, Default)]
pub(super) struct Across(Vec<[Option<u32>; 4]>);

impl Across {
    pub(super) fn new(target: &[Face]) -> Across {
        Across(across(target))
    }

    /// The same of some faces alone, by their numbers, ascending.
    pub(super) fn of_some(&self, kept: &[u32]) -> Across {
        let number = |face: u32| kept.binary_search(&face).ok().map(|place| place as u32);
        let faces = kept.iter().filter_map(|&face| self.0.get(face as usize));
        Across(
            faces
                .map(|own| own.map(|face| face.and_then(number)))
                .collect(),
        )
    }

    pub(super) fn of(&self, item: u32) -> impl Iterator<Item = (usize, u32)> + '_ {
        let own = self.0.get(item as usize).into_iter().flatten().enumerate();
        own.filter_map(|(edge, face)| Some((edge, (*face)?)))
    }
}
