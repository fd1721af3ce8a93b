//! Metals under uniaxial stress at small strain: bars, and the fibres of beams.
//!
//! σ = E (ε - ε_x), yield at |σ| = σ_y, flow dε_x = sign(σ) dε_p. That is von Mises flow with one stress: its sides are free, the plastic
//! flow keeps the volume, and the equivalent plastic strain is the axial one, summed up. The return over a step is that of
//! [`flow`](crate::flow) with E in the place of 3μ,
//!
//! |E (ε - ε_x)| - E Δε_p = σ_y(Δε_p),
//!
//! with the consistent tangent E H/(E + H), H = dσ_y/dΔε_p, where it flows. Energies are those of the hardening in solids. The history is
//! ε_x, ε_p, and what the hardening keeps beside it. Simo and Hughes (1998), Computational Inelasticity, chapter 1.

use std::fmt::Debug;

use crate::hardening::Hardening;

/// Place of ε_p in the history.
pub(crate) const PLASTIC: usize = 1;

/// What a law answers under uniaxial stress at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct UniaxialResponse {
    /// Stress σ in Pa, positive in tension.
    pub stress: f64,
    /// dσ/dε of the step in Pa.
    pub tangent: f64,
    /// Energy per volume that elastic strain stores, in J/m³.
    pub stored: f64,
    /// Energy per volume that hardening stores, in J/m³.
    pub hardening: f64,
    /// Energy per volume dissipated since the old history, in J/m³, not negative.
    pub dissipated: f64,
}

/// A law under uniaxial stress at small strain, at one point. The history of a point that nothing has happened to is zero.
pub trait Uniaxial: Debug + Send + Sync {
    /// Numbers that the law keeps of a point from one step to the next: the axial plastic strain, the equivalent one, and more.
    fn history_len(&self) -> usize;

    /// Young's modulus, Pa: the stress is its product with the strain less the first number of the history.
    fn young(&self) -> f64;

    /// Equivalent plastic strain in the history of a point, without unit.
    fn plastic_strain(&self, history: &[f64]) -> f64 {
        history[PLASTIC]
    }

    /// Stress at a strain at the end of a step of `dt` (s) that began with the history `old`; writes the history there into `new`.
    fn update(&self, strain: f64, dt: f64, history: (&[f64], &mut [f64])) -> UniaxialResponse;
}

