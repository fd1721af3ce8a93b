//! The curvature of a stencil as a small matrix over the unknowns of its nodes.

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Vec3;
use carom_elements::MAX_FACE_NODES;

/// The largest number of unknowns of a stencil.
pub const UNKNOWNS: usize = 6 * MAX_FACE_NODES;

/// A linear form of the motion of the stencil's nodes, those of the point first: one vector per node.
pub type Form = [Vec3; 2 * MAX_FACE_NODES];

/// Small symmetric matrix over the unknowns of a stencil.
pub struct Block {
    dim: usize,
    /// Unknowns: rows of the matrix.
    n: usize,
    entries: [f64; UNKNOWNS * UNKNOWNS],
}

impl Block {
    /// No unknowns yet.
    pub fn new(dim: usize) -> Block {
        Block {
            dim,
            n: 0,
            entries: [0.0; UNKNOWNS * UNKNOWNS],
        }
    }

    /// Zeros over the unknowns of so many nodes.
    pub fn clear(&mut self, nodes: usize) {
        self.n = self.dim * nodes;
        self.entries[..self.n * self.n].fill(0.0);
    }

    /// Adds the block to the matrix over all unknowns, in which its own are these.
    pub fn add_to(&self, unknowns: &[u32], matrix: &mut Csr) {
        matrix.add_block(unknowns, &self.entries[..self.n * self.n]);
    }

    /// Adds to it what couples the unknowns of the first `own` nodes with each other, and those of the others, of a side whose unknowns it all
    /// `takes`.
    pub fn add_sides_to(
        &self,
        (unknowns, own): (&[u32], usize),
        takes: &dyn Fn(u32) -> bool,
        matrix: &mut Csr,
    ) {
        let own = self.dim * own;
        let sides = [0..own, own..self.n].into_iter();
        for side in sides.filter(|side| unknowns[side.clone()].iter().all(|&i| takes(i))) {
            for i in side.clone() {
                for j in side.clone() {
                    let entry = self.entries[i * self.n + j];
                    matrix.add(unknowns[i] as usize, unknowns[j] as usize, entry);
                }
            }
        }
    }

    /// Adds value · matrix in the rows of one node and the columns of another.
    pub fn add_nodes(&mut self, row: usize, column: usize, value: f64, matrix: &[[f64; 3]; 3]) {
        for (i, entries) in matrix.iter().enumerate().take(self.dim) {
            let first = (self.dim * row + i) * self.n + self.dim * column;
            for (to, entry) in self.entries[first..].iter_mut().zip(&entries[..self.dim]) {
                *to += value * entry;
            }
        }
    }

    /// Adds value · (a bᵀ + b aᵀ).
    pub fn add(&mut self, value: f64, a: &Form, b: &Form) {
        let (a, b) = (self.flat(a), self.flat(b));
        let (a, b) = (&a[..self.n], &b[..self.n]);
        for (i, row) in self
            .entries
            .chunks_exact_mut(self.n)
            .take(self.n)
            .enumerate()
        {
            let (a_i, b_i) = (value * a[i], value * b[i]);
            for ((entry, a_j), b_j) in row.iter_mut().zip(a).zip(b) {
                *entry += a_i * b_j + b_i * a_j;
            }
        }
    }

    /// The components that are unknowns.
    fn flat(&self, form: &Form) -> [f64; UNKNOWNS] {
        let mut flat = [0.0; UNKNOWNS];
        for (flat, vector) in flat.chunks_exact_mut(self.dim).zip(form) {
            flat.copy_from_slice(&vector.as_slice()[..self.dim]);
        }
        flat
    }
}
