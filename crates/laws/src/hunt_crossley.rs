//! The law of Hunt and Crossley: a Hertz point that loses energy.

use carom_quantities::Speed;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hertz::{of_spheres, penetrates};
use crate::{ContactLaw, CurveError, Defaults, End, Hertz, Level, Local, Relation, Status};

/// Halvings of the interval of c v: all digits.
const HALVINGS: usize = 60;

/// 1 - e below which c v is the first term of its series in 1 - e: the next one, (1 - e)² of it, is then 1e-8, and so is what
/// rounding leaves of the equation.
const NEARLY_ELASTIC: f64 = 1e-4;

/// Hunt and Crossley, `P = share k δⁿ max(0, 1 - c ġ₊)` where the penetration `δ = -g₊` is positive: a damper as stiff as the
/// spring at hand, so that the force begins and ends with zero, and does not pull.
///
/// A mass that comes with v leaves with e v where, from `m δ̇ dδ̇/dδ = -k δⁿ (1 + c δ̇)`,
/// ```text
/// c v - ln(1 + c v) = -c v e - ln(1 - c v e)
/// ```
/// whatever m, k and n. For small losses `e = 1 - 2/3 c v`, the `c = 3 (1 - e)/(2 v)` of the paper; c from e takes the equation above.
/// The relation is the tangent about the present gap and rate.
///
/// Source: K. H. Hunt, F. R. E. Crossley, Coefficient of restitution interpreted as damping in vibroimpact, Journal of Applied
/// Mechanics 42 (1975), 440-445; the equation of e is its first integral, derived here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HuntCrossley {
    /// k in N/mⁿ, and n.
    pub spring: Hertz,
    /// c in s/m, zero or more.
    pub damping: f64,
}

/// The law as the case file gives it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(
    description = "The law of Hunt and Crossley, for the contact as a whole: its points share the force by their areas.",
    extend("oneOf" = [{ "required": ["damping"] }, { "required": ["restitution"] }])
)]
pub struct GivenHuntCrossley {
    /// Stiffness k of the whole contact, in N/m^n with n the exponent. Two spheres: 4/3 E* sqrt(R).
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub stiffness: f64,
    /// Exponent n: 3/2 of bodies that touch in a point.
    #[serde(default = "of_spheres")]
    #[schemars(extend("minimum" = 1.0))]
    pub exponent: f64,
    /// Damping c, in s/m.
    #[schemars(extend("minimum" = 0.0))]
    pub damping: Option<f64>,
    /// The rebound that gives c, in place of `damping`.
    pub restitution: Option<Rebound>,
}

/// A rebound of a free mass from a body that does not move.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Rebound {
    /// Coefficient e at this speed.
    #[schemars(extend("exclusiveMinimum" = 0.0, "maximum" = 1.0))]
    pub coefficient: f64,
    /// Speed of the approach.
    pub speed: Speed,
}

impl Rebound {
    /// c (s/m): of a free mass that comes with the speed v it leaves e v.
    fn damping(&self) -> f64 {
        let e = self.coefficient;
        if 1.0 - e < NEARLY_ELASTIC {
            return 1.5 * (1.0 - e * e) / (1.0 + e.powi(3)) / self.speed.0;
        }
        // of x = c v, positive below the root and negative beyond it
        let left = |x: f64| x * (1.0 + e) - x.ln_1p() + (-x * e).ln_1p();
        let (mut low, mut high) = (0.0, 1.0 / e);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            match left(middle) > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        0.5 * (low + high) / self.speed.0
    }
}

impl GivenHuntCrossley {
    /// The law as it is given.
    ///
    /// # Errors
    /// None.
    pub fn law(&self, _defaults: &Defaults) -> Result<HuntCrossley, CurveError> {
        let of_rebound = || self.restitution.map_or(0.0, |rebound| rebound.damping());
        Ok(HuntCrossley {
            spring: Hertz {
                stiffness: self.stiffness,
                exponent: self.exponent,
            },
            damping: self.damping.unwrap_or_else(of_rebound),
        })
    }
}

