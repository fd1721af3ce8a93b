//! Factor, solve, sweeps, errors, counts.

use crate::block::{System, block};
use carom_testing::Random;

use crate::numbers::{dense, distance, random};
use carom_algebra::{Error, csr::Csr, dense::DenseCholesky, solver::Cholesky};

fn factor(system: &System) -> Cholesky {
    Cholesky::new(&system.matrix, &system.node).unwrap()
}

fn systems() -> Vec<System> {
    let mut numbers = Random(11);
    let mut systems: Vec<System> = [
        (1, 0),
        (2, 1),
        (10, 2),
        (57, 3),
        (300, 4),
        (301, 9),
        (500, 40),
    ]
    .into_iter()
    .map(|(n, degree)| random(n, degree, &mut numbers))
    .collect();
    systems.extend([block(1, 0.1), block(3, 0.1), block(6, 1e-3)]);
    systems
}

#[test]
fn solutions_equal_those_of_the_dense_factor() {
    let mut numbers = Random(12);
    for system in systems() {
        let n = system.matrix.n;
        let b = numbers.vector(n);
        let (mut x, mut reference) = (b.clone(), b);
        factor(&system).solve(&mut x);
        DenseCholesky::new(n, &dense(&system.matrix))
            .unwrap()
            .solve(&mut reference);
        assert!(
            distance(&x, &reference) < 1e-11,
            "{n} unknowns: {}",
            distance(&x, &reference)
        );
    }
}

#[test]
fn the_residual_of_a_block_is_rounding() {
    // 14 739 unknowns: nested dissection of the graph is tried, and wins.
    let system = block(16, 0.5);
    let mut solver = factor(&system);
    assert_eq!(solver.stats().ordering, "nested dissection");
    let b = Random(13).vector(system.matrix.n);
    let (mut x, mut product) = (b.clone(), b.clone());
    solver.solve(&mut x);
    system.matrix.multiply(&x, &mut product);
    assert!(distance(&product, &b) < 1e-12, "{}", distance(&product, &b));
}

#[test]
fn a_solve_is_one_forward_and_one_backward_sweep() {
    for system in systems() {
        let n = system.matrix.n;
        let mut solver = factor(&system);
        let b = Random(14).vector(n);
        let (mut solved, mut y, mut x) = (b.clone(), vec![0.0; n], vec![0.0; n]);
        solver.solve(&mut solved);
        solver.forward(&b, &mut y);
        // L⁻¹ P b has the energy of b: yᵀ y = bᵀ A⁻¹ b.
        let energy: f64 = b.iter().zip(&solved).map(|(b, x)| b * x).sum();
        let square: f64 = y.iter().map(|y| y * y).sum();
        assert!((square - energy).abs() < 1e-11 * energy);
        solver.backward(&mut y, &mut x);
        assert_eq!(x, solved);
        assert_eq!(solver.stats().sweeps, 4);
        assert_eq!(solver.stats().factorisations, 1);
    }
}

#[test]
fn refactoring_gives_the_bits_of_a_new_factor() {
    let (first, second) = (block(5, 1.0), block(5, 0.25));
    let mut reused = factor(&first);
    reused.refactor(&second.matrix).unwrap();
    let b = Random(15).vector(first.matrix.n);
    let (mut x, mut y) = (b.clone(), b);
    reused.solve(&mut x);
    factor(&second).solve(&mut y);
    assert_eq!(x, y);
    assert_eq!(reused.stats().factorisations, 2);
}

#[test]
fn fixed_unknowns_cost_nothing() {
    let free = block(8, 0.5);
    let fixed: Vec<bool> = (0..free.matrix.n).map(|i| i % 3 != 2).collect();
    let held = System {
        matrix: free.matrix.with_identity(&fixed).into_owned(),
        node: free.node.clone(),
    };
    let mut solver = factor(&held);
    let alone = held.matrix.n / 3 * 2;
    assert!(solver.stats().nnz_factor - alone < factor(&free).stats().nnz_factor / 8);
    let mut x = vec![3.0; held.matrix.n];
    solver.solve(&mut x);
    assert!(x.iter().zip(&fixed).all(|(x, fixed)| !fixed || *x == 3.0));
    let mut product = vec![0.0; x.len()];
    held.matrix.multiply(&x, &mut product);
    assert!(distance(&product, &vec![3.0; x.len()]) < 1e-13);
}

#[test]
fn a_matrix_of_fixed_unknowns_alone_is_its_diagonal() {
    let matrix = block(1, 0.5).matrix.with_identity(&[true; 24]).into_owned();
    let mut solver = Cholesky::new(&matrix, &[0; 24]).unwrap();
    let (mut x, expected) = (vec![2.5; 24], vec![2.5; 24]);
    solver.solve(&mut x);
    assert_eq!(x, expected);
    assert_eq!(solver.stats().nnz_factor, 24);
    assert_eq!(solver.stats().flops, 0.0);
}

