//! A linear oscillator under a record of base acceleration, exactly.

use crate::record::Record;

/// A damped oscillator, ü + 2 ξ ω u̇ + ω² u = -a(t), with u relative to its base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// Circular frequency ω, rad/s; greater than zero.
    pub omega: f64,
    /// Damping ratio ξ, below 1.
    pub damping: f64,
}

/// Motion of an oscillator at one time, relative to its base.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Displacement, m.
    pub u: f64,
    /// Velocity, m/s.
    pub v: f64,
}

impl Oscillator {
    /// The motion a time `h` (s) later under the base acceleration `a` (m/s²) that changes at the constant rate `slope`
    /// (m/s³): the exact solution u = A + B t + e^(-ξωt) (C cos ω_d t + D sin ω_d t) with ω_d = ω √(1 - ξ²), of Nigam and
    /// Jennings (1969).
    pub fn after(&self, start: Response, h: f64, [a, slope]: [f64; 2]) -> Response {
        let (w, xi) = (self.omega, self.damping);
        let wd = w * (1.0 - xi * xi).sqrt();
        let rate = -slope / (w * w);
        let mean = (-a - 2.0 * xi * w * rate) / (w * w);
        let c = start.u - mean;
        let d = (start.v - rate + xi * w * c) / wd;
        let (sin, cos) = (wd * h).sin_cos();
        let decay = (-xi * w * h).exp();
        Response {
            u: mean + rate * h + decay * (c * cos + d * sin),
            v: rate + decay * ((wd * d - xi * w * c) * cos - (wd * c + xi * w * d) * sin),
        }
    }

    /// Absolute acceleration of a motion, -(2 ξ ω u̇ + ω² u), m/s².
    pub fn acceleration(&self, at: Response) -> f64 {
        -(2.0 * self.damping * self.omega * at.v + self.omega * self.omega * at.u)
    }

    /// The motion at the points of a record, from rest at the first.
    pub fn response(&self, record: &Record) -> Vec<Response> {
        let mut now = Response::default();
        let mut advance = Advance::new(*self);
        let mut all = vec![now];
        for pair in record.points().windows(2) {
            let [[t0, a0], [t1, a1]] = [pair[0], pair[1]];
            now = advance.after(now, t1 - t0, [a0, (a1 - a0) / (t1 - t0)]);
            all.push(now);
        }
        all
    }
}

/// Part of a step within which another one counts as the same: rounding of the times of equal steps.
const SAME: f64 = 1e-10;

/// [`Oscillator::after`], which is linear in motion and acceleration, over many equal steps: its coefficients are computed once. A record of
/// duration T is thereby off by 1e-10 T at most.
#[derive(Clone, Debug)]
pub(crate) struct Advance {
    of: Oscillator,
    h: f64,
    /// What u, v, the acceleration and its slope, each 1, give after the step.
    parts: [Response; 4],
}

impl Advance {
    pub(crate) fn new(of: Oscillator) -> Advance {
        Advance {
            of,
            h: 0.0,
            parts: [Response::default(); 4],
        }
    }

    /// The motion a time `h` (s) later.
    pub(crate) fn after(&mut self, start: Response, h: f64, [a, slope]: [f64; 2]) -> Response {
        if (h - self.h).abs() > SAME * self.h {
            let unit = |k: usize| [0, 1, 2, 3].map(|i| if i == k { 1.0 } else { 0.0 });
            self.parts = [0, 1, 2, 3].map(|k| {
                let [u, v, a, slope] = unit(k);
                self.of.after(Response { u, v }, h, [a, slope])
            });
            self.h = h;
        }
        let values = [start.u, start.v, a, slope];
        let sum = |of: fn(&Response) -> f64| {
            let terms = self.parts.iter().zip(values);
            terms.map(|(part, x)| of(part) * x).sum()
        };
        Response {
            u: sum(|part| part.u),
            v: sum(|part| part.v),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: Oscillator = Oscillator {
        omega: 12.0,
        damping: 0.05,
    };

    #[test]
    fn the_motion_obeys_the_equation() {
        let start = Response { u: 0.3, v: -1.1 };
        let load = [2.0, 7.0];
        let h = 1e-4;
        for k in 1..30 {
            let t = 0.03 * f64::from(k);
            let [before, now, after] = [t - h, t, t + h].map(|t| ONE.after(start, t, load));
            let second = (after.v - before.v) / (2.0 * h);
            let base = load[0] + load[1] * t;
            // central difference: ω³ h²/6 of the velocity, 3e-6 of 1 m/s
            assert!((second + base - ONE.acceleration(now)).abs() < 1e-4);
            assert!(((after.u - before.u) / (2.0 * h) - now.v).abs() < 1e-5);
        }
        assert_eq!(ONE.after(start, 0.0, load), Response { u: 0.3, v: -1.1 });
    }

    #[test]
    fn two_half_steps_are_one() {
        let start = Response { u: 0.3, v: -1.1 };
        let whole = ONE.after(start, 0.2, [2.0, 7.0]);
        let halves = ONE.after(ONE.after(start, 0.1, [2.0, 7.0]), 0.1, [2.7, 7.0]);
        assert!((whole.u - halves.u).abs() < 1e-15 && (whole.v - halves.v).abs() < 1e-14);
    }

    #[test]
    fn a_step_of_acceleration_swings_to_twice_the_static_displacement() {
        let free = Oscillator {
            omega: 2.0,
            damping: 0.0,
        };
        let half = std::f64::consts::PI / 2.0;
        let far = free.after(Response::default(), half, [4.0, 0.0]);
        // -2 a/ω²
        assert!((far.u + 2.0).abs() < 1e-15 && far.v.abs() < 1e-15);
    }
}
