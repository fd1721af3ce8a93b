//! Triangular solves with one dense panel of a factor, for one right-hand side or [`LANES`] of them.
//!
//! A panel is a trapezoid of `rows` rows and `columns` columns, column-major: a lower triangle over a rectangle. The columns are
//! taken a few at a time, so that the right-hand side is read and written once for several of them; the loops are plain and
//! become vector code of the instruction set `S` when the caller runs them inside `Simd::vectorize`. A closure of `array::map` is no
//! part of that, and calls a function for each instruction of the set: sums of lanes are taken in loops.

use pulp::Simd;
use std::array::from_fn;

/// Right-hand sides that travel together: as many as a block of eight columns lets stay in 32 registers of eight numbers. With eight
/// of them panels come twice as often from memory and take twice the time, with 32 registers overflow.
pub(crate) const LANES: usize = 16;

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

/// Adds to the lanes of the dot product of x with each of the `y`, all of one length. The bits of a product do not depend on the others.
#[inline(always)]
pub(crate) fn add_dots<S: Simd, const B: usize>(
    simd: S,
    x: &[f64],
    y: [&[f64]; B],
    sums: &mut [S::f64s; B],
) {
    let (xs, x_tail) = S::as_simd_f64s(x);
    let wide: [&[S::f64s]; B] = from_fn(|b| &S::as_simd_f64s(y[b]).0[..xs.len()]);
    let mut own = *sums;
    for i in 0..xs.len() {
        for b in 0..B {
            own[b] = simd.mul_add_e_f64s(wide[b][i], xs[i], own[b]);
        }
    }
    if !x_tail.is_empty() {
        let last = simd.partial_load_f64s(x_tail);
        for b in 0..B {
            let tail = simd.partial_load_f64s(S::as_simd_f64s(y[b]).1);
            own[b] = simd.mul_add_e_f64s(tail, last, own[b]);
        }
    }
    *sums = own;
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
pub(crate) fn backward<S: Simd>(
    simd: S,
    panel: &[f64],
    rows: usize,
    columns: usize,
    x: &mut [f64],
) {
    let mut j = columns;
    if columns & 1 != 0 {
        j -= 1;
        backward_block::<S, 1>(simd, panel, rows, j, x);
    }
    if columns & 2 != 0 {
        j -= 2;
        backward_block::<S, 2>(simd, panel, rows, j, x);
    }
    if columns & 4 != 0 {
        j -= 4;
        backward_block::<S, 4>(simd, panel, rows, j, x);
    }
    while j > 0 {
        j -= 8;
        backward_block::<S, 8>(simd, panel, rows, j, x);
    }
}

#[inline(always)]
fn backward_block<S: Simd, const B: usize>(
    simd: S,
    panel: &[f64],
    rows: usize,
    j: usize,
    x: &mut [f64],
) {
    let (head, tail) = x[j..rows].split_at_mut(B);
    let columns = below::<B>(panel, rows, j);
    let sums = dots(simd, &columns, tail);
    for b in (0..B).rev() {
        let column = &panel[(j + b) * rows + j..][..B];
        let mut sum = head[b] - sums[b];
        for c in b + 1..B {
            sum = multiply_add::<S>(-column[c], head[c], sum);
        }
        head[b] = sum / column[b];
    }
}

/// Dot products of `x` with several columns.
#[inline(always)]
fn dots<S: Simd, const B: usize>(simd: S, columns: &[&[f64]; B], x: &[f64]) -> [f64; B] {
    let mut sums = [simd.splat_f64s(0.0); B];
    add_dots(simd, x, *columns, &mut sums);
    let mut dots = [0.0; B];
    for b in 0..B {
        dots[b] = simd.reduce_sum_f64s(sums[b]);
    }
    dots
}

/// Columns j .. j + B of a panel, each from row j + B on.
#[inline(always)]
fn below<const B: usize>(panel: &[f64], rows: usize, j: usize) -> [&[f64]; B] {
    // from a loop the columns of several right-hand sides are gathered row by row, which takes twice the time
    from_fn(|b| &panel[(j + b) * rows + j + B..(j + b + 1) * rows])
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, Scalar, WithSimd};

    /// One trapezoid of each shape, with a diagonal that dominates.
    fn panel(rows: usize, columns: usize) -> Vec<f64> {
        (0..rows * columns)
            .map(|k| {
                let (i, j) = (k % rows, k / rows);
                if i == j {
                    3.0 + j as f64
                } else {
                    ((7 * i + 3 * j) % 11) as f64 / 11.0 - 0.4
                }
            })
            .collect()
    }

    /// Forward, then backward, then forward in lanes, of x_i = 1 + i / 7.
    struct Sweeps(usize, usize);

    impl WithSimd for Sweeps {
        type Output = [Vec<f64>; 3];

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Self(rows, columns) = self;
            let panel = panel(rows, columns);
            let x: Vec<f64> = (0..rows).map(|i| 1.0 + i as f64 / 7.0).collect();
            let (mut down, mut up) = (x.clone(), x.clone());
            let mut lanes: Vec<Lanes> = x
                .iter()
                .map(|x| from_fn(|k| x * (k == 5) as u8 as f64))
                .collect();
            forward::<S>(&panel, rows, columns, &mut down);
            backward(simd, &panel, rows, columns, &mut up);
            forward_lanes::<S>(&panel, rows, columns, &mut lanes);
            [down, up, lanes.iter().map(|x| x[5]).collect()]
        }
    }

    /// The definitions: L z = x with the rows below reduced, and the transposed solve.
    fn by_definition(rows: usize, columns: usize) -> [Vec<f64>; 2] {
        let panel = panel(rows, columns);
        let x: Vec<f64> = (0..rows).map(|i| 1.0 + i as f64 / 7.0).collect();
        let (mut down, mut up) = (x.clone(), x);
        for j in 0..columns {
            down[j] /= panel[j * rows + j];
            for i in j + 1..rows {
                down[i] -= panel[j * rows + i] * down[j];
            }
        }
        for j in (0..columns).rev() {
            for i in j + 1..rows {
                up[j] -= panel[j * rows + i] * up[i];
            }
            up[j] /= panel[j * rows + j];
        }
        [down, up]
    }

    #[test]
    fn every_instruction_set_solves_what_the_definition_solves() {
        for (rows, columns) in [
            (1, 1),
            (3, 2),
            (7, 7),
            (8, 3),
            (33, 15),
            (40, 16),
            (65, 29),
            (100, 1),
        ] {
            let [down, up] = by_definition(rows, columns);
            for results in [
                Arch::new().dispatch(Sweeps(rows, columns)),
                Scalar.vectorize(Sweeps(rows, columns)),
            ] {
                for (result, reference) in results.iter().zip([&down, &up, &down]) {
                    let error = result
                        .iter()
                        .zip(reference)
                        .map(|(a, b)| (a - b).abs())
                        .fold(0.0, f64::max);
                    assert!(error < 1e-13, "{rows} x {columns}: {error}");
                }
            }
        }
    }
}
