//! Systems to solve: blocks of trusses with the pattern of hexahedral elasticity, and random ones.

use carom_algebra::{csr::Csr, pattern::Cliques};

/// Numbers in [-1, 1) from a fixed seed (xorshift64*).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

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
    lists.iter().for_each(|list| matrix.add_block(list, &springs));
    (0..unknowns).for_each(|i| matrix.add(i, i, shift));
    System { matrix, node: (0..unknowns as u32).map(|i| i / 3).collect() }
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

/// Random diagonally dominant symmetric matrix: `n` unknowns, about `degree` neighbours each, nodes of uneven size, several
/// components and some unknowns alone.
pub fn random(n: usize, degree: usize, random: &mut Random) -> System {
    let mut pick = |below: usize| ((random.next() + 1.0) / 2.0 * below as f64) as usize;
    // The last tenth has no neighbour, the others stay within their half: two components.
    let coupled = n - n / 10;
    let pairs: Vec<[u32; 2]> = (0..coupled * degree / 2)
        .map(|k| {
            let half = (k % 2) * (coupled / 2);
            [half + pick(coupled / 2), half + pick(coupled / 2)].map(|i| i as u32)
        })
        .collect();
    let node = (0..n).map(|_| pick(n / 2 + 1) as u32 * 7).collect();
    let mut cliques = Cliques::new();
    pairs.iter().for_each(|pair| cliques.push(pair));
    let mut matrix = Csr::from_cliques(n, &cliques);
    for i in 0..n {
        matrix.add(i, i, 0.5 + random.next().abs());
    }
    for [i, j] in pairs.iter().map(|pair| pair.map(|i| i as usize)) {
        let k = random.next();
        if i != j {
            matrix.add(i, j, k);
            matrix.add(j, i, k);
            matrix.add(i, i, k.abs());
            matrix.add(j, j, k.abs());
        }
    }
    System { matrix, node }
}

/// All entries, row-major.
pub fn dense(matrix: &Csr) -> Vec<f64> {
    let n = matrix.n;
    let mut a = vec![0.0; n * n];
    for i in 0..n {
        let (columns, values) = matrix.row(i);
        columns.iter().zip(values).for_each(|(&j, value)| a[i * n + j as usize] = *value);
    }
    a
}

/// Largest |x_i - y_i| over the largest |y_i|.
pub fn distance(x: &[f64], y: &[f64]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |a: f64, b| a.max(b.abs()));
    assert!(x.iter().chain(y).all(|v| v.is_finite()));
    largest(&mut x.iter().zip(y).map(|(a, b)| a - b)) / largest(&mut y.iter().copied())
}
