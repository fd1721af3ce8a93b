//! Faces across the edges of those that a point sees.
//!
//! The closest place of the faces in view may be on an edge whose other face is out of view: of a block of which a point sees the top alone,
//! the edge between top and side. A point below the plane of the top is then beside the block where it is before the side, and inside it
//! where it is behind both.

use carom_mesh::{Face, Projection, across, is_on};

use super::{Sight, View};
use crate::Places;
use crate::search::foot_on;

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

    fn of(&self, item: u32) -> impl Iterator<Item = (usize, u32)> + '_ {
        let own = self.0.get(item as usize).into_iter().flatten().enumerate();
        own.filter_map(|(edge, face)| Some((edge, (*face)?)))
    }
}

impl Sight {
    /// The views with other faces of the target, whose neighbours are others.
    pub(crate) fn with_target(&self, target: &[Face]) -> Sight {
        Sight {
            across: Across::new(target),
            ..self.clone()
        }
    }
}

impl View<'_> {
    /// Whether a point at `x` (m) is behind the plane of a face of the target and beyond an edge of it, but before the face across that edge.
    pub(crate) fn is_over_neighbour(
        &self,
        (item, foot): (u32, &Projection),
        x: &[f64; 3],
        (places, faces): (&Places, &[Face]),
    ) -> bool {
        if foot.inside || foot.gap >= 0.0 {
            return false;
        }
        let kind = faces[item as usize].kind;
        let beyond = |edge: usize| is_on(kind, edge, &foot.xi);
        let mut others = self.sight.across.of(item).filter(|(edge, _)| beyond(*edge));
        others.any(|(_, other)| foot_on(places, faces, other, x).0.gap > 0.0)
    }

    /// Faces of the target across the edges of one, which say whether a point beyond these is beside the body.
    pub(crate) fn across(&self, item: u32) -> impl Iterator<Item = u32> + '_ {
        self.sight.across.of(item).map(|(_, other)| other)
    }
}
