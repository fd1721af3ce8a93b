//! The face through which a point has come in a step.
//!
//! A point that comes deep behind a face in one step may be nearer to another face, on which it comes from within: that of the far side, or of a flank. It
//! has come through the one that it was before at the start, and that it is behind now.

use carom_mesh::{Face, Projection};

use super::faces::{FaceTree, Question};
use super::foot::{Stand, diagonal, faces_point, foot_on};
use crate::Places;

/// How far behind a face a place may be and count as before it, over the diagonal of the face.
const LEVEL: f64 = 1e-6;

/// Where a step started.
#[derive(Clone, Copy)]
pub(crate) struct Start<'a> {
    /// Where all nodes were.
    pub(crate) places: &'a Places<'a>,
    /// Where the point was, m.
    pub(crate) x: [f64; 3],
}

impl Start<'_> {
    /// Whether the point was before a face of a target.
    fn is_before(&self, faces: &[Face], item: u32) -> bool {
        let (foot, face) = foot_on(self.places, faces, item, &self.x);
        foot.gap >= -LEVEL * diagonal(self.places, face)
    }
}

impl FaceTree {
    /// The face that a point has come through since the start of a step, where it is behind the one that it is found at, was so at the start already, and was
    /// not inside then. None where there is no such one within the distance of the question.
    pub(crate) fn come_through(
        &self,
        (places, faces): (&Places, &[Face]),
        question: &Question,
        start: &Start,
        found: u32,
    ) -> Option<(u32, Projection)> {
        if faces[found as usize].is_round() || start.is_before(faces, found) {
            return None;
        }
        let stand = Stand {
            x: &question.x,
            of: question.of,
        };
        let foot_of = |item: u32| {
            let (foot, face) = foot_on(places, faces, item, &question.x);
            let is_through = foot.gap < 0.0 && foot.inside && !face.is_round();
            let foot = match question.view.filter(|_| is_through) {
                Some(view) => view.seen((places, stand), (item, face), foot, self.normals())?,
                None => foot,
            };
            let counts = is_through
                && faces_point((stand, &foot), face, false, || places.of_face(face))
                && start.is_before(faces, item);
            counts.then_some(foot)
        };
        let distance = |item: u32| foot_of(item).map_or(f64::INFINITY, |foot| foot.distance);
        let (item, _) = self.nearest_within((&question.x, 0.0), question.within, distance)?;
        Some((item, foot_of(item)?))
    }
}
