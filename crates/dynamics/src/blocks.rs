//! Blocks of nodes, and resultants of the forces on one, several nodes at a time.
//!
//! A vector keeps the components of a node together, so that the factors of a term of a moment are an entry of the places and one of the forces
//! that is at most two further: x_i f_(i±1) and x_i f_(i±2). All these products are added in lanes, each of one axis; those
//! that are no term of a moment are left out at the end.

use std::ops::Range;

use crate::resultant::Resultant;
use crate::system::System;

/// Nodes of a block, at most: what it reads and writes stays in the nearest cache.
pub(crate) const NODES: usize = 128;

/// Lanes: a multiple of one, two and three components, and of the width of the processor's registers.
pub(crate) const LANES: usize = 24;

/// Zeros before and after a block, for the entries that it does not have.
const RIM: usize = 2;

/// A vector repeated, as the unknowns of nodes follow each other.
pub(crate) fn pattern(dim: usize, w: &[f64; 3]) -> [f64; LANES] {
    std::array::from_fn(|k| w[k % dim])
}

/// Nodes of one connected part, ascending.
#[derive(Clone, Debug)]
pub(crate) enum Nodes {
    /// That follow each other: the first one, and one end more.
    Run([usize; 2]),
    /// Several such runs.
    Runs(Runs),
}

/// Runs of nodes: the first one of each, and one end more; and what is always the same of the nodes, so that it lies together.
#[derive(Clone, Debug)]
pub(crate) struct Runs {
    pub(crate) runs: Vec<[usize; 2]>,
    /// Whether each unknown is held.
    pub(crate) fixed: Vec<bool>,
    /// Mass of each node, kg.
    pub(crate) mass: Vec<f64>,
    /// Place of each node in the reference configuration, m.
    pub(crate) x: Vec<[f64; 3]>,
}

impl Runs {
    /// Takes the entries of the nodes from a system vector, `dim` of each.
    #[inline(always)]
    pub(crate) fn pick<T: Copy>(&self, dim: usize, vector: &[T], out: &mut [T]) {
        let mut at = 0;
        for run in &self.runs {
            let [first, last] = run.map(|node| dim * node);
            copy(dim, &vector[first..last], &mut out[at..at + last - first]);
            at += last - first;
        }
    }

    /// The reverse, into a vector that begins with the unknowns of the node `origin`.
    #[inline(always)]
    pub(crate) fn place(&self, (dim, origin): (usize, usize), values: &[f64], vector: &mut [f64]) {
        let mut at = 0;
        for run in &self.runs {
            let [first, last] = run.map(|node| dim * (node - origin));
            copy(
                dim,
                &values[at..at + last - first],
                &mut vector[first..last],
            );
            at += last - first;
        }
    }
}

/// Copies the unknowns of some nodes; those of a single node, of which unstructured meshes have many, without a call.
#[inline(always)]
fn copy<T: Copy>(dim: usize, from: &[T], to: &mut [T]) {
    match (from, &mut *to, dim) {
        ([x, y, z], [to_x, to_y, to_z], 3) => (*to_x, *to_y, *to_z) = (*x, *y, *z),
        ([x, y], [to_x, to_y], 2) => (*to_x, *to_y) = (*x, *y),
        _ => to.copy_from_slice(from),
    }
}

impl Nodes {
    /// Of nodes, of which there is one at least.
    fn of(system: &System, nodes: &[u32]) -> Nodes {
        let dim = system.dim;
        let follow = nodes.chunk_by(|one, next| *next == one + 1);
        let ends = |run: &[u32]| [run[0] as usize, run[0] as usize + run.len()];
        let runs: Vec<[usize; 2]> = follow.map(ends).collect();
        if let [run] = runs[..] {
            return Nodes::Run(run);
        }
        let all = || nodes.iter().map(|node| *node as usize);
        Nodes::Runs(Runs {
            fixed: all()
                .flat_map(|node| system.fixed[dim * node..][..dim].to_vec())
                .collect(),
            mass: all().map(|node| system.mass.lumped[dim * node]).collect(),
            x: all().map(|node| system.x[node]).collect(),
            runs,
        })
    }

    fn runs(&self) -> &[[usize; 2]] {
        match self {
            Nodes::Run(run) => std::slice::from_ref(run),
            Nodes::Runs(runs) => &runs.runs,
        }
    }

    /// The first of them.
    pub(crate) fn first(&self) -> usize {
        self.runs()[0][0]
    }

    pub(crate) fn contain(&self, node: usize) -> bool {
        let mut runs = self.runs().iter();
        runs.any(|[first, last]| (*first..*last).contains(&node))
    }

    /// Writes zeros for their unknowns.
    pub(crate) fn clear(&self, dim: usize, vector: &mut [f64]) {
        for [first, last] in self.runs() {
            vector[dim * first..dim * last].fill(0.0);
        }
    }
}

