//! The graph of groups, the orders of libraries for it, and the size of a factor in an order.

use crate::{Error, csr::Csr};
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// Place of an unknown, that of its node.
pub type Place<'a> = dyn Fn(usize) -> [f64; 3] + 'a;

/// Marks the root of a tree.
pub(crate) const ROOT: u32 = u32::MAX;

/// True if `permutation` holds every number below its length once.
pub(crate) fn is_permutation(permutation: &[u32]) -> bool {
    let mut seen = vec![false; permutation.len()];
    permutation.iter().all(|&i| {
        seen.get_mut(i as usize)
            .is_some_and(|s| !std::mem::replace(s, true))
    })
}

/// Position of every unknown: the inverse of a list of unknowns, [`ROOT`] for those of `0..n` that are not in it.
pub(crate) fn inverse(n: usize, permutation: &[u32]) -> Vec<u32> {
    let mut position = vec![ROOT; n];
    for (k, &i) in permutation.iter().enumerate() {
        position[i as usize] = k as u32;
    }
    position
}

/// The connected unknowns by group, groups numbered from zero in the order of their names.
pub(super) struct Groups {
    offsets: Vec<usize>,
    unknowns: Vec<u32>,
    /// Group of each unknown of the matrix; [`ROOT`] for isolated ones.
    of: Vec<u32>,
}

impl Groups {
    pub(super) fn new(connected: &[u32], group_of: &[u32]) -> Self {
        let mut unknowns = connected.to_vec();
        unknowns.sort_by_key(|&i| (group_of[i as usize], i));
        let mut of = vec![ROOT; group_of.len()];
        let mut offsets = vec![];
        for (k, &i) in unknowns.iter().enumerate() {
            if k == 0 || group_of[i as usize] != group_of[unknowns[k - 1] as usize] {
                offsets.push(k);
            }
            of[i as usize] = offsets.len() as u32 - 1;
        }
        offsets.push(unknowns.len());
        Self {
            offsets,
            unknowns,
            of,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Place of each group: that of its first unknown.
    pub(super) fn places(&self, place: &Place) -> Vec<[f64; 3]> {
        let first = self.offsets[..self.len()].iter();
        first.map(|&k| place(self.unknowns[k] as usize)).collect()
    }

    pub(super) fn members(&self, group: u32) -> &[u32] {
        &self.unknowns[self.offsets[group as usize]..self.offsets[group as usize + 1]]
    }
}

/// Undirected graph of groups without loops, both directions stored, neighbours ascending.
pub(super) struct Graph {
    offsets: Vec<usize>,
    neighbours: Vec<u32>,
    /// Number of unknowns of each group.
    pub(super) weights: Vec<u32>,
}

impl Graph {
    pub(super) fn new(matrix: &Csr, groups: &Groups) -> Self {
        let mut offsets = vec![0];
        let mut neighbours = vec![];
        let mut weights = vec![];
        let mut seen = vec![ROOT; groups.len()];
        for g in 0..groups.len() as u32 {
            let begin = neighbours.len();
            seen[g as usize] = g;
            for &i in groups.members(g) {
                for &j in matrix.row(i as usize).0 {
                    let h = groups.of[j as usize];
                    if seen[h as usize] != g {
                        seen[h as usize] = g;
                        neighbours.push(h);
                    }
                }
            }
            neighbours[begin..].sort_unstable();
            offsets.push(neighbours.len());
            weights.push(groups.members(g).len() as u32);
        }
        Self {
            offsets,
            neighbours,
            weights,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.weights.len()
    }

    pub(super) fn neighbours(&self, g: usize) -> &[u32] {
        &self.neighbours[self.offsets[g]..self.offsets[g + 1]]
    }

    pub(super) fn minimum_degree(&self, unknowns: usize) -> Result<Vec<u32>, Error> {
        let failed = |reason: String| Error::Analysis { unknowns, reason };
        let n = self.len();
        let neighbours: Vec<usize> = self.neighbours.iter().map(|&h| h as usize).collect();
        let pattern =
            SymbolicSparseColMatRef::<usize>::new_checked(n, n, &self.offsets, None, &neighbours);
        let mut memory = MemBuffer::try_new(amd::order_scratch::<usize>(n, neighbours.len()))
            .map_err(|_| failed("out of memory".into()))?;
        let (mut order, mut position) = (vec![0usize; n], vec![0usize; n]);
        let stack = MemStack::new(&mut memory);
        amd::order(
            &mut order,
            &mut position,
            pattern,
            amd::Control::default(),
            stack,
        )
        .map_err(|error| failed(error.to_string()))?;
        Ok(order.into_iter().map(|g| g as u32).collect())
    }

    /// None where the graph is too large for the library, or where what it returns is no permutation.
    pub(super) fn nested_dissection(&self) -> Option<Vec<u32>> {
        let offsets: Vec<i32> = self
            .offsets
            .iter()
            .map(|&k| i32::try_from(k).ok())
            .collect::<Option<_>>()?;
        let neighbours: Vec<i32> = self
            .neighbours
            .iter()
            .map(|&g| i32::try_from(g).ok())
            .collect::<Option<_>>()?;
        let pattern = feral_ordering_core::CscPattern::new(self.len(), &offsets, &neighbours)?;
        let order = feral_scotch::scotch_order(&pattern).ok()?;
        let order: Vec<u32> = order
            .into_iter()
            .map(|g| u32::try_from(g).ok())
            .collect::<Option<_>>()?;
        (order.len() == self.len() && is_permutation(&order)).then_some(order)
    }

    /// Entries and operations of the factor in that order, every group taken as dense. Climbs the elimination tree from each
    /// neighbour (Liu 1990, row subtrees): time proportional to the entries of the factor of the graph.
    pub(super) fn work(&self, order: &[u32]) -> Work {
        let n = self.len();
        let position = inverse(n, order);
        let mut parent = vec![ROOT; n];
        let mut reached = vec![ROOT; n];
        let mut below = vec![0u64; n];
        for (k, &g) in order.iter().enumerate() {
            reached[k] = k as u32;
            for &h in self.neighbours(g as usize) {
                let mut i = position[h as usize] as usize;
                while i < k && reached[i] != k as u32 {
                    reached[i] = k as u32;
                    below[i] += u64::from(self.weights[g as usize]);
                    if parent[i] == ROOT {
                        parent[i] = k as u32;
                    }
                    i = parent[i] as usize;
                }
            }
        }
        let mut work = Work {
            entries: 0.0,
            operations: 0.0,
        };
        for (k, &g) in order.iter().enumerate() {
            for column in 1..=u64::from(self.weights[g as usize]) {
                let length = (below[k] + column) as f64;
                work.entries += length;
                work.operations += length * length;
            }
        }
        work
    }
}

/// Size of a factor: stored entries, and operations (additions and multiplications) to compute it.
pub(super) struct Work {
    pub(super) entries: f64,
    pub(super) operations: f64,
}
