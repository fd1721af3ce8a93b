//! What is near a point along a surface.

use std::collections::BinaryHeap;

use carom_mesh::Face;

use super::lists::{Incidence, Lists};
use crate::Point;

/// Faces that share a node with a face that has a node of the point, and those with a corner that is at most as far away along edges as `far` (m);
/// ascending, for each point. `x`: reference coordinates, m.
pub(super) fn near(points: &[Point], target: &[Face], x: &[[f64; 3]], far: f64) -> Lists {
    let (of_nodes, mut lists) = (Incidence::new(target), Lists::default());
    let mut reached = Reached::default();
    for point in points {
        reached.begin(point.carriers().map(|(node, _)| node));
        let carriers = point.carriers();
        let first = carriers.flat_map(|(node, _)| of_nodes.of(node));
        let second = first.flat_map(|k| target[k as usize].corners().iter().copied());
        let mut found: Vec<u32> = second.flat_map(|node| of_nodes.of(node)).collect();
        while let Some((node, distance)) = reached.next() {
            for k in of_nodes.of(node) {
                found.push(k);
                let corners = target[k as usize].corners();
                for &other in corners {
                    let way = distance + length(x, node, other);
                    if way <= far {
                        reached.push(other, way);
                    }
                }
            }
        }
        found.sort_unstable();
        found.dedup();
        lists.push(found);
    }
    lists
}

fn length(x: &[[f64; 3]], a: u32, b: u32) -> f64 {
    let (a, b) = (x[a as usize], x[b as usize]);
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

/// Nodes by their distance along edges (Dijkstra).
#[derive(Default)]
struct Reached {
    next: BinaryHeap<Way>,
    done: Vec<u32>,
}

struct Way {
    distance: f64,
    node: u32,
}

impl Reached {
    fn begin(&mut self, nodes: impl Iterator<Item = u32>) {
        self.next.clear();
        self.done.clear();
        nodes.for_each(|node| self.push(node, 0.0));
    }

    fn push(&mut self, node: u32, distance: f64) {
        if !self.done.contains(&node) {
            self.next.push(Way { distance, node });
        }
    }

    /// The closest node that was not told before.
    fn next(&mut self) -> Option<(u32, f64)> {
        loop {
            let Way { distance, node } = self.next.pop()?;
            if !self.done.contains(&node) {
                self.done.push(node);
                return Some((node, distance));
            }
        }
    }
}

impl PartialEq for Way {
    fn eq(&self, other: &Way) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Way {}

impl PartialOrd for Way {
    fn partial_cmp(&self, other: &Way) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Way {
    /// The shortest way is the greatest.
    fn cmp(&self, other: &Way) -> std::cmp::Ordering {
        let by_distance = other.distance.total_cmp(&self.distance);
        by_distance.then(other.node.cmp(&self.node))
    }
}
