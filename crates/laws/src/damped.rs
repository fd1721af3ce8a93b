//! The damped law: a compliant static part and a viscous one on closed points.

use serde::{Deserialize, Serialize};

use crate::{ContactLaw, End, Level, Local, Relation, Status};

/// What becomes of tension in the damper.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Adhesion {
    /// The total pressure is cut off at zero.
    Clip,
    /// The damper may pull, as the equation is printed.
    AsPrinted,
}

/// Damped law, total pressure `p_t = k_p max(0, -g₊) - S_g C_n ġ₊`, S_g = 1 where g₊ < 0.
///
/// The static part is compliant because with an exact multiplier the damper is inert or glues. In a closed point
/// `k_p g₊ + C_n ġ₊ + P / area = 0`. A 0/1 sign may not exist: if without force the gap would end negative, and with
/// the law's force positive, the point takes the corner g₊ = 0.
///
/// Source: Ben Dhia, Zammali, Voldoire, Lamarche (2003), equation (6), with a compliance instead of its multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Damped {
    /// k_p in Pa/m.
    pub stiffness: f64,
    /// C_n in Pa s/m.
    pub damping: f64,
    /// Whether tension is cut off.
    pub adhesion: Adhesion,
}

impl ContactLaw for Damped {
    fn name(&self) -> &'static str {
        "damped"
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
        match status {
            Status::Corner => Relation::GAP,
            Status::Open | Status::Closed | Status::Piece(_) => Relation {
                gap: self.stiffness * local.area,
                rate: self.damping * local.area,
                compliance: 1.0,
                offset: 0.0,
            },
        }
    }

    fn status(&self, now: Status, end: &End, _local: &Local, reversals: u32) -> Status {
        pressing(now, end, self.damping > 0.0 && reversals >= 3)
    }

    fn clips(&self) -> bool {
        self.adhesion == Adhesion::Clip
    }
}

/// Status of a compliant law that presses where the gap of `end` is negative. `cycles`: whether the point has turned
/// too often to find a sign, which only a damper can cause; it then takes the corner.
pub(crate) fn pressing(now: Status, end: &End, cycles: bool) -> Status {
    match now {
        Status::Open if end.gap >= 0.0 => Status::Open,
        Status::Open if cycles => Status::Corner,
        Status::Open => Status::Closed,
        Status::Closed | Status::Piece(_) if end.gap < 0.0 => Status::Closed,
        _ if end.gap_released < 0.0 => Status::Corner,
        _ => Status::Open,
    }
}
