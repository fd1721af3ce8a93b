//! The Hertz point: a force that grows with a power of the penetration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ContactLaw, CurveError, Defaults, End, Level, Local, Relation, Status};

/// Hertz point, `P = share k δⁿ` where the penetration `δ = -g₊` is positive, for the contact as a whole. For two spheres n = 3/2 and
/// `k = 4/3 E* √R` with `1/R = 1/R₁ + 1/R₂` and `1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂`.
///
/// Nothing is lost: the energy of the contact is `share k δⁿ⁺¹/(n + 1)`. A mass m that comes with v reaches
/// `δ_m = ((n + 1) m v²/(2 k))^(1/(n + 1))`. The relation is the tangent about the present gap; since P is convex in δ a tangent never
/// lies above the law, and Newton's method comes to the force of a point from below.
///
/// Source: H. Hertz, Über die Berührung fester elastischer Körper, Journal für die reine und angewandte Mathematik 92 (1881); K. L.
/// Johnson, Contact Mechanics (1985), equations 4.23 and 11.20 to 11.24.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(
    description = "A Hertz point, for the contact as a whole: its points share the force by their areas."
)]
pub struct Hertz {
    /// k in N/mⁿ.
    #[schemars(
        description = "Stiffness k of the whole contact, in N/m^n with n the exponent. Two spheres: 4/3 E* sqrt(R).",
        extend("exclusiveMinimum" = 0.0)
    )]
    pub stiffness: f64,
    /// n, one or more.
    #[serde(default = "of_spheres")]
    #[schemars(
        description = "Exponent n: 3/2 of bodies that touch in a point.",
        extend("minimum" = 1.0)
    )]
    pub exponent: f64,
}

/// The exponent of bodies that touch in a point.
pub(crate) fn of_spheres() -> f64 {
    1.5
}

impl Hertz {
    /// The law as it is given.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, _defaults: &Defaults) -> Result<Hertz, CurveError> {
        Ok(*self)
    }

    /// Force `share k δⁿ` (N) at a penetration δ (m), and its derivative (N/m); both zero where δ is negative.
    pub(crate) fn force(&self, penetration: f64, local: &Local) -> [f64; 2] {
        if penetration <= 0.0 {
            return [0.0; 2];
        }
        let slope =
            local.share * self.stiffness * self.exponent * penetration.powf(self.exponent - 1.0);
        [slope * penetration / self.exponent, slope]
    }
}

/// Status of a law whose force is continuous where the gap closes: closed where the gap is negative, or would be without the force.
pub(crate) fn penetrates(end: &End) -> Status {
    match end.gap < 0.0 || end.gap_released < 0.0 {
        true => Status::Closed,
        false => Status::Open,
    }
}

impl ContactLaw for Hertz {
    fn name(&self) -> &'static str {
        "hertz"
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

    fn relation(&self, _status: Status, local: &Local) -> Relation {
        let penetration = -local.at[0];
        let [force, slope] = self.force(penetration, local);
        Relation {
            gap: slope,
            rate: 0.0,
            compliance: 1.0,
            offset: slope * penetration - force,
        }
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn depth(&self, energy: f64) -> f64 {
        let power = self.exponent + 1.0;
        (power * energy / self.stiffness).powf(1.0 / power)
    }

    fn status(&self, _now: Status, end: &End, _local: &Local, _reversals: u32) -> Status {
        penetrates(end)
    }

    fn is_of_the_whole(&self) -> bool {
        true
    }

    fn is_function(&self) -> bool {
        true
    }

    fn clips(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Hertz = Hertz {
        stiffness: 8.0,
        exponent: 1.5,
    };
    const LOCAL: Local = Local {
        area: 1.0,
        share: 0.25,
        gap: 0.0,
        rate: 0.0,
        start: 0.0,
        gap_free: 0.0,
        dt: 1.0,
        tolerance: 0.0,
        crush: 0.0,
        at: [0.0; 2],
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
    fn it_closes_where_the_gap_is_negative_whatever_the_rate() {
        for rate in [-1.0, 1.0] {
            for now in [Status::Open, Status::Closed] {
                assert_eq!(
                    LAW.status(now, &end(1e-9, rate, 0.0), &LOCAL, 0),
                    Status::Open
                );
                assert_eq!(
                    LAW.status(now, &end(-1e-9, rate, 1.0), &LOCAL, 0),
                    Status::Closed
                );
            }
        }
    }

    #[test]
    fn the_relation_is_the_tangent_of_the_force() {
        for penetration in [0.25, 1.0, 4.0] {
            let relation = LAW.relation(Status::Closed, &LOCAL.about(-penetration, 3.0));
            let force = 2.0 * f64::powf(penetration, 1.5);
            // on the law at the point, powers of two and their roots being exact
            assert_eq!(relation.gap * -penetration + relation.offset, -force);
            let step = 1e-6;
            let [before, after] =
                [-step, step].map(|step| LAW.force(penetration + step, &LOCAL)[0]);
            // of central differences the error is that of rounding, 1e-16/1e-6
            assert!((relation.gap - (after - before) / (2.0 * step)).abs() < 1e-8 * force);
        }
        let open = LAW.relation(Status::Closed, &LOCAL.about(0.1, 0.0));
        assert_eq!((open.gap, open.offset, open.compliance), (0.0, 0.0, 1.0));
    }

    #[test]
    fn a_contact_holds_its_energy_at_the_depth() {
        let depth = LAW.depth(0.7);
        let [force, _] = LAW.force(depth, &LOCAL);
        // a quarter of the points, rounding of a few products
        assert!((force * depth / 2.5 - 0.25 * 0.7).abs() < 1e-15);
    }
}
