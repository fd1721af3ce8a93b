//! A random load along a line has the variance, the spectrum and the coherence that it is made for.
//!
//! Problem: loads at three places of a line, at 0, 0.4 m and 1.2 m, with a spectral density that rises from 1 to 4 Hz and falls to 9 Hz
//! and the correlation length 0.8 m, from several seeds. Closed solution: mean square ∫ G df; mean square in each of eight bands ∫ G df over
//! it; of two places at the distance d the complex coherence Σ a b̄ / √(Σ |a|² Σ |b|²) is e^(-d/L), in every band. Reference: the
//! target, by harmonics found by projection on the load as the run takes it, straight between its samples.
//!
//! Tolerance, from the size of the sample before the run: the squares of N independent harmonics of densities g have the relative
//! standard deviation √(Σ g²)/Σ g, and a coherence c the standard deviation (1 - c²)/√(2N); four of them, which chance exceeds
//! in one of 16 000 cases, and 1e-3 for the harmonics that straight pieces add above the band. The means over all seeds are
//! compared: a generator that is off by its own statistical error fails.

use std::f64::consts::TAU;

use carom_signals::{Amplitude, RandomField};

use crate::Error;
use crate::check::{Check, Row, Size};

const SPECTRUM: [[f64; 2]; 3] = [[1.0, 1.0], [4.0, 5.0], [9.0, 0.5]];
const LENGTH: f64 = 0.8;
const PLACES: [f64; 3] = [0.0, 0.4, 1.2];
const BANDS: usize = 8;
/// Standard deviations that chance may make.
const SIGMAS: f64 = 4.0;
const STRAIGHT: f64 = 1e-3;

/// Complex amplitudes of the harmonics k/T of a load.
fn harmonics(
    load: &Amplitude,
    duration: f64,
    lines: std::ops::RangeInclusive<usize>,
) -> Vec<[f64; 2]> {
    let count = (128.0 * duration * SPECTRUM[2][0] / 2.0) as usize;
    let values: Vec<f64> = (0..count)
        .map(|n| load.at(duration * (n as f64 + 0.5) / count as f64))
        .collect();
    let of = |k: usize| {
        let turn = TAU * k as f64 / count as f64;
        // e^(-i turn (n + 1/2)) by its recursion
        let (mut at, step) = (
            [(0.5 * turn).cos(), -(0.5 * turn).sin()],
            [turn.cos(), -turn.sin()],
        );
        let mut sum = [0.0; 2];
        for value in &values {
            sum = [sum[0] + value * at[0], sum[1] + value * at[1]];
            at = [
                at[0] * step[0] - at[1] * step[1],
                at[0] * step[1] + at[1] * step[0],
            ];
        }
        sum.map(|part| 2.0 * part / count as f64)
    };
    lines.map(of).collect()
}

fn rows(duration: f64, seeds: u64) -> Result<Vec<Row>, Error> {
    let [first, last] = [SPECTRUM[0][0], SPECTRUM[2][0]];
    let lines = (first * duration) as usize..=(last * duration) as usize;
    let density = Amplitude::new(SPECTRUM.to_vec())?;
    let targets: Vec<f64> = lines
        .clone()
        .map(|k| density.at(k as f64 / duration) / duration)
        .collect();
    let mut found: Vec<Vec<Vec<[f64; 2]>>> = Vec::new();
    for seed in 0..seeds {
        let field = RandomField {
            spectrum: SPECTRUM.to_vec(),
            correlation_length: LENGTH,
            duration,
            seed,
        };
        let loads = field.at(&PLACES)?;
        let of = |load| harmonics(load, duration, lines.clone());
        found.push(loads.iter().map(of).collect());
    }
    let count = targets.len();
    let mut rows = Vec::new();
    for (place, x) in PLACES.iter().enumerate() {
        let square = |range: std::ops::Range<usize>| {
            let all = found.iter().flat_map(|seed| &seed[place][range.clone()]);
            let sum: f64 = all.map(|[re, im]| 0.5 * (re * re + im * im)).sum();
            let target: f64 = targets[range.clone()].iter().sum();
            let squares: f64 = targets[range].iter().map(|g| g * g).sum();
            let chance = squares.sqrt() / target / (seeds as f64).sqrt();
            (sum / seeds as f64 / target, SIGMAS * chance + STRAIGHT)
        };
        let (value, tolerance) = square(0..count);
        let name = format!("mean square at {x} m / target");
        rows.push(Row::near(name, value, 1.0, tolerance));
        for band in 0..BANDS {
            let range = count * band / BANDS..count * (band + 1) / BANDS;
            let (value, tolerance) = square(range);
            let name = format!("mean square at {x} m in band {band} / target");
            rows.push(Row::near(name, value, 1.0, tolerance));
        }
    }
    for [one, other] in [[0, 1], [1, 2], [0, 2]] {
        let exact = (-(PLACES[other] - PLACES[one]) / LENGTH).exp();
        for half in 0..2 {
            let range = count * half / 2..count * (half + 1) / 2;
            let (mut cross, mut squares) = ([0.0; 2], [0.0; 2]);
            for seed in &found {
                for (k, target) in range.clone().zip(&targets[range.clone()]) {
                    let [a, b] = [seed[one][k], seed[other][k]];
                    // each harmonic weighs the same
                    cross[0] += (a[0] * b[0] + a[1] * b[1]) / target;
                    cross[1] += (a[1] * b[0] - a[0] * b[1]) / target;
                    squares[0] += (a[0] * a[0] + a[1] * a[1]) / target;
                    squares[1] += (b[0] * b[0] + b[1] * b[1]) / target;
                }
            }
            let coherence = cross.map(|part| part / (squares[0] * squares[1]).sqrt());
            let sample = (seeds as usize * range.len()) as f64;
            let chance = (1.0 - exact * exact) / (2.0 * sample).sqrt();
            let name = format!(
                "coherence of {} m and {} m, half {half}",
                PLACES[one], PLACES[other]
            );
            let tolerance = SIGMAS * chance + STRAIGHT;
            rows.push(Row::near(&name, coherence[0], exact, tolerance));
            // in phase: the imaginary part of independent parts has the deviation √((1 - c²)/2N)
            let chance = ((1.0 - exact * exact) / (2.0 * sample)).sqrt();
            let name = format!("{name}, out of phase");
            rows.push(Row::near(
                name,
                coherence[1],
                0.0,
                SIGMAS * chance + STRAIGHT,
            ));
        }
    }
    Ok(rows)
}

pub(crate) const CHECK: Check = Check {
    name: "random-field",
    fact: "a random load has the variance, the spectrum in bands and the coherence over the distance that it is made for, within the statistical error of the sample",
    run: |size| match size {
        Size::Quick => rows(20.0, 4),
        Size::Full => rows(60.0, 16),
    },
};
