//! Response spectra of records.

use std::f64::consts::TAU;

use crate::oscillator::{Advance, Oscillator, Response};
use crate::record::Record;

/// Pieces of a period between which peaks are sought.
const PIECES: f64 = 16.0;

/// Largest responses of oscillators of one damping ratio to a record, by frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResponseSpectrum {
    /// Frequencies, Hz.
    pub frequencies: Vec<f64>,
    /// Largest displacement relative to the base, m.
    pub displacement: Vec<f64>,
    /// Largest absolute acceleration, m/s².
    pub acceleration: Vec<f64>,
}

/// Response spectrum of a record at some frequencies (Hz, greater than zero) and a damping ratio below 1. The record and one
/// period of free motion after it count. Motions are exact ([`Oscillator::after`]) at sixteen times in a period at least;
/// between two of them a peak is that of the cubic through values and slopes, so it is missed by (2π/16)⁴/384 = 6e-5 at most.
pub fn response_spectrum(record: &Record, frequencies: &[f64], damping: f64) -> ResponseSpectrum {
    let mut spectrum = ResponseSpectrum {
        frequencies: frequencies.to_vec(),
        ..ResponseSpectrum::default()
    };
    for frequency in frequencies {
        let oscillator = Oscillator {
            omega: TAU * frequency,
            damping,
        };
        let [displacement, acceleration] = peaks(record, oscillator);
        spectrum.displacement.push(displacement);
        spectrum.acceleration.push(acceleration);
    }
    spectrum
}

/// Largest displacement and absolute acceleration of an oscillator.
fn peaks(record: &Record, oscillator: Oscillator) -> [f64; 2] {
    let period = TAU / oscillator.omega;
    let mut most = [0.0_f64; 2];
    let mut now = Response::default();
    let mut advance = Advance::new(oscillator);
    let points = record.points();
    let last = points[points.len() - 1];
    let free = [[last[0], 0.0], [last[0] + period, 0.0]];
    for pair in points.windows(2).chain([&free[..]]) {
        let [[t0, a0], [t1, a1]] = [pair[0], pair[1]];
        let slope = (a1 - a0) / (t1 - t0);
        let pieces = ((t1 - t0) * PIECES / period).ceil().max(1.0);
        let h = (t1 - t0) / pieces;
        for piece in 0..pieces as usize {
            let a = a0 + slope * h * piece as f64;
            let next = advance.after(now, h, [a, slope]);
            let ends = [(now, a), (next, a + slope * h)];
            let of = ends.map(|(at, base)| {
                let acceleration = oscillator.acceleration(at);
                let relative = Response {
                    u: at.v,
                    v: acceleration - base,
                };
                (
                    [at.u, at.v],
                    [acceleration, oscillator.acceleration(relative)],
                )
            });
            let [(u0, a0), (u1, a1)] = of;
            most[0] = most[0].max(cubic_peak(u0, u1, h));
            most[1] = most[1].max(cubic_peak(a0, a1, h));
            now = next;
        }
    }
    most
}

/// Largest absolute value of the cubic with these (value, slope) at the ends of a step h.
fn cubic_peak([p, dp]: [f64; 2], [q, dq]: [f64; 2], h: f64) -> f64 {
    let ends = p.abs().max(q.abs());
    if dp * dq >= 0.0 {
        return ends;
    }
    // p + h dp s + (3 d - 2 h dp - h dq) s² + (h dp + h dq - 2 d) s³, d = q - p
    let d = q - p;
    let (b, c, e) = (
        h * dp,
        3.0 * d - h * (2.0 * dp + dq),
        h * (dp + dq) - 2.0 * d,
    );
    // roots of b + 2 c s + 3 e s²: slopes of different signs at the ends have one between them
    let root = (c * c - 3.0 * e * b).max(0.0).sqrt();
    let inside = [-b / (c + root), -b / (c - root)];
    inside
        .iter()
        .filter(|s| **s > 0.0 && **s < 1.0)
        .map(|s| (p + s * (b + s * (c + s * e))).abs())
        .fold(ends, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectrum_of_a_harmonic_record_is_that_of_the_closed_form() {
        // sin 2π t over 40 periods with many points: the steady state of a damped oscillator dominates
        let count = 40 * 400;
        let wave = |k: usize| {
            let t = k as f64 / 400.0;
            [t, (TAU * t).sin()]
        };
        let record = Record::new((0..=count).map(wave).collect()).unwrap();
        let xi: f64 = 0.05;
        let spectrum = response_spectrum(&record, &[1.0, 4.0], xi);
        // resonance: u_max = 1/(2 ξ ω²) (1 - e^(-ξ ω t)), and |a| = √(1 + 4 ξ²) ω² u
        let rise = 1.0 - (-xi * TAU * 40.0).exp();
        let exact = rise / (2.0 * xi * TAU * TAU);
        assert!((spectrum.displacement[0] / exact - 1.0).abs() < 1e-3);
        let exact = exact * TAU * TAU * (1.0 + 4.0 * xi * xi).sqrt();
        assert!((spectrum.acceleration[0] / exact - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_stiff_oscillator_has_the_peak_of_the_record() {
        let record = Record::new(vec![[0.0, 0.0], [1.0, 3.0], [2.0, -1.0], [4.0, 0.0]]).unwrap();
        let spectrum = response_spectrum(&record, &[300.0], 0.05);
        assert!((spectrum.acceleration[0] - 3.0).abs() < 0.01);
    }

    #[test]
    fn the_peak_of_a_cubic_is_found() {
        // s (1 - s): peak 1/4 in the middle
        assert!((cubic_peak([0.0, 1.0], [0.0, -1.0], 1.0) - 0.25).abs() < 1e-15);
        // s (1 - s) (2 - s), slopes 2 and -1: 2/(3 √3) at 1 - 1/√3
        let found = cubic_peak([0.0, 2.0], [0.0, -1.0], 1.0);
        assert!((found - 2.0 / 27.0_f64.sqrt()).abs() < 1e-15, "{found}");
        assert_eq!(cubic_peak([1.0, 1.0], [2.0, 1.0], 1.0), 2.0);
    }
}
