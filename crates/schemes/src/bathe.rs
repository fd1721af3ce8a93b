//! Bathe's composite scheme.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::step_map::{Impulse, Row, StepMap};
use crate::{EnergyIdentity, TimeScheme};

/// Ratio with which both stages have one effective matrix, 2 - √2.
const EQUAL: f64 = 2.0 - std::f64::consts::SQRT_2;
/// Relative difference of two factors of the stiffness that is rounding.
const ROUNDING: f64 = 1e-14;

/// Trapezoidal rule over γ dt, then the three-point backward formula over the whole step. Two stages, each with a balance of its own:
///
/// 1. `u_γ = u + γ dt/2 (v + v_γ)`, `v_γ = v + γ dt/2 (a + a_γ)`, `M a_γ + f(u_γ) = p_ext + Nᵀ P_γ`;
/// 2. `v₊ = c₁ u + c₂ u_γ + c₃ u₊`, `a₊ = c₁ v + c₂ v_γ + c₃ v₊`, `M a₊ + f(u₊) = p_ext + Nᵀ P₊`, with
///    `c₁ = (1 - γ)/(γ dt)`, `c₂ = -1/((1 - γ) γ dt)`, `c₃ = (2 - γ)/((1 - γ) dt)`.
///
/// The unknown is the acceleration at the end of the stage. Stage 2 needs u and v at the start of the step. The memory holds v; the
/// trapezoidal rule gives `u = u_γ - γ dt/2 (v + v_γ)`. With `b = 1/c₃`, `r = c₁/c₃` and the memory m stage 2 is
///
/// `v₊ = (1 + r) v_γ - r m + b a₊`, `u₊ = u_γ + b v₊ + b (1 - γ)/2 (m + v_γ)`.
///
/// Of second order, stable at any step without contact; the amplification factors vanish at infinite frequency. Contact laws hold at
/// the ends of both stages, for gap and rate there. The effective matrices are `M + (γ dt/2)² K` and `M + b² K`, the same for
/// γ = 2 - √2.
///
/// Momentum: with F the forces at the instants, `M (v_γ - v) = γ dt/2 (F + F_γ)` and `M (v₊ - v_γ) = b (F₊ + (1 - γ)/2 (F + F_γ))`.
///
/// Without forces from outside the energy of a linear system grows in no step: on `ẏ = J y` with J skew in the energy the scheme is one
/// rational function R(dt J) with `|R| <= 1` on the imaginary axis. Of stage 2 no identity with terms of one sign is known; the energy is
/// balanced by works.
///
/// Source: Bathe, Baig, Computers & Structures 83 (2005) 2513; Bathe, Computers & Structures 85 (2007) 437. Their texts
/// were not at hand: the stages are those of the later literature on the scheme, impulses and memory are derived here.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
#[schemars(description = "Bathe's scheme.")]
pub struct Bathe {
    /// Part of the step that the trapezoidal rule takes. The default 2 - √2 = 0.5858 gives both stages one effective matrix; others cost
    /// two factors.
    #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 1.0))]
    pub gamma: f64,
}

impl Default for Bathe {
    fn default() -> Bathe {
        Bathe { gamma: EQUAL }
    }
}

impl Bathe {
    /// Factors of the new acceleration in the new velocity of both stages, over the step: γ/2 and (1 - γ)/(2 - γ). The same bits where they differ by
    /// rounding, so that one factor serves both.
    fn factors(&self) -> [f64; 2] {
        let gamma = self.gamma;
        let [first, second] = [0.5 * gamma, (1.0 - gamma) / (2.0 - gamma)];
        match (first - second).abs() <= ROUNDING * first {
            true => [first; 2],
            false => [first, second],
        }
    }

    /// A stage that ends in balance, from its motion.
    fn ending(displacement: Row, velocity: Row, memory: Row, impulse: Impulse) -> StepMap {
        StepMap {
            inertia: Row::UNKNOWN,
            force: displacement,
            force_fraction: Some(1.0),
            displacement,
            velocity,
            acceleration: Row::UNKNOWN,
            placed: Row::START,
            gap: displacement,
            rate: velocity,
            moves: 0.0,
            memory,
            contact: 1.0,
            impulse,
            contact_impulse: impulse,
        }
    }

    /// Stage 1 of a step of `dt`.
    fn trapezoid(&self, dt: f64) -> StepMap {
        let half = self.factors()[0] * dt;
        let velocity = Row {
            v: 1.0,
            a: half,
            x: half,
            ..Row::default()
        };
        let displacement = Row {
            u: 1.0,
            v: 2.0 * half,
            a: half * half,
            x: half * half,
            ..Row::default()
        };
        // R = F + F_γ, which stage 2 needs
        let impulse = Impulse {
            old: 0.0,
            new: 0.5,
            gain: 1.0,
            carry: -1.0,
        };
        StepMap {
            moves: self.gamma * dt,
            ..Bathe::ending(displacement, velocity, Row::MOVING, impulse)
        }
    }

