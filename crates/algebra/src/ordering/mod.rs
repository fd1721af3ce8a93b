//! The order in which a sparse Cholesky factorisation eliminates unknowns.
//!
//! 1. Unknowns without neighbours (fixed ones: 1 on the diagonal and nothing else) leave: they go last and cost nothing.
//! 2. The others are ordered by groups (the unknowns of one node): same fill as unknown by unknown, with a graph that is
//!    an order of magnitude smaller. Approximate minimum degree first; where it predicts much work, nested dissection by
//!    planes through the places of the groups, and nested dissection of the graph alone. The order with the fewest
//!    operations is kept.
//! 3. The groups are expanded and the elimination tree is postordered, so that columns of equal pattern become neighbours.
//!
//! Planes follow the layers of nodes of a mesh along the axes, and are then better than the graph alone, in a tenth of the
//! time. Elsewhere they are worse, sometimes worse than minimum degree. Their separators tell which: in layers they are flat
//! (roughness of [`dissection::by_planes`]). Operations over those of minimum degree:
//!
//! | nodes moved by up to 0.15 of an edge | planes | graph alone | roughness |
//! |---|---|---|---|
//! | 24³ hexahedra | 0.29 | 0.33 | 0.08 |
//! | 48³ hexahedra, not moved | 0.21 | 0.25 | 0 |
//! | 24³ cubes of tetrahedra | 0.44 | 0.49 | 0.08 |
//! | 24³ hexahedra, turned by 6° about two axes | 0.39 | 0.33 | 0.31 |
//! | 24³ hexahedra, turned by 40° | 1.43 | 0.33 | 0.43 |
//! | 24³ cubes of tetrahedra, turned by 40° | 1.02 | 0.49 | 0.42 |
//! | tetrahedra of 36 000 scattered nodes (Delaunay) | 0.45 | 0.31 | 0.60 |
//!
//! So the graph alone is not dissected where planes have flat separators and beat minimum degree.
//!
//! The dissection of the graph comes from a young library: what it returns is checked, and minimum degree stands behind it.

mod dissection;

use crate::{Error, csr::Csr};
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// Below this number of unknowns minimum degree is as good as nested dissection of the graph (measured on blocks of hexahedra).
const DISSECTION_UNKNOWNS: usize = 8000;

/// Below this number of predicted operations per entry of the factor, minimum degree stays: one- and two-dimensional
/// problems, where dissecting would take longer than it saves.
const DISSECTION_INTENSITY: f64 = 200.0;

/// Roughness of separators below which planes follow layers of nodes: 0 where nodes of a layer lie in a plane, 0.08 where they are moved by up to
/// 0.15 of an edge, 0.25 and more where planes cross the layers, or where there are none.
const FLAT: f64 = 0.15;

/// Place of an unknown, that of its node.
pub type Place<'a> = dyn Fn(usize) -> [f64; 3] + 'a;

/// Marks the root of a tree.
pub(crate) const ROOT: u32 = u32::MAX;

/// An elimination order.
pub struct Ordering {
    /// Which method gave the order.
    pub(crate) name: &'static str,
    /// New position to unknown. The first `connected` positions are postordered, the others have no neighbour.
    pub(crate) permutation: Vec<u32>,
    /// Number of unknowns that have a neighbour.
    pub(crate) connected: usize,
    work: Work,
}

impl Ordering {
    /// Chooses an order for the pattern of `matrix`. `group_of[i]`: node of unknown i; any numbers do. `place`: where the nodes
    /// are, if they are somewhere.
    ///
    /// # Errors
    /// The analysis fails.
    pub fn new(matrix: &Csr, group_of: &[u32], place: Option<&Place>) -> Result<Ordering, Error> {
        let (connected, isolated): (Vec<u32>, Vec<u32>) =
            (0..matrix.n as u32).partition(|&i| matrix.row(i as usize).0.len() > 1);
        let groups = Groups::new(&connected, group_of);
        let graph = Graph::new(matrix, &groups);
        let places = place.map(|place| groups.places(place));
        let (name, order, work) = graph.best_order(connected.len(), places.as_deref())?;
        let expanded: Vec<u32> = order
            .iter()
            .flat_map(|&g| groups.members(g))
            .copied()
            .collect();
        let mut permutation = postordered(matrix, expanded);
        permutation.extend(isolated);
        Ok(Ordering {
            name,
            permutation,
            connected: connected.len(),
            work,
        })
    }

    /// Entries of the factor in this order, and additions and multiplications to compute it, every group taken as dense.
    pub fn work(&self) -> [f64; 2] {
        [self.work.entries, self.work.operations]
    }
}

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
struct Groups {
    offsets: Vec<usize>,
    unknowns: Vec<u32>,
    /// Group of each unknown of the matrix; [`ROOT`] for isolated ones.
    of: Vec<u32>,
}

