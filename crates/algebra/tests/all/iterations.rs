//! Conjugate gradients, and constrained motions.

use crate::block::block;
use crate::numbers::distance;
use std::ops::Range;

use carom_algebra::Error;
use carom_algebra::csr::Csr;
use carom_algebra::pattern::Cliques;
use carom_algebra::solver::{Cholesky, Iterative, Saddle, SharedRows, SparseRow, gram};
use carom_ranks::{Ranks, threads};
use carom_testing::Random;

/// Rows of the bottom of a block of `n` cubed cells: two neighbours each, so that rows share nodes.
fn rows(n: usize) -> Vec<SparseRow> {
    let nodes = (n as u32 + 1).pow(2);
    let row = |node: u32| SparseRow {
        dofs: vec![3 * node + 2, 3 * (node + 1) + 2, 3 * node],
        coefficients: vec![0.6, 0.4, 0.1],
    };
    (0..nodes - 1).map(row).collect()
}

#[test]
fn solutions_equal_those_of_the_factor() {
    for (n, shift) in [(1, 0.1), (4, 0.5), (9, 5.0)] {
        let system = block(n, shift);
        let b = Random(31).vector(system.matrix.n);
        let (mut x, mut reference) = (vec![0.0; b.len()], b.clone());
        Cholesky::new(&system.matrix, &system.node)
            .unwrap()
            .solve(&mut reference);
        let mut solver = Iterative::new(&system.matrix, &system.node).unwrap();
        let iterations = solver.solve(&b, &mut x, 1e-13).unwrap();
        assert!(
            distance(&x, &reference) < 1e-11,
            "{}",
            distance(&x, &reference)
        );
        assert!(iterations < 150, "{iterations}");
        assert_eq!(solver.products(), iterations);
    }
}

#[test]
fn iterations_do_not_grow_with_the_mesh() {
    // the shift is what the mass is in a step at a Courant number that stays: the condition number stays too
    let iterations = |n| {
        let system = block(n, 3.0);
        let b = Random(32).vector(system.matrix.n);
        let mut x = vec![0.0; b.len()];
        Iterative::new(&system.matrix, &system.node)
            .unwrap()
            .solve(&b, &mut x, 1e-10)
            .unwrap()
    };
    let [coarse, fine] = [8, 16].map(iterations);
    // as the square root of the condition number they would double with the halved size of the elements
    assert!(2 * fine < 3 * coarse, "{coarse} and {fine}");
}

#[test]
fn constrained_motions_equal_those_of_the_columns() {
    let (n, shift) = (5, 1.0);
    let system = block(n, shift);
    let rows = rows(n);
    let mut factor = Cholesky::new(&system.matrix, &system.node).unwrap();
    let columns = factor.respond(&rows);
    let d = gram(&columns.iter().collect::<Vec<_>>());
    let mut saddle = Saddle::default();
    let solver = Box::new(Iterative::new(&system.matrix, &system.node).unwrap());
    saddle.begin(vec![(0, solver)], rows.iter().cloned(), (1e-12, |_| ()));
    // first without compliance, then fewer rows, some of which yield, from the motion before
    let all: Vec<u32> = (0..rows.len() as u32).collect();
    let some: Vec<u32> = all.iter().copied().filter(|k| k % 3 != 1).collect();
    let yielding: Vec<f64> = some
        .iter()
        .map(|&k| if k % 2 == 0 { 0.0 } else { 0.3 })
        .collect();
    for (points, own) in [(&all, vec![0.0; all.len()]), (&some, yielding)] {
        let b = Random(33).vector(points.len());
        let mut forces = b.clone();
        saddle.solve((points, &own), 0.0, &mut forces).unwrap();
        // N A⁻¹ Nᵀ P + K P = b, with the products of the columns
        let product = |i: u32| -> f64 {
            let terms = points.iter().zip(&forces);
            terms
                .map(|(&j, p)| d[i as usize * rows.len() + j as usize] * p)
                .sum()
        };
        for (k, &i) in points.iter().enumerate() {
            let left = product(i) + own[k] * forces[k] - b[k];
            assert!(left.abs() < 1e-9, "{left}");
        }
        for i in 0..rows.len() {
            assert!((saddle.along(i) - product(i as u32)).abs() < 1e-9);
        }
    }
    let operators = saddle.end();
    assert_eq!(operators.len(), 1);
}

