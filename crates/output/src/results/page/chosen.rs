//! What of the model is in a page.

use std::collections::BTreeSet;

use crate::results::page::surface::Surface;
use crate::results::stills::Seen;

/// Nodes and cells that are in the page, by their places in [`Seen`], ascending.
pub(super) struct Chosen<'a> {
    pub(super) nodes: Vec<u32>,
    pub(super) cells: Vec<u32>,
    became: Option<&'a [u32]>,
}

impl<'a> Chosen<'a> {
    pub(super) fn new(surface: &Surface, seen: &Seen, became: Option<&'a [u32]>) -> Chosen<'a> {
        let nodes: Vec<u32> = match became {
            None => (0..seen.nodes.len() as u32).collect(),
            Some(_) => {
                let mut nodes: BTreeSet<u32> =
                    surface.triangles.iter().flatten().copied().collect();
                nodes.extend(surface.lines.iter().flatten());
                nodes.extend(&surface.points);
                nodes.into_iter().collect()
            }
        };
        let mut cells: BTreeSet<u32> = surface.cells.iter().copied().collect();
        cells.extend(&surface.line_cells);
        Chosen {
            nodes,
            cells: cells.into_iter().collect(),
            became,
        }
    }

    /// Number in the page of a node that is there.
    pub(super) fn node(&self, node: u32) -> u32 {
        self.find(node).unwrap_or(0)
    }

    /// The same of a node that may not be there.
    pub(super) fn find(&self, node: u32) -> Option<u32> {
        let node = self.became.map_or(node, |became| became[node as usize]);
        let found = self.nodes.binary_search(&node).ok();
        found.map(|place| place as u32)
    }

    /// Number in the page of a cell that is there.
    pub(super) fn cell(&self, cell: u32) -> u32 {
        self.cells
            .binary_search(&cell)
            .map_or(0, |place| place as u32)
    }
}
