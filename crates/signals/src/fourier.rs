//! Fourier sums of equal steps.

use std::f64::consts::TAU;

/// Real part of Σ_k c_k e^(2πi k n/N) for n = 0..N, by the fast Fourier transform of Cooley and Tukey (1965).
///
/// `coefficients`: (real, imaginary) parts; N is their number, a power of two.
pub(crate) fn real_sums(coefficients: &[[f64; 2]]) -> Vec<f64> {
    let count = coefficients.len();
    debug_assert!(count.is_power_of_two());
    let bits = count.trailing_zeros();
    let reversed = |n: usize| match bits {
        0 => n,
        _ => n.reverse_bits() >> (usize::BITS - bits),
    };
    let mut values: Vec<[f64; 2]> = (0..count).map(|n| coefficients[reversed(n)]).collect();
    let mut half = 1;
    while half < count {
        let turn = TAU / (2 * half) as f64;
        for k in 0..half {
            let (sin, cos) = (turn * k as f64).sin_cos();
            for one in (k..count).step_by(2 * half) {
                let ([a, b], [c, d]) = (values[one], values[one + half]);
                let [x, y] = [c * cos - d * sin, c * sin + d * cos];
                values[one] = [a + x, b + y];
                values[one + half] = [a - x, b - y];
            }
        }
        half *= 2;
    }
    values.iter().map(|[real, _]| *real).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn sums_are_those_of_the_formula() {
        for count in [1, 2, 8, 64] {
            let mut random = Random::new(3);
            let c: Vec<[f64; 2]> = (0..count)
                .map(|_| [random.uniform(), random.uniform()])
                .collect();
            for (n, found) in real_sums(&c).into_iter().enumerate() {
                let term = |(k, [a, b]): (usize, &[f64; 2])| {
                    let (sin, cos) = (TAU * (k * n) as f64 / count as f64).sin_cos();
                    a * cos - b * sin
                };
                let exact: f64 = c.iter().enumerate().map(term).sum();
                assert!((found - exact).abs() < 1e-12, "{count}: {found} {exact}");
            }
        }
    }
}