/// Nodes of one connected part.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) nodes: Nodes,
    /// Their part.
    pub(crate) part: usize,
    /// Whether any of their unknowns is held.
    pub(crate) held: bool,
    /// Whether there may be contact forces on them at the start and at the end of the step.
    pub(crate) touched: [bool; 2],
    /// Whether its sums count here; not where those of another process do.
    pub(crate) counts: bool,
}

impl Block {
    /// Of nodes of a part; whether they count.
    fn new(system: &System, nodes: Nodes, part: usize, counts: bool) -> Block {
        let dim = system.dim;
        let held =
            |[first, last]: &[usize; 2]| system.fixed[dim * first..dim * last].contains(&true);
        Block {
            part,
            held: nodes.runs().iter().any(held),
            nodes,
            touched: [true; 2],
            counts,
        }
    }
}

/// The blocks of a system whose nodes have translations alone.
pub(crate) fn blocks(system: &System) -> Vec<Block> {
    let dim = system.dim;
    let of_part = |(part, unknowns): (usize, &Range<usize>)| {
        let (begin, end) = (unknowns.start / dim, unknowns.end / dim);
        (begin..end).step_by(NODES).map(move |first| {
            let last = end.min(first + NODES);
            Block::new(system, Nodes::Run([first, last]), part, true)
        })
    };
    system.parts.iter().enumerate().flat_map(of_part).collect()
}

/// The blocks of some nodes, ascending, of such a system; `counts`: whether the sums of a node are taken. Those of nodes that count come first.
pub(crate) fn blocks_of(
    system: &System,
    nodes: &[u32],
    counts: &dyn Fn(usize) -> bool,
) -> Vec<Block> {
    let of_kind = |counted: bool| {
        let own = nodes.iter().copied();
        let own: Vec<u32> = own
            .filter(|node| counts(*node as usize) == counted)
            .collect();
        let part = |node: u32| system.part_of(system.dim * node as usize);
        let mut blocks = Vec::new();
        for of_part in own.chunk_by(|one, other| part(*one) == part(*other)) {
            let part = part(of_part[0]);
            let of_block = |nodes| Block::new(system, Nodes::of(system, nodes), part, counted);
            blocks.extend(of_part.chunks(NODES).map(of_block));
        }
        blocks
    };
    [true, false].map(of_kind).concat()
}

/// A vector of the unknowns of a block; zero behind them.
pub(crate) struct Buffer([f64; 3 * NODES + 2 * RIM]);

impl Default for Buffer {
    #[inline(always)]
    fn default() -> Buffer {
        Buffer([0.0; 3 * NODES + 2 * RIM])
    }
}

impl Buffer {
    /// Sets an entry.
    #[inline(always)]
    pub(crate) fn set(&mut self, i: usize, value: f64) {
        self.0[RIM + i] = value;
    }

    #[inline(always)]
    pub(crate) fn get(&self, i: usize) -> f64 {
        self.0[RIM + i]
    }

    /// Entries from one of them on.
    #[inline(always)]
    pub(crate) fn lanes<const W: usize>(&self, first: usize) -> [f64; W] {
        let mut out = [0.0; W];
        out.copy_from_slice(&self.0[RIM + first..][..W]);
        out
    }

    /// Writes entries from one of them on.
    #[inline(always)]
    pub(crate) fn put<const W: usize>(&mut self, first: usize, values: &[f64; W]) {
        self.0[RIM + first..][..W].copy_from_slice(values);
    }

    /// Leaves nothing of a longer block behind the first `n` entries.
    #[inline(always)]
    pub(crate) fn end(&mut self, n: usize) {
        let behind = &mut self.0[RIM + n..];
        let count = behind.len().min(LANES);
        behind[..count].fill(0.0);
    }

    /// Takes a repeated vector off `n` entries; what is behind them stays zero.
    pub(crate) fn take_off(&mut self, n: usize, w: &[f64; LANES]) {
        let entries = self.0[RIM..RIM + n].iter_mut();
        entries.zip(w.iter().cycle()).for_each(|(x, w)| *x -= w);
    }

    /// Takes `dim` components of the vectors of some nodes.
    #[inline(always)]
    pub(crate) fn fill(&mut self, dim: usize, vectors: &[[f64; 3]]) {
        let entries = &mut self.0[RIM..];
        if dim == 3 {
            entries[..3 * vectors.len()].copy_from_slice(vectors.as_flattened());
        } else {
            for (entry, vector) in entries.chunks_exact_mut(dim).zip(vectors) {
                entry.copy_from_slice(&vector[..dim]);
            }
        }
    }

    /// Takes a number of each node, for its `dim` unknowns.
    #[inline(always)]
    pub(crate) fn spread(&mut self, dim: usize, numbers: &[f64]) {
        match dim {
            3 => self.repeat::<3>(numbers),
            2 => self.repeat::<2>(numbers),
            _ => self.repeat::<1>(numbers),
        }
    }

