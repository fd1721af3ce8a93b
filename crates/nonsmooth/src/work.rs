//! Impulses that do given works.

/// Most sweeps over the points; some ten are usual.
const MOST_SWEEPS: usize = 1000;

/// Writes the impulses I > 0 with `I_i (r_i + ½ (D I)_i) = w_i`. `d`: D over the points, row-major; `rates`: r of each, m/s; `works`: w
/// of each, J, positive.
///
/// They are where the strictly convex `I · r + ¼ I · D I - Σ w_i ln I_i` is least: coordinates in turn go to their own
/// least value, a root of a quadratic equation, until none changes.
pub fn impulses_of_work(d: &[f64], rates: &[f64], works: &[f64], impulses: &mut Vec<f64>) {
    let n = rates.len();
    impulses.clear();
    impulses.resize(n, 0.0);
    for _ in 0..MOST_SWEEPS {
        let mut change: f64 = 0.0;
        for i in 0..n {
            let row = &d[i * n..(i + 1) * n];
            let of_all: f64 = row.iter().zip(&*impulses).map(|(d, q)| d * q).sum();
            let t = rates[i] + 0.5 * (of_all - row[i] * impulses[i]);
            let root = (t * t + 2.0 * row[i] * works[i]).sqrt();
            let impulse = match t > 0.0 {
                true => 2.0 * works[i] / (root + t),
                false => (root - t) / row[i],
            };
            change = change.max((impulse - impulses[i]).abs() / impulse);
            impulses[i] = impulse;
        }
        if change <= 4.0 * f64::EPSILON {
            break;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::impulses_of_work;

    #[test]
    fn each_impulse_does_its_work() {
        let d = [2.0, 0.5, 0.1, 0.5, 3.0, -0.4, 0.1, -0.4, 1.0];
        let (rates, works) = ([0.3, -0.7, 0.0], [0.2, 1e-6, 3.0]);
        let mut impulses = Vec::new();
        impulses_of_work(&d, &rates, &works, &mut impulses);
        for i in 0..3 {
            let of_all: f64 = (0..3).map(|j| d[3 * i + j] * impulses[j]).sum();
            let work = impulses[i] * (rates[i] + 0.5 * of_all);
            assert!(impulses[i] > 0.0);
            assert!((work / works[i] - 1.0).abs() < 1e-9, "{i}: {work}");
        }
    }
}