#[test]
fn an_empty_matrix_is_solved() {
    let mut solver = Cholesky::new(&Csr::from_cliques(0, &Default::default()), &[]).unwrap();
    solver.solve(&mut []);
    assert!(solver.respond(&[]).is_empty());
}

#[test]
fn an_indefinite_matrix_is_refused_with_the_unknown() {
    // Whatever the order: the pivots before the spoilt one are those of a positive definite matrix, its own is negative.
    for spoilt in [0, 17, 100, 186, 374] {
        let mut system = block(4, 1.0);
        system.matrix.add(spoilt, spoilt, -1e6);
        let error = Cholesky::new(&system.matrix, &system.node).err();
        let diagonal = system.matrix.get(spoilt, spoilt);
        assert_eq!(
            error,
            Some(Error::NotPositiveDefinite {
                unknown: spoilt,
                diagonal
            })
        );
        let message = error.unwrap().to_string();
        assert!(
            message.contains(&format!("pivot of unknown {spoilt} is not positive")),
            "{message}"
        );
    }
}

#[test]
fn a_floating_body_is_refused() {
    let error = Cholesky::new(&block(3, -1e-9).matrix, &block(3, 0.0).node).err();
    assert!(
        matches!(error, Some(Error::NotPositiveDefinite { .. })),
        "{error:?}"
    );
}

#[test]
fn a_singular_diagonal_is_refused() {
    let mut matrix = block(1, 1.0).matrix.with_identity(&[true; 24]).into_owned();
    matrix.add(7, 7, -1.0);
    let error = Cholesky::new(&matrix, &[0; 24]).err();
    assert_eq!(
        error,
        Some(Error::NotPositiveDefinite {
            unknown: 7,
            diagonal: 0.0
        })
    );
}

#[test]
fn entries_that_are_not_finite_are_named() {
    let mut system = block(2, 1.0);
    system.matrix.add(5, 4, f64::NAN);
    let error = Cholesky::new(&system.matrix, &system.node).err();
    assert!(
        matches!(
            error,
            Some(Error::NotFinite {
                row: 5,
                column: 4,
                ..
            })
        ),
        "{error:?}"
    );
}

#[test]
fn wrong_sizes_and_other_patterns_are_refused() {
    let system = block(2, 1.0);
    let error = Cholesky::new(&system.matrix, &[0, 1]).err();
    assert_eq!(
        error,
        Some(Error::WrongLength {
            what: "groups of unknowns",
            expected: 81,
            found: 2
        })
    );
    let mut solver = factor(&system);
    let held = system.matrix.with_identity(&[true; 81]);
    let error = solver.refactor(&held).err();
    assert_eq!(
        error,
        Some(Error::PatternChanged {
            expected: system.matrix.nnz(),
            found: 81
        })
    );
}

#[test]
fn the_order_of_elimination_does_not_depend_on_the_names_of_the_groups() {
    let system = block(4, 1.0);
    let renamed: Vec<u32> = system.node.iter().map(|g| 5 * g + 1_000_000).collect();
    let mut other = Cholesky::new(&system.matrix, &renamed).unwrap();
    let b = Random(16).vector(system.matrix.n);
    let (mut x, mut y) = (b.clone(), b);
    factor(&system).solve(&mut x);
    other.solve(&mut y);
    assert_eq!(x, y);
}

#[test]
fn counted_entries_bound_the_fill_of_a_block() {
    // Nested dissection of a cube: entries of L for n = 16 measured at 5.9 million with SCOTCH itself.
    let solver = factor(&block(16, 0.5));
    let stats = solver.stats();
    assert_eq!(stats.unknowns, 14_739);
    assert!(stats.nnz_factor < 6_500_000, "{}", stats.nnz_factor);
    assert!(stats.bytes > 8 * stats.nnz_factor && stats.bytes < 24 * stats.nnz_factor);
}

mod dense_factor {
    use super::*;

    #[test]
    fn least_pivot_is_what_the_others_leave_of_a_diagonal() {
        // the angle between two vectors: 1 - cos²
        let (cos, size) = (0.6, 9.0);
        let matrix = [size, 3.0 * cos, 3.0 * cos, 1.0];
        let factor = DenseCholesky::new(2, &matrix).unwrap();
        assert!((factor.least_pivot() - 0.64).abs() < 1e-15);
    }

    #[test]
    fn solves_a_matrix_of_known_inverse() {
        // Second difference matrix: inverse (min(i, j) + 1) (n - max(i, j)) / (n + 1).
        let n = 37;
        let mut a = vec![0.0; n * n];
        for i in 0..n {
            a[i * n + i] = 2.0;
            if i + 1 < n {
                a[i * n + i + 1] = -1.0;
                a[(i + 1) * n + i] = -1.0;
            }
        }
        let solver = DenseCholesky::new(n, &a).unwrap();
        for j in [0, 5, 36] {
            let mut x = vec![0.0; n];
            x[j] = 1.0;
            solver.solve(&mut x);
            let exact: Vec<f64> = (0..n)
                .map(|i| (i.min(j) + 1) as f64 * (n - i.max(j)) as f64 / (n + 1) as f64)
                .collect();
            assert!(distance(&x, &exact) < 1e-13);
        }
    }

