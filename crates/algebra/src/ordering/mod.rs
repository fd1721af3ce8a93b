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
mod graph;

use crate::{Error, csr::Csr};
use graph::{Graph, Groups, Work};

pub use graph::Place;
pub(crate) use graph::{ROOT, inverse};

/// Below this number of unknowns minimum degree is as good as nested dissection of the graph (measured on blocks of hexahedra).
const DISSECTION_UNKNOWNS: usize = 8000;

/// Below this number of predicted operations per entry of the factor, minimum degree stays: one- and two-dimensional
/// problems, where dissecting would take longer than it saves.
const DISSECTION_INTENSITY: f64 = 200.0;

/// Roughness of separators below which planes follow layers of nodes: 0 where nodes of a layer lie in a plane, 0.08 where they are moved by up to
/// 0.15 of an edge, 0.25 and more where planes cross the layers, or where there are none.
const FLAT: f64 = 0.15;

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
        let (name, order, work) = best_order(&graph, connected.len(), places.as_deref())?;
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

/// Name of the order that [`Ordering::new`] chooses for a matrix, and [`Ordering::work`] in it, from the graph of its nodes, as which `nodes` stands: for
/// matrices that are never whole. `weights`: unknowns of each node that are not held, none of a node without neighbours; `place`: of a node.
pub(crate) fn counted(
    nodes: &Csr,
    weights: &[u32],
    place: &Place,
) -> Result<(&'static str, [f64; 2]), Error> {
    let coupled = |&node: &u32| nodes.row(node as usize).0.len() > 1;
    let connected: Vec<u32> = (0..nodes.n as u32).filter(coupled).collect();
    let each: Vec<u32> = (0..nodes.n as u32).collect();
    let groups = Groups::new(&connected, &each);
    let mut graph = Graph::new(nodes, &groups);
    let own = connected.iter().map(|&node| weights[node as usize]);
    graph.weights = own.collect();
    let unknowns: u32 = graph.weights.iter().sum();
    let places = groups.places(place);
    let (name, _, work) = best_order(&graph, unknowns as usize, Some(&places))?;
    Ok((name, [work.entries, work.operations]))
}

/// The best of minimum degree and the nested dissections, with its name and its work.
fn best_order(
    graph: &Graph,
    unknowns: usize,
    places: Option<&[[f64; 3]]>,
) -> Result<(&'static str, Vec<u32>, Work), Error> {
    let degree = graph.minimum_degree(unknowns)?;
    let work = graph.work(&degree);
    let mut best = ("minimum degree", degree, work);
    if best.2.operations < DISSECTION_INTENSITY * best.2.entries {
        return Ok(best);
    }
    let mut suffices = unknowns < DISSECTION_UNKNOWNS;
    if let Some(places) = places {
        let (planes, roughness) = dissection::by_planes(graph, places);
        let work = graph.work(&planes);
        if work.operations < best.2.operations {
            suffices |= roughness < FLAT;
            best = ("nested dissection by planes", planes, work);
        }
    }
    if !suffices && let Some(dissection) = graph.nested_dissection() {
        let work = graph.work(&dissection);
        if work.operations < best.2.operations {
            best = ("nested dissection", dissection, work);
        }
    }
    Ok(best)
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
