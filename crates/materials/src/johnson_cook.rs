//! Metal plasticity of Johnson and Cook.

use carom_algebra::number::Number;
use carom_quantities::{Modulus, Rate, Stress};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::flow::{PLASTIC, flows};
use crate::hardening::Hardening;
use crate::range::{OutOfRange, require};
use crate::{Elastic, Material, Parameters, PlaneStress, Uniaxial};

/// Place of the rise of the temperature in the history, behind ε_p.
const RISE: usize = 1;

/// Most iterations of a return; a bisection alone needs fewer for the last digit of the slip.
const MOST: usize = 100;

/// Softening by the heat of the plastic work, which stays where it is made.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Softening by the heat of the plastic work.", extend("additionalProperties" = false))]
pub struct Thermal {
    /// Exponent m.
    #[schemars(description = "Exponent of the homologous temperature.")]
    pub exponent: f64,
    /// Rise from the initial temperature to melting, K.
    #[schemars(description = "Rise from the initial temperature to melting, K.")]
    pub melting_rise: f64,
    /// Specific heat, J/(kg K).
    #[schemars(description = "Specific heat, J/(kg K).")]
    pub specific_heat: f64,
    /// Part of the plastic work that becomes heat.
    #[schemars(description = "Part of the plastic work that becomes heat, up to 1.")]
    pub converted: f64,
}

/// Plasticity of Johnson and Cook, in logarithmic strain:
///
/// σ_y = (A + B ε_pⁿ) (1 + C ln max(1, ε̇_p/ε̇_0)) (1 - (T/T_m)ᵐ),
///
/// with T and T_m the rises from the initial temperature at present and to melting. The strain and its rate Δε_p/dt are those of the
/// end of the step, T that of its beginning; the work σ_y Δε_p then raises it by η σ_y Δε_p/(ρ c), without conduction. The return is
/// one equation, which falls with Δε_p: Newton's method, kept inside a bracket. All plastic work counts as dissipated. In a
/// static stage there is no rate. The history has T after ε_p. Elastic law, flow and the rest of the history: those of all metals here,
/// theory/materials.
///
/// Johnson and Cook (1983), 7th International Symposium on Ballistics, 541.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(description = "Plasticity of Johnson and Cook.", extend("additionalProperties" = false))]
pub struct JohnsonCook {
    /// The law at small elastic strain, with the density.
    #[serde(flatten)]
    pub initial: Elastic,
    /// A, Pa.
    #[serde(deserialize_with = "Modulus::si")]
    #[schemars(
        with = "Modulus",
        description = "Yield stress A of the virgin material at the reference rate."
    )]
    pub yield_stress: f64,
    /// B, Pa.
    #[serde(deserialize_with = "Stress::si")]
    #[schemars(
        with = "Stress",
        description = "Factor B of the power of the plastic strain."
    )]
    pub hardening: f64,
    /// n.
    #[schemars(description = "Exponent n of the plastic strain.")]
    pub exponent: f64,
    /// C.
    #[schemars(description = "Factor C of the logarithm of the rate.")]
    pub rate_factor: f64,
    /// ε̇_0, 1/s.
    #[serde(deserialize_with = "Rate::si")]
    #[schemars(
        with = "Rate",
        description = "Reference rate of the plastic strain; below it the rate has no effect."
    )]
    pub reference_rate: f64,
    /// Softening by heat.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(description = "Softening by the heat of the plastic work. Default: none.")]
    pub thermal: Option<Thermal>,
}

impl JohnsonCook {
    /// Rise of the temperature in the history of a point, K.
    pub fn temperature_rise(history: &[f64]) -> f64 {
        history[PLASTIC + RISE]
    }

    /// Yield stress (Pa) at a plastic strain that was reached by `slip` in `dt` (s), with what heat leaves of it; and its slope over
    /// the slip.
    fn stress_at(&self, [plastic, slip]: [f64; 2], dt: f64, left: f64) -> [f64; 2] {
        let power = self.hardening * plastic.powf(self.exponent);
        let base = self.yield_stress + power;
        let base_slope = match plastic > 0.0 {
            true => self.exponent * power / plastic,
            false => 0.0,
        };
        let rate = match dt > 0.0 {
            true => slip / (dt * self.reference_rate),
            false => 0.0,
        };
        let (faster, faster_slope) = match rate > 1.0 {
            true => (1.0 + self.rate_factor * rate.ln(), self.rate_factor / slip),
            false => (1.0, 0.0),
        };
        [base * faster, base_slope * faster + base * faster_slope].map(|x| left * x)
    }

