//! The way of a point over the faces in the iterations of a step: where it goes to and fro between two, it stays with one.

use carom_mesh::{Face, Projection};

use super::foot::diagonal;
use crate::Places;

/// Returns of a point, within one step, to a face that it has left in it, after which it stays with that face.
const RETURNS: u32 = 2;

/// Gap beyond which a point between two faces is left alone, over the diagonal of the face.
const NEAR: f64 = 0.1;

/// The way of a point over the faces in the iterations of a step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Way {
    /// The faces, each once, that of the last iteration last.
    faces: Vec<u32>,
    returns: u32,
    /// The face that it stays with.
    pub held: Option<u32>,
}

impl Way {
    /// The first of its faces that are closest, by their distances.
    pub fn closest(&self, measure: impl Fn(u32) -> f64) -> Option<u32> {
        let faces = self.faces.iter().map(|&item| (item, measure(item)));
        let closest = faces.min_by(|a, b| a.1.total_cmp(&b.1));
        closest.map(|(item, _)| item)
    }

    /// Goes on to a face.
    pub fn goes(&mut self, item: u32) {
        if self.faces.last() == Some(&item) {
            return;
        }
        if let Some(before) = self.faces.iter().position(|&face| face == item) {
            self.faces.remove(before);
            self.returns += 1;
            self.held = (self.returns >= RETURNS).then_some(item);
        }
        self.faces.push(item);
    }
}

/// Whether a point is so near to its face that it may go to and fro between that and another one.
pub(crate) fn is_between(places: &Places, foot: &Projection, face: &Face) -> bool {
    foot.gap.abs() < NEAR * diagonal(places, face)
}
