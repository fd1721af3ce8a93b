//! Records of accelerations: values at times, straight between them, zero outside.

use crate::amplitude::{Amplitude, Knot, check};
use crate::error::Error;

/// Accelerations at ascending times, straight between them. Before the first and after the last time the acceleration is
/// zero: the ground is at rest before, and goes on with its last velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    points: Vec<[f64; 2]>,
}

/// The shortest and the longest step between the times of a record, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steps {
    /// The shortest.
    pub shortest: f64,
    /// The longest.
    pub longest: f64,
}

/// A sum with the rounding errors added apart (Neumaier 1974).
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let total = self.sum + term;
        self.lost += match self.sum.abs() >= term.abs() {
            true => (self.sum - total) + term,
            false => (term - total) + self.sum,
        };
        self.sum = total;
    }

    fn value(self) -> f64 {
        self.sum + self.lost
    }
}

impl Record {
    /// Points (time in s, acceleration in m/s²).
    ///
    /// # Errors
    /// Fewer than two points, times that do not ascend, numbers that are not finite.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Record, Error> {
        check(&points)?;
        match points.len() {
            1 => Err(Error::NoDuration),
            _ => Ok(Record { points }),
        }
    }

    /// The points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Time from the first to the last point, s.
    pub fn duration(&self) -> f64 {
        self.points[self.points.len() - 1][0] - self.points[0][0]
    }

    /// The shortest and the longest step.
    pub fn steps(&self) -> Steps {
        let steps = self.points.windows(2).map(|pair| pair[1][0] - pair[0][0]);
        let none = Steps {
            shortest: f64::INFINITY,
            longest: 0.0,
        };
        steps.fold(none, |found, step| Steps {
            shortest: found.shortest.min(step),
            longest: found.longest.max(step),
        })
    }

    /// Largest absolute acceleration, m/s².
    pub fn peak(&self) -> f64 {
        let sizes = self.points.iter().map(|point| point[1].abs());
        sizes.fold(0.0, f64::max)
    }

    /// The record times a factor, and later by `delay` (s).
    pub fn moved(&self, factor: f64, delay: f64) -> Record {
        let moved = |point: &[f64; 2]| [point[0] + delay, factor * point[1]];
        Record {
            points: self.points.iter().map(moved).collect(),
        }
    }

    /// The same function at equal steps, the last one no longer than `step` (s): resampled by straight lines.
    ///
    /// # Errors
    /// As [`Record::new`], for a step that is not positive.
    pub fn resampled(&self, step: f64) -> Result<Record, Error> {
        let start = self.points[0][0];
        let count = (self.duration() / step).ceil();
        let straight = Amplitude::new(self.points.clone())?;
        let at = |k: usize| {
            let time = (start + k as f64 * step).min(start + self.duration());
            [time, straight.at(time)]
        };
        Record::new((0..=count as usize).map(at).collect())
    }

    /// Acceleration as a function of time: straight between the points, zero before the first and after the last. Where the
    /// record does not begin or end with zero, it jumps there.
    pub fn acceleration(&self) -> Amplitude {
        let mut knots = Vec::with_capacity(self.points.len() + 1);
        let [first, last] = [self.points[0], self.points[self.points.len() - 1]];
        if first[1] != 0.0 {
            // zero before the first point: an amplitude is constant before its first knot
            let time = first[0] - self.duration();
            knots.push(Knot { time, c: [0.0; 4] });
        }
        for pair in self.points.windows(2) {
            let slope = (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0]);
            knots.push(Knot {
                time: pair[0][0],
                c: [pair[0][1], slope, 0.0, 0.0],
            });
        }
        let end = [last[1], 0.0, 0.0, 0.0];
        knots.push(Knot {
            time: last[0],
            c: end,
        });
        if last[1] != 0.0 {
            knots.push(Knot {
                time: last[0].next_up(),
                c: [0.0; 4],
            });
        }
        Amplitude::of_knots(knots)
    }

    /// Velocity (m/s) and displacement (m) at the points, from rest at the first: the integrals of the straight pieces,
    /// v₊ = v + h (a + a₊)/2, u₊ = u + h v + h² (2 a + a₊)/6, summed with compensation.
    pub fn integrals(&self) -> Vec<[f64; 2]> {
        let (mut v, mut u) = (Sum::default(), Sum::default());
        let mut all = Vec::with_capacity(self.points.len());
        all.push([0.0; 2]);
        for pair in self.points.windows(2) {
            let [[t0, a0], [t1, a1]] = [pair[0], pair[1]];
            let h = t1 - t0;
            u.add(h * v.value());
            u.add(h * h * (2.0 * a0 + a1) / 6.0);
            v.add(0.5 * h * (a0 + a1));
            all.push([v.value(), u.value()]);
        }
        all
    }

    /// Velocity and displacement at the end, from rest at the start: the drift of the record.
    pub fn drift(&self) -> [f64; 2] {
        self.integrals().last().copied().unwrap_or([0.0; 2])
    }

    /// Displacement as a function of time, from rest at zero: the exact double integral, of third degree between the
    /// points; after the last it goes on with the last velocity.
    pub fn displacement(&self) -> Amplitude {
        let integrals = self.integrals();
        let knot = |(k, &[v, u]): (usize, &[f64; 2])| {
            let [time, a] = self.points[k];
            let c = match self.points.get(k + 1) {
                None => [u, v, 0.0, 0.0],
                Some(next) => {
                    let jerk = (next[1] - a) / (next[0] - time);
                    [u, v, 0.5 * a, jerk / 6.0]
                }
            };
            Knot { time, c }
        };
        Amplitude::of_knots(integrals.iter().enumerate().map(knot).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Record {
        let points = vec![[0.5, 0.0], [1.0, 2.0], [2.5, -1.0], [3.0, -1.0], [4.0, 0.0]];
        Record::new(points).unwrap()
    }

    #[test]
    fn the_second_derivative_of_the_displacement_is_the_acceleration() {
        let record = sample();
        let (u, a) = (record.displacement(), record.acceleration());
        let h = 1e-3;
        for k in 1..400 {
            let t = 0.4999 + 0.01 * f64::from(k);
            let second = (u.at(t + h) - 2.0 * u.at(t) + u.at(t - h)) / (h * h);
            // exact for a cubic; within h of a knot the slope of a changes by 6 at most, h/6 of which is seen
            assert!((second - a.at(t)).abs() < 2e-3, "{t}: {second} {}", a.at(t));
            let first = (u.at(t + h) - u.at(t - h)) / (2.0 * h);
            assert!((first - u.rate(t)).abs() < 1e-5);
        }
        assert_eq!(
            (u.at(0.2), u.rate(0.2), a.at(0.2), a.at(4.5)),
            (0.0, 0.0, 0.0, 0.0)
        );
    }

    #[test]
    fn integrals_are_those_of_the_straight_pieces() {
        // areas by hand: 1/2 · 2 · 0.5, then trapezoids
        let v: Vec<f64> = sample().integrals().iter().map(|i| i[0]).collect();
        assert_eq!(v, [0.0, 0.5, 1.25, 0.75, 0.25]);
        // a constant acceleration: u = a t²/2
        let even = Record::new(vec![[0.0, 3.0], [1.0, 3.0], [2.0, 3.0]]).unwrap();
        assert_eq!(even.drift(), [6.0, 6.0]);
        assert_eq!(even.acceleration().at(-1e-9), 0.0);
        assert_eq!(even.acceleration().at(0.0), 3.0);
        assert_eq!(even.acceleration().at(2.0), 3.0);
        assert_eq!(even.acceleration().at(2.0 + 1e-9), 0.0);
    }

    #[test]
    fn resampling_at_a_divisor_of_the_step_changes_no_integral() {
        let record = sample();
        let finer = record.resampled(0.125).unwrap();
        let [a, b] = [record.drift(), finer.drift()];
        assert!((a[0] - b[0]).abs() < 1e-14 && (a[1] - b[1]).abs() < 1e-14);
        assert_eq!(
            finer.steps(),
            Steps {
                shortest: 0.125,
                longest: 0.125
            }
        );
        assert_eq!(
            record.steps(),
            Steps {
                shortest: 0.5,
                longest: 1.5
            }
        );
    }

    #[test]
    fn a_record_without_duration_is_refused() {
        assert_eq!(Record::new(vec![[0.0, 1.0]]), Err(Error::NoDuration));
    }
}
