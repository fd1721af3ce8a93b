//! Synthetic accelerograms fitted to a response spectrum.

use std::f64::consts::TAU;

use crate::baseline::corrected;
use crate::error::Error;
use crate::fourier::real_sums;
use crate::oscillator::{Advance, Oscillator, Response};
use crate::random::Random;
use crate::record::Record;
use crate::spectrum::response_spectrum;

/// Ratio of neighbouring frequencies at which the first iterations compare spectra.
const RATIO: f64 = 1.25;
/// Iterations of the first kind, on the amplitudes of the harmonics.
const HARMONIC: usize = 4;
/// Iterations of the second kind, by wavelets.
const WAVELETS: usize = 25;
/// Sets of phases, one after the other, until one meets the spectrum: some keep two peaks that take turns.
const TRIALS: usize = 4;
/// Part of a misfit that one iteration of the second kind takes away: the wavelets of neighbours overlap.
const PART: f64 = 0.5;
/// Pieces of a period in which a wavelet is placed.
const PIECES: f64 = 16.0;
/// Widths from its middle at which a wavelet is zero: e^(-28²) is none of the numbers.
const NOTHING: f64 = 28.0;
/// Most steps of a record: its iterations take minutes then.
const STEPS: usize = 1 << 20;
/// Last part of the record over which it fades to zero.
const FADE: f64 = 0.05;

/// A record to be made: its response spectrum, its envelope, and its seed.
///
/// The stationary part Σ A_k sin(2π f_k t + φ_k) has random phases; the envelope (t/rise)², then 1, then an exponential decay to
/// 5 % and a linear fade to zero, makes it a record. Four times the A_k are multiplied by the ratio of the spectra. Then wavelets
/// cos(ω_d x) e^(-(x/γ)²), γ = 1.178 f^-0.93 s (Al Atik, Abrahamson 2010), are added at the instants of the largest responses until each
/// point of the spectrum is met; where that fails, with other phases from the same seed. Every iterate has its baseline corrected, so velocity and displacement end at zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Synthetic {
    /// Points (frequency in Hz, absolute acceleration in m/s²), frequencies ascending; between them straight in both logarithms.
    pub spectrum: Vec<[f64; 2]>,
    /// Damping ratio of the spectrum.
    pub damping: f64,
    /// Duration, s.
    pub duration: f64,
    /// Time in which the envelope rises, s.
    pub rise: f64,
    /// Time over which it is one, s.
    pub strong: f64,
    /// Step of the record, s.
    pub step: f64,
    /// Seed of the phases.
    pub seed: u64,
    /// Largest relative misfit at the points of the spectrum.
    pub tolerance: f64,
}

impl Synthetic {
    /// The record.
    ///
    /// # Errors
    /// Points that are no spectrum; a duration shorter than the longest period; a step longer than a quarter of the shortest;
    /// more than a million steps; an envelope longer than the record; a spectrum that the iterations do not meet.
    pub fn record(&self) -> Result<Record, Error> {
        self.check()?;
        let mut random = Random::new(self.seed);
        let (mut misfit, mut best) = self.trial(&mut random)?;
        for _ in 1..TRIALS {
            if misfit.1.abs() <= self.tolerance {
                break;
            }
            let (other, record) = self.trial(&mut random)?;
            if other.1.abs() < misfit.1.abs() {
                (misfit, best) = (other, record);
            }
        }
        match misfit.1.abs() <= self.tolerance {
            true => Ok(best),
            false => Err(Error::NotMet {
                frequency: self.spectrum[misfit.0][0],
                target: self.spectrum[misfit.0][1],
                misfit: misfit.1,
                tolerance: self.tolerance,
            }),
        }
    }

    /// The best record of one set of phases, with its worst point and its misfit there.
    fn trial(&self, random: &mut Random) -> Result<((usize, f64), Record), Error> {
        let mut record = self.by_harmonics(random)?;
        let (mut misfit, mut best) = (self.misfit(&record), record.clone());
        for _ in 0..WAVELETS {
            if misfit.1.abs() <= 0.8 * self.tolerance {
                break;
            }
            record = self.adjusted(&record)?;
            let now = self.misfit(&record);
            if now.1.abs() < misfit.1.abs() {
                (misfit, best) = (now, record.clone());
            }
        }
        Ok((misfit, best))
    }