impl ContactLaw for HuntCrossley {
    fn name(&self) -> &'static str {
        "hunt-crossley"
    }

    fn level(&self) -> Level {
        self.spring.level()
    }

    fn capture(&self) -> f64 {
        self.spring.capture()
    }

    fn watches(&self, gap: f64, tolerance: f64) -> Option<bool> {
        self.spring.watches(gap, tolerance)
    }

    fn reach(&self, known: f64) -> Option<f64> {
        self.spring.reach(known)
    }

    fn relation(&self, _status: Status, local: &Local) -> Relation {
        let [gap, rate] = local.at;
        let [force, slope] = self.spring.force(-gap, local);
        let factor = (1.0 - self.damping * rate).max(0.0);
        let damping = match factor > 0.0 {
            true => force * self.damping,
            false => 0.0,
        };
        Relation {
            gap: slope * factor,
            rate: damping,
            compliance: 1.0,
            offset: -(force + slope * gap) * factor - damping * rate,
        }
    }

    fn is_linear(&self) -> bool {
        false
    }

    fn depth(&self, energy: f64) -> f64 {
        self.spring.depth(energy)
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

    const LAW: HuntCrossley = HuntCrossley {
        spring: Hertz {
            stiffness: 8.0,
            exponent: 1.5,
        },
        damping: 0.5,
    };

    fn local() -> Local {
        Local {
            share: 0.25,
            ..Local::default()
        }
    }

    /// The force of the law at a gap and a rate, N.
    fn force(gap: f64, rate: f64) -> f64 {
        let relation = LAW.relation(Status::Closed, &local().about(gap, rate));
        -(relation.gap * gap + relation.rate * rate + relation.offset)
    }

    #[test]
    fn it_closes_where_the_gap_is_negative_and_does_not_pull() {
        for rate in [-1.0, 1.0] {
            let end = |gap| End {
                gap_released: gap,
                gap,
                rate,
                force: 0.0,
            };
            let status = |gap| LAW.status(Status::Open, &end(gap), &local(), 0);
            assert_eq!(status(1e-9), Status::Open);
            assert_eq!(status(-1e-9), Status::Closed);
        }
        // k δⁿ = 2 N: half as much again at one m/s inwards, half as much outwards, nothing from 2 m/s on
        let forces = [-1.0, 0.0, 1.0, 2.0, 3.0].map(|rate| force(-1.0, rate));
        assert_eq!(forces, [3.0, 2.0, 1.0, 0.0, 0.0]);
        assert_eq!(force(0.5, -1.0), 0.0);
    }

    #[test]
    fn the_relation_is_the_tangent_of_the_force() {
        let step = 1e-6;
        for (gap, rate) in [(-0.3, -2.0), (-1.7, 0.4), (-0.9, 2.5)] {
            let relation = LAW.relation(Status::Closed, &local().about(gap, rate));
            let along_gap = (force(gap + step, rate) - force(gap - step, rate)) / (2.0 * step);
            let along_rate = (force(gap, rate + step) - force(gap, rate - step)) / (2.0 * step);
            // of central differences the error is that of rounding, 1e-16/1e-6 of some newtons
            assert!((relation.gap + along_gap).abs() < 1e-8);
            assert!((relation.rate + along_rate).abs() < 1e-8);
        }
    }

    #[test]
    fn damping_of_a_rebound_solves_its_equation_and_has_the_limit_of_the_paper() {
        for coefficient in [0.05, 0.5, 0.9, 0.999] {
            let speed = Speed(3.0);
            let x = 3.0 * Rebound { coefficient, speed }.damping();
            let [came, left] = [x, -x * coefficient].map(|x| x - x.ln_1p());
            // rounding of terms of the size x, and of 1 - e x under the logarithm
            let rounding = f64::EPSILON * (x + 1.0 / (1.0 - x * coefficient));
            assert!((came - left).abs() < 8.0 * rounding, "{coefficient}");
        }
        for part in [1e-5, 1.1e-4, 1e-3] {
            let rebound = Rebound {
                coefficient: 1.0 - part,
                speed: Speed(2.0),
            };
            // c v = 3/2 (1 - e) (1 + (1 - e) + ...)
            let ratio = rebound.damping() / (1.5 * part / 2.0);
            assert!((ratio - 1.0).abs() < 1.1 * part, "{ratio}");
        }
    }
}
