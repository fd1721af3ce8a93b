//! Buffers of the force sweeps.

use crate::block::Block;
use crate::finite::{Outcome, Stored};

/// Forces and moments on the nodes of a shell element, N and N m, and its energies.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ShellForces {
    pub nodes: [[f64; 6]; 4],
    pub stored: Stored,
}

/// Nodes of a chunk of shell elements with one point.
#[derive(Debug, Default)]
pub(crate) struct ShellChunk {
    /// Place of each, m, and the rows of its rotation.
    pub states: Vec<[f64; 12]>,
    /// Force and moment on each, N and N m.
    pub forces: Vec<[f64; 6]>,
    pub stored: Stored,
}

/// Buffers of the internal-force sweep: one list of nodal forces and one energy per chunk.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(crate) forces: Vec<Vec<[f64; 3]>>,
    pub(crate) energies: Vec<f64>,
    /// A system vector.
    pub(crate) middle: Vec<f64>,
    /// At finite strain, one of each chunk.
    pub(crate) outcomes: Vec<Outcome>,
    /// Of shells with finite rotations, one of each element.
    pub(crate) shells: Vec<ShellForces>,
    /// Of shells with one point, one of each chunk.
    pub(crate) shell_chunks: Vec<ShellChunk>,
}

impl Scratch {
    /// Makes room on the first call.
    pub(crate) fn prepare(&mut self, blocks: &[Block]) {
        if !self.forces.is_empty() {
            return;
        }
        let chunks = blocks.iter().flat_map(|block| &block.chunks);
        let lists = chunks.map(|chunk| vec![[0.0; 3]; chunk.nodes.len()]);
        self.forces = lists.collect();
        self.energies = vec![0.0; self.forces.len()];
        self.outcomes = vec![Outcome::default(); self.forces.len()];
    }
}
