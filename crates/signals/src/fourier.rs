//! Fourier sums of equal steps.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Real part of Σ_k c_k e^(2πi k n/N) for n = 0..N, with the number N of the coefficients (real, imaginary), any number. The plan is one for
/// scalars, so that the sums do not depend on the processor.
pub(crate) fn real_sums(coefficients: &[[f64; 2]]) -> Vec<f64> {
    let complex = |&[re, im]: &[f64; 2]| Complex { re, im };
    let mut values: Vec<Complex<f64>> = coefficients.iter().map(complex).collect();
    if !values.is_empty() {
        let plan = FftPlanner::new().plan_fft_inverse(values.len());
        plan.process(&mut values);
    }
    values.iter().map(|value| value.re).collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::random::Random;

    #[test]
    fn sums_are_those_of_the_formula() {
        for count in [0, 1, 2, 7, 64, 90] {
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
