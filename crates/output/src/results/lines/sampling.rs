//! Whether the steps see the loads and motions that the case gives as functions of time.

use carom_dynamics::Amplitude;
use carom_pages::form::Form;

use crate::results::lines::{Evidence, Finding, worst};
use crate::verdict::{Bounds, Line};

/// Bounds of what straight lines between the steps leave of a function of time, ∫ |a - a_h| dt over ∫ |a| dt. A sine of n steps a period
/// loses (π/n)²/3 of it: a tenth at six steps. At a half the function that the run sees is another one.
const BOUNDS: Bounds = Bounds::Both(0.1, 0.5);

/// The function of time that the steps see worst.
pub(super) fn of_functions(evidence: &Evidence) -> Finding {
    let system = evidence.system;
    let given = &system.nonlinear;
    let (dt, end) = (system.dt, evidence.last.time);
    if evidence.last.ledger.is_static || dt <= 0.0 {
        return Finding::Absent;
    }
    let missed = |amplitude: &Amplitude| missed(amplitude, dt, end);
    let loads = given.loads.iter().map(|load| {
        let name = load.named.and_then(|place| given.load_names.get(place));
        let name = name.map_or("the motion of the base", |name| name.as_str());
        (name, missed(&load.amplitude))
    });
    let supports = given.amplitudes.iter();
    let supports = supports.map(|amplitude| ("the motion of a support", missed(amplitude)));
    let Some((name, value)) = worst(loads.chain(supports)) else {
        return Finding::Absent;
    };
    let bounds = match (
        system.adaptive.is_some() || system.critical_fraction.is_some(),
        BOUNDS,
    ) {
        // its steps may be smaller than the largest
        (true, Bounds::Both(look, _)) => Bounds::Look(look),
        (_, bounds) => bounds,
    };
    Finding::Line(Line::new(
        "sampling",
        (
            &format!("part of a function of time that lies between the steps, of `{name}`"),
            value,
            Form::Percent,
        ),
        bounds,
        "use a step that is a tenth of the shortest pulse or period at most",
    ))
}

/// ∫ |a - a_h| dt over ∫ |a| dt from 0 to `end` (s), with a_h straight between steps of `dt` (s); 0 of a function that vanishes.
fn missed(amplitude: &Amplitude, dt: f64, end: f64) -> f64 {
    let knots: Vec<f64> = amplitude
        .knots()
        .filter(|time| (0.0..end).contains(time))
        .collect();
    let at = |time: f64| amplitude.at(time);
    let mut whole = 0.0;
    let mut before = 0.0;
    for &time in knots.iter().chain([&end]) {
        whole += 0.5 * (time - before) * (at(before).abs() + at(time).abs());
        before = time;
    }
    let (mut missed, mut k) = (0.0, 0);
    while k < knots.len() {
        let step = (knots[k] / dt).floor();
        let [from, to] = [step * dt, ((step + 1.0) * dt).min(end)];
        let inside = knots[k..].partition_point(|time| *time < to).max(1);
        let [first, last] = [at(from), at(to)];
        let off = |time: f64| {
            let part = if to > from {
                (time - from) / (to - from)
            } else {
                0.0
            };
            (at(time) - first - part * (last - first)).abs()
        };
        let mut before = from;
        for &time in knots[k..k + inside].iter().chain([&to]) {
            missed += 0.5 * (time - before) * (off(before) + off(time));
            before = time;
        }
        k += inside;
    }
    if missed == 0.0 { 0.0 } else { missed / whole }
}

#[cfg(test)]
mod tests {
    use carom_dynamics::Amplitude;

    use super::missed;

    fn of(points: Vec<[f64; 2]>) -> Amplitude {
        Amplitude::new(points).unwrap()
    }

    /// Points of a sine of this period, fifty to a period.
    fn sine(period: f64, end: f64) -> Amplitude {
        let count = (50.0 * end / period) as usize;
        let point = |k: usize| {
            let time = k as f64 * period / 50.0;
            [time, (std::f64::consts::TAU * time / period).sin()]
        };
        of((0..=count).map(point).collect())
    }

    #[test]
    fn what_is_straight_between_the_steps_is_seen_whole() {
        let ramp = of(vec![[0.0, 0.0], [0.5, 1.0], [1.0, 0.0]]);
        assert!(missed(&ramp, 0.1, 2.0) < 1e-12);
        assert_eq!(missed(&Amplitude::constant(3.0), 0.1, 2.0), 0.0);
    }

    #[test]
    fn a_pulse_between_two_steps_is_missed_whole() {
        let pulse = of(vec![[0.3e-3, 0.0], [0.4e-3, 1.0], [0.5e-3, 0.0]]);
        assert!((missed(&pulse, 1e-3, 0.1) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_sine_of_n_steps_a_period_loses_a_third_of_the_square_of_pi_over_n() {
        // trapezoid: mean |a| = 2/π, mean error of the chord h²/12 |a''| = (2π/n)²/12 |a|
        for n in [10.0, 20.0] {
            let expected = (std::f64::consts::PI / n).powi(2) / 3.0;
            let found = missed(&sine(1.0, 10.0), 1.0 / n, 10.0);
            assert!((found / expected - 1.0).abs() < 0.1, "{found} {expected}");
        }
    }

    #[test]
    fn a_record_sampled_once_a_period_is_another_one() {
        assert!(missed(&sine(0.0102, 1.0), 0.01, 1.0) > 0.5);
    }
}
