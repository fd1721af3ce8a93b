//! A force over an elongation or a rate, straight between points.

use thiserror::Error as ThisError;

/// A function F(x) that is straight between its points; the first and the last piece go on beyond them.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(Vec<[f64; 2]>);

/// Why points make no curve.
#[derive(Clone, Copy, Debug, PartialEq, ThisError)]
pub enum CurveError {
    /// Fewer than two.
    #[error("a curve has two points at least")]
    TooFew,
    /// A number that is not finite.
    #[error("point {point} of the curve has a number that is not finite")]
    NotFinite {
        /// Its number, from 1.
        point: usize,
    },
    /// A point that is not to the right of the one before it.
    #[error(
        "point {point} of the curve is at {found:e}, not above {before:e}: the points must ascend"
    )]
    NotAscending {
        /// Its number, from 1.
        point: usize,
        /// Its x.
        found: f64,
        /// That of the point before it.
        before: f64,
    },
}

impl Curve {
    /// The curve through points (x, F), x ascending.
    ///
    /// # Errors
    /// Fewer than two points, numbers that are not finite, an x that does not ascend.
    pub fn new(points: Vec<[f64; 2]>) -> Result<Curve, CurveError> {
        if points.len() < 2 {
            return Err(CurveError::TooFew);
        }
        if let Some(k) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(CurveError::NotFinite { point: k + 1 });
        }
        for (k, pair) in points.windows(2).enumerate() {
            let [before, found] = [pair[0][0], pair[1][0]];
            if found <= before {
                return Err(CurveError::NotAscending {
                    point: k + 2,
                    found,
                    before,
                });
            }
        }
        Ok(Curve(points))
    }

    /// The straight line F = slope x.
    pub fn line(slope: f64) -> Curve {
        Curve(vec![[0.0, 0.0], [1.0, slope]])
    }

    /// The points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Whether it is one straight line through (0, 0).
    pub fn is_line(&self) -> bool {
        match self.0[..] {
            [[x, f], _] => f - self.slope(x) * x == 0.0,
            _ => false,
        }
    }

    /// F(x).
    pub fn value(&self, x: f64) -> f64 {
        self.on(self.piece(x), x)
    }

    /// dF/dx; at a point that of the piece before it.
    pub fn slope(&self, x: f64) -> f64 {
        self.slope_of(self.piece(x))
    }

    /// The largest |dF/dx|.
    pub fn steepest(&self) -> f64 {
        let slopes = (0..self.0.len() - 1).map(|piece| self.slope_of(piece).abs());
        slopes.fold(0.0, f64::max)
    }

    /// ∫ F dx from 0 to x, without loss of digits.
    pub fn integral(&self, x: f64) -> f64 {
        self.between(0.0, x)
    }

    /// Mean of F from one x to another, and its derivative by the other: what conserves ∫ F dx between the two. F and half
    /// its slope where both are the same.
    pub fn mean(&self, from: f64, to: f64) -> (f64, f64) {
        let piece = self.piece(to);
        if self.piece(from) == piece {
            return (
                self.on(piece, 0.5 * (from + to)),
                0.5 * self.slope_of(piece),
            );
        }
        let mean = self.between(from, to) / (to - from);
        (mean, (self.value(to) - mean) / (to - from))
    }

    /// ∫ F dx between two places, piece by piece.
    fn between(&self, from: f64, to: f64) -> f64 {
        if to < from {
            return -self.between(to, from);
        }
        let (first, last) = (self.piece(from), self.piece(to));
        let part = |piece: usize| {
            let start = if piece == first {
                from
            } else {
                self.0[piece][0]
            };
            let end = if piece == last {
                to
            } else {
                self.0[piece + 1][0]
            };
            self.on(piece, 0.5 * (start + end)) * (end - start)
        };
        (first..=last).map(part).sum()
    }

    /// The piece that x is in, the first and the last one going on.
    fn piece(&self, x: f64) -> usize {
        let inner = &self.0[1..self.0.len() - 1];
        inner.partition_point(|point| point[0] < x)
    }

    fn slope_of(&self, piece: usize) -> f64 {
        let ([x0, f0], [x1, f1]) = (self.0[piece], self.0[piece + 1]);
        (f1 - f0) / (x1 - x0)
    }

    fn on(&self, piece: usize, x: f64) -> f64 {
        let [start, value] = self.0[piece];
        value + self.slope_of(piece) * (x - start)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> Curve {
        Curve::new(vec![[-2.0, -7.0], [-1.0, 0.0], [0.5, 0.0], [2.0, 3.0]]).unwrap()
    }

    #[test]
    fn a_curve_is_straight_between_its_points_and_beyond_them() {
        for (x, value, slope) in [
            (-3.0, -14.0, 7.0),
            (-1.5, -3.5, 7.0),
            (0.0, 0.0, 0.0),
            (1.25, 1.5, 2.0),
            (3.0, 5.0, 2.0),
        ] {
            assert_eq!((curve().value(x), curve().slope(x)), (value, slope));
        }
        assert_eq!(curve().steepest(), 7.0);
        assert!(Curve::line(3.0).is_line() && !curve().is_line());
        assert!(!Curve::new(vec![[0.0, 1.0], [1.0, 2.0]]).unwrap().is_line());
    }

    #[test]
    fn the_integral_is_that_of_the_pieces() {
        // from 0 back to -2: a triangle of 1 x 7; to 3: triangles and a trapezoid, 1.5 x 3 / 2 + 4
        assert_eq!(curve().integral(-2.0), 3.5);
        assert_eq!(curve().integral(3.0), 2.25 + 4.0);
    }

    #[test]
    fn the_mean_conserves_the_integral_and_has_its_derivative() {
        let curve = curve();
        for (from, to) in [(-2.5, 2.5), (0.7, 1.9), (2.5, -1.5), (0.1, 0.1)] {
            let (mean, by_end) = curve.mean(from, to);
            let change = curve.integral(to) - curve.integral(from);
            assert!((mean * (to - from) - change).abs() < 1e-14, "{from} {to}");
            let step = 1e-6;
            let ahead = [to - step, to + step].map(|to| curve.mean(from, to).0);
            let found = (ahead[1] - ahead[0]) / (2.0 * step);
            assert!((found - by_end).abs() < 1e-8, "{from} {to}: {found}");
        }
    }

    #[test]
    fn points_that_make_no_curve_are_refused() {
        let none = Curve::new(vec![[0.0, 0.0]]);
        assert_eq!(none, Err(CurveError::TooFew));
        let back = Curve::new(vec![[0.0, 0.0], [0.0, 1.0]]);
        assert!(matches!(
            back,
            Err(CurveError::NotAscending { point: 2, .. })
        ));
        let lost = Curve::new(vec![[0.0, 0.0], [1.0, f64::NAN]]);
        assert_eq!(lost, Err(CurveError::NotFinite { point: 2 }));
    }
}
