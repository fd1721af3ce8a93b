//! The list of contact laws.

use serde::{Deserialize, Serialize};

use crate::{Compliance, ContactLaw, Damped, Displacement, Penalty, Restitution, Stop, Velocity};

/// A contact law, as chosen in the case file.
#[expect(
    clippy::large_enum_variant,
    reason = "laws are plain values that are copied; only the curve of a stop is large"
)]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Law {
    /// Hybrid displacement, sign field S_g.
    Displacement(Displacement),
    /// Damped, sign field S_g.
    Damped(Damped),
    /// Velocity, sign fields S_d and S_v.
    Velocity(Velocity),
    /// Compliance in velocity, sign fields S_d and S_v.
    Compliance(Compliance),
    /// Newton's restitution, sign fields S_d and S_v.
    Restitution(Restitution),
    /// Penalty, sign field S_g.
    Penalty(Penalty),
    /// Stop with a force-penetration curve, sign field S_g.
    Stop(Stop),
}

impl Law {
    /// Whether velocity and acceleration are projected when points of this law close.
    pub fn projects(&self) -> bool {
        matches!(self, Law::Displacement(Displacement { projection: true }))
    }

    /// The largest penetration of a point that has carried a force, in m, after a step that ended with the gap `gap` in
    /// m; `before`: the one before the step. Only laws with memory change it.
    pub fn crushed(&self, before: f64, gap: f64) -> f64 {
        match self {
            Law::Stop(stop) => stop.crushed(before, gap),
            _ => before,
        }
    }

    /// Energy that a contact all of whose points have this largest penetration (m) does not give back, J.
    pub fn crush_energy(&self, crush: f64) -> f64 {
        match self {
            Law::Stop(stop) => stop.crush_energy(crush),
            _ => 0.0,
        }
    }

    /// Whether it is complementarity of the force and one quantity, for which there is a weak form with a multiplier.
    pub fn has_weak_form(&self) -> bool {
        matches!(
            self,
            Law::Displacement(Displacement { projection: false }) | Law::Velocity(_)
        )
    }

    /// Whether it gives the force of each point as a continuous function of one quantity there, so that points may be as
    /// many as one likes. A damper beside a spring is none: its force jumps where the gap closes.
    pub fn is_function(&self) -> bool {
        match self {
            Law::Compliance(_) => true,
            Law::Penalty(Penalty(law)) => law.damping == 0.0,
            Law::Stop(law) => law.damping == 0.0,
            Law::Displacement(_) | Law::Velocity(_) | Law::Restitution(_) | Law::Damped(_) => false,
        }
    }

    /// The law behind the choice.
    pub fn get(&self) -> &dyn ContactLaw {
        match self {
            Law::Displacement(law) => law,
            Law::Damped(law) => law,
            Law::Velocity(law) => law,
            Law::Compliance(law) => law,
            Law::Restitution(law) => law,
            Law::Penalty(law) => law,
            Law::Stop(law) => law,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Adhesion, Capture, End, Local, Reading, Relation, Status};

    const LOCAL: Local = Local {
        area: 0.5,
        share: 1.0,
        gap: 0.0,
        rate: 0.0,
        start: 0.0,
        gap_free: 0.0,
        dt: 1.0,
        tolerance: 0.0,
        crush: 0.0,
    };

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
        let law = Displacement::default();
        assert_eq!(
            law.status(Status::Open, &end(1e-3, -1.0, 0.0), &LOCAL, 0),
            Status::Open
        );
        assert_eq!(
            law.status(Status::Open, &end(-1e-3, -1.0, 0.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 5.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, -5.0), &LOCAL, 0),
            Status::Open
        );
        // at rest on the surface without force: the strict sign leaves it free
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 0.0), &LOCAL, 0),
            Status::Open
        );
    }

    #[test]
    fn velocity_signs_watch_the_closed_gap_and_the_approach() {
        let law = Velocity {
            capture: Capture::Half,
            reading: Reading::Closed,
        };
        assert_eq!(law.watches(-1e-6, 1e-12), Some(true));
        assert_eq!(law.watches(0.0, 1e-12), Some(true));
        assert_eq!(law.watches(1e-6, 1e-12), Some(false));
        assert_eq!(
            law.status(Status::Open, &end(0.0, -1.0, 0.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Open, &end(0.0, 1.0, 0.0), &LOCAL, 0),
            Status::Open
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, 5.0), &LOCAL, 0),
            Status::Closed
        );
        assert_eq!(
            law.status(Status::Closed, &end(0.0, 0.0, -5.0), &LOCAL, 0),
            Status::Open
        );
        let printed = Velocity {
            reading: Reading::AsPrinted,
            ..law
        };
        assert_eq!(printed.watches(1e-6, 1e-12), Some(true));
        assert_eq!(printed.watches(-1e-6, 1e-12), Some(false));
    }

    #[test]
    fn damped_law_takes_the_corner_when_closing_would_open() {
        let law = Damped {
            stiffness: 2.0,
            damping: 3.0,
            adhesion: Adhesion::Clip,
        };
        assert_eq!(
            law.relation(Status::Closed, &LOCAL),
            Relation {
                gap: 1.0,
                rate: 1.5,
                compliance: 1.0,
                offset: 0.0
            }
        );
        assert_eq!(
            law.status(Status::Open, &end(-1.0, 0.0, 0.0), &LOCAL, 0),
            Status::Closed
        );
        let opened = End {
            gap_released: -1.0,
            gap: 0.1,
            rate: 0.0,
            force: 4.0,
        };
        assert_eq!(
            law.status(Status::Closed, &opened, &LOCAL, 1),
            Status::Corner
        );
        let free = End {
            gap_released: 1.0,
            gap: 1.1,
            rate: 0.0,
            force: 4.0,
        };
        assert_eq!(law.status(Status::Closed, &free, &LOCAL, 1), Status::Open);
    }
}