    fn check(&self) -> Result<(), Error> {
        let points = &self.spectrum;
        let wrong = |at: &usize| {
            let positive = points[*at].iter().all(|x| x.is_finite() && *x > 0.0);
            !positive || (*at > 0 && points[*at][0] <= points[*at - 1][0])
        };
        if let Some(at) = (0..points.len()).find(wrong) {
            return Err(Error::NotASpectrum { at });
        }
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return Err(Error::Empty);
        };
        if self.duration < 1.0 / first[0] {
            return Err(Error::TooBrief {
                duration: self.duration,
                frequency: first[0],
            });
        }
        if self.step > 0.25 / last[0] {
            return Err(Error::TooCoarse {
                step: self.step,
                frequency: last[0],
            });
        }
        let samples = (self.duration / self.step).ceil();
        if samples > STEPS as f64 {
            return Err(Error::TooManySamples {
                samples,
                most: STEPS,
            });
        }
        match self.rise + self.strong > self.duration {
            true => Err(Error::Envelope {
                least: self.rise + self.strong,
                duration: self.duration,
            }),
            false => Ok(()),
        }
    }

    /// Target at a frequency, m/s².
    fn target(&self, frequency: f64) -> f64 {
        logarithmic(&self.spectrum, frequency)
    }

    /// Envelope at a time.
    fn envelope(&self, t: f64) -> f64 {
        let decay = self.duration - self.rise - self.strong;
        let late = t - self.rise - self.strong;
        let shape = match (t < self.rise, late > 0.0 && decay > 0.0) {
            (true, _) => (t / self.rise).powi(2),
            (false, true) => (-(20.0_f64.ln()) * late / decay).exp(),
            (false, false) => 1.0,
        };
        shape * ((self.duration - t) / (FADE * self.duration)).clamp(0.0, 1.0)
    }

    /// Times of the record; the last one is its duration.
    fn times(&self) -> Vec<f64> {
        let steps = (self.duration / self.step).ceil();
        let step = self.duration / steps;
        (0..=steps as usize).map(|k| step * k as f64).collect()
    }

    /// Harmonics of random phases whose amplitudes are iterated.
    fn by_harmonics(&self, random: &mut Random) -> Result<Record, Error> {
        let times = self.times();
        let [low, high] = [0, self.spectrum.len() - 1].map(|k| self.spectrum[k][0]);
        let top = (1.3 * high).min(0.5 / self.step) * self.duration;
        let first = (0.7 * low * self.duration).ceil().max(1.0) as usize;
        let mut lines: Vec<[f64; 3]> = (first..=top as usize)
            .map(|k| {
                let f = k as f64 / self.duration;
                [
                    f,
                    self.target(f) / (f * self.duration).sqrt(),
                    random.phase(),
                ]
            })
            .collect();
        let controls = self.controls();
        let mut record = self.sum(&times, (first, &lines))?;
        for _ in 0..HARMONIC {
            let found = response_spectrum(&record, &controls, self.damping);
            let ratios = controls.iter().zip(&found.acceleration);
            let ratios: Vec<_> = ratios.map(|(&f, a)| [f, self.target(f) / a]).collect();
            for line in &mut lines {
                line[1] *= logarithmic(&ratios, line[0]);
            }
            record = self.sum(&times, (first, &lines))?;
        }
        Ok(record)
    }

    /// The points of the spectrum, and frequencies between those that are far apart.
    fn controls(&self) -> Vec<f64> {
        let mut all = vec![self.spectrum[0][0]];
        for pair in self.spectrum.windows(2) {
            let ratio = pair[1][0] / pair[0][0];
            let parts = (ratio.ln() / RATIO.ln()).ceil().max(1.0);
            all.extend((1..=parts as usize).map(|k| pair[0][0] * ratio.powf(k as f64 / parts)));
        }
        all
    }

    /// E(t) Σ A sin(2π f t + φ) on its baseline; `lines`: f, A, φ, with f those of the periods duration/`first` and on.
    fn sum(&self, times: &[f64], (first, lines): (usize, &[[f64; 3]])) -> Result<Record, Error> {
        let mut coefficients = vec![[0.0; 2]; times.len() - 1];
        for (coefficient, [_, a, phase]) in coefficients[first..].iter_mut().zip(lines) {
            // A sin(x + φ) is the real part of -i A e^(iφ) e^(ix)
            *coefficient = [a * phase.sin(), -a * phase.cos()];
        }
        let waves = real_sums(&coefficients);
        let at = |(n, &t): (usize, &f64)| [t, self.envelope(t) * waves[n % waves.len()]];
        corrected(&Record::new(times.iter().enumerate().map(at).collect())?)
    }

    /// The point of the spectrum that is met worst, and found over target less one there.
    fn misfit(&self, record: &Record) -> (usize, f64) {
        let frequencies: Vec<f64> = self.spectrum.iter().map(|point| point[0]).collect();
        let found = response_spectrum(record, &frequencies, self.damping);
        let misfits = found.acceleration.iter().zip(&self.spectrum);
        let misfits = misfits.map(|(a, point)| a / point[1] - 1.0).enumerate();
        misfits.fold((0, 0.0), |worst: (usize, f64), now| {
            match now.1.abs() > worst.1.abs() {
                true => now,
                false => worst,
            }
        })
    }

    /// The record with a wavelet for each point of the spectrum.
    fn adjusted(&self, record: &Record) -> Result<Record, Error> {
        let mut values: Vec<f64> = record.points().iter().map(|point| point[1]).collect();
        for &[frequency, target] in &self.spectrum {
            let oscillator = Oscillator {
                omega: TAU * frequency,
                damping: self.damping,
            };
            let (at, peak) = largest(record, oscillator);
            let wavelet = self.wavelet(record, oscillator, at)?;
            let response = response_at(&wavelet, oscillator, at);
            let size = PART * peak.signum() * (target - peak.abs()) / response;
            if size.is_finite() {
                let added = values.iter_mut().zip(wavelet.points());
                added.for_each(|(value, point)| *value += size * point[1]);
            }
        }
        let points = record.points().iter().zip(values);
        corrected(&Record::new(
            points.map(|(point, a)| [point[0], a]).collect(),
        )?)
    }

    /// A wavelet that makes an oscillator respond most at a time, within the envelope.
    fn wavelet(&self, record: &Record, of: Oscillator, at: f64) -> Result<Record, Error> {
        let root = (1.0 - of.damping * of.damping).sqrt();
        let turn = of.omega * root;
        let begin = at - (root / of.damping).atan() / turn;
        let width = 1.178 * (of.omega / TAU).powf(-0.93);
        let value = |point: &[f64; 2]| {
            let x = point[0] - begin;
            if x.abs() > NOTHING * width {
                return [point[0], 0.0];
            }
            let within = (3.0 * self.envelope(point[0])).min(1.0);
            let shape = (turn * x).cos() * (-(x / width).powi(2)).exp();
            [point[0], within * shape]
        };
        corrected(&Record::new(record.points().iter().map(value).collect())?)
    }
}

