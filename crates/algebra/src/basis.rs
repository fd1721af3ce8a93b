//! Motions of nodes by the unknowns of others, and amplitudes: unknowns without a node.

use std::sync::Arc;

/// What of a rigid motion an amplitude is: its value for unit translations along the axes, 1, and unit rotations about them through
/// the origin, m. A force on an amplitude has this part in the resultant and in the moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Amplitude {
    /// For unit translations.
    pub translation: [f64; 3],
    /// For unit rotations about axes through the origin.
    pub rotation: [f64; 3],
}

/// Motions u = T q of nodes that have no unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// Numbers of q in a system vector.
    unknowns: Vec<u32>,
    /// Rows of T, one after the other.
    rows: Arc<[f64]>,
    /// First row of each node, by ascending nodes.
    first: Vec<(u32, u32)>,
    amplitudes: Vec<(usize, Amplitude)>,
}

impl Basis {
    /// `unknowns`: q, each an entry of a system vector; `rows`: of T; `first`: first row of each node, of its translations;
    /// `amplitudes`: those unknowns that belong to no other node.
    pub fn new(
        unknowns: Vec<u32>,
        rows: Arc<[f64]>,
        mut first: Vec<(u32, u32)>,
        amplitudes: Vec<(usize, Amplitude)>,
    ) -> Basis {
        first.sort_unstable();
        Basis {
            unknowns,
            rows,
            first,
            amplitudes,
        }
    }

    /// The nodes whose motion it gives, ascending.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = u32> {
        self.first.iter().map(|(node, _)| *node)
    }

    /// Each amplitude, and what of a rigid motion it is.
    pub fn amplitudes(&self) -> impl Iterator<Item = (usize, &Amplitude)> {
        self.amplitudes
            .iter()
            .map(|(unknown, amplitude)| (*unknown, amplitude))
    }

    /// The translations of a node in a system vector, if it is one of this basis.
    pub(crate) fn motion(&self, node: u32, dim: usize, values: &[f64]) -> Option<[f64; 3]> {
        let place = self
            .first
            .binary_search_by_key(&node, |(node, _)| *node)
            .ok()?;
        let first = self.first[place].1 as usize;
        let mut motion = [0.0; 3];
        for (i, motion) in motion.iter_mut().enumerate().take(dim) {
            *motion = self.row(first + i, values);
        }
        Some(motion)
    }

    /// A row of T on a system vector.
    pub fn row(&self, row: usize, values: &[f64]) -> f64 {
        let width = self.unknowns.len();
        let row = &self.rows[row * width..(row + 1) * width];
        let terms = row.iter().zip(&self.unknowns);
        terms
            .map(|(t, unknown)| t * values[*unknown as usize])
            .sum()
    }
}
