//! A bound of the largest eigenvalue of some elements together, sharper than that of each alone.
//!
//! Where weights fall to zero, the element at the end has little mass at its last node and less than its share of stiffness
//! next to it: alone it rings faster than in its body.

use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;

/// Power iterations.
const ITERATIONS: usize = 100;
/// Least entry of the trial vector beside its largest: any positive one gives a bound.
const SMALLEST: f64 = 1e-200;

/// Elements that are assembled on their own nodes.
pub(crate) struct Together {
    dim: usize,
    /// System numbers of the nodes, ascending.
    nodes: Vec<u32>,
    /// Σ |K_e|, N/m.
    stiffness: Csr,
    /// Lumped, kg.
    mass: Vec<f64>,
}

impl Together {
    /// Room for elements with these nodes.
    pub(crate) fn new(dim: usize, elements: &[Vec<u32>]) -> Together {
        let mut nodes: Vec<u32> = elements.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut cliques = Cliques::new();
        for element in elements {
            cliques.push(&unknowns(dim, &nodes, element));
        }
        let n = dim * nodes.len();
        Together {
            dim,
            stiffness: Csr::from_cliques(n, &cliques),
            mass: vec![0.0; n],
            nodes,
        }
    }

    /// Adds an element: stiffness (N/m, row-major over node-major unknowns), lumped mass of the nodes (kg).
    pub(crate) fn add(&mut self, element: &[u32], k: &[f64], m: &[f64]) {
        let unknowns = unknowns(self.dim, &self.nodes, element);
        let absolute: Vec<f64> = k.iter().map(|k| k.abs()).collect();
        self.stiffness.add_block(&unknowns, &absolute);
        for (i, &unknown) in unknowns.iter().enumerate() {
            self.mass[unknown as usize] += m[i / self.dim];
        }
    }

    /// Upper bound of the largest eigenvalue of M⁻¹ K, 1/s²: with B = M⁻¹ Σ |K_e|, entry by entry,
    ///
    /// `λ <= max_i (B x)_i / x_i` for any x > 0.
    ///
    /// If K y = λ M y, then |λ| |y| <= M⁻¹ |K| |y| <= B |y|, row by row, so that λ is at most the spectral radius of B.
    /// As B has no negative entry, that radius is at most the norm of X⁻¹ B X by rows, X = diag(x), which is the right-hand
    /// side (Collatz, Wielandt). x runs through power iterations from ones, which bring the right-hand side down to the
    /// radius; each gives a bound, and the least is taken. The radius is λ itself where a change of signs of some unknowns
    /// leaves no negative entry in K, as in a straight bar.
    ///
    /// Unknowns without stiffness do not count; one with stiffness and no mass makes the bound infinite.
    pub(crate) fn largest_eigenvalue(&self) -> f64 {
        let n = self.mass.len();
        let (mut x, mut y) = (vec![1.0; n], vec![0.0; n]);
        let mut least = f64::INFINITY;
        for _ in 0..ITERATIONS {
            self.stiffness.multiply(&x, &mut y);
            let (mut bound, mut largest) = (0.0, 0.0);
            for i in (0..n).filter(|&i| self.stiffness.get(i, i) > 0.0) {
                let rate = y[i] / self.mass[i];
                bound = f64::max(bound, rate / x[i]);
                largest = f64::max(largest, rate);
                y[i] = rate;
            }
            least = f64::min(least, bound);
            if largest == 0.0 || largest.is_infinite() {
                break;
            }
            for (x, y) in x.iter_mut().zip(&y) {
                *x = (y / largest).max(SMALLEST);
            }
        }
        least
    }
}

/// Unknowns of an element on the nodes of the group.
fn unknowns(dim: usize, nodes: &[u32], element: &[u32]) -> Vec<u32> {
    let place = |node: &u32| nodes.partition_point(|other| other < node) * dim;
    let of_node = |node| (0..dim).map(move |i| (place(node) + i) as u32);
    element.iter().flat_map(of_node).collect()
}
