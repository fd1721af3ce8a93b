//! Sparse factor, sweeps and responses on a block of hexahedra, beside what memory allows.
//!
//! `cargo bench -p carom-benches --bench algebra`; `CAROM_BENCH_N=32` sets the cells along an edge (24 unless given; n = 32 has 107 811
//! unknowns and takes minutes). The sweeps and `memory/read` count the same bytes, 8 per entry of the factor: the ratio of
//! their rates is the part of the memory bandwidth that a sweep reaches. `respond` takes one row per node of a face, as a
//! contact with a rigid plane does, and counts rows; `factor` counts operations. `iterations` count the bytes that they read and write, of which a
//! product has half of the matrix.

#[path = "../../crates/algebra/tests/all/block.rs"]
mod block;

use carom_algebra::{
    reduce,
    solver::{Cholesky, Iterative, Response, SparseRow, gram},
};
use criterion::{Criterion, Throughput};
use std::hint::black_box;

fn main() {
    let cells = std::env::var("CAROM_BENCH_N")
        .ok()
        .and_then(|n| n.parse().ok())
        .unwrap_or(24);
    let system = block::block(cells, 0.5);
    let mut criterion = Criterion::default().sample_size(10).configure_from_args();
    if let Ok(mut solver) = Cholesky::new(&system.matrix, &system.node) {
        factor(&mut criterion, &system, &mut solver);
        sweeps(&mut criterion, &mut solver);
        respond(&mut criterion, &mut solver, cells);
    }
    if let Ok(mut solver) = Iterative::new(&system.matrix, &system.node) {
        iterations(&mut criterion, &mut solver, system.matrix.nnz());
    }
    criterion.final_summary();
}

fn factor(criterion: &mut Criterion, system: &block::System, solver: &mut Cholesky) {
    let mut group = criterion.benchmark_group("factor");
    group.throughput(Throughput::Elements(solver.stats().flops as u64));
    group.bench_function("refactor", |bench| {
        bench.iter(|| solver.refactor(&system.matrix))
    });
    group.finish();
}

fn sweeps(criterion: &mut Criterion, solver: &mut Cholesky) {
    let (unknowns, entries) = (solver.stats().unknowns, solver.stats().nnz_factor);
    let (r, mut y, mut x) = (
        vec![1.0; unknowns],
        vec![0.0; unknowns],
        vec![0.0; unknowns],
    );
    let memory = vec![1.0; entries];
    let mut group = criterion.benchmark_group("sweeps");
    group.throughput(Throughput::Bytes(8 * entries as u64));
    group.bench_function("memory/read", |bench| {
        bench.iter(|| reduce::sum(black_box(&memory)))
    });
    group.bench_function("forward", |bench| bench.iter(|| solver.forward(&r, &mut y)));
    group.bench_function("backward", |bench| {
        bench.iter(|| {
            y.copy_from_slice(&r);
            solver.backward(&mut y, &mut x);
        });
    });
    group.finish();
}

fn respond(criterion: &mut Criterion, solver: &mut Cholesky, cells: usize) {
    let nodes = 0..(cells as u32 + 1).pow(2);
    let rows: Vec<SparseRow> = nodes
        .map(|node| SparseRow {
            dofs: vec![3 * node + 2],
            coefficients: vec![1.0],
        })
        .collect();
    let columns = solver.respond(&rows);
    let columns: Vec<&Response> = columns.iter().collect();
    let mut group = criterion.benchmark_group("contact");
    group.throughput(Throughput::Elements(rows.len() as u64));
    group.bench_function("respond", |bench| bench.iter(|| solver.respond(&rows)));
    group.bench_function("gram", |bench| bench.iter(|| gram(&columns)));
    group.finish();
}

fn iterations(criterion: &mut Criterion, solver: &mut Iterative, entries: usize) {
    const MOST: usize = 10;
    let load: Vec<f64> = (0..solver.unknowns()).map(|i| (i as f64).sin()).collect();
    let mut x = vec![0.0; load.len()];
    let mut group = criterion.benchmark_group("iterations");
    // half of the entries, and an index for each nine
    group.throughput(Throughput::Bytes((4 * entries + 2 * entries / 9) as u64));
    group.bench_function("product", |bench| {
        bench.iter(|| solver.multiply(&load, &mut x))
    });
    group.throughput(Throughput::Bytes((MOST * solver.bytes()) as u64));
    group.bench_function("ten", |bench| {
        bench.iter(|| black_box(solver.solve_within(&load, &mut x, (1e-30, MOST)).is_ok()))
    });
    group.finish();
}
