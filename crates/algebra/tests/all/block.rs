//! A block of trusses with the pattern of hexahedral elasticity; shared with the benchmarks.

use carom_algebra::{csr::Csr, pattern::Cliques};

/// A matrix, and the node of each unknown.
pub struct System {
    pub matrix: Csr,
    pub node: Vec<u32>,
}

/// `n` cubed cells, every pair of nodes of a cell joined by a spring of unit stiffness, plus `shift` on the diagonal: the pattern of
/// hex8 elasticity, positive definite for any positive shift.
pub fn block(n: usize, shift: f64) -> System {
    let corner = |k: usize| [k & 1, (k >> 1) & 1, k >> 2];
    let cells = (0..n * n * n).map(|c| [c % n, c / n % n, c / (n * n)]);
    let lists: Vec<Vec<u32>> = cells
        .map(|cell| {
            (0..8)
                .flat_map(|k| {
                    let [x, y, z] = std::array::from_fn(|d| cell[d] + corner(k)[d]);
                    let node = (x + (n + 1) * (y + (n + 1) * z)) as u32;
                    [3 * node, 3 * node + 1, 3 * node + 2]
                })
                .collect()
        })
        .collect();
    let unknowns = 3 * (n + 1).pow(3);
    let mut cliques = Cliques::new();
    lists.iter().for_each(|list| cliques.push(list));
    let mut matrix = Csr::from_cliques(unknowns, &cliques);
    let springs = cell_of_springs(corner);
    lists
        .iter()
        .for_each(|list| matrix.add_block(list, &springs));
    (0..unknowns).for_each(|i| matrix.add(i, i, shift));
    System {
        matrix,
        node: (0..unknowns as u32).map(|i| i / 3).collect(),
    }
}

fn cell_of_springs(corner: impl Fn(usize) -> [usize; 3]) -> Vec<f64> {
    let mut stiffness = vec![0.0; 24 * 24];
    for a in 0..8 {
        for b in 0..a {
            let d: [f64; 3] = std::array::from_fn(|k| corner(a)[k] as f64 - corner(b)[k] as f64);
            let square = d.iter().map(|x| x * x).sum::<f64>();
            for i in 0..3 {
                for j in 0..3 {
                    let k = d[i] * d[j] / square;
                    stiffness[(3 * a + i) * 24 + 3 * a + j] += k;
                    stiffness[(3 * b + i) * 24 + 3 * b + j] += k;
                    stiffness[(3 * a + i) * 24 + 3 * b + j] -= k;
                    stiffness[(3 * b + i) * 24 + 3 * a + j] -= k;
                }
            }
        }
    }
    stiffness
}
