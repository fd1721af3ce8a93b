//! Columns of Y = L⁻¹ P Nᵀ: the responses of a factored operator to unit multipliers of sparse rows N.
//!
//! A column is zero outside the elimination-tree paths of its row, so it is kept as dense segments. Its bits depend on the factor
//! and on its own row alone, never on the rows that were computed with it.

use super::panel;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

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
    /// Positions outside which the column is zero: ascending, disjoint, those of each panel of the factor apart. What two columns have in
    /// common are whole segments of both.
    pub(super) segments: Vec<Range<usize>>,
    /// Values, segment after segment.
    values: Vec<f64>,
}

impl Response {
    /// Column with values at the positions of `ranges`: ascending, disjoint.
    pub(super) fn collect(
        ranges: impl Iterator<Item = Range<usize>>,
        value: impl Fn(usize) -> f64,
    ) -> Self {
        let segments: Vec<Range<usize>> = ranges.collect();
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

/// Products of a response with some others.
#[inline(always)]
pub(super) fn multiply<S: Simd, const B: usize>(
    simd: S,
    row: &Response,
    columns: [&Response; B],
) -> [f64; B] {
    let (mut x, mut y) = (Cursor::new(row), columns.map(Cursor::new));
    let mut sums = [simd.splat_f64s(0.0); B];
    while let Some((start, values)) = x.take() {
        let found: [Option<&[f64]>; B] = y.each_mut().map(|cursor| cursor.take_at(start));
        if found.iter().all(Option::is_some) {
            let found = found.map(Option::unwrap_or_default);
            panel::add_dots(simd, values, found, &mut sums);
            continue;
        }
        for (found, sum) in found.into_iter().zip(&mut sums) {
            if let Some(found) = found {
                let mut one = [*sum];
                panel::add_dots(simd, values, [found], &mut one);
                *sum = one[0];
            }
        }
    }
    sums.map(|sum| simd.reduce_sum_f64s(sum))
}

/// A place in a response: before one of its segments.
struct Cursor<'a> {
    segments: &'a [Range<usize>],
    values: &'a [f64],
}

impl<'a> Cursor<'a> {
    fn new(response: &'a Response) -> Cursor<'a> {
        Cursor {
            segments: &response.segments,
            values: &response.values,
        }
    }

    /// First position and values of the segment, behind which it is then.
    #[inline(always)]
    fn take(&mut self) -> Option<(usize, &'a [f64])> {
        let (segment, rest) = self.segments.split_first()?;
        self.segments = rest;
        let (values, rest) = self.values.split_at(segment.len());
        self.values = rest;
        Some((segment.start, values))
    }

    /// Goes to the segment that starts at a position, and behind it, with its values; if there is none, to the first beyond.
    #[inline(always)]
    fn take_at(&mut self, start: usize) -> Option<&'a [f64]> {
        while self.segments.first()?.start < start {
            self.take();
        }
        let is_there = self.segments.first()?.start == start;
        let (_, values) = is_there.then(|| self.take())??;
        Some(values)
    }
}

/// Product of two responses.
struct Dot<'a>(&'a Response, &'a Response);

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let [product] = multiply(simd, self.0, [self.1]);
        product
    }
}

struct DotDense<'a>(&'a Response, &'a [f64]);

impl WithSimd for DotDense<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let mut sums = [simd.splat_f64s(0.0)];
        for (range, values) in self.0.pieces() {
            panel::add_dots(simd, values, [&self.1[range]], &mut sums);
        }
        simd.reduce_sum_f64s(sums[0])
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
