//! Iterations of a run: how many a step takes, and the order at which they converge.

use carom_dynamics::Driver;

use crate::check::Row;

/// Residuals between which three in a row tell an order, relative: farther out higher terms matter, below the last rounding does,
/// and from the first one less than the second of these a kept factor is enough.
const FIRST: [f64; 2] = [1e-3, 0.1];
const LAST: f64 = 1e-12;

/// What the iterations of a run were.
#[derive(Default)]
pub(crate) struct Iterations {
    steps: usize,
    count: usize,
    most: usize,
    /// The largest order of each step that has one.
    orders: Vec<f64>,
}

impl Iterations {
    /// Counts those of the step that was taken last.
    pub(crate) fn follow(&mut self, newton: &Driver) {
        let residuals = newton.residuals();
        self.steps += 1;
        self.count += residuals.len();
        self.most = self.most.max(residuals.len());
        let tells = |three: &&[f64]| {
            let falls = three[1] < three[0] && three[2] < three[1];
            falls && three[0] > FIRST[0] && three[0] < FIRST[1] && three[2] > LAST
        };
        let orders = residuals.windows(3).filter(tells);
        let orders = orders.map(|r| (r[2] / r[1]).ln() / (r[1] / r[0]).ln());
        self.orders.extend(orders.max_by(f64::total_cmp));
    }

    /// Iterations a step, the evaluation that ends it counted.
    pub(crate) fn mean(&self) -> f64 {
        self.count as f64 / self.steps as f64
    }

    /// Iterations a step, at most those that are allowed; and the order p of r₊ = c r^p, the median over the steps that tell one, which
    /// Newton's method with the whole derivative has as 2: 1.8 is asked for, as the c of three residuals is not the same.
    pub(crate) fn rows(&self, name: &str, allowed: f64) -> Vec<Row> {
        let row = |what: &str| format!("{name}: {what}");
        let mut rows = vec![
            Row::at_most(row("iterations a step"), self.mean(), allowed),
            Row::shown(row("most iterations of a step"), self.most as f64),
        ];
        let mut orders = self.orders.clone();
        orders.sort_by(f64::total_cmp);
        if let Some(order) = orders.get(orders.len() / 2) {
            rows.push(Row::at_least(row("order of the iterations"), *order, 1.8));
        }
        rows
    }
}
