//! The peak of a windowed mean against brute force and closed cases.

use carom_output::window::peak_of_mean;

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

#[test]
fn a_constant_is_its_own_mean_and_a_window_as_long_as_the_record_gives_the_mean() {
    let times = [0.0, 0.1, 0.5, 2.0];
    for window in [1e-3, 0.3, 1.0, 2.0, 5.0] {
        let peak = peak_of_mean(&times, &[3.0; 3], window).unwrap();
        assert!((peak - 3.0).abs() < 1e-12);
    }
    let peak = peak_of_mean(&times, &[4.0, 0.0, 2.0], 9.0).unwrap();
    assert!((peak - 3.4 / 2.0).abs() < 1e-14);
}

#[test]
fn a_spike_counts_with_its_impulse() {
    // 100 N for 0.01 s on 1 N: in a window of 0.1 s, (100 * 0.01 + 0.09) / 0.1.
    let peak = peak_of_mean(&[0.0, 0.5, 0.51, 1.0], &[1.0, 100.0, 1.0], 0.1).unwrap();
    assert!((peak - 10.9).abs() < 1e-10, "{peak}");
}

#[test]
fn no_window_of_a_fine_scan_has_a_larger_mean_and_one_comes_close() {
    let random = random(80);
    let mut times = vec![0.0];
    for dt in &random[..40] {
        times.push(times[times.len() - 1] + dt);
    }
    let values = &random[40..];
    let last = times[40];
    for window in [0.05, 0.7, 3.0] {
        let peak = peak_of_mean(&times, values, window).unwrap();
        let mean = |start: f64| {
            let overlap =
                |k: usize| (times[k + 1].min(start + window) - times[k].max(start)).max(0.0);
            (0..40).map(|k| values[k] * overlap(k)).sum::<f64>() / window
        };
        let scan = (0..=20_000).map(|i| mean((last - window) * f64::from(i) / 20_000.0));
        let largest = scan.fold(0.0, f64::max);
        assert!(
            largest <= peak + 1e-12 && largest > peak - 1e-2,
            "{largest} {peak}"
        );
    }
}

#[test]
fn what_has_no_mean_has_no_peak() {
    assert_eq!(peak_of_mean(&[], &[], 1.0), None);
    assert_eq!(peak_of_mean(&[0.0], &[], 1.0), None);
    assert_eq!(peak_of_mean(&[1.0, 1.0], &[5.0], 1.0), None);
    assert_eq!(peak_of_mean(&[0.0, 1.0], &[5.0], 0.0), None);
    assert_eq!(peak_of_mean(&[0.0, 1.0], &[5.0], f64::NAN), None);
    assert_eq!(peak_of_mean(&[0.0, 1.0], &[5.0, 6.0], 1.0), None);
}
