//! Which nodes a rank has, which of them others have too, and what they send each other.
//!
//! A rank *has* the nodes of its elements, and those of the contact points whose [home](super::homes) it is. The forces of a node that several have are
//! the sums of what their elements give, added in the order of the ranks by each that has it, so that all of them
//! have the same bits and compute the same motion. Each node counts in the sums of one rank, its *owner*: the first whose elements have it.

use carom_ranks::Message;

use super::homes::Homes;
use super::in_reach::Faces;
use crate::system::System;

/// Nodes, ascending, of a message with another rank.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct With {
    pub(crate) rank: usize,
    pub(crate) nodes: Vec<u32>,
}

/// The nodes of a rank.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Halo {
    /// Owner of each node of the system.
    pub(crate) owner: Vec<u32>,
    /// Nodes that this rank has, ascending.
    pub(crate) present: Vec<u32>,
    /// Those of them that elements of other ranks have too, or that others have; ascending.
    pub(crate) shared: Vec<u32>,
    /// Nodes of which this rank sends forces, by rank, and of which it receives some.
    pub(crate) sends: Vec<With>,
    pub(crate) receives: Vec<With>,
    /// Nodes of contacts that several have, by the other rank: those to which the home, this rank, gives the forces of the contacts, and
    /// those of which it is given them.
    pub(crate) touches: Vec<With>,
    pub(crate) touched: Vec<With>,
    /// Where the contacts are.
    pub(crate) homes: Homes,
}

/// Ranks of the elements of each body.
pub(crate) type Parts = [Vec<u32>];

/// Ranks whose elements have each node.
#[derive(Debug, Default)]
pub(crate) struct AtNodes {
    /// That of the first element; `u32::MAX` for nodes without any.
    first: Vec<u32>,
    /// Nodes with each further one, ascending.
    further: Vec<[u32; 2]>,
}

impl AtNodes {
    pub(crate) fn new(system: &System, parts: &Parts) -> AtNodes {
        let mut first = vec![u32::MAX; system.x.len()];
        let mut further: Vec<[u32; 2]> = Vec::new();
        for (body, parts) in system.bodies.iter().zip(parts) {
            let mut parts = parts.iter();
            body.each_element(&mut |nodes| {
                let Some(&part) = parts.next() else { return };
                for &node in nodes {
                    let own = &mut first[node as usize];
                    if *own == u32::MAX {
                        *own = part;
                    } else if *own != part {
                        further.push([node, part]);
                    }
                }
            });
        }
        further.sort_unstable();
        further.dedup();
        AtNodes { first, further }
    }

    /// Whether elements of a rank have each node.
    pub(crate) fn has(&self, rank: usize) -> Vec<bool> {
        let rank = rank as u32;
        let mut has: Vec<bool> = self.first.iter().map(|first| *first == rank).collect();
        let further = self.further.iter().filter(|[_, part]| *part == rank);
        further.for_each(|[node, _]| has[*node as usize] = true);
        has
    }

    /// Of some of the nodes alone, ascending, which these are the numbers of.
    pub(crate) fn some(&self, nodes: &[u32]) -> AtNodes {
        let further = self.further.iter().filter_map(|&[node, part]| {
            let place = nodes.binary_search(&node).ok()?;
            Some([place as u32, part])
        });
        AtNodes {
            first: nodes
                .iter()
                .map(|node| self.first[*node as usize])
                .collect(),
            further: further.collect(),
        }
    }

    /// The owner of each node.
    fn owners(&self) -> Vec<u32> {
        let mut owner = self.first.clone();
        for [node, part] in &self.further {
            let own = &mut owner[*node as usize];
            *own = (*own).min(*part);
        }
        // nodes without elements
        for owner in owner.iter_mut().filter(|owner| **owner == u32::MAX) {
            *owner = 0;
        }
        owner
    }
}

impl Halo {
    /// Of a rank. `in_reach`: the faces that points may touch.
    pub(crate) fn new(
        system: &System,
        (elements, in_reach): (&AtNodes, &Faces),
        rank: usize,
    ) -> Halo {
        let AtNodes { first, further } = elements;
        let owner = elements.owners();
        let mut halo = Halo {
            homes: Homes::new(system, &owner, in_reach),
            owner,
            ..Halo::default()
        };
        let (mut further, mut have) = (&further[..], Vec::new());
        for node in 0..first.len() as u32 {
            have.clear();
            have.extend(Some(first[node as usize]).filter(|rank| *rank != u32::MAX));
            while let Some(([_, part], rest)) = further.split_first().filter(|(f, _)| f[0] == node)
            {
                have.push(*part);
                further = rest;
            }
            have.sort_unstable();
            halo.take(node, &have, rank as u32);
        }
        let lists = [
            &mut halo.sends,
            &mut halo.receives,
            &mut halo.touches,
            &mut halo.touched,
        ];
        for list in lists {
            list.sort_by_key(|with| with.rank);
        }
        halo
    }

