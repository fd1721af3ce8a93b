//! Which nodes cells join: connected parts, and the closest nodes of two of them.

use crate::{Bounds, BoxTree, ElementId, Mesh};

/// Nodes by connected part.
#[derive(Clone, Debug)]
pub struct Parts {
    /// For each node one nearer to the least node of its part, which leads to itself; `u32::MAX` where no cell has it.
    root: Vec<u32>,
}

impl Parts {
    /// The parts of some cells: those that share nodes are together.
    pub fn new(mesh: &Mesh, cells: impl Iterator<Item = ElementId>) -> Parts {
        let mut root = vec![u32::MAX; mesh.nodes.len()];
        for cell in cells {
            let nodes = mesh.element_nodes(cell);
            for &node in nodes {
                if root[node as usize] == u32::MAX {
                    root[node as usize] = node;
                }
                unite(&mut root, nodes[0], node);
            }
        }
        let mut parts = Parts { root };
        parts.shorten();
        parts
    }

    /// Makes the parts of some nodes one; nodes that no cell has stay without a part.
    pub fn join(&mut self, nodes: &[u32]) {
        let mut known = nodes.iter().filter(|node| self.of(**node).is_some());
        let Some(&first) = known.next() else { return };
        let others: Vec<u32> = known.copied().collect();
        for node in others {
            unite(&mut self.root, first, node);
        }
    }

    fn shorten(&mut self) {
        for node in 0..self.root.len() as u32 {
            if self.root[node as usize] != u32::MAX {
                self.root[node as usize] = find(&mut self.root, node);
            }
        }
    }

    /// How many parts there are.
    pub fn count(&self) -> usize {
        let leads = |(node, root): (usize, &u32)| node == *root as usize;
        self.root.iter().enumerate().filter(|of| leads(*of)).count()
    }

    /// The least node of the part that a node is in; none where no cell has it.
    pub fn of(&self, node: u32) -> Option<u32> {
        let mut root = self.root[node as usize];
        if root == u32::MAX {
            return None;
        }
        while self.root[root as usize] != root {
            root = self.root[root as usize];
        }
        Some(root)
    }
}

fn unite(root: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(root, a), find(root, b));
    // the smaller number leads
    root[a.max(b) as usize] = a.min(b);
}

fn find(root: &mut [u32], mut node: u32) -> u32 {
    while root[node as usize] != node {
        root[node as usize] = root[root[node as usize] as usize];
        node = root[node as usize];
    }
    node
}

impl Mesh {
    /// The closest nodes of two lists and their distance in m, the first of equals in the order of `other`; none where a list
    /// is empty.
    pub fn closest_nodes(&self, one: &[u32], other: &[u32]) -> Option<([u32; 2], f64)> {
        let place = |node: u32| self.nodes[node as usize];
        let boxes: Vec<Bounds> = one.iter().map(|&n| Bounds::of(&[place(n)])).collect();
        let tree = BoxTree::new(&boxes);
        let mut best: Option<([u32; 2], f64)> = None;
        for &node in other {
            let x = place(node);
            let within = best.map_or(f64::INFINITY, |(_, distance)| distance);
            let distance = |item: u32| boxes[item as usize].distance_squared(&x).sqrt();
            if let Some((item, found)) = tree.closest(&x, within, 0.0, distance)
                && best.is_none_or(|(_, least)| found < least)
            {
                best = Some(([one[item as usize], node], found));
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::rectangle;

    #[test]
    fn parts_share_no_node_and_their_closest_nodes_are_found() {
        let mut mesh = rectangle("a", [0.0; 2], [1.0, 1.0], [2, 2], false);
        let other = rectangle("b", [1.25, 0.0], [1.0, 1.0], [2, 3], false);
        mesh.merge("b", other).unwrap();
        let cells = |name: &str| mesh.groups[name].elements.clone();
        let parts = Parts::new(&mesh, cells("a").into_iter().chain(cells("b")));
        let (a, b): (Vec<u32>, Vec<u32>) = (0..21).partition(|&node| parts.of(node) == Some(0));
        assert_eq!((a.len(), b.len(), parts.count()), (9, 12, 2));
        assert!(b.iter().all(|&node| parts.of(node) == Some(9)));
        // the corners below on the right and on the left
        let (nodes, distance) = mesh.closest_nodes(&a, &b).unwrap();
        assert_eq!(
            (nodes.map(|n| mesh.nodes[n as usize]), distance),
            ([[1.0, 0.0, 0.0], [1.25, 0.0, 0.0]], 0.25)
        );
        let parts = Parts::new(&mesh, cells("a").into_iter());
        assert_eq!(parts.of(9), None);
        assert_eq!(mesh.closest_nodes(&a, &[]), None);
    }
}
