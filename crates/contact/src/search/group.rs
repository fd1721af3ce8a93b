//! Points of a contact that one thread looks at, one after the other, with what they remember.

use std::ops::Range;

use super::faces::Scratch;
use super::kept::Kept;
use super::way::Way;

/// A block of the points that rest.
#[derive(Debug, Default)]
pub(crate) struct Group {
    /// What each point remembers.
    pub kept: Vec<Kept>,
    /// The way of each point over the faces in the step, where such are looked at.
    pub ways: Vec<Way>,
    /// Whether they are.
    pub watches: bool,
    pub scratch: Scratch,
    /// Which of the points that are due are in the group.
    pub due: Range<usize>,
}

impl Group {
    /// Memory in bytes.
    pub fn bytes(&self) -> usize {
        self.kept.iter().map(Kept::bytes).sum()
    }
}
