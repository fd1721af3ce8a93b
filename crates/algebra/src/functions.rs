//! Logarithm and exponential of several numbers at a time.

use crate::number::Number;

/// ln 2 in two parts; the first has zeros at its end, so that small multiples of it are exact.
const LN_2: [f64; 2] = [
    f64::from_bits(0x3fe6_2e42_fee0_0000),
    1.908_214_929_270_587_7e-10,
];
/// A number plus this one is the whole number next to it, in the last bits.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
/// Bits of sqrt(1/2).
const ROOT_HALF: i64 = 0x3fe6_a09e_667f_3bcd;

/// 1/3, 1/5, ..., 1/23: of t³, t⁵, ... in atanh t.
const ATANH: [f64; 11] = {
    let mut table = [0.0; 11];
    let mut k = 0;
    while k < table.len() {
        table[k] = 1.0 / (2 * k + 3) as f64;
        k += 1;
    }
    table
};

/// 1/2!, 1/3!, ..., 1/14!.
const EXP: [f64; 13] = {
    let mut table = [0.0; 13];
    let (mut k, mut factorial) = (0, 1.0);
    while k < table.len() {
        factorial *= (k + 2) as f64;
        table[k] = 1.0 / factorial;
        k += 1;
    }
    table
};

/// Σ c_k x^k.
#[inline(always)]
fn polynomial<T: Number>(coefficients: &[f64], x: T) -> T {
    let mut sum = x.like(0.0);
    for &c in coefficients.iter().rev() {
        sum = sum.mul_add(x, x.like(c));
    }
    sum
}

/// ln(1 + x). 1 + x = 2^n m with m between sqrt(1/2) and sqrt(2); ln m = 2 atanh((m - 1)/(m + 1)), what rounding took from
/// 1 + x in m - 1.
#[inline(always)]
pub(crate) fn ln_1p<T: Number>(x: T) -> T {
    let one = x.like(1.0);
    let sum = x + one;
    let kept = sum - one;
    let lost = (x - kept) + (one - (sum - kept));
    // n and 2^-n
    let (mut times, mut back) = (sum, sum);
    for (times, back) in times.lanes_mut().iter_mut().zip(back.lanes_mut()) {
        let exponent = (times.to_bits() as i64 - ROOT_HALF) >> 52;
        *times = f64::from_bits((ROUNDING.to_bits() as i64 + exponent) as u64) - ROUNDING;
        *back = f64::from_bits(((1023 - exponent) << 52) as u64);
    }
    let beyond = (sum * back - one) + lost * back;
    let t = beyond / (beyond + x.like(2.0));
    let square = t * t;
    let rest = polynomial(&ATANH, square) * square * t;
    let small = (rest + t).scale(2.0) + times.scale(LN_2[1]);
    times.mul_add(x.like(LN_2[0]), small)
}

/// exp(x) - 1. x = n ln 2 + r with |r| ≤ ln(2)/2; exp(x) - 1 = 2^n (exp(r) - 1) + (2^n - 1).
#[inline(always)]
pub(crate) fn exp_m1<T: Number>(x: T) -> T {
    let rounding = x.like(ROUNDING);
    let shifted = x.mul_add(x.like(std::f64::consts::LOG2_E), rounding);
    let times = shifted - rounding;
    let mut power = shifted;
    for power in power.lanes_mut() {
        let exponent = power.to_bits() as i64 - ROUNDING.to_bits() as i64;
        *power = f64::from_bits(((exponent + 1023) << 52) as u64);
    }
    let r = times.mul_add(x.like(-LN_2[0]), x);
    let r = times.mul_add(x.like(-LN_2[1]), r);
    let grown = polynomial(&EXP, r).mul_add(r * r, r);
    grown.mul_add(power, power - x.like(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::Lanes;

    /// Largest difference in units of the last place of the right value.
    fn worst(of: fn(Lanes<8>) -> Lanes<8>, right: fn(f64) -> f64, values: &[f64]) -> f64 {
        let errors = values.chunks(8).flat_map(|chunk| {
            let lanes = Lanes(std::array::from_fn(|k| chunk[k % chunk.len()]));
            let found = of(lanes).0;
            let error = |k: usize| {
                let exact = right(chunk[k % chunk.len()]);
                (found[k] - exact).abs() / (exact.abs() * f64::EPSILON).max(f64::MIN_POSITIVE)
            };
            (0..8).map(error).collect::<Vec<_>>()
        });
        errors.fold(0.0, f64::max)
    }

    /// Both sides of every power of two, and down to the smallest numbers.
    fn values(low: f64, high: f64) -> Vec<f64> {
        let even = (0..4000).map(|k| low + (high - low) * (k as f64 + 0.37) / 4000.0);
        let small = (1..60).flat_map(|k| [1.0, -1.0, 0.71].map(|x| x * 0.3 * 0.5_f64.powi(5 * k)));
        even.chain(small).chain([0.0]).collect()
    }

    /// Four roundings of results below twice the value each are four units at most.
    #[test]
    fn the_logarithm_has_its_last_digits() {
        let error = worst(ln_1p, f64::ln_1p, &values(-0.999, 9.0));
        assert!(error < 4.0, "{error}");
        let large: Vec<f64> = (0..800).map(|k| 1.5_f64.powi(k)).collect();
        let error = worst(ln_1p, f64::ln_1p, &large);
        assert!(error < 4.0, "{error}");
    }

    /// Where n is not zero, 2^n - 1 and the rest may have opposite signs: three times as much.
    #[test]
    fn the_exponential_has_its_last_digits() {
        let error = worst(exp_m1, f64::exp_m1, &values(-3.0, 3.0));
        assert!(error < 6.0, "{error}");
        let error = worst(exp_m1, f64::exp_m1, &values(-600.0, 600.0));
        assert!(error < 6.0, "{error}");
    }
}
