//! One model computed with several values of a key: how its results depend on it, and how fast they converge.
//!
//! The runs are plain data here. Where the case names an exact solution the errors are distances from it; elsewhere the
//! order comes from the differences of neighbouring runs, which needs values in a constant ratio.

mod envelope;
mod fitted;
mod forces;
mod orders;
mod page;
mod quantities;
mod run;

pub use envelope::{Envelope, Governed};
pub use fitted::{Fitted, Found, Goal};
pub use orders::{Fit, consecutive, differences, extrapolate, fit, saturation};
pub use page::RAW_PEAK;
pub use quantities::{Measure, Quantity};
pub use run::Run;

/// All runs, in the order of the table.
#[derive(Clone, Debug)]
pub struct Study {
    /// Title of the case.
    pub title: String,
    /// Keys that vary, with their values, one per run.
    pub keys: Vec<(String, Vec<String>)>,
    /// What the orders are taken against.
    pub abscissa: Abscissa,
    /// The runs.
    pub runs: Vec<Run>,
    /// What a fit looked for and found; the figure of forces shows a history that it came nearest to under that of the nearest run.
    pub fitted: Option<Fitted>,
}

/// What the orders are taken against.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Abscissa {
    /// The time step, s.
    Step,
    /// The value of the first key, that of the first axis of a grid.
    Key,
    /// Nothing: the key has no numbers.
    Nothing,
}

/// What is known of the convergence of one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The quantity.
    pub quantity: Quantity,
    /// [`Run::series`] of its runs.
    pub series: String,
    /// From what the order is taken.
    pub source: Source,
    /// Abscissae and errors (or differences), by rising abscissa.
    pub points: Vec<(f64, f64)>,
    /// Least squares over all points.
    pub fit: Option<Fit>,
    /// Orders between neighbours.
    pub consecutive: Vec<Option<f64>>,
    /// Limit of the values of the finest three runs, SI; `None` of errors, whose limit is zero.
    pub extrapolated: Option<f64>,
    /// Abscissa from which the error does not fall any more towards finer runs.
    pub saturation: Option<f64>,
}

/// From what an order is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Distances from the exact solution.
    Exact,
    /// Differences between neighbouring runs.
    Differences,
}

impl Study {
    /// Orders of all quantities that have some: at least two points. The raw peak has none where the exact force jumps,
    /// and is never given one.
    pub fn orders(&self) -> Vec<Order> {
        let quantities = Quantity::ALL.into_iter();
        let converging = quantities.filter(|quantity| *quantity != Quantity::PeakForce);
        let series = self.series();
        converging
            .flat_map(|quantity| series.iter().map(move |series| (quantity, *series)))
            .filter_map(|(quantity, series)| self.order(quantity, series))
            .collect()
    }

    /// Name of the contact that is looked at; `None` where no run was computed, or the case has none.
    pub fn contact(&self) -> Option<&str> {
        let mut done = self.runs.iter().filter_map(|run| run.variant.done());
        done.find_map(|done| done.history.contact.as_deref())
    }

    /// The series, each once, in the order of their first runs.
    fn series(&self) -> Vec<&str> {
        let mut all: Vec<&str> = Vec::new();
        for run in &self.runs {
            if !all.contains(&run.series.as_str()) {
                all.push(&run.series);
            }
        }
        all
    }

    fn order(&self, quantity: Quantity, series: &str) -> Option<Order> {
        let measured = self
            .runs
            .iter()
            .filter(|run| run.series == series)
            .filter_map(|run| Some((run.x?, quantity.of(run)?)));
        let mut measured: Vec<(f64, Measure)> = measured.collect();
        measured.sort_by(|a, b| a.0.total_cmp(&b.0));
        let x: Vec<f64> = measured.iter().map(|(x, _)| *x).collect();
        let values: Vec<f64> = measured.iter().map(|(_, m)| m.value).collect();
        let extrapolated = (!quantity.is_error()).then(|| extrapolate(&x, &values));
        let exact: Option<Vec<f64>> = measured.iter().map(|(_, m)| m.error()).collect();
        let (source, x, errors) = match exact {
            Some(errors) => (Source::Exact, x, errors),
            None => {
                let (x, errors) = differences(&x, &values)?;
                (Source::Differences, x, errors)
            }
        };
        let (fit, consecutive) = (fit(&x, &errors), consecutive(&x, &errors));
        (x.len() > 1).then(|| Order {
            quantity,
            series: series.to_owned(),
            source,
            extrapolated: extrapolated.flatten(),
            saturation: fit.and_then(|fit| saturation(&x, fit.order, &consecutive)),
            fit,
            consecutive,
            points: x.into_iter().zip(errors).collect(),
        })
    }
}
