//! Faces that the deletion of cells lays bare.

use std::collections::BTreeSet;

use crate::surface::{axis, key, nodes_of};
use crate::{ElementId, Face, Mesh, Rim};

impl Mesh {
    /// The faces that cells have in common with deleted ones, each as a face of the cell that is left, its normal out of it: in the order
    /// of the cells and of their faces. `deleted`: whether each of the cells is.
    pub fn bare_faces(&self, cells: &[ElementId], deleted: &[bool]) -> Vec<Face> {
        let mut touched = vec![false; self.nodes.len()];
        let mut gone = BTreeSet::new();
        for (&cell, _) in cells.iter().zip(deleted).filter(|(_, deleted)| **deleted) {
            for &node in self.element_nodes(cell) {
                touched[node as usize] = true;
            }
            let faces = 0..self.kind(cell).table().faces.len();
            gone.extend(faces.map(|face| key(&nodes_of(self, cell, face))));
        }
        let mut bare = Vec::new();
        for (&cell, _) in cells.iter().zip(deleted).filter(|(_, deleted)| !**deleted) {
            let touches = |&node: &u32| touched[node as usize];
            if !self.element_nodes(cell).iter().any(touches) {
                continue;
            }
            for (number, face) in self.kind(cell).table().faces.iter().enumerate() {
                let nodes = nodes_of(self, cell, number);
                if gone.contains(&key(&nodes)) {
                    bare.push(Face {
                        kind: face.kind,
                        nodes,
                        parent: cell,
                        axis: axis(self, cell, number),
                        radius: None,
                        rim: Rim::default(),
                    });
                }
            }
        }
        bare
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate;

    #[test]
    fn a_cell_in_the_middle_leaves_six_faces_whose_normals_point_into_its_place() {
        let mesh = generate::box_("box", [0.0; 3], [3.0; 3], [3; 3], false);
        let cells = mesh.groups["box"].elements.clone();
        let middle = |nodes: &[u32]| {
            let sum = |i: usize| {
                nodes
                    .iter()
                    .map(|&n| mesh.nodes[n as usize][i])
                    .sum::<f64>()
            };
            [0, 1, 2].map(|i| sum(i) / nodes.len() as f64)
        };
        let at = |cell: &ElementId, x: [f64; 3]| middle(mesh.element_nodes(*cell)) == x;
        let deleted: Vec<bool> = cells.iter().map(|cell| at(cell, [1.5; 3])).collect();
        assert_eq!(deleted.iter().filter(|deleted| **deleted).count(), 1);
        let bare = mesh.bare_faces(&cells, &deleted);
        assert_eq!(bare.len(), 6);
        for face in &bare {
            let (of_face, of_parent) = (
                middle(face.corners()),
                middle(mesh.element_nodes(face.parent)),
            );
            let [a, b, c] = [0, 1, 2].map(|k| mesh.nodes[face.nodes[k] as usize]);
            let (s, t) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - b[i]),
            );
            let normal = [0, 1, 2].map(|i| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                s[j] * t[k] - s[k] * t[j]
            });
            // unit squares half an edge from the middles of both cells
            for i in 0..3 {
                assert_eq!(normal[i], 2.0 * (of_face[i] - of_parent[i]));
                assert_eq!(normal[i], 2.0 * (1.5 - of_face[i]));
            }
        }
        // nothing is bare where nothing or all is gone
        assert!(mesh.bare_faces(&cells, &[false; 27]).is_empty());
        assert!(mesh.bare_faces(&cells, &[true; 27]).is_empty());
    }
}
