//! Sparse responses Y = L⁻¹ P Nᵀ.

use crate::block::{System, block};
use carom_testing::Random;

use crate::numbers::{distance, random};
use carom_algebra::solver::{Cholesky, Response, SparseRow, gram};

/// `count` rows of `width` unknowns each, with a repeated and an isolated unknown among them where there is one.
fn rows(system: &System, count: usize, width: usize) -> Vec<SparseRow> {
    let mut numbers = Random(21);
    (0..count)
        .map(|_| {
            let pick = |r: f64| ((r + 1.0) / 2.0 * system.matrix.n as f64) as u32;
            let mut dofs: Vec<u32> = (0..width).map(|_| pick(numbers.next())).collect();
            dofs.push(dofs[0]);
            dofs.push(system.matrix.n as u32 - 1);
            let coefficients = numbers.vector(dofs.len());
            SparseRow { dofs, coefficients }
        })
        .collect()
}

fn systems() -> [System; 4] {
    let mut numbers = Random(22);
    [
        block(5, 0.3),
        random(400, 3, &mut numbers),
        random(60, 12, &mut numbers),
        random(30, 0, &mut numbers),
    ]
}

fn scatter(row: &SparseRow, n: usize) -> Vec<f64> {
    let mut x = vec![0.0; n];
    row.dofs
        .iter()
        .zip(&row.coefficients)
        .for_each(|(&i, c)| x[i as usize] += c);
    x
}

fn same_bits(a: &Response, b: &Response) -> bool {
    a == b && a.dot(a).to_bits() == b.dot(b).to_bits()
}

#[test]
fn products_of_responses_are_entries_of_the_compliance() {
    for system in systems() {
        let n = system.matrix.n;
        let rows = rows(&system, 13, 4);
        let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
        let responses = solver.respond(&rows);
        let w = gram(&responses.iter().collect::<Vec<_>>());
        let mut exact = vec![0.0; 13 * 13];
        for (j, row) in rows.iter().enumerate() {
            let mut x = scatter(row, n);
            solver.solve(&mut x);
            for (i, row) in rows.iter().enumerate() {
                exact[i * 13 + j] = row
                    .dofs
                    .iter()
                    .zip(&row.coefficients)
                    .map(|(&i, c)| c * x[i as usize])
                    .sum();
            }
        }
        assert!(distance(&w, &exact) < 1e-12, "{}", distance(&w, &exact));
        assert_eq!(solver.stats().responses, 13);
        for i in 0..13 {
            for j in 0..13 {
                assert_eq!(w[i * 13 + j], responses[i].dot(&responses[j]));
                assert_eq!(w[i * 13 + j], responses[j].dot(&responses[i]));
            }
        }
    }
}

#[test]
fn a_column_has_the_same_bits_alone_among_five_and_among_eight() {
    for system in systems() {
        let rows = rows(&system, 21, 3);
        let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
        let together = solver.respond(&rows);
        for company in [1, 5, 8] {
            for (k, group) in rows.chunks(company).enumerate() {
                for (response, reference) in
                    solver.respond(group).iter().zip(&together[k * company..])
                {
                    assert!(same_bits(response, reference));
                }
            }
        }
        let reversed: Vec<SparseRow> = rows.iter().rev().cloned().collect();
        let backwards = solver.respond(&reversed);
        assert!(
            backwards
                .iter()
                .rev()
                .zip(&together)
                .all(|(a, b)| same_bits(a, b))
        );
    }
}

#[test]
fn responses_have_the_same_bits_on_any_number_of_threads() {
    let system = block(6, 0.3);
    let rows = rows(&system, 40, 2);
    let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
    let mut on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let responses = solver.respond(&rows);
            let w = gram(&responses.iter().collect::<Vec<_>>());
            (responses, w)
        })
    };
    assert!(on(1) == on(3));
}

#[test]
fn a_response_is_the_forward_sweep_of_its_row() {
    for system in systems() {
        let n = system.matrix.n;
        let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
        for row in rows(&system, 5, 3) {
            let responses = solver.respond(std::slice::from_ref(&row));
            let (mut sparse, mut dense) = (vec![0.0; n], vec![0.0; n]);
            responses[0].add_scaled(1.0, &mut sparse);
            solver.forward(&scatter(&row, n), &mut dense);
            assert!(distance(&sparse, &dense) < 1e-13);
            let square: f64 = dense.iter().map(|y| y * y).sum();
            assert!((responses[0].dot_dense(&dense) - square).abs() < 1e-12 * square);
        }
    }
}

#[test]
fn two_sweeps_make_a_step_with_contact() {
    // x = A⁻¹ (r + Nᵀ p), with N x = 0: the condensed form against a solve with the multipliers found.
    let system = block(4, 0.3);
    let n = system.matrix.n;
    let rows: Vec<SparseRow> = (0..2)
        .map(|k| SparseRow {
            dofs: vec![3 * k + 2, 200],
            coefficients: vec![1.0, -0.5],
        })
        .collect();
    let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
    let responses = solver.respond(&rows);
    let r = Random(23).vector(n);
    let (mut y, mut x) = (vec![0.0; n], vec![0.0; n]);
    solver.forward(&r, &mut y);
    let w = gram(&[&responses[0], &responses[1]]);
    let free: Vec<f64> = responses
        .iter()
        .map(|response| response.dot_dense(&y))
        .collect();
    let determinant = w[0] * w[3] - w[1] * w[2];
    let p = [
        (w[1] * free[1] - w[3] * free[0]) / determinant,
        (w[2] * free[0] - w[0] * free[1]) / determinant,
    ];
    responses
        .iter()
        .zip(p)
        .for_each(|(response, p)| response.add_scaled(p, &mut y));
    solver.backward(&mut y, &mut x);
    for row in &rows {
        let gap: f64 = row
            .dofs
            .iter()
            .zip(&row.coefficients)
            .map(|(&i, c)| c * x[i as usize])
            .sum();
        assert!(gap.abs() < 1e-13);
    }
    let mut loaded = r;
    for (row, p) in rows.iter().zip(p) {
        row.dofs
            .iter()
            .zip(&row.coefficients)
            .for_each(|(&i, c)| loaded[i as usize] += c * p);
    }
    solver.solve(&mut loaded);
    assert!(distance(&x, &loaded) < 1e-12);
}

#[test]
fn a_response_keeps_its_tree_path_and_nothing_else() {
    let system = block(12, 0.3);
    let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
    let row = SparseRow {
        dofs: vec![2],
        coefficients: vec![1.0],
    };
    let bytes = solver.respond(&[row])[0].bytes();
    assert!(bytes < 8 * system.matrix.n / 3, "{bytes}");
}

#[test]
fn a_row_of_nothing_responds_with_nothing() {
    let system = block(2, 0.3);
    let mut solver = Cholesky::new(&system.matrix, &system.node).unwrap();
    let responses = solver.respond(&[SparseRow::default()]);
    assert_eq!(responses[0].dot(&responses[0]), 0.0);
    assert_eq!(responses[0].dot_dense(&vec![1.0; system.matrix.n]), 0.0);
}
