//! Points over a neighbour of the face that is closest to them.

use carom_mesh::{Face, Projection, is_on};

use super::across::Across;
use super::{Sight, View};
use crate::Places;
use crate::search::{Stand, diagonal, foot_on, is_beside_rim};

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
    /// Whether a point is behind the plane of a face of the target and beyond an edge of it, but beside the body there: before
    /// the face across that edge, or beyond the rim of the surface that this and the faces beyond it reach.
    pub(crate) fn is_over_neighbour(
        &self,
        (item, foot): (u32, &Projection),
        stand: Stand,
        of: (&Places, &[Face]),
    ) -> bool {
        if foot.inside || foot.gap >= 0.0 {
            return false;
        }
        let (places, faces) = of;
        let kind = faces[item as usize].kind;
        let beyond = |edge: usize| is_on(kind, edge, &foot.xi);
        let mut others = self.sight.across.of(item).filter(|(edge, _)| beyond(*edge));
        others.any(|(_, other)| {
            let (across, face) = foot_on(places, faces, other, stand.x);
            across.gap > 0.0 && across.gap > stand.overhang_across(&across, diagonal(places, face))
                || is_beside_rim((stand, &across), face, || places.of_face(face))
                || across.distance < foot.distance
                    && self.is_over_neighbour((other, &across), stand, of)
        })
    }

    /// Faces of the target across the edges of one, which say whether a point beyond these is beside the body.
    pub(crate) fn across(&self, item: u32) -> impl Iterator<Item = u32> + '_ {
        self.sight.across.of(item).map(|(_, other)| other)
    }
}
