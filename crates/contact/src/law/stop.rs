//! The stop of engineering structures: a clearance, a curve of force over penetration, a dashpot.

use serde::{Deserialize, Serialize};

use super::damped::pressing;
use super::{Adhesion, ContactLaw, End, Level, Local, Relation, Status};

/// Most points of a curve.
pub const MOST_CURVE_POINTS: usize = 16;

/// Force over penetration of a whole contact, linear in pieces from (0, 0) through increasing points; beyond the last
/// point the last piece goes on. A fixed array, so that laws stay plain values.
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
    /// A point that is not above the one before it in penetration and in force, the first above (0, 0).
    #[error(
        "point {point} of the curve, {found:?} m and N, is not above {before:?}: penetration and force must increase"
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
    /// No point or more than [`MOST_CURVE_POINTS`]; points that do not increase.
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
            if !(found[0] > before[0] && found[1] > before[1]) {
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

    /// The piece that holds a penetration.
    fn piece(&self, penetration: f64) -> u16 {
        let inner = &self.points[..self.pieces as usize - 1];
        inner.partition_point(|point| point[0] < penetration) as u16
    }

    /// First point of a piece.
    fn start(&self, piece: u16) -> [f64; 2] {
        match piece {
            0 => [0.0; 2],
            _ => self.points[piece as usize - 1],
        }
    }

    /// Slope of a piece, N/m.
    fn stiffness(&self, piece: u16) -> f64 {
        let ([x0, f0], [x1, f1]) = (self.start(piece), self.points[piece as usize]);
        (f1 - f0) / (x1 - x0)
    }

    /// The piece with the greatest slope.
    fn stiffest(&self) -> u16 {
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

/// Stop: `P = share (F(δ) - C ġ₊)` where the penetration `δ = -(g₊ + j)` is positive, F a curve that is linear in
/// pieces, j the clearance. Elastic: unloading follows the same curve. As in the damped law a point whose damper leaves
/// it no sign takes the corner δ = 0.
///
/// Within a step a point first goes to the piece of its penetration, and to the next one towards it where that has not
/// settled: for one point the solution is always on that side, since force and compliance increase.
///
/// Source: the force-gap elements of structural codes; the pieces are solved as signs of a semi-smooth Newton method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// j in m, zero or more.
    pub clearance: f64,
    /// F, in N over m, of the whole contact.
    pub curve: Curve,
    /// C of the whole contact, N s/m.
    pub damping: f64,
    /// Whether tension is cut off.
    pub adhesion: Adhesion,
}

impl Stop {
    /// The piece after `now` for this penetration in m.
    fn piece(&self, now: Status, penetration: f64, reversals: u32) -> u16 {
        let wanted = self.curve.piece(penetration);
        match now {
            Status::Piece(piece) if reversals >= 3 => {
                wanted.clamp(piece.saturating_sub(1), piece + 1)
            }
            _ => wanted,
        }
    }
}

impl ContactLaw for Stop {
    fn name(&self) -> &'static str {
        "stop"
    }

    fn level(&self) -> Level {
        Level::GapAndRate
    }

    fn capture(&self) -> f64 {
        0.0
    }

    fn watches(&self, _gap: f64, _tolerance: f64) -> Option<bool> {
        None
    }

    fn relation(&self, status: Status, local: &Local) -> Relation {
        let piece = match status {
            Status::Corner => {
                return Relation {
                    offset: self.clearance,
                    ..Relation::GAP
                };
            }
            Status::Piece(piece) => piece.min(self.curve.pieces - 1),
            // where the piece is not known, the one that bounds the stiffness
            Status::Open | Status::Closed => self.curve.stiffest(),
        };
        let ([penetration, force], stiffness) =
            (self.curve.start(piece), self.curve.stiffness(piece));
        Relation {
            gap: local.share * stiffness,
            rate: local.share * self.damping,
            compliance: 1.0,
            offset: local.share * (stiffness * (self.clearance + penetration) - force),
        }
    }

    fn status(&self, now: Status, end: &End, _local: &Local, reversals: u32) -> Status {
        let end = End {
            gap: end.gap + self.clearance,
            gap_released: end.gap_released + self.clearance,
            ..*end
        };
        let piece = || Status::Piece(self.piece(now, -end.gap, reversals));
        if let Status::Closed | Status::Piece(1..) = now {
            // a piece that goes on below its start says nothing about opening: only the first one opens
            return piece();
        }
        // the way along the pieces is no cycle
        let cycles = self.damping > 0.0 && reversals as usize >= 3 + MOST_CURVE_POINTS;
        match pressing(now, &end, cycles) {
            Status::Closed => piece(),
            other => other,
        }
    }

    fn clips(&self) -> bool {
        self.adhesion == Adhesion::Clip
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const POINTS: [[f64; 2]; 3] = [[1.0, 10.0], [2.0, 11.0], [3.0, 31.0]];

    fn stop() -> Stop {
        Stop {
            clearance: 0.5,
            curve: Curve::new(&POINTS).unwrap(),
            damping: 0.0,
            adhesion: Adhesion::Clip,
        }
    }

    #[test]
    fn curve_goes_through_its_points_and_on() {
        let curve = stop().curve;
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
        for bad in [[2.0, 10.0], [1.0, 11.0], [f64::NAN, 11.0]] {
            let points = [[1.0, 10.0], bad];
            assert!(matches!(
                Curve::new(&points),
                Err(CurveError::NotIncreasing { point: 2, .. })
            ));
        }
    }

    #[test]
    fn the_relation_of_each_piece_is_its_part_of_the_curve() {
        let law = stop();
        let local = Local {
            share: 0.25,
            ..Local::default()
        };
        for (piece, penetration) in [(0, 0.3), (1, 1.7), (2, 2.5), (2, 8.0)] {
            let relation = law.relation(Status::Piece(piece), &local);
            let gap = -penetration - law.clearance;
            let force = -(relation.gap * gap + relation.offset) / relation.compliance;
            let expected = 0.25 * law.curve.force(penetration);
            assert!((force - expected).abs() < 1e-14, "{force} {expected}");
        }
        // the bound of the stiffness is the steepest piece
        assert_eq!(law.relation(Status::Closed, &local).gap, 0.25 * 20.0);
    }

    /// Scalar steps g₊ = g_f + d P: soft, stiff and soft again, where plain jumps between pieces go in circles.
    #[test]
    fn pieces_are_found_from_every_start() {
        let points = [[1.0, 0.1], [1.1, 100.0], [2.0, 100.1]];
        let law = Stop {
            curve: Curve::new(&points).unwrap(),
            ..stop()
        };
        let local = Local {
            share: 1.0,
            ..Local::default()
        };
        let d = 0.05;
        for k in 0..400 {
            let free = -0.05 * k as f64;
            for start in [
                Status::Open,
                Status::Piece(0),
                Status::Piece(1),
                Status::Piece(2),
            ] {
                let (mut status, mut passes) = (start, 0);
                let (force, gap) = loop {
                    let force = match status {
                        Status::Open => 0.0,
                        _ => {
                            let relation = law.relation(status, &local);
                            -(relation.gap * free + relation.offset)
                                / (relation.gap * d + relation.compliance)
                        }
                    };
                    let gap = free + d * force;
                    let end = End {
                        gap_released: free,
                        gap,
                        rate: 0.0,
                        force,
                    };
                    let next = law.status(status, &end, &local, passes);
                    if next == status {
                        break (force, gap);
                    }
                    status = next;
                    passes += 1;
                    assert!(passes < 20, "{free} {start:?}");
                };
                let expected = law.curve.force(-gap - law.clearance);
                assert!((force - expected).abs() < 1e-9 * (1.0 + expected));
            }
        }
    }
}
