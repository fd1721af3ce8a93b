//! Bolts between two nodes, or between nodes and the ground.

use super::{Discrete, DiscreteKind, axis, row};
use crate::Bolt;

impl Discrete {
    /// The bolts that its elements are: of several each has its number.
    pub(super) fn bolted(&self) -> Vec<Bolt> {
        let DiscreteKind::Bolt(given) = &self.kind else {
            return Vec::new();
        };
        let axis = axis(&given.link, 0);
        let elements = self.first.iter().enumerate();
        let bolt = |(element, first): (usize, &[usize; 2])| Bolt {
            name: match self.first.len() {
                1 => self.name.clone(),
                _ => format!("{}-{}", self.name, element + 1),
            },
            force: given.force,
            stiffness: given.link.curve.slope(0.0),
            row: row(&first[..self.per], (axis, self.dim)).collect(),
        };
        elements.map(bolt).collect()
    }

    /// The bolts that its elements are.
    pub(crate) fn bolts(&self) -> &[Bolt] {
        &self.bolts
    }

    /// Directions in which the sum of the forces is told by the name of the elements: none of bolts, each of which is told by itself.
    pub fn told_directions(&self) -> usize {
        match self.bolts.is_empty() {
            true => self.directions(),
            false => 0,
        }
    }
}
