//! Friction that is larger at rest than in motion.

use carom_quantities::Speed;
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::law::FrictionLaw;

/// Static and kinetic friction: a point sticks with |t| <= μ_s P and slides with |t| = μ P,
/// ```text
/// μ = μ_k                                    without a speed of decay
/// μ = μ_k + (μ_s - μ_k) exp(-|q̇|/v_c)        with the speed of decay v_c
/// ```
///
/// q̇ is the rate of the sliding at the start of the step. So the force of a step is known before the step, but for stick and
/// slip; with the rate at the end a step would have several solutions where the force falls faster with the rate than the inertia
/// over the step lets it, `(μ_s - μ_k) P dt/(m v_c) > 1`. The error is of first order in the step, dt q̈/v_c of the part that decays.
/// A point that begins to slide has μ_s for that step, with the decay.
///
/// Whether a point sticks is decided in the step: it sticks where the force with which it sticks is at most μ_s P, otherwise it slides.
/// Where both are possible, since μ is less than μ_s, it sticks.
///
/// Source: E. Rabinowicz, Journal of Applied Physics 22 (1951), 1373, for the two coefficients; the decay is that of structural codes,
/// as in Oden and Martins, Computer Methods in Applied Mechanics and Engineering 52 (1985), 527, a survey.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "A coefficient of sticking and a lower one of sliding.")]
pub struct StaticKinetic {
    /// μ_s.
    #[serde(rename = "static")]
    #[schemars(
        description = "Coefficient up to which a point sticks.",
        extend("minimum" = 0.0)
    )]
    pub at_rest: f64,
    /// μ_k.
    #[schemars(
        description = "Coefficient of a point that slides, at most the static one.",
        extend("minimum" = 0.0)
    )]
    pub kinetic: f64,
    /// v_c in m/s.
    #[schemars(
        with = "Option<Speed>",
        description = "Speed v over which the coefficient falls from the static to the kinetic one: it is kinetic + (static - kinetic) exp(-speed/v), with the speed of the sliding at the start of the step. Default: it falls as soon as the point slides."
    )]
    #[serde(default, deserialize_with = "speed")]
    pub decay: Option<f64>,
}

/// A speed that is given, m/s.
fn speed<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    Speed::si(deserializer).map(Some)
}

impl FrictionLaw for StaticKinetic {
    fn name(&self) -> &'static str {
        "static-kinetic"
    }

    #[inline]
    fn sticks(&self) -> f64 {
        self.at_rest
    }

    fn slides(&self, rate: f64) -> f64 {
        // exact at both ends, where it is compared with the coefficient of sticking
        let left = self.decay.map_or(0.0, |speed| (-rate / speed).exp());
        left * self.at_rest + (1.0 - left) * self.kinetic
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_coefficient_falls_to_the_kinetic_one() {
        let law = |decay| StaticKinetic {
            at_rest: 0.5,
            kinetic: 0.3,
            decay,
        };
        assert_eq!(law(None).slides(0.0), 0.3);
        assert_eq!(law(None).slides(10.0), 0.3);
        let decays = law(Some(2.0));
        assert_eq!(decays.slides(0.0), 0.5);
        // by e over each 2 m/s; sums of two numbers, rounded once or twice
        for speeds in [1.0, 3.0] {
            let expected = 0.3 + 0.2 * f64::exp(-speeds);
            assert!((decays.slides(2.0 * speeds) - expected).abs() < 1e-15);
        }
        assert_eq!(decays.sticks(), 0.5);
    }

    #[test]
    fn both_ends_are_the_coefficients_to_the_last_bit() {
        // 0.03 + (0.3 - 0.03) is above 0.3
        for (at_rest, kinetic) in [(0.3, 0.03), (0.7, 0.1), (1.0, 0.0)] {
            let law = StaticKinetic {
                at_rest,
                kinetic,
                decay: Some(0.1),
            };
            assert_eq!(law.slides(0.0), at_rest);
            assert_eq!(law.slides(f64::INFINITY), kinetic);
        }
    }
}
