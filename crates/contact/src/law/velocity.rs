//! The velocity law: complementarity of force and gap rate on closed points.

use serde::{Deserialize, Serialize};

use super::{ContactLaw, End, Level, Local, Relation, Status};

/// When a point counts as closed (S_d): where the gap of this configuration is at most the tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Capture {
    /// g_k, the newest known configuration. Penetration up to (2 - θ) v₀ dt.
    Now,
    /// g_k + dt/2 ġ_k. Penetration up to (3/2 - θ) v₀ dt.
    Half,
    /// g_k + dt ġ_k: may start contact a step too early.
    Full,
}

/// How the closed field (7.d) of the paper is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reading {
    /// S_d = 1 where the gap is closed: the meaning.
    Closed,
    /// S_d = 1 where the gap is open or just touching, as the equation is printed. Bodies then pass through each
    /// other: a negative control for the laboratory, not for use.
    AsPrinted,
}

/// Velocity law: on closed points, `0 <= ġ₊ ⟂ P >= 0` for the rate at the END of the step, i.e.
/// `P = S_d S_v (P - r_v ġ₊)` with S_v = 1 where `P - r_v ġ₊ > 0`. As with the displacement law nothing depends on r_v.
///
/// Source: Ben Dhia, Zammali, Voldoire, Lamarche (2003), equation (7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Velocity {
    /// Which configuration is tested for closure.
    pub capture: Capture,
    /// How closure is read.
    pub reading: Reading,
}

impl ContactLaw for Velocity {
    fn name(&self) -> &'static str {
        "velocity"
    }

    fn level(&self) -> Level {
        Level::Rate
    }

    fn capture(&self) -> f64 {
        match self.capture {
            Capture::Now => 0.0,
            Capture::Half => 0.5,
            Capture::Full => 1.0,
        }
    }

    fn watches(&self, gap: f64, tolerance: f64) -> Option<bool> {
        Some(match self.reading {
            Reading::Closed => gap <= tolerance,
            Reading::AsPrinted => gap >= -tolerance,
        })
    }

    fn relation(&self, _status: Status, _local: &Local) -> Relation {
        Relation::RATE
    }

    fn status(&self, now: Status, end: &End, _local: &Local, _reversals: u32) -> Status {
        let closed = match now {
            Status::Open => end.rate < 0.0,
            Status::Closed | Status::Corner | Status::Piece(_) => end.force > 0.0,
        };
        if closed { Status::Closed } else { Status::Open }
    }

    fn clips(&self) -> bool {
        false
    }
}