#[test]
fn a_matrix_that_is_not_positive_definite_is_refused() {
    let mut system = block(3, 1.0);
    system.matrix.add(40, 40, -1e3);
    let refused = Iterative::new(&system.matrix, &system.node).err();
    assert!(matches!(
        refused,
        Some(Error::NotPositiveDefinite { unknown: 39, .. })
    ));
    // blocks that are positive, and a matrix that is not
    let mut system = block(3, 1.0);
    let stiff = 10.0 * system.matrix.get(40, 40);
    system.matrix.add(40, 43, stiff);
    system.matrix.add(43, 40, stiff);
    let mut solver = Iterative::new(&system.matrix, &system.node).unwrap();
    let b = Random(34).vector(solver.unknowns());
    let mut x = vec![0.0; b.len()];
    let failed = solver.solve(&b, &mut x, 1e-12);
    assert!(
        matches!(failed, Err(Error::Iterations { .. })),
        "{failed:?}"
    );
}

#[test]
fn motions_of_a_load_and_of_forces_are_found_together_and_gone_on_with() {
    let (n, shift) = (5, 1.0);
    let system = block(n, shift);
    let rows = rows(n);
    let load = Random(35).vector(system.matrix.n);
    let points: Vec<u32> = (0..rows.len() as u32).filter(|k| k % 3 != 1).collect();
    let own = vec![0.1; points.len()];
    let b = Random(36).vector(points.len());
    // with few digits and then with all, or with all at once
    let solved = |tolerances: &[f64]| {
        let mut saddle = Saddle::default();
        let solver = Box::new(Iterative::new(&system.matrix, &system.node).unwrap());
        let given = |to: &mut [f64]| to.copy_from_slice(&load);
        saddle.begin(vec![(0, solver)], rows.iter().cloned(), (1e-12, given));
        let mut forces = Vec::new();
        for &tolerance in tolerances {
            forces.clone_from(&b);
            saddle
                .solve((&points, &own), tolerance, &mut forces)
                .unwrap();
        }
        let mut motion = vec![0.0; load.len()];
        saddle.add_motion(1.0, &mut motion);
        (saddle, forces, motion)
    };
    let (mut at_once, forces, motion) = solved(&[0.0]);
    // A x = r + Nᵀ P, N x + K P = b
    let mut image = vec![0.0; load.len()];
    system.matrix.multiply(&motion, &mut image);
    let mut all = load.clone();
    for ((&k, force), (own, b)) in points.iter().zip(&forces).zip(own.iter().zip(&b)) {
        let row = &rows[k as usize];
        let terms = || row.dofs.iter().zip(&row.coefficients);
        let along: f64 = terms().map(|(&i, n)| n * motion[i as usize]).sum();
        assert!((along + own * force - b).abs() < 1e-10);
        terms().for_each(|(&i, n)| all[i as usize] += n * force);
    }
    assert!(distance(&image, &all) < 1e-10);
    let (mut in_turn, again, moved) = solved(&[1e-3, 1e-3, 0.0]);
    assert!(distance(&again, &forces) < 1e-10 && distance(&moved, &motion) < 1e-10);
    // iterations go on where they have ended
    let products = |saddle: &mut Saddle| saddle.end()[0].1.products();
    assert_eq!(products(&mut in_turn), products(&mut at_once));
    let (mut free, ..) = solved(&[]);
    free.solve((&[], &[]), 0.0, &mut []).unwrap();
    let mut motion = vec![0.0; load.len()];
    free.add_motion(1.0, &mut motion);
    system.matrix.multiply(&motion, &mut image);
    assert!(distance(&image, &load) < 1e-10);
}

/// The rows of ranks that share a matrix.
fn shared(matrix: &Csr, node: &[u32], ranks: &Ranks) -> SharedRows {
    SharedRows::new(node, ranks, |own| {
        let first = own.map(|i| matrix.row(i).0[0] as usize);
        first.min().unwrap()
    })
}

/// These rows of a matrix, and no other entry than zeros on the diagonal.
fn of_rows(matrix: &Csr, rows: &Range<usize>) -> Csr {
    let mut cliques = Cliques::new();
    for i in rows.clone() {
        for &j in matrix.row(i).0 {
            cliques.push(&[i as u32, j]);
        }
    }
    let mut own = Csr::from_cliques(matrix.n, &cliques);
    for i in rows.clone() {
        let (columns, values) = matrix.row(i);
        for (&j, &value) in columns.iter().zip(values) {
            own.add(i, j as usize, value);
        }
    }
    own
}

