//! Triangular solves with one dense panel of a factor, for one right-hand side or [`LANES`] of them.
//!
//! A panel is a trapezoid of `rows` rows and `columns` columns, column-major: a lower triangle over a rectangle. The columns are
//! taken a few at a time, so that the right-hand side is read and written once for several of them; the loops are plain and
//! become vector code of the instruction set `S` when the caller runs them inside `Simd::vectorize`.

use pulp::Simd;
use std::array::from_fn;

/// Right-hand sides that travel together.
pub(crate) const LANES: usize = 8;

/// One entry of [`LANES`] right-hand sides.
pub(crate) type Lanes = [f64; LANES];

/// a b + c, rounded once where the instruction set can: without it `mul_add` is a library call.
#[inline(always)]
fn multiply_add<S: Simd>(a: f64, b: f64, c: f64) -> f64 {
    if S::IS_SCALAR {
        a * b + c
    } else {
        a.mul_add(b, c)
    }
}

/// Dot product in sixteen lanes that are added in order.
#[inline(always)]
pub(crate) fn dot<S: Simd>(x: &[f64], y: &[f64]) -> f64 {
    let (xs, x_tail) = x.as_chunks::<16>();
    let (ys, y_tail) = y.as_chunks::<16>();
    let mut lanes = [0.0; 16];
    for (a, b) in xs.iter().zip(ys) {
        for k in 0..16 {
            lanes[k] = multiply_add::<S>(a[k], b[k], lanes[k]);
        }
    }
    for (k, (a, b)) in x_tail.iter().zip(y_tail).enumerate() {
        lanes[k] = multiply_add::<S>(*a, *b, lanes[k]);
    }
    lanes.iter().sum()
}

/// y += alpha x.
#[inline(always)]
pub(crate) fn add_scaled<S: Simd>(alpha: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y = multiply_add::<S>(alpha, *x, *y);
    }
}

/// Solves with the triangle and takes its effect from the rows below: on return the first `columns` entries of `x` hold the
/// solution z of T z = x, and the others have lost R z.
#[inline(always)]
pub(crate) fn forward<S: Simd>(panel: &[f64], rows: usize, columns: usize, x: &mut [f64]) {
    let mut j = 0;
    while columns - j >= 8 {
        forward_block::<S, 8>(panel, rows, j, x);
        j += 8;
    }
    if columns - j >= 4 {
        forward_block::<S, 4>(panel, rows, j, x);
        j += 4;
    }
    if columns - j >= 2 {
        forward_block::<S, 2>(panel, rows, j, x);
        j += 2;
    }
    if columns > j {
        forward_block::<S, 1>(panel, rows, j, x);
    }
}

#[inline(always)]
fn forward_block<S: Simd, const B: usize>(panel: &[f64], rows: usize, j: usize, x: &mut [f64]) {
    let (head, tail) = x[j..rows].split_at_mut(B);
    let mut z = [0.0; B];
    for b in 0..B {
        let column = &panel[(j + b) * rows + j..][..B];
        z[b] = head[b] / column[b];
        for c in b + 1..B {
            head[c] = multiply_add::<S>(-z[b], column[c], head[c]);
        }
    }
    head.copy_from_slice(&z);
    let columns = below::<B>(panel, rows, j);
    for i in 0..tail.len() {
        let mut sum = tail[i];
        for b in 0..B {
            sum = multiply_add::<S>(-z[b], columns[b][i], sum);
        }
        tail[i] = sum;
    }
}

/// The same as [`forward`] for [`LANES`] right-hand sides. No lane sees another: its bits do not depend on their values.
#[inline(always)]
pub(crate) fn forward_lanes<S: Simd>(panel: &[f64], rows: usize, columns: usize, x: &mut [Lanes]) {
    let mut j = 0;
    while columns - j >= 8 {
        forward_lanes_block::<S, 8>(panel, rows, j, x);
        j += 8;
    }
    if columns - j >= 4 {
        forward_lanes_block::<S, 4>(panel, rows, j, x);
        j += 4;
    }
    if columns - j >= 2 {
        forward_lanes_block::<S, 2>(panel, rows, j, x);
        j += 2;
    }
    if columns > j {
        forward_lanes_block::<S, 1>(panel, rows, j, x);
    }
}

