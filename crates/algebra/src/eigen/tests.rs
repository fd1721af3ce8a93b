use std::f64::consts::PI;

use super::*;
use crate::csr::Csr;
use crate::pattern::Cliques;
use crate::solver::SparseRow;

/// Chains of unit springs: of `n` unit masses each, `copies` of them side by side.
fn chains(n: usize, copies: usize) -> (Csr, Csr, Vec<u32>) {
    let mut cliques = Cliques::new();
    let at = |copy: usize, i: usize| (copies * i + copy) as u32;
    for copy in 0..copies {
        (1..n).for_each(|i| cliques.push(&[at(copy, i - 1), at(copy, i)]));
    }
    let size = n * copies;
    let (mut k, mut m) = (
        Csr::from_cliques(size, &cliques),
        Csr::from_cliques(size, &cliques),
    );
    for copy in 0..copies {
        for i in 1..n {
            k.add_block(&[at(copy, i - 1), at(copy, i)], &[1.0, -1.0, -1.0, 1.0]);
        }
    }
    (0..size).for_each(|i| m.add(i, i, 1.0));
    (k, m, (0..size).map(|i| (i / copies) as u32).collect())
}

fn free_chain(n: usize, k: usize) -> f64 {
    4.0 * (0.5 * PI * k as f64 / n as f64).sin().powi(2)
}

fn orthonormal(m: &Csr, vectors: &[Vec<f64>]) -> f64 {
    let mut worst: f64 = 0.0;
    for (i, x) in vectors.iter().enumerate() {
        let mut image = vec![0.0; m.n];
        m.multiply(x, &mut image);
        for (j, y) in vectors.iter().enumerate() {
            let product: f64 = y.iter().zip(&image).map(|(y, m)| y * m).sum();
            worst = worst.max((product - if i == j { 1.0 } else { 0.0 }).abs());
        }
    }
    worst
}

#[test]
fn free_chains_have_each_frequency_as_often_as_there_are_chains() {
    // three equal chains: each eigenvalue three times, zero among them, which Lanczos' method alone does not see; the
    // dense and the sparse way
    for n in [60, 500] {
        let (k, m, groups) = chains(n, 3);
        let problem = Problem {
            stiffness: &k,
            mass: &m,
            fixed: &vec![false; 3 * n],
            groups: &groups,
            constraints: &[],
        };
        let found = lowest(&problem, 13).unwrap();
        assert_eq!((found.values.len(), found.existing), (13, 3 * n));
        for (j, value) in found.values.iter().enumerate() {
            let exact = free_chain(n, j / 3);
            assert!((value - exact).abs() < 1e-12, "{n} {j}: {value} {exact}");
            assert!(found.bounds[j] < 1e-6);
        }
        assert_eq!(found.count.exist, found.count.found);
        assert!(orthonormal(&m, &found.vectors) < 1e-12);
    }
}

#[test]
fn constraints_and_held_unknowns_act_alike() {
    // the first mass held, or tied to one that is held
    let n = 400;
    let (k, m, groups) = chains(n, 1);
    let mut fixed = vec![false; n];
    fixed[0] = true;
    let exact = |j: usize| {
        let angle = (j as f64 + 0.5) * PI / (2 * n - 1) as f64;
        4.0 * angle.sin().powi(2)
    };
    let held = Problem {
        stiffness: &k,
        mass: &m,
        fixed: &fixed,
        groups: &groups,
        constraints: &[],
    };
    let row = SparseRow {
        dofs: vec![0],
        coefficients: vec![2.0],
    };
    let rows = [row.clone(), row];
    let tied = Problem {
        fixed: &vec![false; n],
        constraints: &rows,
        ..held
    };
    let [held, tied] = [held, tied].map(|problem| lowest(&problem, 10).unwrap());
    for j in 0..10 {
        assert!((held.values[j] / exact(j) - 1.0).abs() < 1e-9);
        assert!((tied.values[j] / exact(j) - 1.0).abs() < 1e-9);
        assert!(tied.vectors[j][0].abs() < 1e-12, "{}", tied.vectors[j][0]);
    }
    assert_eq!((held.existing, tied.existing), (n - 1, n - 1));
    assert_eq!(tied.count.exist, tied.count.found);
}

