//! A quantity as a function of time.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::Error;

/// A quantity as a function of time: a polynomial of third degree at most between its knots, constant before the first.
/// Most are straight between their points and constant after the last; the displacement that belongs to a record of
/// accelerations is of third degree, and goes on with the last velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplitude {
    knots: Vec<Knot>,
    /// Where it is not known before.
    held: Option<Held>,
}

/// A number that is set while a run goes on, between its steps: that of a controller. Its copies are the same number.
#[derive(Clone, Debug, Default)]
pub struct Held(Arc<AtomicU64>);

impl Held {
    /// Zero at first.
    pub fn new() -> Held {
        Held::default()
    }

    /// Sets it for the steps to come.
    pub fn set(&self, value: f64) {
        self.0.store(value.to_bits(), Ordering::Relaxed);
    }

    /// The number.
    pub fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// Copies of one number are equal, whatever it is now.
impl PartialEq for Held {
    fn eq(&self, other: &Held) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The polynomial from a time on: c₀ + c₁ s + c₂ s² + c₃ s³ with s the time since the knot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Knot {
    pub(crate) time: f64,
    pub(crate) c: [f64; 4],
}

impl Amplitude {
    /// The same value at all times.
    pub fn constant(value: f64) -> Amplitude {
        let c = [value, 0.0, 0.0, 0.0];
        Amplitude {
            knots: vec![Knot { time: 0.0, c }],
            held: None,
        }
    }

    /// What is set between the steps: constant over each of them. It is what it is now at all times, so that a step must be taken
    /// before the next value is set.
    pub fn held(held: &Held) -> Amplitude {
        Amplitude {
            knots: Vec::new(),
            held: Some(held.clone()),
        }
    }

    /// Straight between points (time in s, value), constant before the first and after the last.
    ///
    /// # Errors
    /// No point, a time that does not ascend, a number that is not finite.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Amplitude, Error> {
        check(&points)?;
        let slope = |k: usize| match points.get(k + 1) {
            Some(next) => (next[1] - points[k][1]) / (next[0] - points[k][0]),
            None => 0.0,
        };
        let knot = |k: usize| Knot {
            time: points[k][0],
            c: [points[k][1], slope(k), 0.0, 0.0],
        };
        Ok(Amplitude {
            knots: (0..points.len()).map(knot).collect(),
            held: None,
        })
    }

    /// Of knots with ascending times; not empty.
    pub(crate) fn of_knots(knots: Vec<Knot>) -> Amplitude {
        Amplitude { knots, held: None }
    }

    /// Value at a time in s.
    pub fn at(&self, time: f64) -> f64 {
        if let Some(held) = &self.held {
            return held.get();
        }
        self.eval(time, |c, s| c[0] + s * (c[1] + s * (c[2] + s * c[3])))
    }

    /// Derivative at a time in s; at a knot that of what follows.
    pub fn rate(&self, time: f64) -> f64 {
        let before = self.knots.first().is_some_and(|first| time < first.time);
        match before {
            true => 0.0,
            false => self.eval(time, |c, s| c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])),
        }
    }

    fn eval(&self, time: f64, of: impl Fn(&[f64; 4], f64) -> f64) -> f64 {
        let after = self.knots.partition_point(|knot| knot.time <= time);
        let knot = self.knots.get(after.saturating_sub(1));
        knot.map_or(0.0, |knot| of(&knot.c, (time - knot.time).max(0.0)))
    }

    /// Whether it is the same at all times.
    pub fn is_constant(&self) -> bool {
        if self.held.is_some() {
            return false;
        }
        let first = self.knots.first().map_or(0.0, |knot| knot.c[0]);
        let mut knots = self.knots.iter();
        knots.all(|knot| knot.c == [first, 0.0, 0.0, 0.0])
    }

    /// Times between which it is one polynomial, s, ascending.
    pub fn knots(&self) -> impl Iterator<Item = f64> + '_ {
        self.knots.iter().map(|knot| knot.time)
    }

    /// Times of the first and of the last knot, s.
    pub fn span(&self) -> [f64; 2] {
        let time = |knot: Option<&Knot>| knot.map_or(0.0, |knot| knot.time);
        [time(self.knots.first()), time(self.knots.last())]
    }
}

/// Whether points are those of a function of time.
pub(crate) fn check(points: &[[f64; 2]]) -> Result<(), Error> {
    if points.is_empty() {
        return Err(Error::Empty);
    }
    let finite = |point: &[f64; 2]| point.iter().all(|number| number.is_finite());
    if let Some(at) = points.iter().position(|point| !finite(point)) {
        return Err(Error::NotFinite { at });
    }
    match (1..points.len()).find(|&at| points[at][0] <= points[at - 1][0]) {
        None => Ok(()),
        Some(at) => Err(Error::Times {
            at,
            time: points[at][0],
            before: points[at - 1][0],
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amplitude_is_straight_between_its_points_and_constant_outside() {
        let ramp = Amplitude::new(vec![[1.0, 0.0], [2.0, 4.0], [4.0, 2.0]]).unwrap();
        for (time, value) in [(0.0, 0.0), (1.25, 1.0), (2.0, 4.0), (3.0, 3.0), (9.0, 2.0)] {
            assert_eq!(ramp.at(time), value);
        }
        assert_eq!(
            (ramp.rate(0.5), ramp.rate(1.5), ramp.rate(5.0)),
            (0.0, 4.0, 0.0)
        );
        assert_eq!(ramp.span(), [1.0, 4.0]);
        assert!(!ramp.is_constant());
        assert_eq!(Amplitude::new(vec![]), Err(Error::Empty));
        let twice = Amplitude::new(vec![[1.0, 0.0], [1.0, 1.0]]);
        assert!(matches!(twice, Err(Error::Times { at: 1, .. })));
        let hole = Amplitude::new(vec![[1.0, 0.0], [2.0, f64::NAN]]);
        assert_eq!(hole, Err(Error::NotFinite { at: 1 }));
        assert_eq!(Amplitude::constant(3.0).at(-7.0), 3.0);
        assert!(Amplitude::constant(3.0).is_constant());
    }

    #[test]
    fn a_held_number_is_seen_by_all_copies_of_its_amplitude() {
        let held = Held::new();
        let amplitude = Amplitude::held(&held);
        let copy = amplitude.clone();
        assert_eq!((amplitude.at(0.0), amplitude.is_constant()), (0.0, false));
        held.set(-2.5);
        assert_eq!(
            (amplitude.at(1.0), copy.at(7.0), held.get()),
            (-2.5, -2.5, -2.5)
        );
        assert_eq!(amplitude.rate(1.0), 0.0);
        assert_eq!(amplitude, copy);
        assert_ne!(amplitude, Amplitude::held(&Held::new()));
    }
}
