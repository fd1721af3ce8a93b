//! A history kept for a figure, in bounded memory.

use carom_pages::plot::thin;
use serde::{Deserialize, Serialize};

/// Most samples that a trace holds, if nothing else is said: 1 MB.
const LIMIT: usize = 1 << 16;

/// Samples of a quantity over time. When it is full it is thinned to the first, lowest, highest and last sample of equal parts of the
/// time so far, an eighth of its limit in number: no extreme is lost, and a figure, a few thousand dots wide, does not
/// change.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Trace {
    points: Vec<(f64, f64)>,
    limit: usize,
}

impl Default for Trace {
    fn default() -> Trace {
        Trace::of(LIMIT)
    }
}

impl Trace {
    /// With room for this many samples, eight at least.
    pub fn of(limit: usize) -> Trace {
        Trace {
            points: Vec::new(),
            limit: limit.max(8),
        }
    }

    /// Adds a sample, not before the last one. What is not finite cannot be drawn and is left out.
    pub fn push(&mut self, time: f64, value: f64) {
        if self.points.len() >= self.limit {
            self.points = thin(&self.points, self.limit / 8);
        }
        if value.is_finite() {
            self.points.push((time, value));
        }
    }

    /// Whether another one, of a checkpoint, may take its place.
    pub fn takes(&self, kept: &Trace) -> bool {
        let mut pairs = kept.points.windows(2);
        kept.limit == self.limit && pairs.all(|pair| pair[0].0 <= pair[1].0)
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The samples.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Abscissae and ordinates.
    pub fn columns(&self) -> (Vec<f64>, Vec<f64>) {
        self.points.iter().copied().unzip()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_history_stays_bounded_and_keeps_its_extremes_and_ends() {
        let mut trace = Trace::default();
        let value = |k: u32| match k {
            123_456 => 1e6,
            400_000 => -1e6,
            _ => f64::from(k % 1009),
        };
        for k in 0..1_000_000 {
            trace.push(f64::from(k), value(k));
            assert!(trace.points.len() <= LIMIT);
        }
        for k in [0, 123_456, 400_000, 999_999] {
            assert!(trace.points.contains(&(f64::from(k), value(k))), "{k}");
        }
        assert!(trace.points.is_sorted_by(|a, b| a.0 < b.0));
    }
}
