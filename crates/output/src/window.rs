//! The peak of a mean over a window of time.
//!
//! Where the exact force jumps, the largest force of a single step does not converge with the mesh; the largest mean
//! over a fixed time does. Both are given, side by side.

/// Largest mean of a step-wise constant quantity over `window` seconds:
/// max over t of (1/w) ∫ from t to t + w.
///
/// `values[k]` holds from `times[k]` to `times[k + 1]` (s): one instant more than values, never decreasing. Exact: as a
/// function of t the mean is piecewise linear, so its largest value is found where an end of the window meets an
/// instant. A window longer than the record is cut to the record. `None` if there is no value, or the record has no
/// length, or the window is not positive.
pub fn peak_of_mean(times: &[f64], values: &[f64], window: f64) -> Option<f64> {
    let (first, last) = (*times.first()?, *times.last()?);
    let shortened = window.min(last - first);
    // `min` drops NaN.
    let possible = !window.is_nan() && shortened > 0.0;
    if !possible || values.is_empty() || values.len() + 1 != times.len() {
        return None;
    }
    let window = shortened;
    let mut integral = vec![0.0; times.len()];
    for k in 0..values.len() {
        integral[k + 1] = integral[k] + values[k] * (times[k + 1] - times[k]);
    }
    let up_to = |t: f64| {
        let k = times
            .partition_point(|time| *time <= t)
            .clamp(1, values.len())
            - 1;
        integral[k] + values[k] * (t - times[k])
    };
    let starts = times
        .iter()
        .copied()
        .chain(times.iter().map(|t| t - window));
    let inside = starts.filter(|start| *start >= first && start + window <= last);
    // The window that ends with the record may be lost to rounding in the filter.
    let means = inside.chain([first, last - window]);
    means
        .map(|start| (up_to(start + window) - up_to(start)) / window)
        .reduce(f64::max)
}