/// See [`Uniaxial::update`].
pub(crate) fn update<H: Hardening>(
    law: &H,
    strain: f64,
    dt: f64,
    (old, new): (&[f64], &mut [f64]),
) -> UniaxialResponse {
    let young = law.elastic().young;
    let trial = young * (strain - old[0]);
    let [slip, slope] = law.slip(trial.abs(), young, &old[PLASTIC..], dt);
    new[0] = old[0] + trial.signum() * slip;
    new[PLASTIC] = old[PLASTIC] + slip;
    // not E (ε - ε_x), whose rounding is that of the plastic strain
    let size = trial.abs() - young * slip;
    let kept = (&old[PLASTIC..], &mut new[PLASTIC..]);
    let [hardening, dissipated] = law.spent(slip, size, kept);
    UniaxialResponse {
        stress: size.copysign(trial),
        tangent: match slip > 0.0 {
            true => young * slope / (young + slope),
            false => young,
        },
        stored: 0.5 * size * size / young,
        hardening,
        dissipated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, HardeningPoint, J2Plasticity, J2Table, JohnsonCook, Thermal};

    const STEEL: Elastic = Elastic {
        density: 7800.0,
        young: 2e11,
        poisson: 0.3,
    };

    fn linear(hardening: f64) -> J2Plasticity {
        J2Plasticity {
            initial: STEEL,
            yield_stress: 3e8,
            hardening,
        }
    }

    fn laws() -> Vec<Box<dyn Uniaxial>> {
        let point = |strain, stress| HardeningPoint { strain, stress };
        let points = [point(0.0, 3e8), point(1e-3, 3.5e8), point(5e-3, 4e8)];
        let table = J2Table::new(STEEL, &points);
        let cook = JohnsonCook {
            initial: STEEL,
            yield_stress: 3e8,
            hardening: 5e8,
            exponent: 0.3,
            rate_factor: 0.02,
            reference_rate: 1.0,
            thermal: Some(Thermal {
                exponent: 1.0,
                melting_rise: 1500.0,
                specific_heat: 460.0,
                converted: 0.9,
            }),
        };
        let mut laws: Vec<Box<dyn Uniaxial>> = vec![
            Box::new(linear(0.0)),
            Box::new(linear(2e10)),
            Box::new(cook),
        ];
        laws.extend(table.map(|table| Box::new(table) as Box<dyn Uniaxial>));
        laws
    }

    /// The response after a way of strains, and the history there.
    fn after(law: &dyn Uniaxial, way: &[f64], dt: f64) -> (UniaxialResponse, Vec<f64>) {
        let mut old = vec![0.0; law.history_len()];
        let mut last = UniaxialResponse::default();
        for &strain in way {
            let mut new = old.clone();
            last = law.update(strain, dt, (&old, &mut new));
            old = new;
        }
        (last, old)
    }

    #[test]
    fn a_cycle_with_linear_hardening_has_the_corners_of_the_closed_form() {
        let (h, yield_stress) = (2e10, 3e8);
        let law = linear(h);
        let slope = STEEL.young * h / (STEEL.young + h);
        let top = yield_stress + slope * (4e-3 - yield_stress / STEEL.young);
        let (found, _) = after(&law, &[1e-3, 4e-3], 1.0);
        // rounding of a few operations
        assert!((found.stress / top - 1.0).abs() < 1e-14);
        assert!((found.tangent / slope - 1.0).abs() < 1e-14);
        // isotropic hardening: elastic over twice the largest stress, and the same slope from there
        let reversed = 4e-3 - 2.0 * top / STEEL.young;
        let bottom = -top + slope * (-4e-3 - reversed);
        let (found, history) = after(&law, &[4e-3, 0.0, -4e-3], 1.0);
        assert!((found.stress / bottom - 1.0).abs() < 1e-13);
        assert!((history[0] - (-4e-3 - bottom / STEEL.young)).abs() < 1e-17);
        let slips = [top, bottom].map(|stress| (stress.abs() - yield_stress) / h);
        assert!((history[1] - slips[1]).abs() < 1e-16);
        assert!(slips[1] > slips[0]);
    }

    #[test]
    fn the_tangent_is_the_derivative_of_the_stress() {
        for law in laws() {
            let way = [1e-3, 3e-3, 6e-3, -1e-3];
            for end in [1.3e-3, -4e-3, 8e-3] {
                let (_, old) = after(&*law, &way, 1e-4);
                let at = |strain: f64| law.update(strain, 1e-4, (&old, &mut old.clone()));
                let step = 1e-8;
                let slope = (at(end + step).stress - at(end - step).stress) / (2.0 * step);
                // the square of the step times third derivatives, and rounding over it
                let tangent = at(end).tangent;
                assert!(
                    (slope - tangent).abs() < 1e-6 * STEEL.young,
                    "{slope} {tangent}"
                );
            }
        }
    }

    #[test]
    fn the_work_of_small_steps_is_stored_and_dissipated() {
        for law in laws() {
            let mut old = vec![0.0; law.history_len()];
            let (mut work, mut dissipated, mut before) = (0.0, 0.0, UniaxialResponse::default());
            let (count, mut last) = (200_000, 0.0);
            for k in 1..=count {
                let strain = 5e-3 * (7.0 * f64::from(k) / f64::from(count)).sin();
                let mut new = old.clone();
                let now = law.update(strain, 1e-6, (&old, &mut new));
                work += 0.5 * (before.stress + now.stress) * (strain - last);
                assert!(now.dissipated >= 0.0);
                dissipated += now.dissipated;
                (old, last, before) = (new, strain, now);
            }
            let spent = before.stored + before.hardening + dissipated;
            // first order in the step, 1.75e-7 of strain, over a strain of yield of 1.5e-3: 1e-4
            assert!((work - spent).abs() < 1e-4 * work, "{work} {spent}");
        }
    }

    #[test]
    fn an_unloaded_point_keeps_stress_and_history_without_a_change_of_strain() {
        for law in laws() {
            let (found, old) = after(&*law, &[6e-3, 5e-3], 1e-4);
            let mut new = old.clone();
            let again = law.update(5e-3, 0.0, (&old, &mut new));
            assert_eq!((again.stress, &new), (found.stress, &old));
            assert_eq!(again.dissipated, 0.0);
        }
    }
}
