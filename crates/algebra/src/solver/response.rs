//! Columns of Y = L⁻¹ P Nᵀ: the responses of a factored operator to unit multipliers of sparse rows N.
//!
//! A column is zero outside the elimination-tree paths of its row, so it is kept as dense segments. Its bits depend on the factor
//! and on its own row alone, never on the rows that were computed with it.

use super::gram::Dot;
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
    pub(super) values: Vec<f64>,
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
