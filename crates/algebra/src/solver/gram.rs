//! Products of responses.
//!
//! Responses of neighbours in a mesh have most of their panels in common: a response is multiplied with several others at once, and a
//! number of it that is loaded serves several products. The bits of a product depend on its two responses alone.

use super::panel;
use super::response::Response;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::ops::Range;

/// Responses whose products with all before them are one piece of work.
const PIECE: usize = 16;

/// W = Yᵀ Y, row-major, `responses.len()` squared entries; each has the bits of [`Response::dot`].
pub fn gram(responses: &[&Response]) -> Vec<f64> {
    let n = responses.len();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|&k| (responses[k].segments.first().map(|s| s.start), k));
    let sorted: Vec<&Response> = order.iter().map(|&k| responses[k]).collect();
    let pieces: Vec<Vec<f64>> = (0..n.div_ceil(PIECE))
        .into_par_iter()
        .map(|piece| {
            let end = n.min((piece + 1) * PIECE);
            Arch::new().dispatch(Rows(&sorted[..end], piece * PIECE))
        })
        .collect();
    let mut w = vec![0.0; n * n];
    for (piece, products) in pieces.iter().enumerate() {
        let end = n.min((piece + 1) * PIECE);
        for (i, row) in products.chunks_exact(end).enumerate() {
            for (j, &product) in row.iter().enumerate() {
                let (i, j) = (order[piece * PIECE + i], order[j]);
                (w[i * n + j], w[j * n + i]) = (product, product);
            }
        }
    }
    w
}

/// Products of the responses from the given one on with all of them, row after row.
struct Rows<'a>(&'a [&'a Response], usize);

impl WithSimd for Rows<'_> {
    type Output = Vec<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<f64> {
        let Rows(all, first) = self;
        let wide = all.len();
        let mut products = vec![0.0; (wide - first) * wide];
        let (eights, rest) = all.as_chunks::<8>();
        // columns outside: they stay in the second-level cache while the rows pass by
        for (k, columns) in eights.iter().enumerate() {
            for (row, to) in all[first..].iter().zip(products.chunks_exact_mut(wide)) {
                to[8 * k..][..8].copy_from_slice(&multiply(simd, row, *columns));
            }
        }
        for (row, to) in all[first..].iter().zip(products.chunks_exact_mut(wide)) {
            for (column, to) in rest.iter().zip(&mut to[8 * eights.len()..]) {
                [*to] = multiply(simd, row, [*column]);
            }
        }
        products
    }
}

/// Products of a response with some others.
#[inline(always)]
fn multiply<S: Simd, const B: usize>(simd: S, row: &Response, columns: [&Response; B]) -> [f64; B] {
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
pub(super) struct Dot<'a>(pub &'a Response, pub &'a Response);

impl WithSimd for Dot<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let [product] = multiply(simd, self.0, [self.1]);
        product
    }
}
