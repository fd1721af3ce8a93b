//! Curves of force over penetration, linear in pieces.

use serde::{Deserialize, Serialize};

/// Most points of a curve.
pub const MOST_CURVE_POINTS: usize = 16;

/// Force over penetration of a whole contact, linear in pieces from (0, 0) through points of increasing penetration whose forces
/// do not fall, the first above zero; beyond the last point the last piece goes on. A fixed array, so that laws stay plain values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct Curve {
    points: [[f64; 2]; MOST_CURVE_POINTS],
    pieces: u16,
}

/// Why points make no curve.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// No point, or too many.
    #[error("a curve of {points} points: it has 1 to {MOST_CURVE_POINTS}")]
    Count {
        /// How many there are.
        points: usize,
    },
    /// A piece along which a permanent crush would give back more than it took.
    #[error(
        "the curve rises by {stiffness:e} N/m to point {point}; with a permanent crush at most by the {first:e} N/m of its beginning"
    )]
    TooSteep {
        /// The point at its end, from 1.
        point: usize,
        /// Its stiffness, N/m.
        stiffness: f64,
        /// That of the first piece, N/m.
        first: f64,
    },
    /// A point that is not beyond the one before it in penetration, or below it in force; the first one not above (0, 0).
    #[error(
        "point {point} of the curve, {found:?} m and N, does not follow {before:?}: penetrations must increase, and forces not fall, from more than zero on"
    )]
    NotIncreasing {
        /// Its number, from 1.
        point: usize,
        /// The point.
        found: [f64; 2],
        /// The point before it.
        before: [f64; 2],
    },
}

impl Curve {
    /// A curve through (0, 0) and these points: penetration in m, force of the whole contact in N.
    ///
    /// # Errors
    /// No point or more than [`MOST_CURVE_POINTS`]; penetrations that do not increase, forces that fall, a first one of zero.
    pub fn new(points: &[[f64; 2]]) -> Result<Curve, CurveError> {
        let count = points.len();
        if count == 0 || count > MOST_CURVE_POINTS {
            return Err(CurveError::Count { points: count });
        }
        let mut curve = Curve {
            points: [[0.0; 2]; MOST_CURVE_POINTS],
            pieces: count as u16,
        };
        let mut before = [0.0; 2];
        for (k, &found) in points.iter().enumerate() {
            // along a plateau the force is what it is whatever the penetration; the first piece says how stiff the stop is
            let rises = match k {
                0 => found[1] > 0.0,
                _ => found[1] >= before[1],
            };
            if !(found[0] > before[0] && rises) {
                return Err(CurveError::NotIncreasing {
                    point: k + 1,
                    found,
                    before,
                });
            }
            curve.points[k] = found;
            before = found;
        }
        Ok(curve)
    }

    /// Force at a penetration in m, N; zero where it is negative.
    pub fn force(&self, penetration: f64) -> f64 {
        let piece = self.piece(penetration);
        let [start, force] = self.start(piece);
        force + self.stiffness(piece) * (penetration.max(0.0) - start)
    }

    /// ∫ F dδ from 0 to a penetration in m, J.
    pub fn energy(&self, penetration: f64) -> f64 {
        let last = self.piece(penetration);
        let whole: f64 = (0..last)
            .map(|piece| {
                let ([x0, f0], [x1, f1]) = (self.start(piece), self.points[piece as usize]);
                0.5 * (f0 + f1) * (x1 - x0)
            })
            .sum();
        let [start, force] = self.start(last);
        whole + 0.5 * (force + self.force(penetration)) * (penetration.max(0.0) - start)
    }

    /// The number, from 1, of the first point to which the curve rises more steeply than to its first one.
    pub fn first_steeper(&self) -> Option<usize> {
        let steeper = |piece: &u16| self.stiffness(*piece) > self.stiffness(0);
        (1..self.pieces)
            .find(steeper)
            .map(|piece| usize::from(piece) + 1)
    }

    /// That the piece which ends at this point, from 1, is steeper than the first.
    pub(crate) fn too_steep(&self, point: usize) -> CurveError {
        CurveError::TooSteep {
            point,
            stiffness: self.stiffness(point as u16 - 1),
            first: self.stiffness(0),
        }
    }

