//! The peak of a windowed mean against brute force and closed cases.

use carom_output::window::PeakOfMean;

/// A fixed pseudo-random sequence in (0, 1).
fn random(count: usize) -> Vec<f64> {
    let step = |seed: &mut u64| {
        *seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        Some((*seed >> 11) as f64 / (1_u64 << 53) as f64)
    };
    std::iter::repeat_n((), count)
        .scan(7_u64, |seed, ()| step(seed))
        .collect()
}

fn peak(values: &[f64], steps: usize) -> f64 {
    let mut mean = PeakOfMean::new(steps as f64 * 0.1);
    values.iter().for_each(|value| mean.push(0.1, *value));
    mean.peak()
}

#[test]
fn a_constant_is_its_own_mean_once_the_window_is_full() {
    assert!((peak(&[3.0; 5], 5) - 3.0).abs() < 1e-14);
    assert!((peak(&[3.0; 4], 5) - 3.0 * 4.0 / 5.0).abs() < 1e-15);
    assert!((peak(&[1.0, 7.0, 2.0], 1) - 7.0).abs() < 1e-14);
    assert_eq!(peak(&[], 3), 0.0);
}

#[test]
fn a_spike_counts_with_its_impulse() {
    let mut values = vec![1.0; 100];
    values[60] = 100.0;
    assert!((peak(&values, 10) - 10.9).abs() < 1e-12);
}

#[test]
fn the_peak_is_that_of_brute_force_and_does_not_drift() {
    let values = random(100_000);
    for steps in [3, 40, 997] {
        let sums = values.windows(steps).map(|w| w.iter().sum::<f64>());
        let largest = sums.fold(0.0, f64::max) / steps as f64;
        assert!((peak(&values, steps) - largest).abs() < 1e-13 * largest);
    }
}

#[test]
fn peaks_are_taken_one_after_the_other() {
    let mut mean = PeakOfMean::new(2.0);
    [4.0, 6.0, 0.0]
        .iter()
        .for_each(|value| mean.push(1.0, *value));
    assert_eq!(mean.take(), 5.0);
    [0.0, 2.0].iter().for_each(|value| mean.push(1.0, *value));
    assert_eq!((mean.take(), mean.peak()), (1.0, 5.0));
}

#[test]
fn unequal_steps_count_with_their_length() {
    // the same function of time in equal steps of 1/8 and in steps of 1/8 to 1
    let values = [1.0, 1.0, 4.0, 4.0, 4.0, 4.0, 2.0, 7.0];
    let joined = [(0.25, 1.0), (0.5, 4.0), (0.125, 2.0), (0.125, 7.0)];
    for window in [0.125, 0.25, 0.3, 0.5, 0.875] {
        let (mut equal, mut unequal) = (PeakOfMean::new(window), PeakOfMean::new(window));
        values.iter().for_each(|value| equal.push(0.125, *value));
        joined
            .iter()
            .for_each(|(dt, value)| unequal.push(*dt, *value));
        // the last window, which both take, is that of the peak
        assert!(
            (equal.peak() - unequal.peak()).abs() < 1e-14,
            "window {window}"
        );
    }
}