    /// Stage 2 of a step of `dt`.
    fn backward(&self, dt: f64) -> StepMap {
        let gamma = self.gamma;
        let b = self.factors()[1] * dt;
        let r = (1.0 - gamma).powi(2) / (gamma * (2.0 - gamma));
        let before = 0.5 * (1.0 - gamma);
        let velocity = Row {
            v: 1.0 + r,
            m: -r,
            x: b,
            ..Row::default()
        };
        let displacement = Row {
            u: 1.0,
            v: b * (velocity.v + before),
            m: b * (velocity.m + before),
            x: b * b,
            ..Row::default()
        };
        let memory = Row {
            m: 1.0,
            ..Row::default()
        };
        let new = 1.0 / (2.0 - gamma);
        let impulse = Impulse::weights(before * new, new);
        StepMap {
            moves: (1.0 - gamma) * dt,
            ..Bathe::ending(displacement, velocity, memory, impulse)
        }
    }
}

impl TimeScheme for Bathe {
    fn name(&self) -> &'static str {
        "bathe"
    }

    /// That of stage 2.
    fn step_map(&self, dt: f64) -> StepMap {
        self.backward(dt)
    }

    fn stages(&self) -> Vec<f64> {
        vec![self.gamma, 1.0 - self.gamma]
    }

    fn stage_map(&self, stage: usize, dt: f64) -> StepMap {
        match stage {
            0 => self.trapezoid(dt),
            _ => self.backward(dt),
        }
    }

    fn energy_identity(&self, _dt: f64) -> Option<EnergyIdentity> {
        None
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

    fn usual() -> Vec<Bathe> {
        vec![Bathe::default(), Bathe { gamma: 0.5 }]
    }
}

#[cfg(test)]
mod tests {
    use super::Bathe;
    use crate::TimeScheme;
    use crate::step_map::{Known, Row, StepMap};

    /// u, v, a and memory of one unknown.
    type Motion = [f64; 4];

    /// One stage of `u'' + c u' + k u = p` with p at its end.
    fn stage(map: &StepMap, [c, k, p]: [f64; 3], motion: Motion) -> Motion {
        let [u, v, a, memory] = motion.map(|value| [value]);
        let known = |row: &Row, x: f64| {
            let mut out = [0.0];
            let start = Known {
                u: &u,
                v: &v,
                a: &a,
                memory: &memory,
            };
            row.whole(start, &[x], &[0.0], &mut out);
            out[0]
        };
        let left = |x: f64| {
            known(&map.inertia, x) + c * known(&map.velocity, x) + k * known(&map.force, x) - p
        };
        let x = left(0.0) / (left(0.0) - left(1.0));
        [
            &map.displacement,
            &map.velocity,
            &map.acceleration,
            &map.memory,
        ]
        .map(|row| known(row, x))
    }

    /// A step of `dt` under a load that does not change.
    fn step(scheme: &Bathe, dt: f64, spring: [f64; 3], motion: Motion) -> Motion {
        (0..2).fold(motion, |motion, k| {
            stage(&scheme.stage_map(k, dt), spring, motion)
        })
    }

    /// From displacement and velocity in balance.
    fn in_balance([c, k, p]: [f64; 3], u: f64, v: f64) -> Motion {
        [u, v, p - c * v - k * u, f64::NAN]
    }

    /// R(iΩ) of a step, from the motion with ω = 1 that starts with u = 1: u - i v turns by it.
    fn amplification(scheme: &Bathe, omega: f64) -> [f64; 2] {
        let free = [0.0, 1.0, 0.0];
        let [u, v, ..] = step(scheme, omega, free, in_balance(free, 1.0, 0.0));
        [u, -v]
    }

    /// R(iΩ) of the formulas of the two stages on y' = λ y.
    fn by_formulas(gamma: f64, omega: f64) -> [f64; 2] {
        let times = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [a * c - b * d, a * d + b * c];
        let over = |a: [f64; 2], [c, d]: [f64; 2]| {
            let size = c * c + d * d;
            times(a, [c / size, -d / size])
        };
        let half = 0.5 * gamma * omega;
        let first = over([1.0, half], [1.0, -half]);
        let [c1, c2, c3] = [
            (1.0 - gamma) / gamma,
            -1.0 / ((1.0 - gamma) * gamma),
            (2.0 - gamma) / (1.0 - gamma),
        ];
        let above = [-c1 - c2 * first[0], -c2 * first[1]];
        over(above, [c3, -omega])
    }

    const GAMMAS: [f64; 4] = [super::EQUAL, 0.5, 0.3, 0.8];

