//! A scheme in extended state space after Krenk.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Mean values in state space, with a dissipation that acts alike on displacement and velocity, through the changes of
/// two filtered increments s and t. With ū and v̄ the means of the step,
///
/// `M Δv/dt + f(ū + ½αν Δs) = p_ext + Nᵀ P`, `Δu/dt = v̄ + ½αν Δt`, `ν Δs + s̄ = Δu`, `ν Δt + t̄ = Δv`,
///
/// the last two first-order filters of the time constant ν dt. Slow motion has s ≈ dt u̇ and t ≈ dt v̇, so that Δs and Δt
/// are of second order and the damping ratio of the third: second order, against the first of a balanced damping by Δu and
/// Δv themselves, which is [`Theta`](crate::Theta). At infinite frequency the amplification factors coincide for α = ν/2,
/// in -(1 - ν)/(1 + ν): ν = (1 - ρ∞)/(1 + ρ∞). Stable at any step; no overshoot, since the energy below is positive.
///
/// The unknown is v₊, the state keeps a = t/dt, the acceleration reported, and the memory m = s/dt. With κ = ν + ½ and
/// q = αν/κ: `u₊ = u + dt ((1 - q) v + (1 + q) v₊)/2 - q dt²/2 a`, internal forces at
/// `u + (1 + q)/2 Δu - q dt/2 m`, `a₊ = (Δv/dt + (ν - ½) a)/κ`, `m₊ = (Δu/dt + (ν - ½) m)/κ`; at the start m = v.
///
/// Energy identity: `Δ(E + ¼αν dt² (|m|²_K + |a|²_M)) = Δu · F - ½αν² dt² (|Δm|²_K + |Δa|²_M)`, from the balance times Δu with
/// `Δu · K Δs = (s̄ + ν Δs) · K Δs`, and alike for t.
///
/// Source: Krenk, International Journal for Numerical Methods in Engineering 73 (2008) 1767, whose text was not at hand:
/// extended state space, first-order filters and balance are its ideas; equations, parameters and identity are derived
/// here, so that its own parameters may differ. Contact, with the force of the step in the balance, is ours.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "The scheme in extended state space after Krenk.")]
pub struct Krenk {
    /// Spectral radius at infinite frequency: 1 damps nothing, 0 most.
    #[schemars(extend("minimum" = 0.0, "maximum" = 1.0))]
    pub rho_inf: f64,
}

impl Default for Krenk {
    fn default() -> Krenk {
        Krenk { rho_inf: 0.8 }
    }
}

impl Krenk {
    /// ν.
    fn delay(&self) -> f64 {
        (1.0 - self.rho_inf) / (1.0 + self.rho_inf)
    }
}

impl TimeScheme for Krenk {
    fn name(&self) -> &'static str {
        "krenk"
    }

    fn step_map(&self, dt: f64) -> StepMap {
        let nu = self.delay();
        let kappa = nu + 0.5;
        let q = 0.5 * nu * nu / kappa;
        let moved = |row: Row, factor: f64| Row {
            u: 0.0,
            v: row.v * factor,
            a: row.a * factor,
            x: row.x * factor,
            ..Row::default()
        };
        let displacement = Row {
            u: 1.0,
            v: 0.5 * dt * (1.0 - q),
            a: -0.5 * q * dt * dt,
            x: 0.5 * dt * (1.0 + q),
            ..Row::default()
        };
        let velocity = Row::UNKNOWN;
        StepMap {
            inertia: Row {
                v: -1.0 / dt,
                x: 1.0 / dt,
                ..Row::default()
            },
            force: Row {
                u: 1.0,
                m: -0.5 * q * dt,
                ..moved(displacement, 0.5 * (1.0 + q))
            },
            force_fraction: None,
            displacement,
            velocity,
            acceleration: Row {
                v: -1.0 / (kappa * dt),
                a: (nu - 0.5) / kappa,
                x: 1.0 / (kappa * dt),
                ..Row::default()
            },
            placed: Row::START,
            gap: displacement,
            rate: velocity,
            moves: dt,
            memory: Row {
                m: (nu - 0.5) / kappa,
                ..moved(displacement, 1.0 / (kappa * dt))
            },
            contact: 1.0,
            impulse: Impulse::weights(0.0, 1.0),
            contact_impulse: Impulse::weights(0.0, 1.0),
        }
    }

    fn energy_identity(&self, dt: f64) -> Option<EnergyIdentity> {
        let nu = self.delay();
        let stored = 0.125 * nu * nu * dt * dt;
        let lost = 0.25 * nu.powi(3) * dt * dt;
        Some(EnergyIdentity {
            inertia: stored,
            memory: stored,
            new: 1.0,
            acceleration: lost,
            filtered: lost,
            ..EnergyIdentity::default()
        })
    }

    fn keeps_acceleration(&self) -> bool {
        true
    }

    fn order(&self) -> u32 {
        2
    }

    fn critical(&self) -> Option<f64> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Known;

    /// Vectors of one unknown.
    struct Motion {
        u: Vec<f64>,
        v: Vec<f64>,
        a: Vec<f64>,
        memory: Vec<f64>,
    }

    impl<'a> From<&'a Motion> for Known<'a> {
        fn from(motion: &'a Motion) -> Known<'a> {
            let Motion { u, v, a, memory } = motion;
            Known { u, v, a, memory }
        }
    }

    /// One unknown with infinite stiffness: the step leaves no internal force.
    fn stiff_step(map: &StepMap, motion: &Motion) -> Motion {
        let [mut out, mut known] = [[0.0]; 2];
        map.force.known(motion, &mut known);
        let x = [-known[0] / map.force.x];
        let mut row = |row: &Row| {
            row.whole(motion, &x, &[0.0], &mut out);
            out.to_vec()
        };
        Motion {
            u: row(&map.displacement),
            v: row(&map.velocity),
            a: row(&map.acceleration),
            memory: row(&map.memory),
        }
    }

    #[test]
    fn all_amplification_factors_at_infinite_frequency_are_minus_the_radius() {
        for rho_inf in [0.0, 0.3, 0.8] {
            let map = Krenk { rho_inf }.step_map(1.0);
            for start in 0..4 {
                let unit = |k: usize| vec![f64::from(u8::from(k == start))];
                let mut motion = Motion {
                    u: unit(0),
                    v: unit(1),
                    a: unit(2),
                    memory: unit(3),
                };
                // (A + ρ)⁴ = 0 by Cayley and Hamilton, if -ρ is the root of all four factors
                for _ in 0..4 {
                    let next = stiff_step(&map, &motion);
                    let sum = |new: Vec<f64>, old: &[f64]| vec![new[0] + rho_inf * old[0]];
                    motion = Motion {
                        u: sum(next.u, &motion.u),
                        v: sum(next.v, &motion.v),
                        a: sum(next.a, &motion.a),
                        memory: sum(next.memory, &motion.memory),
                    };
                }
                for left in [&motion.u, &motion.v, &motion.a, &motion.memory] {
                    assert!(left[0].abs() < 1e-12, "{rho_inf}, {start}: {left:?}");
                }
            }
        }
    }
}
