//! The sum of the forces that the chunks of a body leave on their nodes.

use std::ops::Range;

use crate::block::Block;

/// Nodes that one thread takes, at least.
const PANEL: usize = 2048;

/// For each node of a body the entries of the lists of chunks that are its own. They are added in the order of the chunks, by any
/// number of threads.
#[derive(Debug)]
pub(crate) struct Gather {
    dim: usize,
    /// First unknown of each node, ascending.
    first: Vec<u32>,
    /// First entry of each node, and one end more.
    start: Vec<u32>,
    /// Chunk, and place in its list.
    entries: Vec<[u32; 2]>,
}

impl Gather {
    /// Of the chunks of these blocks, of `dim` unknowns a node.
    pub(crate) fn new(dim: usize, blocks: &[Block]) -> Gather {
        let chunks = blocks.iter().flat_map(|block| &block.chunks).enumerate();
        let of_chunk = chunks.flat_map(|(number, chunk)| {
            let firsts = chunk.first.iter().enumerate();
            firsts.map(move |(place, &first)| (first, [number as u32, place as u32]))
        });
        let mut all: Vec<(u32, [u32; 2])> = of_chunk.collect();
        all.sort_unstable();
        let mut gather = Gather {
            dim,
            first: Vec::new(),
            start: Vec::new(),
            entries: all.iter().map(|(_, entry)| *entry).collect(),
        };
        for (place, (first, _)) in all.iter().enumerate() {
            if gather.first.last() != Some(first) {
                gather.first.push(*first);
                gather.start.push(place as u32);
            }
        }
        gather.start.push(all.len() as u32);
        gather
    }

    /// Adds the lists of all chunks to a system vector.
    pub(crate) fn add(&self, lists: &[Vec<[f64; 3]>], f: &mut [f64]) {
        self.panel(0..self.first.len(), lists, (0, f));
    }

    /// The same for some of the nodes; `f` begins at the unknown `origin`.
    fn panel(
        &self,
        nodes: Range<usize>,
        lists: &[Vec<[f64; 3]>],
        (origin, f): (usize, &mut [f64]),
    ) {
        if nodes.len() >= 2 * PANEL {
            let middle = nodes.start + nodes.len() / 2;
            let border = self.first[middle] as usize;
            let (before, after) = f.split_at_mut(border - origin);
            rayon::join(
                || self.panel(nodes.start..middle, lists, (origin, before)),
                || self.panel(middle..nodes.end, lists, (border, after)),
            );
            return;
        }
        for node in nodes {
            let sum = &mut f[self.first[node] as usize - origin..][..self.dim];
            let entries = self.start[node] as usize..self.start[node + 1] as usize;
            for &[chunk, place] in &self.entries[entries] {
                let force = &lists[chunk as usize][place as usize];
                for (sum, force) in sum.iter_mut().zip(force) {
                    *sum += force;
                }
            }
        }
    }
}
