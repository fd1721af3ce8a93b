//! The largest eigenvalue of an element, which bounds the stable step of an explicit scheme.

use carom_elements::MAX_NODES;
use pulp::{Arch, Simd, WithSimd};

/// Writes M^-1/2 K M^-1/2 with the lumped mass `m` of the nodes (kg) into `out`, row-major (1/s²); 0 where K is 0, even without mass.
pub(crate) fn scale(dim: usize, k: &[f64], m: &[f64], out: &mut Vec<f64>) {
    let n = dim * m.len();
    let mut root = [0.0; MAX_NODES];
    for (root, m) in root.iter_mut().zip(m) {
        *root = m.sqrt();
    }
    out.clear();
    out.extend((0..n * n).map(|entry| match k[entry] {
        0.0 => 0.0,
        k => k / (root[entry / n / dim] * root[entry % n / dim]),
    }));
}

/// Upper bound, within a thousandth, of the largest eigenvalue of a symmetric positive semi-definite matrix
/// (row-major, overwritten): tr(B^p)^(1/p) with p = 4096 by repeated squaring, never below the eigenvalue and at most
/// n^(1/p) times it. Infinite if a diagonal entry is.
pub(crate) fn largest_eigenvalue(b: &mut Vec<f64>) -> f64 {
    largest_eigenvalue_in(b, &mut Vec::new())
}

/// [`largest_eigenvalue`] with memory for a square, whatever it holds.
fn largest_eigenvalue_in(b: &mut Vec<f64>, square: &mut Vec<f64>) -> f64 {
    const SQUARINGS: u32 = 12;
    let n = b.len().isqrt();
    let trace = |b: &[f64]| (0..n).map(|i| b[i * n + i]).sum::<f64>();
    // log of the factor taken out so far, as a power of the original matrix
    let mut logarithm = 0.0;
    square.resize(n * n, 0.0);
    let mut power = 1.0;
    for _ in 0..SQUARINGS {
        let factor = trace(b);
        if factor <= 0.0 {
            return 0.0;
        }
        if factor.is_infinite() {
            return factor;
        }
        let inverse = 1.0 / factor;
        // what would become subnormal is slow to multiply and too small to matter
        for entry in b.iter_mut() {
            let scaled = *entry * inverse;
            *entry = if scaled.abs() < 1e-100 { 0.0 } else { scaled };
        }
        logarithm += factor.ln() / power;
        Arch::new().dispatch(Square { b, square });
        std::mem::swap(b, square);
        power *= 2.0;
    }
    (logarithm + trace(b).ln() / power).exp()
}

/// Upper bound, within a thousandth, of the largest magnitude of an eigenvalue of a symmetric matrix (row-major,
/// overwritten), from its square. `square`: memory, whatever it holds.
pub(crate) fn largest_magnitude(b: &mut Vec<f64>, square: &mut Vec<f64>) -> f64 {
    // entries of order one, so that no square overflows
    let size = b.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
    if size == 0.0 || !size.is_finite() {
        return size;
    }
    b.iter_mut().for_each(|b| *b /= size);
    square.resize(b.len(), 0.0);
    Arch::new().dispatch(Square { b, square });
    std::mem::swap(b, square);
    size * largest_eigenvalue_in(b, square).sqrt()
}

/// The square of a row-major matrix.
struct Square<'a> {
    b: &'a [f64],
    square: &'a mut [f64],
}

impl WithSimd for Square<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let n = self.b.len().isqrt();
        for (out, row) in self.square.chunks_exact_mut(n).zip(self.b.chunks_exact(n)) {
            let (out, tail) = S::as_mut_simd_f64s(out);
            for (place, out) in out.iter_mut().enumerate() {
                let mut sum = simd.splat_f64s(0.0);
                for (&factor, other) in row.iter().zip(self.b.chunks_exact(n)) {
                    let other = S::as_simd_f64s(other).0[place];
                    sum = simd.mul_add_e_f64s(simd.splat_f64s(factor), other, sum);
                }
                *out = sum;
            }
            let first = n - tail.len();
            for (place, out) in tail.iter_mut().enumerate() {
                let column = self.b.chunks_exact(n).map(|other| other[first + place]);
                *out = row.iter().zip(column).map(|(x, y)| x * y).sum();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalue_of_a_bar_element_is_four_c_squared_over_h_squared() {
        let mut scaled = Vec::new();
        let (ea, half_mass) = (3.0, 0.5);
        scale(1, &[ea, -ea, -ea, ea], &[half_mass; 2], &mut scaled);
        let value = largest_eigenvalue(&mut scaled);
        let exact = 2.0 * ea / half_mass;
        assert!(
            value >= exact * (1.0 - 1e-12) && value < exact * 1.001,
            "{value} {exact}"
        );
    }

    #[test]
    fn diagonal_matrix_gives_its_largest_entry() {
        let mut b = vec![0.0; 9];
        (b[0], b[4], b[8]) = (1.0, 7.0, 7.0);
        let value = largest_eigenvalue(&mut b);
        assert!((7.0 * (1.0 - 1e-12)..7.01).contains(&value), "{value}");
    }

    #[test]
    fn magnitude_is_that_of_a_negative_eigenvalue_too() {
        // eigenvalues 1 and -3
        let mut b = vec![-1.0, 2.0, 2.0, -1.0];
        let value = largest_magnitude(&mut b, &mut Vec::new());
        assert!((3.0 * (1.0 - 1e-12)..3.003).contains(&value), "{value}");
    }
}
