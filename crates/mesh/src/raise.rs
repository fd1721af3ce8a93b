//! Quadratic meshes from linear ones: new nodes in the middle of edges, of faces and of cells.

use std::collections::BTreeMap;

use carom_elements::{Kind, MAX_NODES, map};

use crate::mesh::gather;
use crate::{Block, Error, Mesh};

/// The mesh with every element replaced by the quadratic one on the same corners; groups keep their elements.
///
/// New nodes come after the old ones and lie where the linear shape functions put them, so that edges stay straight;
/// neighbours share them. `complete`: with nodes in the middle of quadrilaterals and hexahedra (quad9, hex27) rather than
/// without (quad8, hex20).
///
/// # Errors
/// An element without a quadratic kind: a pyramid, or a wedge if `complete`; one that is quadratic already.
pub fn raise(mesh: &Mesh, complete: bool) -> Result<Mesh, Error> {
    let mut out = Mesh {
        blocks: Vec::new(),
        ..mesh.clone()
    };
    // A new node by the corners between which it lies.
    let mut middles: BTreeMap<Vec<u32>, u32> = BTreeMap::new();
    for block in &mesh.blocks {
        let kind =
            quadratic(block.kind, complete).ok_or(Error::NoQuadratic { kind: block.kind })?;
        let (table, linear) = (kind.table(), block.kind.table());
        let mut nodes = Vec::with_capacity(block.len() * table.nodes);
        for corners in block.nodes.chunks_exact(linear.nodes) {
            nodes.extend_from_slice(corners);
            for xi in &table.reference[linear.nodes..] {
                let (mut n, mut buffer) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
                let n = &mut n[..linear.nodes];
                (linear.shape)(xi, n);
                let around = corners.iter().zip(&*n).filter(|(_, n)| **n != 0.0);
                let mut key: Vec<u32> = around.map(|(&node, _)| node).collect();
                key.sort_unstable();
                let node = *middles.entry(key).or_insert_with(|| {
                    let x = gather(&mesh.nodes, corners, &mut buffer);
                    out.nodes.push(map::point(x, n));
                    out.nodes.len() as u32 - 1
                });
                nodes.push(node);
            }
        }
        out.blocks.push(Block { kind, nodes });
    }
    Ok(out)
}

fn quadratic(linear: Kind, complete: bool) -> Option<Kind> {
    match (linear, complete) {
        (Kind::Point1, _) => Some(Kind::Point1),
        (Kind::Bar2, _) => Some(Kind::Bar3),
        (Kind::Tri3, _) => Some(Kind::Tri6),
        (Kind::Quad4, true) => Some(Kind::Quad9),
        (Kind::Quad4, false) => Some(Kind::Quad8),
        (Kind::Tet4, _) => Some(Kind::Tet10),
        (Kind::Hex8, true) => Some(Kind::Hex27),
        (Kind::Hex8, false) => Some(Kind::Hex20),
        (Kind::Wedge6, false) => Some(Kind::Wedge15),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Surface;
    use crate::generate::{box_, rectangle};

    #[test]
    fn neighbours_share_new_nodes_and_groups_stay() {
        // Nodes of a grid of n cells a side with nodes at all half steps: (2n + 1)^d; without the middles of faces and
        // cells, n² or 3 n²(n + 1) + n³ fewer.
        let square = |tri| rectangle("a", [0.0; 2], [2.0, 1.0], [3, 3], tri);
        let cube = |tets| box_("a", [0.0; 3], [2.0, 1.0, 1.0], [2, 2, 2], tets);
        for (mesh, complete, nodes) in [
            (square(true), true, 49),
            (square(false), true, 49),
            (square(false), false, 40),
            (cube(true), true, 125),
            (cube(false), true, 125),
            (cube(false), false, 81),
        ] {
            let raised = raise(&mesh, complete).unwrap();
            assert_eq!(raised.nodes.len(), nodes);
            assert_eq!(raised.groups, mesh.groups);
            let cells = &raised.groups["a"].elements;
            assert_eq!(raised.check(cells), []);
            for (name, group) in raised.groups.iter().filter(|(name, _)| *name != "a") {
                let surface = Surface::new(&raised, group, cells).unwrap();
                let old = Surface::new(&mesh, group, cells).unwrap();
                let sum = |areas: Vec<f64>| areas.iter().sum::<f64>();
                let (area, expected) = (
                    surface.tributary_areas(&raised, |_| 1.0),
                    old.node_areas(&mesh, |_| 1.0),
                );
                assert!((sum(area) - sum(expected)).abs() < 1e-14, "{name}");
            }
        }
    }

    #[test]
    fn a_quadratic_mesh_is_not_raised_again() {
        let mesh = rectangle("a", [0.0; 2], [1.0; 2], [1, 1], false);
        let raised = raise(&mesh, true).unwrap();
        let kind = Kind::Quad9;
        assert_eq!(raise(&raised, true), Err(Error::NoQuadratic { kind }));
    }
}