    #[test]
    fn refuses_what_it_cannot_factorise() {
        let error = DenseCholesky::new(2, &[1.0, 2.0, 2.0, 1.0]).err();
        assert_eq!(
            error,
            Some(Error::NotPositiveDefinite {
                unknown: 1,
                diagonal: 1.0
            })
        );
        let error = DenseCholesky::new(2, &[1.0, 0.0, f64::INFINITY, 1.0]).err();
        assert_eq!(
            error,
            Some(Error::NotFinite {
                row: 1,
                column: 0,
                value: f64::INFINITY
            })
        );
        assert!(matches!(
            DenseCholesky::new(2, &[1.0]),
            Err(Error::WrongLength { .. })
        ));
    }

    #[test]
    fn of_no_unknowns_solves_nothing() {
        DenseCholesky::new(0, &[]).unwrap().solve(&mut []);
    }
}

mod allocations {
    use super::*;
    use carom_algebra::solver::SparseRow;
    use carom_testing::allocations;

    #[test]
    fn sweeps_and_products_allocate_nothing() {
        let system = block(5, 1.0);
        let mut solver = factor(&system);
        let row = SparseRow {
            dofs: vec![4],
            coefficients: vec![1.0],
        };
        let response = solver.respond(&[row]).remove(0);
        let small = DenseCholesky::new(2, &[2.0, 1.0, 1.0, 2.0]).unwrap();
        let r = vec![1.0; system.matrix.n];
        let (mut y, mut x) = (r.clone(), r.clone());
        let before = allocations();
        solver.forward(&r, &mut y);
        response.add_scaled(response.dot_dense(&y) / response.dot(&response), &mut y);
        solver.backward(&mut y, &mut x);
        solver.solve(&mut x);
        small.solve(&mut x[..2]);
        system.matrix.multiply(&x, &mut y);
        assert_eq!(allocations() - before, 0);
    }
}

mod dense_lu {
    use super::*;
    use carom_algebra::dense::DenseLu;
    use carom_testing::Random;

    #[test]
    fn unsymmetric_systems_are_solved_with_zeros_on_the_diagonal() {
        let mut random = Random(2);
        for n in [1, 2, 3, 17, 80] {
            let mut a = random.vector(n * n);
            if n > 1 {
                // a cyclic permutation dominates, and the diagonal vanishes
                for k in 0..n {
                    a[k * n + k] = 0.0;
                    a[k * n + (k + 1) % n] += n as f64;
                }
            }
            let x = random.vector(n);
            // column-major
            let b: Vec<f64> = (0..n)
                .map(|i| (0..n).map(|j| a[j * n + i] * x[j]).sum())
                .collect();
            let solved = DenseLu::new(n, a).unwrap().solve(&b);
            for (x, solved) in x.iter().zip(&solved) {
                // dominated by a permutation: condition of a few
                assert!((x - solved).abs() < 1e-12, "{n}: {x} {solved}");
            }
        }
    }

    #[test]
    fn a_matrix_that_is_no_matrix_is_refused() {
        assert!(matches!(
            DenseLu::new(2, vec![1.0; 3]),
            Err(Error::WrongLength { .. })
        ));
        let error = DenseLu::new(2, vec![1.0, 2.0, f64::INFINITY, 1.0]).err();
        assert_eq!(
            error,
            Some(Error::NotFinite {
                row: 0,
                column: 1,
                value: f64::INFINITY
            })
        );
    }
}

/// Runs with this number of threads.
fn on<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(run)
}

#[test]
fn threads_share_fronts_and_the_bits_stay() {
    // 14 739 unknowns: dozens of subtrees, and fronts that are cut into strips
    let system = block(16, 0.5);
    let b = Random(16).vector(system.matrix.n);
    let solve = |threads| {
        on(threads, || {
            let mut x = b.clone();
            factor(&system).solve(&mut x);
            x
        })
    };
    let alone = solve(1);
    assert!(alone == solve(2) && alone == solve(5));
}

#[test]
fn threads_agree_on_the_first_pivot_that_fails() {
    let mut system = block(12, 0.5);
    for spoilt in [700, 3000, 5200] {
        system.matrix.add(spoilt, spoilt, -1e6);
    }
    let fails = |threads| {
        on(threads, || {
            Cholesky::new(&system.matrix, &system.node).err()
        })
    };
    let alone = fails(1);
    assert!(alone.is_some());
    assert_eq!(alone, fails(2));
    assert_eq!(alone, fails(5));
}