    /// What heat leaves of the yield stress.
    fn left(&self, rise: f64) -> f64 {
        self.thermal.map_or(1.0, |thermal| {
            let part = (rise / thermal.melting_rise).clamp(0.0, 1.0);
            1.0 - part.powf(thermal.exponent)
        })
    }

    /// Δε_p and the slope of the yield stress there.
    fn returned(&self, (q, stiffness): (f64, f64), [plastic, rise]: [f64; 2], dt: f64) -> [f64; 2] {
        let left = self.left(rise);
        let [start, _] = self.stress_at([plastic, 0.0], dt, left);
        if q <= start {
            return [0.0, 0.0];
        }
        let (mut below, mut above) = (0.0, (q - start) / stiffness);
        let mut slip = above;
        let mut slope = 0.0;
        for _ in 0..MOST {
            let [stress, now] = self.stress_at([plastic + slip, slip], dt, left);
            slope = now;
            let over = q - stiffness * slip - stress;
            match over > 0.0 {
                true => below = slip,
                false => above = slip,
            }
            let newton = slip + over / (stiffness + slope);
            let next = match below < newton && newton < above {
                true => newton,
                false => 0.5 * (below + above),
            };
            let change = (next - slip).abs();
            slip = next;
            if change <= 2.0 * f64::EPSILON * slip {
                break;
            }
        }
        [slip, slope]
    }
}

impl Parameters for JohnsonCook {
    fn finite(&self) -> Option<&dyn Material> {
        Some(self)
    }

    fn undeformed(&self) -> Elastic {
        self.initial
    }

    fn check(&self) -> Result<(), OutOfRange> {
        self.initial.check()?;
        let positive = |name, value: f64| require(name, value, value > 0.0, "positive");
        let not_negative =
            |name, value: f64| require(name, value, value >= 0.0, "zero or positive");
        positive("yield-stress", self.yield_stress)?;
        not_negative("hardening", self.hardening)?;
        positive("exponent", self.exponent)?;
        not_negative("rate-factor", self.rate_factor)?;
        positive("reference-rate", self.reference_rate)?;
        let Some(thermal) = self.thermal else {
            return Ok(());
        };
        positive("thermal.exponent", thermal.exponent)?;
        positive("thermal.melting-rise", thermal.melting_rise)?;
        positive("thermal.specific-heat", thermal.specific_heat)?;
        let converted = thermal.converted;
        let inside = (0.0..=1.0).contains(&converted);
        require("thermal.converted", converted, inside, "from 0 to 1")
    }

    fn dissipates(&self) -> bool {
        true
    }

    fn uniaxial(&self) -> Option<Box<dyn Uniaxial>> {
        Some(Box::new(*self))
    }

    fn plane_stress(&self) -> Option<Box<dyn PlaneStress>> {
        Some(Box::new(*self))
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        Some(history[PLASTIC])
    }
}

impl Hardening for JohnsonCook {
    fn elastic(&self) -> &Elastic {
        &self.initial
    }

    fn further(&self) -> usize {
        1
    }

    /// Lane by lane: only points that flow cost iterations, and none takes those of its neighbours.
    #[inline(always)]
    fn slip<T: Number>(&self, q: T, stiffness: f64, old: &[T], dt: f64) -> [T; 2] {
        let [mut slip, mut slope] = [q.like(0.0); 2];
        let [plastic, rise] = [old[0], old[RISE]];
        for lane in 0..q.lanes().len() {
            let before = [plastic.lanes()[lane], rise.lanes()[lane]];
            let trial = (q.lanes()[lane], stiffness);
            let [found, steep] = self.returned(trial, before, dt);
            slip.lanes_mut()[lane] = found;
            slope.lanes_mut()[lane] = steep;
        }
        [slip, slope]
    }

    #[inline(always)]
    fn spent<T: Number>(&self, slip: T, q: T, (old, new): (&[T], &mut [T])) -> [T; 2] {
        let work = slip * q;
        let heat = self.thermal.map_or(0.0, |thermal| {
            thermal.converted / (self.initial.density * thermal.specific_heat)
        });
        new[RISE] = work.scale_add(heat, old[RISE]);
        [slip.like(0.0), work]
    }
}

flows!(JohnsonCook);
