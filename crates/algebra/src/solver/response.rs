//! Columns of Y = L⁻¹ P Nᵀ: the responses of a factored operator to unit multipliers of sparse rows N.
//!
//! A column is zero outside the elimination-tree paths of its row, so it is kept as dense segments. Its bits depend on the factor
//! and on its own row alone, never on the rows that were computed with it.

use super::panel;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Responses of one tile of [`gram`]: two tiles of long columns fit in a second-level cache.
const TILE: usize = 6;

/// One row of a matrix N: coefficients of some unknowns, zero for the others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SparseRow {
    /// Unknowns, in any order; the coefficients of a repeated one are added.
    pub dofs: Vec<u32>,
    /// Coefficient of each entry of `dofs`.
    pub coefficients: Vec<f64>,
}

/// One column of Y = L⁻¹ P Nᵀ, in the factor's own order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    /// Positions outside which the column is zero: ascending, disjoint, never touching.
    segments: Vec<Range<usize>>,
    /// Values, segment after segment.
    values: Vec<f64>,
}

impl Response {
    /// Column with values at the positions of `ranges` (ascending, disjoint; touching ones are joined).
    pub(super) fn collect(
        ranges: impl Iterator<Item = Range<usize>>,
        value: impl Fn(usize) -> f64,
    ) -> Self {
        let mut segments: Vec<Range<usize>> = vec![];
        for range in ranges {
            match segments.last_mut() {
                Some(last) if last.end == range.start => last.end = range.end,
                _ => segments.push(range),
            }
        }
        let mut values = Vec::with_capacity(segments.iter().map(Range::len).sum());
        values.extend(segments.iter().cloned().flatten().map(value));
        Self { segments, values }
    }

    /// Entry of W = Yᵀ Y = N A⁻¹ Nᵀ of two rows of the same operator. Symmetric in its arguments to the last bit.
    pub fn dot(&self, other: &Response) -> f64 {
        Arch::new().dispatch(Dot(self, other))
    }

    /// Yᵀ y with a dense `y` = L⁻¹ P r from `Cholesky::forward`: N A⁻¹ r.
    pub fn dot_dense(&self, y: &[f64]) -> f64 {
        Arch::new().dispatch(DotDense(self, y))
    }

    /// y += alpha Y: before `Cholesky::backward`, adds A⁻¹ Nᵀ alpha to the solution.
    pub fn add_scaled(&self, alpha: f64, y: &mut [f64]) {
        Arch::new().dispatch(AddScaled(self, alpha, y));
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of::<Self>() + size_of_val(&*self.segments) + size_of_val(&*self.values)
    }

    /// Segments with their values.
    fn pieces(&self) -> impl Iterator<Item = (Range<usize>, &[f64])> {
        self.segments.iter().scan(0, |offset, range| {
            let begin = *offset;
            *offset += range.len();
            Some((range.clone(), &self.values[begin..*offset]))
        })
    }
}

/// W = Yᵀ Y, row-major, `responses.len()` squared entries; each has the bits of [`Response::dot`].
pub fn gram(responses: &[&Response]) -> Vec<f64> {
    let n = responses.len();
    let mut w = vec![0.0; n * n];
    w.par_chunks_mut((TILE * n).max(1))
        .enumerate()
        .for_each(|(tile, w)| {
            let begin = tile * TILE;
            let rows = w.len() / n;
            for first in (0..begin + rows).step_by(TILE) {
                for i in 0..rows {
                    for j in first..(first + TILE).min(begin + i + 1) {
                        w[i * n + j] = responses[begin + i].dot(responses[j]);
                    }
                }
            }
        });
    for i in 0..n {
        for j in 0..i {
            w[j * n + i] = w[i * n + j];
        }
    }
    w
}

struct Dot<'a>(&'a Response, &'a Response);

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let (mut xs, mut ys) = (self.0.pieces(), self.1.pieces());
        let (mut x, mut y) = (xs.next(), ys.next());
        let mut sum = 0.0;
        while let (Some((p, a)), Some((q, b))) = (&x, &y) {
            let (begin, end) = (p.start.max(q.start), p.end.min(q.end));
            if begin < end {
                sum += panel::dot(
                    simd,
                    &a[begin - p.start..end - p.start],
                    &b[begin - q.start..end - q.start],
                );
            }
            // Both advance where both end: no entry is left in either.
            let (p_end, q_end) = (p.end, q.end);
            if p_end <= q_end {
                x = xs.next();
            }
            if q_end <= p_end {
                y = ys.next();
            }
        }
        sum
    }
}

struct DotDense<'a>(&'a Response, &'a [f64]);

impl WithSimd for DotDense<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let mut sum = 0.0;
        for (range, values) in self.0.pieces() {
            sum += panel::dot(simd, values, &self.1[range]);
        }
        sum
    }
}

struct AddScaled<'a>(&'a Response, f64, &'a mut [f64]);

impl WithSimd for AddScaled<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (range, values) in self.0.pieces() {
            panel::add_scaled::<S>(self.1, values, &mut self.2[range]);
        }
    }
}