/// Steps of an oscillator under a record, a sixteenth of its period long at most, and on for a period after it: the time and the
/// absolute acceleration after each, until `until` says that it is enough.
fn follow(record: &Record, of: Oscillator, mut until: impl FnMut(f64, f64) -> bool) {
    let period = TAU / of.omega;
    let points = record.points();
    let last = points[points.len() - 1][0];
    let free = [[last, 0.0], [last + period, 0.0]];
    let mut now = Response::default();
    let mut advance = Advance::new(of);
    for pair in points.windows(2).chain([&free[..]]) {
        let [[t0, a0], [t1, a1]] = [pair[0], pair[1]];
        let pieces = ((t1 - t0) * PIECES / period).ceil().max(1.0);
        let (h, slope) = ((t1 - t0) / pieces, (a1 - a0) / (t1 - t0));
        for piece in 0..pieces as usize {
            let since = h * piece as f64;
            now = advance.after(now, h, [a0 + slope * since, slope]);
            if until(t0 + since + h, of.acceleration(now)) {
                return;
            }
        }
    }
}

/// Time and value of the largest absolute acceleration.
fn largest(record: &Record, of: Oscillator) -> (f64, f64) {
    let mut found = (0.0, 0.0_f64);
    follow(record, of, |t, a| {
        if a.abs() > found.1.abs() {
            found = (t, a);
        }
        false
    });
    found
}

