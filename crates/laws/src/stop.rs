//! The stop of engineering structures: a clearance, a curve of force over penetration, a dashpot.

use carom_quantities::{Clearance, Damping, Force, Length};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::damped::pressing;
use crate::{
    Adhesion, ContactLaw, Curve, CurveError, Defaults, End, Level, Local, MOST_CURVE_POINTS,
    Relation, Status,
};

/// What becomes of the crush of a stop when it is unloaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "What becomes of the crush of a stop.")]
pub enum Crush {
    /// All of it is given back: unloading follows the curve.
    #[default]
    #[schemars(description = "Unloading follows the curve; all energy is recovered.")]
    Recovered,
    /// It stays but for the elastic part: unloading follows a line of the initial stiffness.
    #[schemars(
        description = "The crush is permanent: unloading and reloading follow a line of the initial stiffness from the point of largest penetration; beyond that point the force follows the curve again. No piece of the curve may be steeper than the first."
    )]
    Permanent,
}

/// Stop: `P = share (F(δ) - C ġ₊)` where the penetration `δ = -(g₊ + j)` is positive, F a curve that is linear in
/// pieces, j the clearance. As in the damped law a point whose damper leaves it no sign takes the corner δ = 0.
///
/// Where the crush is permanent, F has a memory δ_m, the largest penetration so far of the point. Below δ_m it is
/// `k₁ max(0, δ - δ_p)` with the stiffness k₁ of the first piece, `δ_p = δ_m - F(δ_m)/k₁` the crush that stays; beyond δ_m
/// the curve goes on. No piece may be steeper than the first ([`Curve::first_steeper`]): unloading would give more energy
/// than loading took. Lost for good is `∫₀^δ_m F dδ - F(δ_m)²/(2 k₁)`.
///
/// Within a step a point first goes to the piece of its penetration, and to the next one towards it where that has not
/// settled: for one point the solution is always on that side, since force and compliance increase. Status piece 0 is the
/// first piece of the curve, or the line below δ_m. A point on the curve goes down to that line only below δ_m by more
/// than the tolerance of gaps: where it rests at δ_m, rounding must not decide between two pieces that give the same force.
///
/// Source: the force-gap elements of structural codes, and elastic unloading as in the plasticity of a bar; the pieces are
/// solved as signs of a semi-smooth Newton method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// j in m, zero or more.
    pub clearance: f64,
    /// F, in N over m, of the whole contact.
    pub curve: Curve,
    /// Whether F has a memory.
    #[serde(default)]
    pub crush: Crush,
    /// C of the whole contact, N s/m.
    pub damping: f64,
    /// Whether tension is cut off.
    pub adhesion: Adhesion,
}

impl Stop {
    /// δ_p in m: where the force begins.
    fn permanent(&self, crush: f64) -> f64 {
        match self.curve.piece(crush) {
            0 => 0.0,
            _ => crush - self.curve.force(crush) / self.curve.stiffness(0),
        }
    }

    /// The piece after `now` for this penetration in m.
    fn piece(&self, now: Status, penetration: f64, local: &Local, reversals: u32) -> u16 {
        let slack = match now {
            Status::Piece(1..) => local.tolerance,
            _ => 0.0,
        };
        let wanted = match penetration <= local.crush - slack {
            true => 0,
            false => self.curve.piece(penetration),
        };
        // the pieces of the curve below the largest penetration are gone
        let first = self.curve.piece(local.crush);
        match now {
            Status::Piece(0) if reversals >= 3 => wanted.min(first.max(1)),
            Status::Piece(piece) if reversals >= 3 => {
                let below = if piece <= first { 0 } else { piece - 1 };
                wanted.clamp(below, piece + 1)
            }
            _ => wanted,
        }
    }
}

/// A point of the curve of a stop.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct CurvePoint {
    /// Penetration, beyond the clearance.
    pub penetration: Length,
    /// Force of the whole contact.
    pub force: Force,
}

