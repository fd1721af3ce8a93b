//! The damped law: a compliant static part and a viscous one on closed points.

use carom_quantities::{SurfaceDamping, SurfaceStiffness};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ContactLaw, CurveError, Defaults, End, Level, Local, Relation, Status};

/// What becomes of tension in the damper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "What becomes of a tensile pressure.")]
pub enum Adhesion {
    /// The total pressure is cut off at zero.
    #[default]
    #[schemars(description = "It is set to zero.")]
    Clip,
    /// The damper may pull, as the equation is printed.
    #[schemars(
        description = "It remains, as in the printed law, and is a negative force in the histories."
    )]
    AsPrinted,
}

/// Damped law, total pressure `p_t = k_p max(0, -g₊) - S_g C_n ġ₊`, S_g = 1 where g₊ < 0.
///
/// The static part is compliant because with an exact multiplier the damper is inert or glues. In a closed point
/// `k_p g₊ + C_n ġ₊ + P / area = 0`. A 0/1 sign may not exist: if without force the gap would end negative, and with
/// the law's force positive, the point takes the corner g₊ = 0.
///
/// Source: Ben Dhia, Zammali, Voldoire, Lamarche (2003), equation (6), with a compliance instead of its multiplier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "A spring with a damper, both given.")]
pub struct Damped {
    /// k_p in Pa/m.
    #[serde(deserialize_with = "SurfaceStiffness::si")]
    #[schemars(with = "SurfaceStiffness", description = "Stiffness per area k.")]
    pub stiffness: f64,
    /// C_n in Pa s/m.
    #[serde(default, deserialize_with = "SurfaceDamping::si")]
    #[schemars(with = "SurfaceDamping", description = "Damping per area C.")]
    pub damping: f64,
    /// Treatment of a tensile pressure of the damper.
    #[serde(default)]
    pub adhesion: Adhesion,
}

/// The damped law as the case file gives it: k_p = E/h and C_n = c sqrt(k_p h / E) ρc of the softer side, unless it says
/// otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(
    description = "A compliant law with a damper.",
    extend("not" = { "required": ["damping", "damping-factor"] })
)]
pub struct GivenDamped {
    /// Stiffness per area k. Default: Young's modulus of the softer side divided by its element size.
    pub stiffness: Option<SurfaceStiffness>,
    /// Damping per area C. Default: from `damping-factor`.
    pub damping: Option<SurfaceDamping>,
    /// C relative to the impedance per area of the softer side times sqrt(k h / E). Default: 0.5.
    #[schemars(extend("minimum" = 0.0))]
    pub damping_factor: Option<f64>,
    /// Treatment of a tensile pressure of the damper.
    #[serde(default)]
    pub adhesion: Adhesion,
}

impl GivenDamped {
    /// The law with its defaults.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, defaults: &Defaults) -> Result<Damped, CurveError> {
        let side = &defaults.softer;
        let stiffness = self.stiffness.map_or(side.young / side.size, |k| k.0);
        let factor = self.damping_factor.unwrap_or(0.5);
        let from_factor = factor * (stiffness * side.size / side.young).sqrt() * side.impedance;
        Ok(Damped {
            stiffness,
            damping: self.damping.map_or(from_factor, |damping| damping.0),
            adhesion: self.adhesion,
        })
    }
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
