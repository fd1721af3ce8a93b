//! The order in which a sparse Cholesky factorisation eliminates unknowns.
//!
//! 1. Unknowns without neighbours (fixed ones: 1 on the diagonal and nothing else) leave: they go last and cost nothing.
//! 2. The others are ordered by groups (the unknowns of one node): same fill as unknown by unknown, with a graph that is
//!    an order of magnitude smaller. Approximate minimum degree first; where it predicts much work, nested dissection as
//!    well, and the one with fewer operations is kept.
//! 3. The groups are expanded and the elimination tree is postordered, so that columns of equal pattern become neighbours.
//!
//! The nested dissection comes from a young library: what it returns is checked, and minimum degree stands behind it.

use crate::{Error, csr::Csr};
use faer::{
    dyn_stack::{MemBuffer, MemStack},
    sparse::{SymbolicSparseColMatRef, linalg::amd},
};

/// Below this number of unknowns minimum degree is as good as nested dissection (measured on blocks of hexahedra).
const DISSECTION_UNKNOWNS: usize = 8000;

/// Below this number of predicted operations per entry of the factor, minimum degree stays: one- and two-dimensional
/// problems, where dissecting would take longer than it saves.
const DISSECTION_INTENSITY: f64 = 200.0;

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
    /// Chooses an order for the pattern of `matrix`. `group_of[i]`: node of unknown i; any numbers do.
    ///
    /// # Errors
    /// The analysis fails.
    pub fn new(matrix: &Csr, group_of: &[u32]) -> Result<Ordering, Error> {
        let (connected, isolated): (Vec<u32>, Vec<u32>) =
            (0..matrix.n as u32).partition(|&i| matrix.row(i as usize).0.len() > 1);
        let groups = Groups::new(&connected, group_of);
        let graph = Graph::new(matrix, &groups);
        let (name, order, work) = graph.best_order(connected.len())?;
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

    /// The better of minimum degree and nested dissection, with its name and its work.
    fn best_order(&self, unknowns: usize) -> Result<(&'static str, Vec<u32>, Work), Error> {
        let degree = self.minimum_degree(unknowns)?;
        let work = self.work(&degree);
        let dissect = unknowns >= DISSECTION_UNKNOWNS
            && work.operations > DISSECTION_INTENSITY * work.entries;
        if dissect && let Some(dissection) = self.nested_dissection() {
            let other = self.work(&dissection);
            if other.operations < work.operations {
                return Ok(("nested dissection", dissection, other));
            }
        }
        Ok(("minimum degree", degree, work))
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
mod tests {
    use super::*;
    use crate::pattern::Cliques;

    /// Grid of cells with `dofs` unknowns per node; every third cell leaves its last node's first unknown out.
    fn grid(cells: [usize; 3], dofs: usize) -> (Csr, Vec<u32>) {
        let [nx, ny, nz] = cells;
        let node = |x: usize, y: usize, z: usize| x + (nx + 1) * (y + (ny + 1) * z);
        let mut cliques = Cliques::new();
        for c in 0..nx * ny * nz.max(1) {
            let (x, y, z) = (c % nx, c / nx % ny, c / (nx * ny));
            let depth = if nz == 0 { 0..1 } else { 0..2 };
            let nodes = depth.flat_map(|k| {
                [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| node(x + i, y + j, z + k))
            });
            let list: Vec<u32> = nodes
                .flat_map(|a| (0..dofs).map(move |d| (dofs * a + d) as u32))
                .collect();
            cliques.push(&list[usize::from(c % 3 == 0)..]);
        }
        let n = dofs * (nx + 1) * (ny + 1) * (nz + 1);
        (
            Csr::from_cliques(n, &cliques),
            (0..n).map(|i| (i / dofs) as u32).collect(),
        )
    }

    fn cases() -> Vec<(Csr, Vec<u32>)> {
        let mut fixed = grid([6, 5, 4], 3);
        let marks: Vec<bool> = (0..fixed.0.n).map(|i| i % 4 == 1 || i < 50).collect();
        fixed.0 = fixed.0.with_identity(&marks);
        vec![
            grid([1, 1, 0], 1),
            grid([40, 3, 0], 2),
            grid([7, 6, 5], 3),
            grid([15, 15, 15], 3),
            fixed,
        ]
    }

    /// Entries of the factor of the matrix eliminated in that order, from the patterns of its rows.
    fn entries(matrix: &Csr, permutation: &[u32]) -> f64 {
        let unknowns: Vec<u32> = (0..matrix.n as u32).collect();
        let groups = Groups::new(&unknowns, &unknowns);
        Graph::new(matrix, &groups).work(permutation).entries
    }

    #[test]
    fn orders_are_permutations_with_the_isolated_unknowns_last() {
        for (matrix, nodes) in cases() {
            let ordering = Ordering::new(&matrix, &nodes).unwrap();
            assert_eq!(ordering.permutation.len(), matrix.n);
            assert!(is_permutation(&ordering.permutation));
            for (k, &i) in ordering.permutation.iter().enumerate() {
                assert_eq!(matrix.row(i as usize).0.len() > 1, k < ordering.connected);
            }
        }
    }

    #[test]
    fn the_elimination_tree_is_postordered() {
        for (matrix, nodes) in cases() {
            let ordering = Ordering::new(&matrix, &nodes).unwrap();
            let parent = elimination_tree(&matrix, &ordering.permutation[..ordering.connected]);
            // In a postorder a subtree is a run of positions that ends with its root.
            let mut first: Vec<usize> = (0..parent.len()).collect();
            let mut size = vec![1; parent.len()];
            for k in 0..parent.len() {
                assert_eq!(k + 1 - first[k], size[k]);
                if parent[k] != ROOT {
                    let p = parent[k] as usize;
                    assert!(p > k);
                    first[p] = first[p].min(first[k]);
                    size[p] += size[k];
                }
            }
        }
    }

    #[test]
    fn postordering_keeps_the_fill() {
        let (matrix, nodes) = grid([7, 6, 5], 3);
        let groups = Groups::new(&(0..matrix.n as u32).collect::<Vec<_>>(), &nodes);
        let degree = Graph::new(&matrix, &groups)
            .minimum_degree(matrix.n)
            .unwrap();
        let expanded: Vec<u32> = degree
            .iter()
            .flat_map(|&g| groups.members(g))
            .copied()
            .collect();
        let before = entries(&matrix, &expanded);
        assert_eq!(entries(&matrix, &postordered(&matrix, expanded)), before);
    }

    #[test]
    fn nested_dissection_is_kept_in_three_dimensions_only() {
        let name = |cells| {
            let (matrix, nodes) = grid(cells, 3);
            Ordering::new(&matrix, &nodes).unwrap().name
        };
        assert_eq!(name([15, 15, 15]), "nested dissection");
        assert_eq!(name([8, 8, 8]), "minimum degree");
        assert_eq!(name([80, 80, 0]), "minimum degree");
        assert_eq!(name([2000, 1, 1]), "minimum degree");
    }

    #[test]
    fn what_is_no_permutation_is_recognised() {
        assert!(is_permutation(&[2, 0, 1]));
        assert!(is_permutation(&[]));
        assert!(!is_permutation(&[0, 0, 1]));
        assert!(!is_permutation(&[0, 1, 3]));
    }
}
