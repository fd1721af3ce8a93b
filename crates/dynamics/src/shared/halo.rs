//! Which nodes a rank has, which of them others have too, and what they send each other.
//!
//! A rank *has* the nodes of its elements, and the first one those of the contacts besides. The forces of a node that several have are
//! the sums of what their elements give, added in the order of the ranks by each that has it, so that all of them
//! have the same bits and compute the same motion. Each node counts in the sums of one rank, its *owner*: the first whose elements have it.

use carom_ranks::Message;

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
    /// Nodes of contacts that other ranks have too, by rank: the first rank gives them the forces of the contacts. Of another rank its own.
    pub(crate) touched: Vec<With>,
}

/// Ranks of the elements of each body.
pub(crate) type Parts = [Vec<u32>];

impl Halo {
    /// Of a rank.
    pub(crate) fn new(system: &System, parts: &Parts, rank: usize) -> Halo {
        let nodes = system.x.len();
        // the rank of the first element at a node, and the others that have some
        let mut first = vec![u32::MAX; nodes];
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
        let contacts = contact_nodes(system);
        let mut halo = Halo::default();
        let (mut further, mut contacts) = (&further[..], &contacts[..]);
        let mut have = Vec::new();
        for node in 0..nodes as u32 {
            have.clear();
            have.extend(Some(first[node as usize]).filter(|rank| *rank != u32::MAX));
            while let Some(([other, part], rest)) =
                further.split_first().filter(|(f, _)| f[0] == node)
            {
                debug_assert_eq!(*other, node);
                have.push(*part);
                further = rest;
            }
            have.sort_unstable();
            let touches = contacts.first() == Some(&node);
            if touches {
                contacts = &contacts[1..];
            }
            halo.owner.push(have.first().copied().unwrap_or(0));
            halo.take(node, (&have, touches), rank as u32);
        }
        for list in [&mut halo.sends, &mut halo.receives, &mut halo.touched] {
            list.sort_by_key(|with| with.rank);
        }
        halo
    }

    /// Takes in a node whose elements are of these ranks.
    fn take(&mut self, node: u32, (have, touches): (&[u32], bool), rank: u32) {
        let (own, root) = (have.contains(&rank), rank == 0);
        let outside = touches && !have.contains(&0);
        let own_or_touched = own || touches && root;
        if !(own_or_touched || have.is_empty() && root) {
            return;
        }
        self.present.push(node);
        if have.len() + usize::from(outside) < 2 {
            return;
        }
        self.shared.push(node);
        for &other in have.iter().filter(|&&other| other != rank) {
            add(&mut self.receives, other, node);
            if own {
                add(&mut self.sends, other, node);
            }
            if touches && root {
                add(&mut self.touched, other, node);
            }
        }
        if own && outside {
            add(&mut self.sends, 0, node);
        }
        if own && touches && !root {
            add(&mut self.touched, 0, node);
        }
    }

    /// Whether this rank counts a node in sums.
    pub(crate) fn counts(&self, node: usize, rank: usize) -> bool {
        self.owner[node] as usize == rank
    }

    /// Bytes that this rank sends in a step: forces of elements, and on the first rank those of contacts.
    pub(crate) fn bytes(&self, dim: usize, rank: usize) -> u64 {
        let count = |lists: &[With]| lists.iter().map(|with| with.nodes.len()).sum::<usize>();
        let touched = if rank == 0 { count(&self.touched) } else { 0 };
        8 * (dim * (count(&self.sends) + touched)) as u64
    }
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

/// Nodes of all contacts, ascending.
pub(crate) fn contact_nodes(system: &System) -> Vec<u32> {
    let contacts = system.contacts.iter();
    let mut nodes: Vec<u32> = contacts.flat_map(|contact| contact.nodes().0).collect();
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