    #[inline(always)]
    fn repeat<const D: usize>(&mut self, numbers: &[f64]) {
        let (entries, _) = self.0[RIM..].as_chunks_mut();
        for (entry, number) in entries.iter_mut().zip(numbers) {
            *entry = [*number; D];
        }
    }

    /// Entries from i + shift - [`RIM`] on.
    #[inline(always)]
    fn at(&self, i: usize, shift: usize) -> &[f64; LANES] {
        // the last lanes end with the buffer
        match self.0[i + shift..].first_chunk() {
            Some(entries) => entries,
            None => &[0.0; LANES],
        }
    }

    /// Resultant of these forces at places, `dim` components of each, of `n` entries.
    #[inline(always)]
    pub(crate) fn resultant(&self, places: &Buffer, dim: usize, n: usize) -> Resultant {
        let mut linear = [0.0; LANES];
        // of places with the forces two before, one before, one behind, two behind
        let mut products = [[0.0; LANES]; 4];
        for i in (0..n).step_by(LANES) {
            let (x, f) = (places.at(i, RIM), self.at(i, RIM));
            for k in 0..LANES {
                linear[k] += f[k];
            }
            for (products, shift) in products.iter_mut().zip([0, 1, 3, 4]) {
                let other = self.at(i, shift);
                for k in 0..LANES {
                    products[k] += x[k] * other[k];
                }
            }
        }
        let sum = |lanes: &[f64; LANES], axis: usize| -> f64 {
            lanes.iter().skip(axis).step_by(dim).sum()
        };
        let mut out = Resultant::default();
        for axis in 0..dim {
            out.linear[axis] = sum(&linear, axis);
        }
        let [two_before, before, behind, two_behind] = &products;
        if dim > 1 {
            out.angular[2] = sum(behind, 0) - sum(before, 1);
        }
        if dim > 2 {
            out.angular[0] = sum(behind, 1) - sum(before, 2);
            out.angular[1] = sum(two_before, 2) - sum(two_behind, 0);
        }
        out
    }

    /// Σ over the nodes, axis by axis.
    #[inline(always)]
    pub(crate) fn total(&self, dim: usize, n: usize) -> [f64; 3] {
        let mut lanes = [0.0; LANES];
        for i in (0..n).step_by(LANES) {
            let f = self.at(i, RIM);
            for k in 0..LANES {
                lanes[k] += f[k];
            }
        }
        let mut out = [0.0; 3];
        for (axis, out) in out.iter_mut().enumerate().take(dim) {
            *out = lanes.iter().skip(axis).step_by(dim).sum();
        }
        out
    }

    /// Largest square of the length of a node's vector.
    #[inline(always)]
    pub(crate) fn largest_square(&self, dim: usize, n: usize) -> f64 {
        let mut most = [0.0; LANES];
        for i in (0..n).step_by(LANES) {
            let mut squares = [0.0; LANES];
            for shift in RIM..RIM + dim {
                let v = self.at(i, shift);
                for k in 0..LANES {
                    squares[k] += v[k] * v[k];
                }
            }
            for k in 0..LANES {
                if squares[k] > most[k] {
                    most[k] = squares[k];
                }
            }
        }
        let own = most.iter().step_by(dim);
        own.fold(0.0, |most: f64, &square| most.max(square))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn resultants_in_lanes_are_those_node_by_node() {
        for (dim, nodes) in [(1, 5), (2, 12), (2, 128), (3, 1), (3, 9), (3, 128)] {
            let n = dim * nodes;
            let value = |i: usize, of: f64| (of * (i + 1) as f64).sin();
            let (mut x, mut f) = (Buffer::default(), Buffer::default());
            let place = |node: usize| [0, 1, 2].map(|i| value(3 * node + i, 0.7));
            x.fill(dim, &(0..nodes).map(place).collect::<Vec<_>>());
            (0..n).for_each(|i| f.set(i, value(i, 1.3)));
            let (mut linear, mut angular, mut largest) = ([0.0; 3], [0.0; 3], 0.0f64);
            for node in 0..nodes {
                let mut force = [0.0; 3];
                (0..dim).for_each(|i| force[i] = f.get(dim * node + i));
                let mut at = [0.0; 3];
                at[..dim].copy_from_slice(&place(node)[..dim]);
                for i in 0..3 {
                    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                    linear[i] += force[i];
                    angular[i] += at[j] * force[k] - at[k] * force[j];
                }
                largest = largest.max(force.iter().map(|f| f * f).sum());
            }
            // rounding of sums of 128 numbers of one
            let near =
                |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 128.0 * 1e-15);
            let found = f.resultant(&x, dim, n);
            assert!(
                near(found.linear, linear) && near(found.angular, angular),
                "{dim} {nodes}"
            );
            assert!(near(f.total(dim, n), linear));
            assert_eq!(f.largest_square(dim, n), largest);
        }
    }
}
