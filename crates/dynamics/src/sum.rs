//! Sums over many steps.

use serde::{Deserialize, Serialize};

/// Sum with compensation of the rounding (Neumaier).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Sum {
    value: f64,
    lost: f64,
}

impl Sum {
    pub(crate) fn add(&mut self, term: f64) {
        let sum = self.value + term;
        self.lost += if self.value.abs() >= term.abs() {
            (self.value - sum) + term
        } else {
            (term - sum) + self.value
        };
        self.value = sum;
    }

    pub(crate) fn get(&self) -> f64 {
        self.value + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::Sum;

    #[test]
    fn compensated_sum_keeps_what_rounding_drops() {
        let mut sum = Sum::default();
        sum.add(1e16);
        (0..1000).for_each(|_| sum.add(0.1));
        sum.add(-1e16);
        assert!((sum.get() - 100.0).abs() < 1e-9);
    }
}