/// The law as the case file gives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(
    description = "A stop, for the contact as a whole: its points share the force by their areas."
)]
pub struct GivenStop {
    /// Clearance that is not in the mesh: the stop acts where the gap is below minus this value. Default: 0.
    pub clearance: Option<Clearance>,
    /// Points of force over penetration; penetrations increase, forces do not fall. The curve begins at (0, 0), which is not
    /// written; it is linear between the points and continues beyond the last one. One point gives a spring, two of one force a
    /// plateau.
    #[schemars(extend("minItems" = 1, "maxItems" = MOST_CURVE_POINTS))]
    pub curve: Vec<CurvePoint>,
    /// Unloading of the stop.
    #[serde(default)]
    pub crush: Crush,
    /// Dashpot. Default: 0.
    pub damping: Option<Damping>,
    /// Treatment of a tensile force of the dashpot.
    #[serde(default)]
    pub adhesion: Adhesion,
}

impl GivenStop {
    /// The law with its defaults.
    ///
    /// # Errors
    /// A curve that falls, or that is too steep.
    pub fn law(&self, _defaults: &Defaults) -> Result<Stop, CurveError> {
        let points = self
            .curve
            .iter()
            .map(|point| [point.penetration.0, point.force.0]);
        let curve = Curve::new(&points.collect::<Vec<_>>())?;
        match (self.crush, curve.first_steeper()) {
            (Crush::Permanent, Some(point)) => Err(curve.too_steep(point)),
            _ => Ok(Stop {
                clearance: self.clearance.map_or(0.0, |clearance| clearance.0),
                curve,
                crush: self.crush,
                damping: self.damping.map_or(0.0, |damping| damping.0),
                adhesion: self.adhesion,
            }),
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

    fn reach(&self, _known: f64) -> Option<f64> {
        Some(1.0)
    }

    fn relation(&self, status: Status, local: &Local) -> Relation {
        let piece = match status {
            Status::Corner => {
                return Relation {
                    offset: self.clearance + self.permanent(local.crush),
                    ..Relation::GAP
                };
            }
            Status::Piece(piece) => piece.min(self.curve.pieces() - 1),
            // where the piece is not known, the one that bounds the stiffness
            Status::Open | Status::Closed => self.curve.stiffest(),
        };
        let [penetration, force] = match piece {
            0 => [self.permanent(local.crush), 0.0],
            _ => self.curve.start(piece),
        };
        let stiffness = self.curve.stiffness(piece);
        Relation {
            gap: local.share * stiffness,
            rate: local.share * self.damping,
            compliance: 1.0,
            offset: local.share * (stiffness * (self.clearance + penetration) - force),
        }
    }

    fn status(&self, now: Status, end: &End, local: &Local, reversals: u32) -> Status {
        let penetration = -(end.gap + self.clearance);
        let start = self.clearance + self.permanent(local.crush);
        let end = End {
            gap: end.gap + start,
            gap_released: end.gap_released + start,
            ..*end
        };
        let piece = || Status::Piece(self.piece(now, penetration, local, reversals));
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

    fn is_of_the_whole(&self) -> bool {
        true
    }

    fn is_function(&self) -> bool {
        self.damping == 0.0
    }

    fn crushed(&self, before: f64, gap: f64) -> f64 {
        match self.crush {
            Crush::Recovered => before,
            Crush::Permanent => before.max(-(gap + self.clearance)),
        }
    }

    fn crush_energy(&self, crush: f64) -> f64 {
        if self.crush == Crush::Recovered || self.curve.piece(crush) == 0 {
            return 0.0;
        }
        let force = self.curve.force(crush);
        self.curve.energy(crush) - 0.5 * force * force / self.curve.stiffness(0)
    }

    fn stays(&self, crush: f64) -> f64 {
        match self.crush {
            Crush::Recovered => 0.0,
            Crush::Permanent => self.permanent(crush),
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
            crush: Crush::Recovered,
            damping: 0.0,
            adhesion: Adhesion::Clip,
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
                let (force, gap) = solve(&law, &local, start, free, d);
                let expected = law.curve.force(-gap - law.clearance);
                assert!((force - expected).abs() < 1e-9 * (1.0 + expected));
            }
        }
    }

    #[test]
    fn a_plateau_is_found_from_every_start_and_left_along_the_initial_stiffness() {
        let law = Stop {
            curve: Curve::new(&[[1.0, 10.0], [3.0, 10.0], [4.0, 12.0]]).unwrap(),
            crush: Crush::Permanent,
            ..stop()
        };
        for crush in [0.0, 1.0, 2.0, 3.5] {
            let local = Local {
                share: 1.0,
                crush,
                ..Local::default()
            };
            for k in 0..300 {
                let free = -0.02 * f64::from(k);
                for start in [
                    Status::Open,
                    Status::Piece(0),
                    Status::Piece(1),
                    Status::Piece(2),
                ] {
                    let (force, gap) = solve(&law, &local, start, free, 0.05);
                    let penetration = -gap - law.clearance;
                    let expected = match penetration < crush {
                        true => (law.curve.force(crush) + 10.0 * (penetration - crush)).max(0.0),
                        false => law.curve.force(penetration),
                    };
                    assert!(
                        (force - expected).abs() < 1e-12 * (1.0 + expected),
                        "{crush} {free}"
                    );
                }
            }
        }
    }

    const CRUSHED: [[f64; 2]; 3] = [[1.0, 10.0], [2.0, 15.0], [4.0, 16.0]];

    fn crushed() -> Stop {
        Stop {
            curve: Curve::new(&CRUSHED).unwrap(),
            crush: Crush::Permanent,
            ..stop()
        }
    }

    /// Force and gap of a scalar step g₊ = g_f + d P.
    fn solve(law: &Stop, local: &Local, start: Status, free: f64, d: f64) -> (f64, f64) {
        let (mut status, mut passes) = (start, 0);
        loop {
            let force = match status {
                Status::Open => 0.0,
                _ => {
                    let relation = law.relation(status, local);
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
            let next = law.status(status, &end, local, passes);
            if next == status {
                return (force, gap);
            }
            (status, passes) = (next, passes + 1);
            assert!(passes < 20, "{free} {start:?}");
        }
    }

    #[test]
    fn a_crushed_stop_unloads_and_reloads_along_the_initial_stiffness_and_goes_on_along_the_curve()
    {
        let law = crushed();
        for crush in [0.0, 0.7, 1.4, 2.0, 3.0, 5.0] {
            let local = Local {
                share: 1.0,
                crush,
                ..Local::default()
            };
            let most = law.curve.force(crush);
            for k in 0..300 {
                let free = -0.05 * f64::from(k);
                for start in [
                    Status::Open,
                    Status::Piece(0),
                    Status::Piece(1),
                    Status::Piece(2),
                ] {
                    let (force, gap) = solve(&law, &local, start, free, 0.05);
                    let penetration = -gap - law.clearance;
                    let expected = match penetration < crush {
                        true => (most + 10.0 * (penetration - crush)).max(0.0),
                        false => law.curve.force(penetration),
                    };
                    assert!(
                        (force - expected).abs() < 1e-12 * (1.0 + expected),
                        "{crush} {free}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_a_cycle_loses_is_the_energy_of_the_crush() {
        let law = crushed();
        // the area between loading to 3 and unloading: 5 + 12.5 + 15.25, less 15.5² / 20
        assert_eq!(law.crushed(0.0, -3.5), 3.0);
        assert!((law.crush_energy(3.0) - (32.75 - 15.5 * 15.5 / 20.0)).abs() < 1e-13);
        // the line of unloading, of 10 N/m, meets no force 1.55 m before 3 m
        assert!((law.stays(3.0) - 1.45).abs() < 1e-14 && law.stays(0.0) == 0.0);
        assert_eq!(law.crushed(3.0, -1.0), 3.0);
        // the first piece is elastic
        assert_eq!(law.crush_energy(0.9), 0.0);
        assert_eq!(stop().crushed(0.0, -3.5), 0.0);
    }

    #[test]
    fn rounding_at_the_largest_penetration_turns_no_status() {
        let law = crushed();
        let local = Local {
            share: 1.0,
            crush: 1.5,
            tolerance: 1e-12,
            ..Local::default()
        };
        for shift in [-1e-15, 0.0, 1e-15] {
            let free = -(1.5 + law.clearance) - 0.05 * law.curve.force(1.5) + shift;
            for start in [Status::Piece(0), Status::Piece(1)] {
                let (force, _) = solve(&law, &local, start, free, 0.05);
                assert!((force - 12.5).abs() < 1e-12);
            }
        }
    }
}
