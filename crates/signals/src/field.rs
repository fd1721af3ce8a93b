//! Random loads along a structure, from a spectrum and a correlation length.

use std::f64::consts::PI;

use crate::amplitude::Amplitude;
use crate::error::Error;
use crate::fourier::real_sums;
use crate::random::Random;

/// Samples of a signal in the shortest period of its spectrum, at least.
const SAMPLES: f64 = 8.0;

/// Most samples of a field at all its places: 512 MiB of them.
const ALL_SAMPLES: usize = 1 << 25;

/// A Gaussian random load p(x, t) along a line, stationary in time and homogeneous along x.
///
/// p = Σ_k √(G(f_k) Δf) Re(z_k(x) e^(2πi f_k t)), f_k = k Δf, Δf = 1/T. The z_k are independent complex Gaussian sequences along x
/// with E|z|² = 2 and the correlation e^(-|x - x'|/L), which has an exact recursion: z₊ = ρ z + √(1 - ρ²) ξ, ρ = e^(-d/L) at the
/// distance d (Ornstein, Uhlenbeck 1930). So the mean square of p is ∫ G df, at any place.
#[derive(Clone, Debug, PartialEq)]
pub struct RandomField {
    /// Points (frequency in Hz, one-sided spectral density G in the square of the load's unit per Hz), frequencies ascending; straight
    /// between them, zero outside.
    pub spectrum: Vec<[f64; 2]>,
    /// Correlation length L, m.
    pub correlation_length: f64,
    /// Duration T, s.
    pub duration: f64,
    /// Seed.
    pub seed: u64,
}

impl RandomField {
    /// The load at some places along the line (m, ascending) as functions of time. They are straight between samples, which takes
    /// (sin πfτ/πfτ)² of a harmonic, with τ the time between samples; the amplitudes are larger by that factor.
    ///
    /// # Errors
    /// Points that are no spectrum; a duration shorter than the longest period, or without a harmonic in the
    /// band; more samples at all places than 512 MiB hold.
    pub fn at(&self, places: &[f64]) -> Result<Vec<Amplitude>, Error> {
        let [first, last] = self.check()?;
        let density = Amplitude::new(self.spectrum.clone())?;
        let samples = (SAMPLES * last * self.duration).ceil();
        let all_samples = samples * places.len() as f64;
        if all_samples > ALL_SAMPLES as f64 {
            return Err(Error::TooManySamples {
                samples: all_samples,
                most: ALL_SAMPLES,
            });
        }
        let samples = (samples as usize).next_power_of_two();
        let step = self.duration / samples as f64;
        let lines = (first * self.duration).ceil() as usize..=(last * self.duration) as usize;
        if lines.is_empty() {
            return Err(Error::NoHarmonic {
                duration: self.duration,
                first,
                last,
            });
        }
        let size = |k: usize| {
            let f = k as f64 / self.duration;
            let sinc = (PI * f * step).sin() / (PI * f * step);
            (density.at(f) / self.duration).sqrt() / (sinc * sinc)
        };
        let sizes: Vec<f64> = lines.clone().map(size).collect();
        let mut random = Random::new(self.seed);
        let mut z: Vec<[f64; 2]> = Vec::new();
        let mut before = None;
        let mut all = Vec::with_capacity(places.len());
        for &place in places {
            let kept = before.map_or(0.0, |x: f64| {
                (-(place - x).abs() / self.correlation_length).exp()
            });
            before = Some(place);
            let new = f64::sqrt(1.0 - kept * kept);
            z.resize(sizes.len(), [0.0; 2]);
            for value in &mut z {
                let fresh = random.gaussian_pair();
                *value = [0, 1].map(|i| kept * value[i] + new * fresh[i]);
            }
            let mut coefficients = vec![[0.0; 2]; samples];
            for ((k, size), z) in lines.clone().zip(&sizes).zip(&z) {
                coefficients[k] = z.map(|part| size * part);
            }
            let values = real_sums(&coefficients);
            // the sums have the period T
            let points = (0..=samples).map(|n| [step * n as f64, values[n % samples]]);
            all.push(Amplitude::new(points.collect())?);
        }
        Ok(all)
    }