#[test]
fn ranks_keep_their_rows_alone_and_find_the_same_solution() {
    let system = block(17, 2.0);
    let b = Random(41).vector(system.matrix.n);
    let solution = |ranks: &Ranks| {
        let rows = shared(&system.matrix, &system.node, ranks);
        let own = of_rows(&system.matrix, &rows.needed());
        let mut solver = Iterative::on(&own, rows).unwrap();
        let mut x = vec![0.0; b.len()];
        let iterations = solver.solve(&b, &mut x, 1e-12).unwrap();
        (x, iterations, solver.bytes(), solver.entries())
    };
    let (x, iterations, bytes, entries) = solution(&Ranks::alone());
    for count in [2, 3, 20] {
        let kept = std::thread::scope(|scope| {
            let own = threads(count).into_iter().map(|ranks| {
                let (solution, x) = (&solution, &x);
                scope.spawn(move || {
                    let own = solution(&ranks);
                    assert!(own.0 == *x);
                    assert_eq!((own.1, own.2), (iterations, bytes));
                    own.3
                })
            });
            let own: Vec<_> = own.collect();
            own.into_iter()
                .map(|rank| rank.join().unwrap())
                .collect::<Vec<_>>()
        });
        // six chunks of rows, of which a rank has its own and the one before, whose columns are among its rows
        let chunks = (6 / count).max(1) + 1;
        let most = kept.iter().max().unwrap();
        assert!(*most <= entries * chunks / 5, "{kept:?} of {entries}");
    }
}

#[test]
fn a_block_that_is_not_positive_definite_is_refused_on_all_ranks() {
    let mut system = block(14, 0.7);
    let last = system.matrix.n - 1;
    system.matrix.add(last, last, -1e9);
    let refused = |ranks: &Ranks| {
        let rows = shared(&system.matrix, &system.node, ranks);
        let own = of_rows(&system.matrix, &rows.needed());
        Iterative::on(&own, rows).err()
    };
    let alone = refused(&Ranks::alone());
    assert!(
        matches!(alone, Some(Error::NotPositiveDefinite { unknown, .. }) if unknown == last - 2)
    );
    std::thread::scope(|scope| {
        for ranks in threads(3) {
            let (refused, alone) = (&refused, &alone);
            scope.spawn(move || assert_eq!(&refused(&ranks), alone));
        }
    });
}

#[test]
fn products_have_the_same_bits_on_any_number_of_threads_and_of_ranks() {
    // several chunks of rows, the last one short
    let system = block(14, 0.7);
    let x = Random(37).vector(system.matrix.n);
    let product = |threads: usize, ranks: &Ranks| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let rows = shared(&system.matrix, &system.node, ranks);
        let own = of_rows(&system.matrix, &rows.needed());
        let mut solver = Iterative::on(&own, rows).unwrap();
        let mut y = vec![0.0; x.len()];
        let multiply = || solver.multiply(&x, &mut y);
        pool.build().unwrap().install(multiply);
        y
    };
    let reference = product(1, &Ranks::alone());
    let mut exact = vec![0.0; x.len()];
    system.matrix.multiply(&x, &mut exact);
    assert!(distance(&reference, &exact) < 1e-14);
    assert!(product(3, &Ranks::alone()) == reference);
    for count in [2, 3, 5] {
        std::thread::scope(|scope| {
            for ranks in threads(count) {
                let (product, reference) = (&product, &reference);
                scope.spawn(move || assert!(&product(1, &ranks) == reference));
            }
        });
    }
}

#[test]
fn blocks_are_those_of_nodes_or_what_nodes_have_in_common() {
    // the same equations with other names of the nodes: blocks of 6, 3, 2 and 1
    let system = block(3, 1.0);
    let n = system.matrix.n;
    let b = Random(38).vector(n);
    let solution = |node: &dyn Fn(u32) -> u32| {
        let nodes: Vec<u32> = (0..n as u32).map(node).collect();
        let mut x = vec![0.0; n];
        Iterative::new(&system.matrix, &nodes)
            .unwrap()
            .solve(&b, &mut x, 1e-13)
            .unwrap();
        x
    };
    let reference = solution(&|i| i / 3);
    let mixed = |i: u32| if i < 6 { 0 } else { i / 3 };
    let names: [&dyn Fn(u32) -> u32; 5] = [&|i| i / 6, &mixed, &|i| i / 2, &|i| i, &|i| i.min(7)];
    for node in names {
        assert!(distance(&solution(node), &reference) < 1e-10);
    }
}

#[test]
fn a_renewed_matrix_is_the_new_one_with_its_pattern_or_another() {
    let first = block(5, 0.5);
    let mut held = vec![false; first.matrix.n];
    held[40..60].fill(true);
    // other values, fewer entries, and those of the first again
    let fewer = first.matrix.with_identity(&held).into_owned();
    let x = Random(39).vector(first.matrix.n);
    let mut solver = Iterative::new(&fewer, &first.node).unwrap();
    for matrix in [&block(5, 2.0).matrix, &fewer, &first.matrix] {
        solver.renew(matrix).unwrap();
        let product = |solver: &mut Iterative| {
            let mut y = vec![0.0; x.len()];
            solver.multiply(&x, &mut y);
            y
        };
        let mut made = Iterative::new(matrix, &first.node).unwrap();
        assert!(product(&mut solver) == product(&mut made));
    }
}
