//! Random systems, and how far two vectors lie apart.

use crate::block::System;
use carom_algebra::{csr::Csr, pattern::Cliques};
use carom_testing::Random;

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
        columns
            .iter()
            .zip(values)
            .for_each(|(&j, value)| a[i * n + j as usize] = *value);
    }
    a
}

/// Largest |x_i - y_i| over the largest |y_i|.
pub fn distance(x: &[f64], y: &[f64]) -> f64 {
    let largest =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |a: f64, b| a.max(b.abs()));
    assert!(x.iter().chain(y).all(|v| v.is_finite()));
    largest(&mut x.iter().zip(y).map(|(a, b)| a - b)) / largest(&mut y.iter().copied())
}