impl Groups {
    fn new(connected: &[u32], group_of: &[u32]) -> Self {
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

    fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Place of each group: that of its first unknown.
    fn places(&self, place: &Place) -> Vec<[f64; 3]> {
        let first = self.offsets[..self.len()].iter();
        first.map(|&k| place(self.unknowns[k] as usize)).collect()
    }

    fn members(&self, group: u32) -> &[u32] {
        &self.unknowns[self.offsets[group as usize]..self.offsets[group as usize + 1]]
    }
}

/// Undirected graph of groups without loops, both directions stored, neighbours ascending.
struct Graph {
    offsets: Vec<usize>,
    neighbours: Vec<u32>,
    /// Number of unknowns of each group.
    weights: Vec<u32>,
}

impl Graph {
    fn new(matrix: &Csr, groups: &Groups) -> Self {
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

    fn len(&self) -> usize {
        self.weights.len()
    }

    fn neighbours(&self, g: usize) -> &[u32] {
        &self.neighbours[self.offsets[g]..self.offsets[g + 1]]
    }

    /// The best of minimum degree and the nested dissections, with its name and its work.
    fn best_order(
        &self,
        unknowns: usize,
        places: Option<&[[f64; 3]]>,
    ) -> Result<(&'static str, Vec<u32>, Work), Error> {
        let degree = self.minimum_degree(unknowns)?;
        let work = self.work(&degree);
        let mut best = ("minimum degree", degree, work);
        if best.2.operations < DISSECTION_INTENSITY * best.2.entries {
            return Ok(best);
        }
        let mut suffices = unknowns < DISSECTION_UNKNOWNS;
        if let Some(places) = places {
            let (planes, roughness) = dissection::by_planes(self, places);
            let work = self.work(&planes);
            if work.operations < best.2.operations {
                suffices |= roughness < FLAT;
                best = ("nested dissection by planes", planes, work);
            }
        }
        if !suffices && let Some(dissection) = self.nested_dissection() {
            let work = self.work(&dissection);
            if work.operations < best.2.operations {
                best = ("nested dissection", dissection, work);
            }
        }
        Ok(best)
    }

    fn minimum_degree(&self, unknowns: usize) -> Result<Vec<u32>, Error> {
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
    fn nested_dissection(&self) -> Option<Vec<u32>> {
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
    fn work(&self, order: &[u32]) -> Work {
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
struct Work {
    entries: f64,
    operations: f64,
}

/// The order with the elimination tree of the matrix postordered: same factor, columns of equal pattern next to each other.
/// Among the children of a column the one with the largest subtree comes last, next to its parent.
fn postordered(matrix: &Csr, order: Vec<u32>) -> Vec<u32> {
    let parent = elimination_tree(matrix, &order);
    let n = order.len();
    let mut size = vec![1u32; n];
    for k in 0..n {
        if parent[k] != ROOT {
            size[parent[k] as usize] += size[k];
        }
    }
    let mut by_size: Vec<u32> = (0..n as u32).collect();
    by_size.sort_by_key(|&k| (size[k as usize], k));
    // Each column is pushed on the list of its parent: the largest subtree ends at the head.
    let (mut head, mut next) = (vec![ROOT; n], vec![ROOT; n]);
    let mut roots = vec![];
    for &k in &by_size {
        match parent[k as usize] {
            ROOT => roots.push(k),
            p => {
                next[k as usize] = head[p as usize];
                head[p as usize] = k;
            }
        }
    }
    // Preorder with the largest child first, read backwards, is the postorder with the largest child last.
    let mut result = Vec::with_capacity(n);
    let mut stack = vec![];
    for &root in &roots {
        stack.push(root);
        while let Some(k) = stack.pop() {
            result.push(order[k as usize]);
            let begin = stack.len();
            let mut child = head[k as usize];
            while child != ROOT {
                stack.push(child);
                child = next[child as usize];
            }
            stack[begin..].reverse();
        }
    }
    result.reverse();
    result
}

/// Parent of each position in the elimination tree of the matrix restricted to `order` (Liu 1986, with path compression).
fn elimination_tree(matrix: &Csr, order: &[u32]) -> Vec<u32> {
    let position = inverse(matrix.n, order);
    let mut parent = vec![ROOT; order.len()];
    let mut ancestor = vec![ROOT; order.len()];
    for (k, &unknown) in order.iter().enumerate() {
        for &j in matrix.row(unknown as usize).0 {
            let mut i = position[j as usize] as usize;
            while i < k {
                let above = std::mem::replace(&mut ancestor[i], k as u32);
                if above == ROOT {
                    parent[i] = k as u32;
                    break;
                }
                i = above as usize;
            }
        }
    }
    parent
}

#[cfg(test)]
mod tests;
