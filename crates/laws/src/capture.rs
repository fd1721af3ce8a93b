//! When a law in the rate takes a point for closed (S_d), and which rate it asks for there.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{End, Local, Status};

/// When a point counts as closed (S_d): where the gap of this configuration, or that at the start of the step, is at most the
/// tolerance. A point that is closed and leaves stays with its law.
///
/// With v₀ the approach rate, a point that closes in a step penetrates by at most the bound given, in the limit of
/// small steps (viability). The geometry is taken in the configuration that is tested, for the free motion in g_k; with an
/// implicit step and rows that turn, in the one to which the step is predicted to lead up to the instant that is tested.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "The gap that decides whether a point is closed in a step.")]
pub enum Capture {
    /// g_k, the newest known configuration. Penetration up to (2 - θ) v₀ dt.
    #[default]
    #[schemars(description = "The gap at the beginning of the step.")]
    Now,
    /// g_k + dt/2 ġ_k. Penetration up to (3/2 - θ) v₀ dt.
    #[schemars(
        description = "The smaller of the gap at the beginning of the step and the gap predicted for its middle."
    )]
    Half,
    /// g_k + dt ġ_k: may start contact a step too early, and then lets go of a point at rest. Penetration up to v₀ dt.
    #[schemars(
        description = "The smaller of the gap at the beginning of the step and the gap predicted for its end from the gap rate."
    )]
    Full,
    /// The end of the step without any contact force: may start contact a step too early. Penetration up to (1 - θ) v₀ dt.
    #[schemars(description = "The gap at the end of the step without any contact force.")]
    Free,
    /// None is tested: in any point the gap itself is the target, ġ₊ + g_k/dt >= 0 instead of ġ₊ >= 0. Penetration up
    /// to (1 - θ) v₀ dt, and what has penetrated is pushed out.
    ///
    /// Source: Stewart and Trinkle, International Journal for Numerical Methods in Engineering 39 (1996).
    #[schemars(
        description = "None. At all points the gap rate at the end of the step is at least -g / dt, with g at its start, so that penetrating points are pushed out (Stewart and Trinkle). Not for the restitution law."
    )]
    GapTarget,
}

impl Capture {
    /// The instant at which the geometry is taken, as a fraction of the step.
    pub(crate) fn ahead(self) -> f64 {
        match self {
            Capture::Now | Capture::Free | Capture::GapTarget => 0.0,
            Capture::Half => 0.5,
            Capture::Full => 1.0,
        }
    }

    /// S_d from the gap at that instant, in m; `None` where it does not tell.
    pub(crate) fn watches(self, gap: f64, tolerance: f64) -> Option<bool> {
        match self {
            Capture::Now | Capture::Half | Capture::Full => Some(gap <= tolerance),
            Capture::Free | Capture::GapTarget => None,
        }
    }

    /// [`ContactLaw::reach`](super::ContactLaw::reach).
    pub(crate) fn reach(self, known: f64) -> Option<f64> {
        match self {
            Capture::Now | Capture::Half | Capture::Full => Some(known + self.ahead()),
            Capture::Free => Some(1.0),
            Capture::GapTarget => None,
        }
    }

    /// What the law adds to ġ₊, m/s: the relation is one of `ġ₊ + excess`.
    ///
    /// `max(0, start)`: where the gap opens at the start of the step a force keeps it from closing over the step, and does no work.
    /// ġ₊ >= 0 there would do the work P (1 - θ) dt ġ > 0. The gap as target pushes out what has penetrated, and does the work of that.
    pub(crate) fn excess(self, local: &Local) -> f64 {
        match self {
            Capture::GapTarget => local.gap / local.dt,
            Capture::Now | Capture::Half | Capture::Full | Capture::Free => local.start.max(0.0),
        }
    }

    /// S_d S_v: the status of a point whose law presses against a negative `ġ₊ + excess`, `excess` in m/s.
    pub(crate) fn status(self, now: Status, end: &End, local: &Local, excess: f64) -> Status {
        let captured = self != Capture::Free || local.gap_free <= local.tolerance;
        let pressed = match now {
            Status::Open => end.rate + excess < 0.0,
            Status::Closed | Status::Corner | Status::Piece(_) => end.force > 0.0,
        };
        if captured && pressed {
            Status::Closed
        } else {
            Status::Open
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FALLING: End = End {
        gap_released: 1.0,
        gap: 1.0,
        rate: -2.0,
        force: 0.0,
    };

    #[test]
    fn free_motion_decides_at_the_end_of_the_step() {
        let local = |gap_free| Local {
            gap: 1.0,
            gap_free,
            dt: 1.0,
            ..Local::default()
        };
        let capture = Capture::Free;
        assert_eq!(capture.watches(1.0, 0.0), None);
        assert_eq!(
            capture.status(Status::Open, &FALLING, &local(-0.1), 0.0),
            Status::Closed
        );
        assert_eq!(
            capture.status(Status::Open, &FALLING, &local(0.1), 0.0),
            Status::Open
        );
        // a point that pressed and that nothing would bring back does not stick
        let pressed = End {
            force: 5.0,
            ..FALLING
        };
        assert_eq!(
            capture.status(Status::Closed, &pressed, &local(0.1), 0.0),
            Status::Open
        );
    }

    #[test]
    fn a_gap_that_opens_at_the_start_may_close_again_by_as_much() {
        // θ = 1/2: the way of the step is dt/2 (ġ + ġ₊)
        let local = Local {
            rate: 2.0,
            start: 2.0,
            dt: 1.0,
            ..Local::default()
        };
        let status = |rate| {
            let excess = Capture::Half.excess(&local);
            Capture::Half.status(Status::Open, &End { rate, ..FALLING }, &local, excess)
        };
        assert_eq!(status(-1.9), Status::Open);
        assert_eq!(status(-2.1), Status::Closed);
        let approaching = Local {
            start: -2.0,
            ..local
        };
        assert_eq!(Capture::Half.excess(&approaching), 0.0);
    }

    #[test]
    fn gap_target_closes_where_the_rate_would_use_up_the_gap() {
        let local = |gap| Local {
            gap,
            dt: 0.5,
            ..Local::default()
        };
        let status = |gap| {
            let local = local(gap);
            let excess = Capture::GapTarget.excess(&local);
            Capture::GapTarget.status(Status::Open, &FALLING, &local, excess)
        };
        // the rate -2 covers a gap of 1 in the step
        assert_eq!(status(1.001), Status::Open);
        assert_eq!(status(0.999), Status::Closed);
        assert_eq!(Capture::GapTarget.excess(&local(-1.0)), -2.0);
    }
}
