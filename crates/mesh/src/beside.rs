//! Cells by their nodes, so that the sides of many surfaces are found without a look at all cells for each.

use crate::{ElementId, Group, Mesh};

/// Some cells, and which of them have a node.
#[derive(Clone, Debug)]
pub struct CellsByNode<'a> {
    cells: &'a [ElementId],
    /// Where the places of a node begin in `places`, by node, and one end more.
    starts: Vec<u32>,
    /// Places in `cells`, ascending for each node.
    places: Vec<u32>,
}

impl<'a> CellsByNode<'a> {
    /// Of cells of a mesh.
    pub fn new(mesh: &Mesh, cells: &'a [ElementId]) -> CellsByNode<'a> {
        let mut starts = vec![0; mesh.nodes.len() + 1];
        for &cell in cells {
            for &node in mesh.element_nodes(cell) {
                starts[node as usize + 1] += 1;
            }
        }
        for node in 0..mesh.nodes.len() {
            starts[node + 1] += starts[node];
        }
        let mut next = starts.clone();
        let mut places = vec![0; starts[mesh.nodes.len()] as usize];
        for (place, &cell) in cells.iter().enumerate() {
            for &node in mesh.element_nodes(cell) {
                let next = &mut next[node as usize];
                places[*next as usize] = place as u32;
                *next += 1;
            }
        }
        CellsByNode {
            cells,
            starts,
            places,
        }
    }

    /// The cells, in their order, of which facets of a group may be sides: those that have the first node of one.
    pub fn beside(&self, mesh: &Mesh, facets: &Group) -> Vec<ElementId> {
        let at = |node: u32| {
            let ends = [node, node + 1].map(|node| self.starts[node as usize] as usize);
            &self.places[ends[0]..ends[1]]
        };
        let first = facets.elements.iter().map(|&id| mesh.element_nodes(id)[0]);
        let mut places: Vec<u32> = first.flat_map(at).copied().collect();
        places.sort_unstable();
        places.dedup();
        let cells = places.iter().map(|&place| self.cells[place as usize]);
        cells.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surface;
    use crate::generate::box_;

    /// A side of a box of 3 x 3 x 3 cells has nine cells beside it, and the surface of these is that of all 27.
    #[test]
    fn the_cells_beside_a_side_make_its_surface() {
        let mesh = box_("a", [0.0; 3], [1.0; 3], [3; 3], false);
        let (cells, side) = (&mesh.groups["a"].elements, &mesh.groups["a.top"]);
        let beside = CellsByNode::new(&mesh, cells).beside(&mesh, side);
        assert_eq!(beside.len(), 9);
        let of = |cells: &[ElementId]| Surface::new(&mesh, side, cells).unwrap();
        assert_eq!(of(&beside), of(cells));
        let none = CellsByNode::new(&mesh, &cells[..9]).beside(&mesh, side);
        assert!(none.is_empty(), "the lowest layer");
    }
}
