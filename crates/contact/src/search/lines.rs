//! The edges of a target and where they are.

use super::faces::FaceTree;
use crate::faced::Faced;

/// The edges of a target and which of them points are closed at.
#[derive(Debug, Default)]
pub(crate) struct Lines {
    /// The edges and their boxes.
    pub(crate) tree: FaceTree,
    /// Points, ascending, and what they were closed at.
    faced: Vec<(u32, Faced)>,
}

impl Lines {
    /// Remembers what points are closed at, by ascending numbers in the contact.
    pub(crate) fn remember(&mut self, faced: impl Iterator<Item = (u32, Faced)>) {
        self.faced.clear();
        self.faced.extend(faced);
    }

    /// What a point was closed at.
    pub(crate) fn faced(&self, point: u32) -> Option<Faced> {
        let place = self.faced.binary_search_by_key(&point, |(point, _)| *point);
        place.ok().map(|place| self.faced[place].1)
    }
}
