//! Contact laws: pure functions of the local state of one point.
//!
//! A law says (i) which points it watches, (ii) what holds at the end of the step in a point of given status,
//! `gap_factor g₊ + rate_factor ġ₊ + compliance P = 0`, or P = 0 if open, and (iii) which status the end state asks for.
//! The sign fields are these decisions: S_g for a law in the gap, S_d and S_v for a law in the rate. With the status
//! frozen all is linear; the interface problem repeats until no status changes.
//!
//! Adding a law: one file here, one variant of [`Law`], one arm of [`Law::get`].

mod damped;
mod displacement;
mod velocity;

use serde::{Deserialize, Serialize};

pub use damped::{Adhesion, Damped};
pub use displacement::Displacement;
pub use velocity::{Capture, Reading, Velocity};

/// Status of a contact point in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Status {
    /// No force.
    #[default]
    Open,
    /// The relation of the law holds.
    Closed,
    /// Between the two: g₊ = 0 with the force that this takes. Only laws whose force jumps with the status need it.
    Corner,
}

/// Which quantity at the end of the step a law constrains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The gap.
    Gap,
    /// The gap rate.
    Rate,
    /// Both, through a compliance.
    GapAndRate,
}

/// State of a point at the end of a trial step.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// Gap without any force in this point, all other forces standing, in m.
    pub gap_released: f64,
    /// Gap g₊ in m.
    pub gap: f64,
    /// Gap rate ġ₊ in m/s.
    pub rate: f64,
    /// Force P in N, compressive positive.
    pub force: f64,
}

/// Coefficients of `gap g₊ + rate ġ₊ + compliance P = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relation {
    /// Factor of the gap.
    pub gap: f64,
    /// Factor of the gap rate.
    pub rate: f64,
    /// Factor of the force.
    pub compliance: f64,
}

/// What a contact law must answer.
pub trait ContactLaw {
    /// Name as in the case file.
    fn name(&self) -> &'static str;
    /// Which end quantity it constrains.
    fn level(&self) -> Level;
    /// The instant at which the geometry is taken and closure is tested, as a fraction of the step ahead of the newest
    /// known configuration.
    fn capture(&self) -> f64;
    /// S_d: whether a point with this gap (m) at the captured instant takes part in the step; `tolerance` in m.
    fn watches(&self, gap: f64, tolerance: f64) -> bool;
    /// What holds in a point of this status other than open; `area`: the surface in m² that the point stands for.
    fn relation(&self, status: Status, area: f64) -> Relation;
    /// The status that the end state asks for. `reversals`: how often the status of this point has turned within the
    /// step so far.
    fn status(&self, now: Status, end: &End, reversals: u32) -> Status;
    /// Whether tensile forces are cut off once the statuses stand.
    fn clips(&self) -> bool;
}

/// A contact law, as chosen in the case file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// Hybrid displacement, sign field S_g.
    Displacement(Displacement),
    /// Damped, sign field S_g.
    Damped(Damped),
    /// Velocity, sign fields S_d and S_v.
    Velocity(Velocity),
}

impl Law {
    /// The law behind the choice.
    pub fn get(&self) -> &dyn ContactLaw {
        match self {
            Law::Displacement(law) => law,
            Law::Damped(law) => law,
            Law::Velocity(law) => law,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn end(gap: f64, rate: f64, force: f64) -> End {
        End {
            gap_released: gap,
            gap,
            rate,
            force,
        }
    }

    #[test]
    fn displacement_signs_close_on_penetration_and_open_on_tension() {
        let law = Displacement;
        assert_eq!(
            law.status(Status::Open, &end(1e-3, -1.0, 0.0), 0),
            Status::Open
        );
        assert_eq!(
            law.status(Status::Open, &end(-1e-3, -1.0, 0.0), 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 5.0), 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, -5.0), 0),
            Status::Open
        );
        // at rest on the surface without force: the strict sign leaves it free
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 0.0), 0),
            Status::Open
        );
    }

    #[test]
    fn velocity_signs_watch_the_closed_gap_and_the_approach() {
        let law = Velocity {
            capture: Capture::Half,
            reading: Reading::Closed,
        };
        assert!(law.watches(-1e-6, 1e-12) && law.watches(0.0, 1e-12));
        assert!(!law.watches(1e-6, 1e-12));
        assert_eq!(
            law.status(Status::Open, &end(0.0, -1.0, 0.0), 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Open, &end(0.0, 1.0, 0.0), 0),
            Status::Open
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 5.0), 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, -5.0), 0),
            Status::Open
        );
        let printed = Velocity {
            reading: Reading::AsPrinted,
            ..law
        };
        assert!(printed.watches(1e-6, 1e-12) && !printed.watches(-1e-6, 1e-12));
    }

    #[test]
    fn damped_law_takes_the_corner_when_closing_would_open() {
        let law = Damped {
            stiffness: 2.0,
            damping: 3.0,
            adhesion: Adhesion::Clip,
        };
        assert_eq!(
            law.relation(Status::Closed, 0.5),
            Relation {
                gap: 1.0,
                rate: 1.5,
                compliance: 1.0
            }
        );
        assert_eq!(
            law.status(Status::Open, &end(-1.0, 0.0, 0.0), 0),
            Status::Closed
        );
        let opened = End {
            gap_released: -1.0,
            gap: 0.1,
            rate: 0.0,
            force: 4.0,
        };
        assert_eq!(law.status(Status::Closed, &opened, 1), Status::Corner);
        let free = End {
            gap_released: 1.0,
            gap: 1.1,
            rate: 0.0,
            force: 4.0,
        };
        assert_eq!(law.status(Status::Closed, &free, 1), Status::Open);
    }
}