    /// Takes in a node whose elements are of these ranks.
    fn take(&mut self, node: u32, have: &[u32], rank: u32) {
        let home = self.homes.of_node(node as usize);
        let (own, touches) = (have.contains(&rank), home == Some(rank));
        let outside = home.filter(|home| !have.contains(home));
        if !(own || touches || have.is_empty() && rank == 0) {
            return;
        }
        self.present.push(node);
        if have.len() + usize::from(outside.is_some()) < 2 {
            return;
        }
        self.shared.push(node);
        for &other in have.iter().filter(|&&other| other != rank) {
            add(&mut self.receives, other, node);
            if own {
                add(&mut self.sends, other, node);
            }
            if touches {
                add(&mut self.touches, other, node);
            }
        }
        if let Some(home) = home.filter(|_| own && !touches) {
            if outside.is_some() {
                add(&mut self.sends, home, node);
            }
            add(&mut self.touched, home, node);
        }
    }

    /// Whether this rank counts a node in sums.
    pub(crate) fn counts(&self, node: usize, rank: usize) -> bool {
        self.owner[node] as usize == rank
    }

    /// Whether the first rank has a node.
    pub(crate) fn is_on_first(&self, node: usize) -> bool {
        self.owner[node] == 0 || self.homes.of_node(node) == Some(0)
    }

    /// Bytes that this rank sends in a step: forces of elements, and of the contacts whose home it is.
    pub(crate) fn bytes(&self, dim: usize) -> u64 {
        let count = |lists: &[With]| lists.iter().map(|with| with.nodes.len()).sum::<usize>();
        8 * (dim * (count(&self.sends) + count(&self.touches))) as u64
    }
}

/// Lists of what other ranks give to the first, each with the rank that has it: on the first one by that rank, on another its own.
pub(crate) fn by_rank(given: impl Iterator<Item = (u32, u32)>, rank: usize) -> Vec<With> {
    let mut lists = Vec::new();
    for (number, from) in given {
        if rank == 0 || from as usize == rank {
            add(&mut lists, if rank == 0 { from } else { 0 }, number);
        }
    }
    lists.sort_by_key(|list| list.rank);
    lists
}

fn add(lists: &mut Vec<With>, rank: u32, node: u32) {
    let rank = rank as usize;
    match lists.iter_mut().find(|with| with.rank == rank) {
        Some(with) => with.nodes.push(node),
        None => lists.push(With {
            rank,
            nodes: vec![node],
        }),
    }
}

/// Nodes of some contacts, by their numbers, ascending.
pub(crate) fn contact_nodes(system: &System, which: impl Fn(usize) -> bool) -> Vec<u32> {
    let contacts = system.contacts.iter().enumerate();
    let contacts = contacts.filter(|(number, _)| which(*number));
    let mut nodes: Vec<u32> = contacts
        .flat_map(|(_, contact)| contact.nodes().0)
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// Room for the messages of some lists, with so many numbers for each node.
pub(crate) fn messages(lists: &[With], numbers: usize) -> Vec<Message> {
    let message = |with: &With| Message {
        with: with.rank,
        values: vec![0.0; numbers * with.nodes.len()],
    };
    lists.iter().map(message).collect()
}

/// Copies the entries of nodes from a system vector into a message, `values` beginning with them.
pub(crate) fn pack(nodes: &[u32], dim: usize, vector: &[f64], values: &mut [f64]) {
    fn of<const D: usize>(nodes: &[u32], vector: &[f64], values: &mut [f64]) {
        let (entries, (values, _)) = (vector.as_chunks::<D>().0, values.as_chunks_mut::<D>());
        for (value, &node) in values.iter_mut().zip(nodes) {
            *value = entries[node as usize];
        }
    }
    match dim {
        3 => of::<3>(nodes, vector, values),
        2 => of::<2>(nodes, vector, values),
        _ => of::<1>(nodes, vector, values),
    }
}

/// The reverse.
pub(crate) fn unpack(nodes: &[u32], dim: usize, values: &[f64], vector: &mut [f64]) {
    fn of<const D: usize>(nodes: &[u32], values: &[f64], vector: &mut [f64]) {
        let ((entries, _), values) = (vector.as_chunks_mut::<D>(), values.as_chunks::<D>().0);
        for (value, &node) in values.iter().zip(nodes) {
            entries[node as usize] = *value;
        }
    }
    match dim {
        3 => of::<3>(nodes, values, vector),
        2 => of::<2>(nodes, values, vector),
        _ => of::<1>(nodes, values, vector),
    }
}
