//! Low-pass filters for channels of impact tests.

use std::f64::consts::{PI, SQRT_2};

/// The low-pass filter of a channel frequency class (CFC): a Butterworth filter of second order, run forward and then backward over
/// the samples, so that it shifts no phase.
///
/// With the class C (Hz), the step T of the samples and α = tan(π 2.0775 C T) it multiplies a vibration of frequency f by
///
/// 1/(1 + (tan(π f T)/α)⁴),
///
/// which is -3 dB at 1.667 C and -6 dB at 2.0775 C. One pass is, with a = α²/(1 + √2 α + α²),
///
/// y_k - y_{k-1} = (1 - √2 α + α²)/(1 + √2 α + α²) (y_{k-1} - y_{k-2}) + a (x_k + 2 x_{k-1} + x_{k-2} - 4 y_{k-1}).
///
/// This is the recursion of the standard written in differences, which rounding does not disturb at steps far below 1/C. Before its
/// first sample a record is taken for constant.
///
/// SAE J211-1 (2014), appendix C; ISO 6487.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelFilter {
    /// a.
    gain: f64,
    /// Factor of the last difference.
    carry: f64,
}

/// Frequency of the filter's poles over the class: -6 dB of both passes together.
const CORNER: f64 = 2.0775;

/// Samples in 1/class, at least, for which the standard takes a filter.
const SAMPLES: f64 = 10.0;

impl ChannelFilter {
    /// The filter of a class (Hz) for samples at this distance (s); none above [`ChannelFilter::longest_step`].
    pub fn new(class: f64, step: f64) -> Option<ChannelFilter> {
        // a mean of steps may be beyond the longest by rounding
        if step.is_nan() || step <= 0.0 || step > ChannelFilter::longest_step(class) * (1.0 + 1e-9)
        {
            return None;
        }
        let alpha = (PI * CORNER * class * step).tan();
        let square = alpha * alpha;
        let all = 1.0 + SQRT_2 * alpha + square;
        Some(ChannelFilter {
            gain: square / all,
            carry: (1.0 - SQRT_2 * alpha + square) / all,
        })
    }

    /// The longest distance of samples for a class (Hz), s: ten samples in the period of the class, as SAE J211-1 asks.
    pub fn longest_step(class: f64) -> f64 {
        1.0 / (SAMPLES * class)
    }

    /// Filters samples at equal distances in place.
    pub fn apply(&self, samples: &mut [f64]) {
        self.pass(samples.iter_mut());
        self.pass(samples.iter_mut().rev());
    }

    fn pass<'a>(&self, mut samples: impl Iterator<Item = &'a mut f64>) {
        let Some(first) = samples.next() else {
            return;
        };
        let ([mut x1, mut x2], mut y, mut change) = ([*first; 2], *first, 0.0);
        for sample in samples {
            let x = *sample;
            change = self.carry * change + self.gain * (x + 2.0 * x1 + x2 - 4.0 * y);
            y += change;
            *sample = y;
            (x2, x1) = (x1, x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CLASSES: [f64; 4] = [60.0, 180.0, 600.0, 1000.0];

    /// Amplitude of a vibration of unit amplitude and this frequency (Hz) behind the filter, by the sums with its sine and cosine over
    /// a whole number of periods in the middle of the record.
    fn gain(filter: &ChannelFilter, frequency: f64, step: f64) -> f64 {
        let samples = (1.0 / (frequency * step)).round() as usize;
        let phase = |k: usize| 2.0 * PI * frequency * step * k as f64;
        let mut record: Vec<f64> = (0..60 * samples).map(|k| phase(k).sin()).collect();
        filter.apply(&mut record);
        let middle = 20 * samples..40 * samples;
        let sum = |with: fn(f64) -> f64| {
            let terms = middle.clone().map(|k| with(phase(k)) * record[k]);
            2.0 * terms.sum::<f64>() / (20 * samples) as f64
        };
        let [sine, cosine] = [sum(f64::sin), sum(f64::cos)];
        assert!(cosine.abs() < 1e-8, "a phase of {cosine}");
        sine
    }

    /// The transient of the start decays as exp(-2π 1.47 C t): below 1e-16 after twenty periods of at most 4 C.
    #[test]
    fn the_gain_is_that_of_two_passes_of_a_butterworth_filter_and_no_phase_is_shifted() {
        for class in CLASSES {
            for ratio in [0.25, 1.0, 2.0, 4.0] {
                let frequency = ratio * class;
                // a whole number of samples in a period
                let step = 1.0 / (40.0 * frequency.max(class));
                let filter = ChannelFilter::new(class, step).unwrap();
                let alpha = (PI * 2.0775 * class * step).tan();
                let exact = 1.0 / (1.0 + ((PI * frequency * step).tan() / alpha).powi(4));
                let found = gain(&filter, frequency, step);
                assert!(
                    (found - exact).abs() < 1e-8,
                    "{class} {ratio}: {found} {exact}"
                );
            }
        }
    }

    /// SAE J211-1 gives the corner of the class C, -3 dB, at 5/3 C: 100, 300, 1000 and 1650 Hz, which it rounds. The gain there is
    /// 1/(1 + (1.6667/2.0775)⁴) = 0.7071 where the step is short.
    #[test]
    fn the_corner_is_where_the_standard_has_it() {
        for class in CLASSES {
            let step = 1.0 / (1000.0 * class / 0.6);
            let filter = ChannelFilter::new(class, step).unwrap();
            let decibels = 20.0 * gain(&filter, class / 0.6, step).log10();
            assert!((decibels + 3.01).abs() < 0.01, "{decibels}");
        }
    }

    /// The recursion as the standard prints it has lost all digits at this step.
    #[test]
    fn a_constant_stays_at_steps_of_a_nanosecond() {
        let filter = ChannelFilter::new(60.0, 1e-9).unwrap();
        let mut record = vec![9.81; 100_000];
        filter.apply(&mut record);
        assert!(record.iter().all(|y| *y == 9.81));
        assert!(ChannelFilter::new(1000.0, 1.1e-4).is_none());
    }
}
