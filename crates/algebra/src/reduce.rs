//! Sums in a fixed order.
//!
//! A sum is cut into blocks of [`BLOCK`] terms, each block is summed in eight lanes, and the block sums are added pairwise.
//! The order of the additions depends on the number of terms alone, so the bits of the result are the same for any number of
//! threads and on any processor. Error bound: about (log2(n / 1024) + 130) rounding units of Σ|terms| (Higham, Accuracy and
//! Stability of Numerical Algorithms, 2002, section 4.2).

/// Terms of one block.
pub const BLOCK: usize = 1024;

/// Terms from which on halves are summed by threads.
const SHARED: usize = 64 * BLOCK;

/// Lanes of one block: two additions never wait for each other within a lane's latency.
const LANES: usize = 8;

/// Dot product Σ x_i y_i.
///
/// Panics in debug builds if the lengths differ.
pub fn dot(x: &[f64], y: &[f64]) -> f64 {
    debug_assert_eq!(x.len(), y.len());
    pairwise(0, x.len(), &|begin, end| {
        block(&x[begin..end], &y[begin..end], |a, b| a * b)
    })
}

/// Squared Euclidean norm Σ x_i².
pub fn norm_squared(x: &[f64]) -> f64 {
    dot(x, x)
}

/// Sum Σ x_i.
pub fn sum(x: &[f64]) -> f64 {
    pairwise(0, x.len(), &|begin, end| {
        block(&x[begin..end], &x[begin..end], |a, _| a)
    })
}

/// Sums the blocks of `begin..end` by halves; a half is a whole number of blocks.
fn pairwise(begin: usize, end: usize, leaf: &(impl Fn(usize, usize) -> f64 + Sync)) -> f64 {
    let length = end - begin;
    if length <= BLOCK {
        return leaf(begin, end);
    }
    let middle = begin + length.div_ceil(BLOCK).div_ceil(2) * BLOCK;
    let halves = [(begin, middle), (middle, end)];
    let half = |k: usize| pairwise(halves[k].0, halves[k].1, leaf);
    let [one, other] = match length < SHARED {
        true => [0, 1].map(half),
        false => rayon::join(|| half(0), || half(1)).into(),
    };
    one + other
}

/// Sum of `term(x_i, y_i)` over one block, in lanes that are added in order.
#[inline(always)]
fn block(x: &[f64], y: &[f64], term: impl Fn(f64, f64) -> f64) -> f64 {
    let mut lanes = [0.0; LANES];
    let (xs, x_tail) = x.as_chunks::<LANES>();
    let (ys, y_tail) = y.as_chunks::<LANES>();
    for (a, b) in xs.iter().zip(ys) {
        for k in 0..LANES {
            lanes[k] += term(a[k], b[k]);
        }
    }
    for (k, (a, b)) in x_tail.iter().zip(y_tail).enumerate() {
        lanes[k] += term(*a, *b);
    }
    lanes.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_of_integers_are_exact_whatever_the_length() {
        for n in [0, 1, 7, 8, 9, 1023, 1024, 1025, 5000, 123_457] {
            let x: Vec<f64> = (0..n).map(|i| i as f64).collect();
            let ones = vec![1.0; n];
            let exact = (n as f64) * (n as f64 - 1.0) / 2.0;
            assert_eq!(sum(&x), if n == 0 { 0.0 } else { exact });
            assert_eq!(dot(&x, &ones), sum(&x));
            assert_eq!(norm_squared(&ones), n as f64);
        }
    }

    #[test]
    fn a_long_sum_of_equal_terms_keeps_its_digits() {
        let x = vec![0.1; 1_000_000];
        assert!((sum(&x) - 1e5).abs() < 1e-9);
    }
}