    #[test]
    fn a_step_of_an_oscillator_is_that_of_the_two_formulas() {
        for gamma in GAMMAS {
            for omega in [1e-3, 0.1, 1.0, 10.0, 1e4] {
                let [one, other] = [
                    amplification(&Bathe { gamma }, omega),
                    by_formulas(gamma, omega),
                ];
                for i in 0..2 {
                    // rounding of sums of terms of size Ω in u and v
                    let bound = 1e-14 * (1.0 + omega);
                    assert!(
                        (one[i] - other[i]).abs() < bound,
                        "{gamma}, {omega}: {one:?} {other:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_mode_grows_and_stiff_ones_vanish_in_a_step() {
        for gamma in GAMMAS {
            let radius = |omega: f64| {
                let [re, im] = by_formulas(gamma, omega);
                re.hypot(im)
            };
            for k in -60..=60 {
                let omega = 10_f64.powf(0.1 * f64::from(k));
                // |R| = 1 - O(Ω⁴): rounding alone at the lower end
                assert!(
                    radius(omega) < 1.0 + 1e-15,
                    "{gamma}, {omega}: {}",
                    radius(omega)
                );
            }
            // R -> (c₂ T(∞) + c₁)/z with T = -1
            assert!(radius(1e8) < 1e-6, "{gamma}: {}", radius(1e8));
        }
    }

    #[test]
    fn the_period_is_longer_by_the_error_constant() {
        for gamma in GAMMAS {
            // e^z - R = K z³ + ... of the trapezoidal rule with backward differences of two steps (Bank et al. 1985)
            let constant = (3.0 * gamma * gamma - 4.0 * gamma + 2.0) / (12.0 * (2.0 - gamma));
            for omega in [0.01, 0.02] {
                let [re, im] = by_formulas(gamma, omega);
                let elongation = omega / im.atan2(re) - 1.0;
                // terms of fourth order in Ω, with factors of order 1, and rounding
                let error = elongation / (omega * omega) - constant;
                assert!(error.abs() < omega * omega, "{gamma}, {omega}: {error}");
            }
        }
    }

    #[test]
    fn a_damped_oscillator_converges_with_order_two() {
        // a quarter of critical damping to t = 2
        let (c, k) = (0.5_f64, 1.0_f64);
        let ring = (k - 0.25 * c * c).sqrt();
        let exact = |t: f64| {
            let (sin, cos) = (ring * t).sin_cos();
            let decay = (-0.5 * c * t).exp();
            [
                decay * (cos + 0.5 * c / ring * sin),
                -decay * k / ring * sin,
            ]
        };
        for scheme in Bathe::usual() {
            let error = |steps: usize| {
                let start = in_balance([c, k, 0.0], 1.0, 0.0);
                let dt = 2.0 / steps as f64;
                let end =
                    (0..steps).fold(start, |motion, _| step(&scheme, dt, [c, k, 0.0], motion));
                let exact = exact(2.0);
                [0, 1].map(|i| (end[i] - exact[i]).abs())
            };
            let (coarse, fine) = (error(100), error(200));
            for i in 0..2 {
                let order = (coarse[i] / fine[i]).log2();
                // the terms beside are smaller by dt = 0.02
                assert!((order - 2.0).abs() < 0.05, "{scheme:?}: {order}");
            }
        }
    }

    #[test]
    fn uniform_acceleration_is_exact() {
        let (dt, load) = (0.3, 2.0);
        for scheme in Bathe::usual() {
            let force = [0.0, 0.0, load];
            let [u, v, a, _] = step(&scheme, dt, force, in_balance(force, 1.0, -3.0));
            let exact = [
                1.0 - 3.0 * dt + 0.5 * load * dt * dt,
                -3.0 + load * dt,
                load,
            ];
            for (value, exact) in [u, v, a].into_iter().zip(exact) {
                assert!((value - exact).abs() < 1e-14, "{scheme:?}: {value} {exact}");
            }
        }
    }

    #[test]
    fn forces_change_the_momentum_with_the_weights_of_the_stages() {
        let dt = 0.3;
        for scheme in Bathe::usual() {
            // as a unit mass has them at the start and at the end of each stage
            let forces = [0.7, -2.0, 1.3];
            let mut motion = in_balance([0.0, 0.0, forces[0]], 0.0, 0.4);
            let (mut before, lengths) = (forces[0], scheme.stages());
            for k in 0..2 {
                let map = scheme.stage_map(k, dt);
                let next = stage(&map, [0.0, 0.0, forces[k + 1]], motion);
                let impulse = map.impulse;
                let now = impulse.gain * forces[k + 1] - impulse.carry * before;
                let given = lengths[k] * dt * (impulse.old * before + impulse.new * now);
                assert!(
                    (next[1] - motion[1] - given).abs() < 1e-15,
                    "{scheme:?}, {k}"
                );
                (motion, before) = (next, now);
            }
        }
    }

    #[test]
    fn both_stages_have_one_matrix_with_the_default() {
        let factors = |gamma: f64| {
            let scheme = Bathe { gamma };
            [0, 1].map(|k| scheme.stage_map(k, 0.37).displacement.x)
        };
        let [one, other] = factors(super::EQUAL);
        assert_eq!(one.to_bits(), other.to_bits());
        let [one, other] = factors(0.585_786_437_626_905);
        assert_eq!(one.to_bits(), other.to_bits());
        let [one, other] = factors(0.5);
        assert!((one - other).abs() > 0.1 * one);
    }
}
