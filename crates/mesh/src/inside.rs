//! Which nodes lie inside cells that are not theirs: a mesh that overlaps itself.

use carom_elements::{MAX_NODES, map};

use crate::mesh::gather;
use crate::{Bounds, BoxTree, ElementId, Mesh};

/// How far inside a cell, in reference units, a node counts as in it: touching is no overlap.
const DEPTH: f64 = 1e-6;

/// Passes of Newton's method for the reference coordinates of a place; affine cells need one.
const PASSES: usize = 30;

impl Mesh {
    /// Those of `nodes` that lie inside one of `cells` of which they are no node, each with the first such cell.
    ///
    /// A node on the common face of two cells is in neither. In the reference position. Cells must fill the space of the mesh and have positive Jacobians ([`Mesh::check`]).
    pub fn nodes_inside(&self, nodes: &[u32], cells: &[ElementId]) -> Vec<(u32, ElementId)> {
        self.nodes_deeper(nodes, cells, DEPTH)
    }

    /// The same of nodes that lie inside a cell or on its border.
    pub fn nodes_within(&self, nodes: &[u32], cells: &[ElementId]) -> Vec<(u32, ElementId)> {
        self.nodes_deeper(nodes, cells, -DEPTH)
    }

    fn nodes_deeper(
        &self,
        nodes: &[u32],
        cells: &[ElementId],
        depth: f64,
    ) -> Vec<(u32, ElementId)> {
        let place = |node: &u32| self.nodes[*node as usize];
        let bounds = |cell: &ElementId| {
            let x: Vec<[f64; 3]> = self.element_nodes(*cell).iter().map(place).collect();
            Bounds::of(&x)
        };
        let boxes: Vec<Bounds> = cells.iter().map(bounds).collect();
        if boxes.is_empty() {
            return Vec::new();
        }
        let tree = BoxTree::new(&boxes);
        let mut near = Vec::new();
        let mut inside = Vec::new();
        for &node in nodes {
            let x = self.nodes[node as usize];
            tree.near(&x, 0.0, &mut near);
            let mut others = near.iter().map(|&place| cells[place as usize]);
            let found = others.find(|&cell| {
                !self.element_nodes(cell).contains(&node) && self.holds(cell, &x, depth)
            });
            inside.extend(found.map(|cell| (node, cell)));
        }
        inside
    }

    /// Whether a place lies inside a cell, by more than `depth` in reference units.
    fn holds(&self, cell: ElementId, place: &[f64; 3], depth: f64) -> bool {
        let table = self.kind(cell).table();
        let mut buffer = [[0.0; 3]; MAX_NODES];
        let x = gather(&self.nodes, self.element_nodes(cell), &mut buffer);
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        let mut xi = [0.0; 3];
        for _ in 0..PASSES {
            (table.shape)(&xi, &mut n[..table.nodes]);
            (table.gradient)(&xi, &mut dn[..table.nodes]);
            let (j, det) = map::jacobian(x, &dn[..table.nodes], table.dim);
            let at = map::point(x, &n[..table.nodes]);
            let miss = [0, 1, 2].map(|i| place[i] - at[i]);
            // J⁻¹ applied to a vector: the transpose of what turns reference gradients into those in space
            let mut rows = [[0.0; 3]; 3];
            let unit = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
            map::physical_gradient(&j, det, &unit, &mut rows);
            let step = rows.map(|row| (0..3).map(|i| row[i] * miss[i]).sum::<f64>());
            for i in 0..table.dim {
                xi[i] += step[i];
            }
            if !xi.iter().all(|t| t.abs() < 10.0) {
                return false;
            }
            if step.iter().all(|t| t.abs() < 1e-10) {
                break;
            }
        }
        (table.contains)(&xi, -depth)
    }
}

#[cfg(test)]
mod tests {
    use crate::generate;

    #[test]
    fn blocks_that_overlap_have_nodes_in_each_other_and_touching_ones_have_none() {
        for (dim, inside) in [(2, 3), (3, 9)] {
            let block = |name: &str, low: f64| match dim {
                2 => generate::rectangle(name, [0.05, low], [0.9, 1.0], [2; 2], false),
                _ => generate::box_(name, [0.05, 0.07, low], [0.9, 0.8, 1.0], [2; 3], false),
            };
            let base = |name: &str| match dim {
                2 => generate::rectangle(name, [0.0; 2], [1.0; 2], [3; 2], true),
                _ => generate::box_(name, [0.0; 3], [1.0; 3], [3; 3], true),
            };
            for (low, count) in [(1.0, 0), (0.97, inside)] {
                let mut mesh = block("upper", low);
                mesh.merge("lower", base("lower")).unwrap();
                let nodes = mesh.group_nodes(&mesh.groups["upper.bottom"]);
                let cells = mesh.groups["lower"].elements.clone();
                let found = mesh.nodes_inside(&nodes, &cells);
                assert_eq!(found.len(), count, "{dim} {low}");
                assert!(found.iter().all(|(node, _)| nodes.contains(node)));
            }
        }
    }
}