#[test]
fn there_are_as_many_pairs_as_masses() {
    let n = 12;
    let (k, mut m, groups) = chains(n, 1);
    m.clear();
    for i in [0, 5, 11] {
        m.add(i, i, 1.0);
    }
    let problem = Problem {
        stiffness: &k,
        mass: &m,
        fixed: &vec![false; n],
        groups: &groups,
        constraints: &[],
    };
    let found = lowest(&problem, 9).unwrap();
    // springs of 1/5 and 1/6 between three unit masses
    let (a, b): (f64, f64) = (1.0 / 5.0, 1.0 / 6.0);
    let root = (a * a - a * b + b * b).sqrt();
    let exact = [0.0, a + b - root, a + b + root];
    assert_eq!(found.values.len(), 3);
    for (value, exact) in found.values.iter().zip(exact) {
        assert!((value - exact).abs() < 1e-12);
    }
}

/// Unit springs along the edges and both diagonals of unit squares in the plane, unit masses at the corners.
fn truss(side: usize) -> (Csr, Csr, Vec<u32>) {
    let n = 2 * side * side;
    let mut cliques = Cliques::new();
    let mut springs = Vec::new();
    for j in 0..side {
        for i in 0..side {
            for (di, dj) in [(1, 0), (0, 1), (1, 1), (-1, 1)] {
                let (k, l) = (i as i32 + di, j as i32 + dj);
                if (0..side as i32).contains(&k) && (0..side as i32).contains(&l) {
                    let other = (l as usize * side + k as usize) as u32;
                    let own = (j * side + i) as u32;
                    let dofs = [2 * own, 2 * own + 1, 2 * other, 2 * other + 1];
                    cliques.push(&dofs);
                    let length = f64::from(di * di + dj * dj).sqrt();
                    let [x, y] = [di, dj].map(|d| f64::from(d) / length);
                    springs.push((dofs, [-x, -y, x, y]));
                }
            }
        }
    }
    let (mut k, mut m) = (
        Csr::from_cliques(n, &cliques),
        Csr::from_cliques(n, &cliques),
    );
    for (dofs, row) in &springs {
        let block: Vec<f64> = (0..16).map(|e| row[e / 4] * row[e % 4]).collect();
        k.add_block(dofs, &block);
    }
    (0..n).for_each(|i| m.add(i, i, 1.0));
    (k, m, (0..n as u32).map(|i| i / 2).collect())
}

#[test]
fn many_modes_of_a_large_problem_are_found_without_a_dense_matrix() {
    // 164 vectors of 3200
    let (k, m, groups) = truss(40);
    let problem = Problem {
        stiffness: &k,
        mass: &m,
        fixed: &vec![false; k.n],
        groups: &groups,
        constraints: &[],
    };
    let found = lowest(&problem, 160).unwrap();
    assert_eq!(found.values.len(), 160);
    // that of a dense matrix counts all
    assert!(found.count.below.is_finite(), "{:?}", found.count);
    assert_eq!(found.count.exist, found.count.found);
    assert!(
        found.bounds.iter().all(|bound| *bound < 1e-8),
        "{:?}",
        found.bounds
    );
    assert!(orthonormal(&m, &found.vectors) < 1e-12);
}

#[test]
fn a_free_truss_in_the_plane_has_three_rigid_motions() {
    let (k, m, groups) = truss(21);
    let problem = Problem {
        stiffness: &k,
        mass: &m,
        fixed: &vec![false; k.n],
        groups: &groups,
        constraints: &[],
    };
    let found = lowest(&problem, 12).unwrap();
    assert_eq!(found.count.exist, found.count.found);
    for (j, value) in found.values.iter().enumerate() {
        assert_eq!(*value < 1e-10, j < 3, "{:?}", found.values);
        assert!(found.bounds[j] < 1e-8, "{:?}", found.bounds);
    }
    assert!(orthonormal(&m, &found.vectors) < 1e-12);
}
