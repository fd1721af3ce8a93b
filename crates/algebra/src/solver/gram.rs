//! Products of responses.
//!
//! Responses of neighbours in a mesh have most of their panels in common: a response is multiplied with several others at once, and a
//! number of it that is loaded serves several products. The bits of a product depend on its two responses alone.

use super::response::{Response, multiply};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// Responses whose products with all before them are one piece of work: so many use eight columns while these are in the cache.
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
