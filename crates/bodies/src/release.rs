//! Hinges of beams.

use carom_mesh::ElementId;

/// Rotations at an end of a cell that are not those of the node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Release {
    /// The cell.
    pub cell: ElementId,
    /// Its first end (0) or its second one (1).
    pub end: usize,
    /// Which of the rotations about the axes x, y, z of the section.
    pub rotations: [bool; 3],
}
