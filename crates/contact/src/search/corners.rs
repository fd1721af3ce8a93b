//! Corners of the faces of a target in one configuration: of all of them, or of those that are asked for.

use carom_mesh::Face;

use crate::sight::Corners;
use crate::{Places, Sight};

/// Corners that were taken in the last configuration. Its memory is kept.
#[derive(Debug, Default)]
pub(super) struct Taken {
    corners: Vec<Option<Corners>>,
    /// The faces that they belong to, in their order.
    items: Vec<u32>,
    /// Of each face the configuration in which it was asked for last, and its place among the corners there.
    places: Vec<[u32; 2]>,
    now: u32,
}

impl Taken {
    /// Begins a configuration of so many faces, of which none is asked for.
    pub fn begin(&mut self, faces: usize) {
        self.items.clear();
        self.now = self.now.wrapping_add(1);
        if self.now == 0 {
            self.places.fill([0; 2]);
            self.now = 1;
        }
        self.places.resize(faces, [0; 2]);
    }

    /// Asks for the corners of a face.
    pub fn ask(&mut self, item: u32) {
        let place = &mut self.places[item as usize];
        if place[0] != self.now {
            *place = [self.now, self.items.len() as u32];
            self.items.push(item);
        }
    }

    /// Takes the corners of the faces that were asked for.
    pub fn take(&mut self, places: &Places, faces: &[Face]) {
        self.corners.resize_with(self.items.len(), || None);
        Sight::corners(places, (faces, &self.items), &mut self.corners);
    }

    /// The corners of a face, none of a curved one; `None` of a face that was not asked for.
    pub fn of(&self, item: u32) -> Option<Option<&Corners>> {
        let [when, place] = *self.places.get(item as usize)?;
        (when == self.now).then(|| self.corners[place as usize].as_ref())
    }

    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.corners[..])
            + size_of_val(&self.items[..])
            + size_of_val(&self.places[..])
    }
}