    /// How many pieces there are.
    pub(crate) fn pieces(&self) -> u16 {
        self.pieces
    }

    /// The piece that holds a penetration.
    pub(crate) fn piece(&self, penetration: f64) -> u16 {
        let inner = &self.points[..self.pieces as usize - 1];
        inner.partition_point(|point| point[0] < penetration) as u16
    }

    /// First point of a piece.
    pub(crate) fn start(&self, piece: u16) -> [f64; 2] {
        match piece {
            0 => [0.0; 2],
            _ => self.points[piece as usize - 1],
        }
    }

    /// Slope of a piece, N/m.
    pub(crate) fn stiffness(&self, piece: u16) -> f64 {
        let ([x0, f0], [x1, f1]) = (self.start(piece), self.points[piece as usize]);
        (f1 - f0) / (x1 - x0)
    }

    /// The piece with the greatest slope.
    pub(crate) fn stiffest(&self) -> u16 {
        let steeper = |best, piece| {
            if self.stiffness(piece) > self.stiffness(best) {
                piece
            } else {
                best
            }
        };
        (1..self.pieces).fold(0, steeper)
    }
}

impl TryFrom<Vec<[f64; 2]>> for Curve {
    type Error = CurveError;

    fn try_from(points: Vec<[f64; 2]>) -> Result<Curve, CurveError> {
        Curve::new(&points)
    }
}

impl From<Curve> for Vec<[f64; 2]> {
    fn from(curve: Curve) -> Vec<[f64; 2]> {
        curve.points[..usize::from(curve.pieces)].to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 2]; 3] = [[1.0, 10.0], [2.0, 11.0], [3.0, 31.0]];

    fn curve() -> Curve {
        Curve::new(&POINTS).unwrap()
    }

    #[test]
    fn curve_goes_through_its_points_and_on() {
        let curve = curve();
        for [penetration, force] in POINTS {
            assert_eq!(curve.force(penetration), force);
        }
        assert_eq!(curve.force(-1.0), 0.0);
        assert_eq!(curve.force(0.5), 5.0);
        assert_eq!(curve.force(1.5), 10.5);
        assert_eq!(curve.force(4.0), 51.0);
    }

    #[test]
    fn points_that_make_no_curve_are_told() {
        assert_eq!(Curve::new(&[]), Err(CurveError::Count { points: 0 }));
        let many: Vec<[f64; 2]> = (1..=17).map(|k| [k as f64; 2]).collect();
        assert_eq!(Curve::new(&many), Err(CurveError::Count { points: 17 }));
        assert!(Curve::new(&many[..16]).is_ok());
        for bad in [[2.0, 9.999], [1.0, 11.0], [f64::NAN, 11.0], [2.0, f64::NAN]] {
            let points = [[1.0, 10.0], bad];
            assert!(matches!(
                Curve::new(&points),
                Err(CurveError::NotIncreasing { point: 2, .. })
            ));
        }
        assert!(matches!(
            Curve::new(&[[1.0, 0.0], [2.0, 1.0]]),
            Err(CurveError::NotIncreasing { point: 1, .. })
        ));
    }

    #[test]
    fn a_plateau_has_one_force_and_goes_on() {
        let curve = Curve::new(&[[1.0, 10.0], [3.0, 10.0]]).unwrap();
        for penetration in [1.0, 2.0, 3.0, 30.0] {
            assert_eq!(curve.force(penetration), 10.0);
            assert_eq!(curve.energy(penetration), 5.0 + 10.0 * (penetration - 1.0));
        }
        assert_eq!(curve.first_steeper(), None);
    }

    #[test]
    fn energy_is_the_area_under_the_curve() {
        let curve = curve();
        assert_eq!(curve.energy(-1.0), 0.0);
        assert_eq!(curve.energy(0.5), 1.25);
        assert_eq!(curve.energy(1.0), 5.0);
        assert_eq!(curve.energy(2.0), 15.5);
        assert_eq!(curve.energy(4.0), 36.5 + 41.0);
    }

    #[test]
    fn the_first_point_beyond_a_steeper_piece_is_told() {
        assert_eq!(curve().first_steeper(), Some(3));
        assert_eq!(Curve::new(&POINTS[..2]).unwrap().first_steeper(), None);
    }
}
