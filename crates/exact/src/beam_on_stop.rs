//! A slender beam that falls against an elastic stop, by its modes.
//!
//! An Euler-Bernoulli beam, uniform, at rest and straight at the start, under a uniform load of mass times a, in the direction of a stop
//! of stiffness k at a distance g. With modes φ_n of mean square 1 and the mass m L of the beam, w = Σ φ_n(x_s) q_n the way
//! towards the stop and F = k max(0, w - g):
//!
//! `q̈_n + ω_n² q_n = a ∫φ_n dx/L - φ_n(x_s) F/(m L)`.
//!
//! Each mode is propagated exactly under a force that is linear in time over a step (Nigam and Jennings 1969), so that errors
//! come from the number of modes and from the course of F within a step.

use std::f64::consts::{PI, SQRT_2};

/// The modes of a beam, and the stop.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamOnStop {
    modes: Vec<Mode>,
    /// m L in kg.
    mass: f64,
    /// k in N/m and g in m.
    stop: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Mode {
    /// ω_n in rad/s.
    frequency: f64,
    /// φ_n(x_s).
    at_stop: f64,
    /// a ∫φ_n dx/L in m/s².
    load: f64,
}

/// Stiffness k (N/m) and distance g (m) of a stop.
pub type Stop = [f64; 2];

impl BeamOnStop {
    /// A cantilever with a stop at its tip. `beam`: E I in N m², m in kg/m, L in m; `load`: a in m/s².
    pub fn cantilever(
        [bending, line, length]: [f64; 3],
        load: f64,
        stop: Stop,
        modes: usize,
    ) -> BeamOnStop {
        let mode = |n: usize| {
            let root = clamped_free(n);
            let sigma = (root.sinh() - root.sin()) / (root.cosh() + root.cos());
            // of large roots the quotient of the exponentials
            let sigma = if sigma.is_finite() { sigma } else { 1.0 };
            Mode {
                frequency: (root / length).powi(2) * (bending / line).sqrt(),
                at_stop: if n.is_multiple_of(2) { 2.0 } else { -2.0 },
                load: load * 2.0 * sigma / root,
            }
        };
        BeamOnStop {
            modes: (0..modes).map(mode).collect(),
            mass: line * length,
            stop,
        }
    }

    /// A simply supported beam with a stop at mid-span: the modes that are symmetric.
    pub fn simply_supported(
        [bending, line, length]: [f64; 3],
        load: f64,
        stop: Stop,
        modes: usize,
    ) -> BeamOnStop {
        let mode = |k: usize| {
            let root = (2 * k + 1) as f64 * PI;
            Mode {
                frequency: (root / length).powi(2) * (bending / line).sqrt(),
                at_stop: if k.is_multiple_of(2) { SQRT_2 } else { -SQRT_2 },
                load: load * SQRT_2 * 2.0 / root,
            }
        };
        BeamOnStop {
            modes: (0..modes).map(mode).collect(),
            mass: line * length,
            stop,
        }
    }

    /// Lowest angular frequency, rad/s.
    pub fn lowest(&self) -> f64 {
        self.modes
            .iter()
            .fold(f64::INFINITY, |m, mode| m.min(mode.frequency))
    }

    /// Force on the stop (N) at the ends of steps of `dt` (s).
    pub fn forces(&self, dt: f64, steps: usize) -> Vec<f64> {
        let [stiffness, gap] = self.stop;
        let mut states = vec![[0.0; 2]; self.modes.len()];
        let mut force = 0.0;
        let mut forces = Vec::with_capacity(steps);
        for _ in 0..steps {
            // the way at the end without the force there, and with a unit of it
            let (mut free, mut slope) = (0.0, 0.0);
            for (mode, state) in self.modes.iter().zip(&states) {
                let part = mode.at_stop / self.mass;
                let before = mode.load - part * force;
                free += mode.at_stop * mode.next(*state, [before, mode.load], dt)[0];
                slope += mode.at_stop * mode.next([0.0; 2], [0.0, part], dt)[0];
            }
            let after = (stiffness * (free - gap) / (1.0 + stiffness * slope)).max(0.0);
            for (mode, state) in self.modes.iter().zip(&mut states) {
                let part = mode.at_stop / self.mass;
                let loads = [force, after].map(|force| mode.load - part * force);
                *state = mode.next(*state, loads, dt);
            }
            force = after;
            forces.push(force);
        }
        forces
    }
}

impl Mode {
    /// q and q̇ after a step under a force per mass that goes linearly from one value to another.
    fn next(&self, [q, v]: [f64; 2], [from, to]: [f64; 2], dt: f64) -> [f64; 2] {
        let omega = self.frequency;
        let (sin, cos) = (omega * dt).sin_cos();
        let square = omega * omega;
        let rate = (to - from) / (dt * square);
        let (about, speed) = (q - from / square, v - rate);
        [
            to / square + about * cos + speed / omega * sin,
            rate - about * omega * sin + speed * cos,
        ]
    }
}

/// The root β L of `cos cosh = -1` with this number, from 0.
fn clamped_free(n: usize) -> f64 {
    // cos + 1/cosh has the same roots, and does not overflow
    let value = |x: f64| x.cos() + 1.0 / x.cosh();
    let middle = (n as f64 + 0.5) * PI;
    let (mut low, mut high) = (middle - 0.5 * PI, middle + 0.5 * PI);
    let sign = value(low);
    for _ in 0..100 {
        let x = 0.5 * (low + high);
        match sign * value(x) > 0.0 {
            true => low = x,
            false => high = x,
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without a stop in reach a mode swings about its static deflection; with all modes that is a L⁴ m/(8 E I).
    #[test]
    fn the_mean_deflection_of_the_tip_is_the_static_one() {
        let beam = BeamOnStop::cantilever([2.0, 3.0, 1.5], 7.0, [1.0, 1e9], 200);
        let statics: f64 = beam
            .modes
            .iter()
            .map(|mode| mode.at_stop * mode.load / mode.frequency.powi(2))
            .sum();
        let exact = 7.0 * 3.0 * 1.5_f64.powi(4) / (8.0 * 2.0);
        assert!((statics / exact - 1.0).abs() < 1e-9, "{statics} {exact}");
        let middle = BeamOnStop::simply_supported([2.0, 3.0, 1.5], 7.0, [1.0, 1e9], 200);
        let statics: f64 = middle
            .modes
            .iter()
            .map(|mode| mode.at_stop * mode.load / mode.frequency.powi(2))
            .sum();
        let exact = 5.0 * 7.0 * 3.0 * 1.5_f64.powi(4) / (384.0 * 2.0);
        assert!((statics / exact - 1.0).abs() < 1e-9, "{statics} {exact}");
    }

    /// One mode and a stop at distance zero: an oscillator of stiffness ω² + k φ²/(m L) while it is closed.
    #[test]
    fn one_mode_against_the_stop_is_an_oscillator() {
        let mut beam = BeamOnStop::cantilever([2.0, 3.0, 1.5], 7.0, [50.0, 0.0], 1);
        let (mode, mass) = (beam.modes[0], beam.mass);
        beam.stop[1] = 0.0;
        let together = mode.frequency.powi(2) + 50.0 * 4.0 / mass;
        let period = 2.0 * PI / together.sqrt();
        let steps = 2000;
        let forces = beam.forces(0.5 * period / steps as f64, steps);
        // twice the static deflection of the tip, times k
        let exact = 50.0 * 2.0 * 2.0 * mode.load / together;
        let peak = forces.iter().copied().fold(0.0, f64::max);
        assert!((peak / exact - 1.0).abs() < 1e-5, "{peak} {exact}");
    }
}
