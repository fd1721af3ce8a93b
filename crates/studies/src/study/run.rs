//! One run of a study.

use crate::compare::Variant;

/// One run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Name, outcome and overrides.
    pub variant: Variant,
    /// Abscissa of the orders; `None` if there is none.
    pub x: Option<f64>,
    /// Mean of the exact force over the exact contact, N, where the case names an exact solution.
    pub exact_mean_force: Option<f64>,
    /// Values of the keys of all axes but the first; empty where there is one axis. Orders are taken among runs that share it.
    pub series: String,
}
