//! Iterations of a run: how many a step takes, and whether they converge quadratically.

use carom_dynamics::Driver;

use crate::check::Row;

/// Residuals, relative, from which an iteration tells whether it is quadratic: farther out higher terms matter.
const FROM: [f64; 2] = [1e-6, 0.1];

/// Residuals to which it does: below, rounding is seen.
const TO: f64 = 1e-12;

/// A tolerance that no iteration reaches: each iteration takes a new tangent.
pub(crate) const OUT_OF_REACH: f64 = 1e-15;

/// What the iterations of a run were.
#[derive(Default)]
pub(crate) struct Iterations {
    steps: usize,
    count: usize,
    most: usize,
    /// r₊ / r² of the iterations that tell it.
    quadratic: Vec<f64>,
}

impl Iterations {
    /// Counts those of the step that was taken last.
    pub(crate) fn follow(&mut self, newton: &Driver) {
        let residuals = newton.residuals();
        self.steps += 1;
        self.count += residuals.len();
        self.most = self.most.max(residuals.len());
        let tells = |two: &&[f64]| two[0] > FROM[0] && two[0] < FROM[1] && two[1] > TO;
        let pairs = residuals.windows(2).filter(tells);
        self.quadratic.extend(pairs.map(|r| r[1] / r[0].powi(2)));
    }

    /// Iterations a step, the evaluation that ends it counted.
    pub(crate) fn mean(&self) -> f64 {
        self.count as f64 / self.steps as f64
    }

    /// Iterations a step, at most those that are allowed, and the most.
    pub(crate) fn rows(&self, name: &str, allowed: f64) -> Vec<Row> {
        let row = |what: &str| format!("{name}: {what}");
        vec![
            Row::at_most(row("iterations a step"), self.mean(), allowed),
            Row::shown(row("most iterations of a step"), self.most as f64),
        ]
    }

    /// c of r₊ = c r², the median. Forces that balance and momenta are the scale of r, so that Newton's method with the whole derivative has a c of
    /// about one; at a rate of 0.05, as with the symmetric part, c is 5 where r is 0.01 and 5000 where it is 1e-5.
    pub(crate) fn quadratic(&self, name: &str) -> Row {
        let mut all = self.quadratic.clone();
        all.sort_by(f64::total_cmp);
        let median = all.get(all.len() / 2).copied();
        let what = format!("{name}: next residual over the square of the last");
        Row::at_most(what, median.unwrap_or(f64::INFINITY), 3.0)
    }
}