#[inline(always)]
fn forward_lanes_block<S: Simd, const B: usize>(
    panel: &[f64],
    rows: usize,
    j: usize,
    x: &mut [Lanes],
) {
    let (head, tail) = x[j..rows].split_at_mut(B);
    let mut z = [[0.0; LANES]; B];
    for b in 0..B {
        let column = &panel[(j + b) * rows + j..][..B];
        for k in 0..LANES {
            z[b][k] = head[b][k] / column[b];
        }
        for c in b + 1..B {
            subtract_scaled::<S>(column[c], &z[b], &mut head[c]);
        }
    }
    head.copy_from_slice(&z);
    let columns = below::<B>(panel, rows, j);
    for i in 0..tail.len() {
        let mut sum = tail[i];
        for b in 0..B {
            subtract_scaled::<S>(columns[b][i], &z[b], &mut sum);
        }
        tail[i] = sum;
    }
}

/// y -= a z, lane by lane.
#[inline(always)]
fn subtract_scaled<S: Simd>(a: f64, z: &Lanes, y: &mut Lanes) {
    for k in 0..LANES {
        y[k] = multiply_add::<S>(-a, z[k], y[k]);
    }
}

/// Solves with the transposed trapezoid: on return the first `columns` entries of `x` hold z of Tᵀ z = x - Rᵀ (rows below).
#[inline(always)]
pub(crate) fn backward<S: Simd>(panel: &[f64], rows: usize, columns: usize, x: &mut [f64]) {
    let mut j = columns;
    if columns & 1 != 0 {
        j -= 1;
        backward_block::<S, 1>(panel, rows, j, x);
    }
    if columns & 2 != 0 {
        j -= 2;
        backward_block::<S, 2>(panel, rows, j, x);
    }
    if columns & 4 != 0 {
        j -= 4;
        backward_block::<S, 4>(panel, rows, j, x);
    }
    while j > 0 {
        j -= 8;
        backward_block::<S, 8>(panel, rows, j, x);
    }
}

#[inline(always)]
fn backward_block<S: Simd, const B: usize>(panel: &[f64], rows: usize, j: usize, x: &mut [f64]) {
    let (head, tail) = x[j..rows].split_at_mut(B);
    let columns = below::<B>(panel, rows, j);
    let sums = dots::<S, B>(&columns, tail);
    for b in (0..B).rev() {
        let column = &panel[(j + b) * rows + j..][..B];
        let mut sum = head[b] - sums[b];
        for c in b + 1..B {
            sum = multiply_add::<S>(-column[c], head[c], sum);
        }
        head[b] = sum / column[b];
    }
}

/// Dot products of `x` with several columns, each in eight lanes that are added in order.
#[inline(always)]
fn dots<S: Simd, const B: usize>(columns: &[&[f64]; B], x: &[f64]) -> [f64; B] {
    let (xs, x_tail) = x.as_chunks::<LANES>();
    let chunks: [&[Lanes]; B] = from_fn(|b| columns[b].as_chunks::<LANES>().0);
    let mut lanes = [[0.0; LANES]; B];
    for i in 0..xs.len() {
        for b in 0..B {
            for k in 0..LANES {
                lanes[b][k] = multiply_add::<S>(chunks[b][i][k], xs[i][k], lanes[b][k]);
            }
        }
    }
    let whole = xs.len() * LANES;
    from_fn(|b| {
        let mut sum = lanes[b].iter().sum();
        for (a, x) in columns[b][whole..].iter().zip(x_tail) {
            sum = multiply_add::<S>(*a, *x, sum);
        }
        sum
    })
}

/// Columns j .. j + B of a panel, each from row j + B on.
#[inline(always)]
fn below<const B: usize>(panel: &[f64], rows: usize, j: usize) -> [&[f64]; B] {
    from_fn(|b| &panel[(j + b) * rows + j + B..(j + b + 1) * rows])
}
