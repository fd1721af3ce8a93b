//! Which elements are whose.

use carom_ranks::{Graph, Ranks, partition};

use crate::error::Error;
use crate::system::System;

/// What an element at finite strain costs over one at small strain, about.
const FINITE: f64 = 3.0;

/// The library's parts are taken where they share fewer nodes than this part of those that planes do: planes keep what is near in space together in
/// memory ([`System::mesh_node`]).
const FEWER: f64 = 0.9;

/// The elements of all bodies in a row.
#[derive(Default)]
struct Elements {
    /// System numbers of their nodes, element after element, where those of each begin, and their end.
    nodes: Vec<u32>,
    first: Vec<usize>,
    cost: Vec<f64>,
    /// Elements of each body.
    counts: Vec<usize>,
    /// Where the elements at each node begin, and their end; and these elements.
    at_nodes: (Vec<usize>, Vec<u32>),
}

impl Elements {
    fn new(system: &System) -> Elements {
        let mut all = Elements {
            first: vec![0],
            ..Elements::default()
        };
        for body in &system.bodies {
            let before = all.cost.len();
            let cost = if body.is_linear() { 1.0 } else { FINITE };
            body.each_element(&mut |nodes| {
                all.nodes.extend_from_slice(nodes);
                all.first.push(all.nodes.len());
                all.cost.push(cost * nodes.len() as f64);
            });
            all.counts.push(all.cost.len() - before);
        }
        all.at_nodes = all.elements_at(system.x.len());
        all
    }

    fn of(&self, element: usize) -> &[u32] {
        &self.nodes[self.first[element]..self.first[element + 1]]
    }

    fn each(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.cost.len()).map(|element| self.of(element))
    }

    fn centres(&self, system: &System) -> Vec<[f64; 3]> {
        let of = |nodes: &[u32]| {
            let mut centre = [0.0; 3];
            for &node in nodes {
                for (sum, x) in centre.iter_mut().zip(system.x[node as usize]) {
                    *sum += x / nodes.len() as f64;
                }
            }
            centre
        };
        self.each().map(of).collect()
    }

    fn elements_at(&self, nodes: usize) -> (Vec<usize>, Vec<u32>) {
        let mut first = vec![0; nodes + 1];
        for &node in &self.nodes {
            first[node as usize + 1] += 1;
        }
        for node in 0..nodes {
            first[node + 1] += first[node];
        }
        let (mut next, mut elements) = (first.clone(), vec![0; self.nodes.len()]);
        for (element, nodes) in self.each().enumerate() {
            for &node in nodes {
                elements[next[node as usize]] = element as u32;
                next[node as usize] += 1;
            }
        }
        (first, elements)
    }

    fn at_node(&self, node: usize) -> &[u32] {
        let (first, elements) = &self.at_nodes;
        &elements[first[node]..first[node + 1]]
    }

    /// Which elements have a face in common with each: as many nodes as there are dimensions.
    fn graph(&self, system: &System) -> Graph {
        let (mut offsets, mut neighbours) = (vec![0], Vec::new());
        let mut common = Vec::new();
        for element in 0..self.cost.len() {
            common.clear();
            for &node in self.of(element) {
                common.extend_from_slice(self.at_node(node as usize));
            }
            common.sort_unstable();
            let others = common.chunk_by(|one, other| one == other);
            let others = others.filter(|same| same.len() >= system.dim);
            let others = others.map(|same| same[0] as usize);
            let others = others.filter(|other| *other != element);
            neighbours.extend(others.map(|other| other as i32));
            offsets.push(neighbours.len() as i32);
        }
        Graph {
            offsets,
            neighbours,
            weights: self.cost.iter().map(|cost| *cost as i32).collect(),
        }
    }

    /// Nodes that parts share, each as many times as there are parts beside the first at it.
    fn shared(&self, parts: &[u32]) -> usize {
        let mut have = Vec::new();
        let mut of_node = |node: usize| {
            have.clear();
            let elements = self.at_node(node).iter();
            have.extend(elements.map(|element| parts[*element as usize]));
            have.sort_unstable();
            have.dedup();
            have.len().saturating_sub(1)
        };
        (0..self.at_nodes.0.len() - 1).map(&mut of_node).sum()
    }
}

impl Partition {
    /// On the first rank, which has the whole system: parts of equal cost, by planes or, where that shares fewer nodes, by the library for graphs
    /// that the ranks have.
    ///
    /// # Errors
    /// What the library says.
    pub(crate) fn of(system: &System, ranks: &Ranks) -> Result<Partition, Error> {
        let elements = Elements::new(system);
        let mut parts = partition(&elements.centres(system), &elements.cost, ranks.count());
        let mut shared = SharedNodes {
            by_planes: elements.shared(&parts),
            by_graph: None,
        };
        if ranks.has_engine() {
            let graph = elements.graph(system);
            if let Some(found) = ranks.parts_of_graph(&graph).map_err(Error::Partition)? {
                shared.by_graph = Some(elements.shared(&found));
                if shared.is_by_graph() {
                    parts = found;
                }
            }
        }
        let mut rest = &parts[..];
        let of_bodies = elements.counts.iter().map(|&count| {
            let (own, others) = rest.split_at(count);
            rest = others;
            own.to_vec()
        });
        Ok(Partition {
            of_bodies: of_bodies.collect(),
            shared,
        })
    }

    /// As numbers, for the other ranks.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let SharedNodes {
            by_planes,
            by_graph,
        } = self.shared;
        let by_graph = by_graph.map_or(-1.0, |count| count as f64);
        let mut numbers = vec![by_planes as f64, by_graph, self.of_bodies.len() as f64];
        numbers.extend(self.of_bodies.iter().map(|parts| parts.len() as f64));
        let parts = self.of_bodies.iter().flatten();
        numbers.extend(parts.map(|part| f64::from(*part)));
        numbers
    }

    /// The reverse.
    pub(crate) fn of_numbers(numbers: &[f64]) -> Partition {
        let (counts, mut parts) = numbers[3..].split_at(numbers[2] as usize);
        let of_bodies = counts.iter().map(|&count| {
            let (own, others) = parts.split_at(count as usize);
            parts = others;
            own.iter().map(|part| *part as u32).collect()
        });
        Partition {
            of_bodies: of_bodies.collect(),
            shared: SharedNodes {
                by_planes: numbers[0] as usize,
                by_graph: (numbers[1] >= 0.0).then_some(numbers[1] as usize),
            },
        }
    }
}

/// Who has which elements.
pub(crate) struct Partition {
    /// The rank of each element of each body.
    pub(crate) of_bodies: Vec<Vec<u32>>,
    pub(crate) shared: SharedNodes,
}

/// Nodes that ranks share, each as many times as there are ranks beside the first that has it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SharedNodes {
    /// Where planes share out the elements.
    pub by_planes: usize,
    /// Where the library for graphs does; none without it.
    pub by_graph: Option<usize>,
}

impl SharedNodes {
    /// Whether the elements are shared out as the library says.
    pub fn is_by_graph(&self) -> bool {
        let fewer = |by_graph: usize| (by_graph as f64) < FEWER * self.by_planes as f64;
        self.by_graph.is_some_and(fewer)
    }
}
