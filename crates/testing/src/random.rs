//! Numbers that are the same on every machine.

/// Numbers from a seed, by the linear congruential generator of Knuth's MMIX.
#[derive(Clone, Copy, Debug)]
pub struct Random(pub u64);

impl Random {
    /// The next number in [-1, 1).
    #[expect(
        clippy::should_implement_trait,
        reason = "it has no end, and is no iterator"
    )]
    pub fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// The next number in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.next() + 1.0)
    }

    /// The next `n` numbers in [-1, 1).
    pub fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n).map(|_| self.next()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn numbers_fill_their_interval_evenly() {
        let mut random = Random(1);
        let numbers = random.vector(10_000);
        assert!(numbers.iter().all(|x| (-1.0..1.0).contains(x)));
        // the standard deviation of the mean of uniform numbers is 1/sqrt(3 n) = 0.006
        let mean = |f: &dyn Fn(f64) -> f64| numbers.iter().map(|x| f(*x)).sum::<f64>() / 1e4;
        assert!(mean(&|x| x).abs() < 0.02);
        assert!((mean(&|x| x * x) - 1.0 / 3.0).abs() < 0.02);
        assert!((2.0..5.0).contains(&random.between(2.0, 5.0)));
    }
}