/// Absolute acceleration at a time of [`largest`].
fn response_at(record: &Record, of: Oscillator, at: f64) -> f64 {
    let mut found = 0.0;
    follow(record, of, |t, a| {
        found = a;
        t >= at
    });
    found
}

/// Value at x of points (x, y), straight in both logarithms, constant outside.
fn logarithmic(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.partition_point(|point| point[0] <= x);
    match (
        after.checked_sub(1).and_then(|k| points.get(k)),
        points.get(after),
    ) {
        (Some(a), Some(b)) => {
            let part = (x / a[0]).ln() / (b[0] / a[0]).ln();
            a[1] * (b[1] / a[1]).powf(part)
        }
        (Some(end), None) | (None, Some(end)) => end[1],
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted(seed: u64) -> Synthetic {
        // a plateau of 6 m/s² from 2 to 7 Hz, 2.4 m/s² for stiff oscillators, falling with f below
        let spectrum = [
            [0.5, 1.5],
            [1.0, 3.0],
            [2.0, 6.0],
            [4.0, 6.0],
            [7.0, 6.0],
            [15.0, 3.6],
            [30.0, 2.4],
        ];
        Synthetic {
            spectrum: spectrum.to_vec(),
            damping: 0.05,
            duration: 12.0,
            rise: 1.5,
            strong: 6.0,
            step: 0.005,
            seed,
            tolerance: 0.05,
        }
    }

    #[test]
    fn a_record_meets_its_spectrum_and_has_no_drift() {
        for seed in 1..4 {
            let wanted = wanted(seed);
            let record = wanted.record().unwrap();
            let (_, misfit) = wanted.misfit(&record);
            assert!(misfit.abs() <= 0.05, "{misfit}");
            let integrals = record.integrals();
            let peak = |k: usize| integrals.iter().fold(0.0, |m: f64, i| m.max(i[k].abs()));
            let [v, u] = record.drift();
            assert!(v.abs() < 1e-12 * peak(0) && u.abs() < 1e-12 * peak(1));
            let points = record.points();
            let last = points[points.len() - 1];
            assert_eq!((points[0], last), ([0.0, 0.0], [12.0, 0.0]));
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_record_and_another_one_another() {
        let record = |seed| wanted(seed).record().unwrap();
        assert_eq!(record(1), record(1));
        assert_ne!(record(1), record(2));
    }

    #[test]
    fn what_cannot_be_met_is_refused() {
        let with = |change: &dyn Fn(&mut Synthetic)| {
            let mut wanted = wanted(1);
            change(&mut wanted);
            wanted.record()
        };
        let brief = with(&|wanted| wanted.duration = 1.0);
        assert!(matches!(brief, Err(Error::TooBrief { .. })));
        let coarse = with(&|wanted| wanted.step = 0.01);
        assert!(matches!(coarse, Err(Error::TooCoarse { .. })));
        // more memory than any machine has, if it were begun
        let endless = with(&|wanted| wanted.duration = 1e9);
        assert!(matches!(endless, Err(Error::TooManySamples { .. })));
        let long = with(&|wanted| wanted.strong = 11.0);
        assert!(matches!(long, Err(Error::Envelope { .. })));
        let back = with(&|wanted| wanted.spectrum[2][0] = 1.0);
        assert_eq!(back, Err(Error::NotASpectrum { at: 2 }));
        // an oscillator of 5 % amplifies a harmonic tenfold at most: the stiff one cannot feel a five-hundredth
        let steep = with(&|wanted| {
            (wanted.duration, wanted.strong) = (4.0, 1.0);
            wanted.spectrum[6][1] = 0.012;
        });
        assert!(matches!(steep, Err(Error::NotMet { .. })), "{steep:?}");
    }
}