    /// Lowest and highest frequency.
    fn check(&self) -> Result<[f64; 2], Error> {
        let points = &self.spectrum;
        let wrong = |at: &usize| {
            let [f, density] = points[*at];
            let valid = f > 0.0 && f.is_finite() && density >= 0.0 && density.is_finite();
            !valid || (*at > 0 && f <= points[*at - 1][0])
        };
        if let Some(at) = (0..points.len()).find(wrong) {
            return Err(Error::NotADensity { at });
        }
        match (points.first(), points.last()) {
            (Some(first), Some(last)) if points.len() > 1 => match self.duration < 1.0 / first[0] {
                true => Err(Error::TooBrief {
                    duration: self.duration,
                    frequency: first[0],
                }),
                false => Ok([first[0], last[0]]),
            },
            _ => Err(Error::Empty),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_square_and_correlation_are_those_of_the_spectrum() {
        // G = 4 from 1 to 9 Hz: mean square 32; 800 harmonics and 8 seeds leave 1/√6400 = 1.25 % by chance
        let (mut square, mut product) = ([0.0; 2], 0.0);
        for seed in 0..8 {
            let field = RandomField {
                spectrum: vec![[1.0, 4.0], [9.0, 4.0]],
                correlation_length: 2.0,
                duration: 100.0,
                seed,
            };
            let loads = field.at(&[0.0, 0.5, 1.0]).unwrap();
            let count = 20_000;
            for n in 0..count {
                let t = 100.0 * (n as f64 + 0.37) / count as f64;
                let [a, b] = [loads[0].at(t), loads[2].at(t)];
                square = [square[0] + a * a, square[1] + b * b];
                product += a * b;
            }
        }
        let total = 8.0 * 20_000.0;
        for square in square {
            assert!(
                (square / total / 32.0 - 1.0).abs() < 0.05,
                "{}",
                square / total
            );
        }
        // e^(-1/2) over two pieces of the line
        let found = product / total / 32.0;
        assert!((found - (-0.5_f64).exp()).abs() < 0.05, "{found}");
    }

    #[test]
    fn a_harmonic_keeps_its_size_between_the_samples() {
        // 7 Hz alone: of the straight pieces the part at 7 Hz, found by projection on it
        let field = RandomField {
            spectrum: vec![[6.95, 1.0], [7.05, 1.0]],
            correlation_length: 1.0,
            duration: 10.0,
            seed: 5,
        };
        let load = &field.at(&[0.0]).unwrap()[0];
        let count = 100_000;
        let mut parts = [0.0; 2];
        for n in 0..count {
            let t = 10.0 * (n as f64 + 0.5) / count as f64;
            let (sin, cos) = (2.0 * PI * 7.0 * t).sin_cos();
            parts[0] += 2.0 * load.at(t) * cos / count as f64;
            parts[1] -= 2.0 * load.at(t) * sin / count as f64;
        }
        let z = Random::new(5).gaussian_pair();
        for i in 0..2 {
            // rule of the middle with 1e4 points in a second: (2π 7 h)²/24 = 1e-6
            assert!(
                (parts[i] - 0.1_f64.sqrt() * z[i]).abs() < 1e-4,
                "{parts:?} {z:?}"
            );
        }
    }

    #[test]
    fn what_is_no_density_is_refused() {
        let with = |spectrum: Vec<[f64; 2]>| {
            let field = RandomField {
                spectrum,
                correlation_length: 1.0,
                duration: 1.0,
                seed: 1,
            };
            field.at(&[0.0])
        };
        assert_eq!(
            with(vec![[2.0, 1.0], [2.0, 1.0]]),
            Err(Error::NotADensity { at: 1 })
        );
        assert_eq!(
            with(vec![[2.0, -1.0], [3.0, 1.0]]),
            Err(Error::NotADensity { at: 0 })
        );
        assert!(matches!(
            with(vec![[0.1, 1.0], [3.0, 1.0]]),
            Err(Error::TooBrief { .. })
        ));
        // no multiple of 1/duration
        assert!(matches!(
            with(vec![[3.1, 1.0], [3.2, 1.0]]),
            Err(Error::NoHarmonic { .. })
        ));
        assert_eq!(with(vec![[0.1, 1.0]]), Err(Error::Empty));
        assert!(matches!(
            with(vec![[2.0, 1.0], [1e12, 1.0]]),
            Err(Error::TooManySamples { .. })
        ));
    }
}
