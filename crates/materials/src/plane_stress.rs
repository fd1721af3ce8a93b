//! Metals under plane stress at small strain: points through the thickness of shells.
//!
//! σ = C : (ε - ε_x) with von Mises flow, the return over a step of [`flow`](crate::flow) with 3μ at small strain: with the trial stress's
//! deviator s and q = √(3/2 s:s), σ = σ_trial - 3μ Δε_p s/q, Δε_x = 3/2 Δε_p s/q. The strain across is the one with σ₃₃ = 0, by Newton's method: σ₃₃ grows with it,
//! and its slope is an entry of the consistent tangent
//!
//! C = K 1⊗1 + 2μ θ (I - 1⊗1/3) - 2μ θ̄ n⊗n, θ = 1 - 3μ Δε_p/q, θ̄ = 3μ/(3μ + H) - (1 - θ), n = s/|s|,
//!
//! that of the plane after elimination of ε₃₃ (static condensation). Simo and Hughes (1998), Computational Inelasticity, boxes 3.1 and 3.2. The history is
//! ε_x (11, 22, twice 12), ε_p, and what the hardening keeps beside it.

use std::fmt::Debug;

use carom_algebra::number::Number;

use crate::hardening::Hardening;
use crate::plane_points::{ITERATIONS, PLASTIC, PlaneStressPoints, ROUNDING};

/// What a law answers under plane stress at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneStressResponse {
    /// σ₁₁, σ₂₂, σ₁₂ in Pa.
    pub stress: [f64; 3],
    /// Derivative of the stress by ε₁₁, ε₂₂, 2ε₁₂, in Pa; symmetric.
    pub tangent: [[f64; 3]; 3],
    /// Energy per volume that elastic strain stores, in J/m³.
    pub stored: f64,
    /// Energy per volume that hardening stores, in J/m³.
    pub hardening: f64,
    /// Energy per volume dissipated since the old history, in J/m³, not negative.
    pub dissipated: f64,
}

/// A law under plane stress at small strain, at one point. The history of a point that nothing has happened to is zero.
pub trait PlaneStress: Debug + Send + Sync {
    /// Numbers that the law keeps of a point from one step to the next: three plastic strains, the equivalent one, and more.
    fn history_len(&self) -> usize;

    /// Equivalent plastic strain in the history of a point, without unit.
    fn plastic_strain(&self, history: &[f64]) -> f64 {
        history[PLASTIC]
    }

    /// Stress at the strain ε₁₁, ε₂₂, 2ε₁₂ in a history that is known.
    fn stress(&self, strain: &[f64; 3], history: &[f64]) -> [f64; 3];

    /// Stress at a strain at the end of a step of `dt` (s) that began with the history `old`; writes the history there into `new`.
    fn update(
        &self,
        strain: &[f64; 3],
        dt: f64,
        history: (&[f64], &mut [f64]),
    ) -> PlaneStressResponse;

    /// The same at several points side by side, without the tangent.
    fn side_by_side(&self, dt: f64, points: &mut PlaneStressPoints);
}

/// See [`PlaneStress::stress`].
pub(crate) fn stress<H: Hardening>(law: &H, strain: &[f64; 3], history: &[f64]) -> [f64; 3] {
    let elastic = law.elastic();
    let [x, y, xy] = [0, 1, 2].map(|i| strain[i] - history[i]);
    let plane = elastic.young / (1.0 - elastic.poisson.powi(2));
    [
        plane * (x + elastic.poisson * y),
        plane * (y + elastic.poisson * x),
        elastic.shear_modulus() * xy,
    ]
}

/// The return of a trial elastic strain 11, 22, 33, 2·12.
struct Return<T> {
    /// σ₁₁, σ₂₂, σ₃₃, σ₁₂.
    stress: [T; 4],
    /// s/|s|.
    normal: [T; 4],
    /// q at the end, and Δε_p.
    size: T,
    slip: T,
    /// θ, and θ̄, none where nothing flows.
    kept: T,
    turned: T,
}

#[inline(always)]
fn returned<H: Hardening, T: Number>(law: &H, strain: &[T; 4], old: &[T], dt: f64) -> Return<T> {
    let shear = law.elastic().shear_modulus();
    let [x, y, z, xy] = *strain;
    let trace = x + y + z;
    let third = trace.scale(1.0 / 3.0);
    let s = [
        (x - third).scale(2.0 * shear),
        (y - third).scale(2.0 * shear),
        (z - third).scale(2.0 * shear),
        xy.scale(shear),
    ];
    let square = s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + (s[3] * s[3]).scale(2.0);
    let norm = square.sqrt();
    let q = norm.scale(1.5_f64.sqrt());
    let (one, tiny) = (q.like(1.0), q.like(f64::MIN_POSITIVE));
    let [slip, slope] = law.slip(q, 3.0 * shear, &old[PLASTIC..], dt);
    let lost = slip.scale(3.0 * shear) / q.most(tiny);
    let kept = one - lost;
    let unit = one / norm.most(tiny);
    let pressure = trace.scale(bulk(law));
    let stress = [
        s[0].mul_add(kept, pressure),
        s[1].mul_add(kept, pressure),
        s[2].mul_add(kept, pressure),
        s[3] * kept,
    ];
    let flowing = q.like(3.0 * shear) / (slope + q.like(3.0 * shear)) - lost;
    Return {
        stress,
        normal: s.map(|s| s * unit),
        size: q * kept,
        slip,
        kept,
        turned: q.like(0.0).if_below(slip, flowing, q.like(0.0)),
    }
}

/// K.
fn bulk<H: Hardening>(law: &H) -> f64 {
    let elastic = law.elastic();
    elastic.young / (3.0 * (1.0 - 2.0 * elastic.poisson))
}

impl<T: Number> Return<T> {
    /// ∂σ₃₃/∂ε₃₃.
    #[inline(always)]
    fn across<H: Hardening>(&self, law: &H) -> T {
        let shear = law.elastic().shear_modulus();
        let n = self.normal[2];
        self.kept.scale_add(4.0 / 3.0 * shear, n.like(bulk(law)))
            - (self.turned * n * n).scale(2.0 * shear)
    }
}

/// C over 11, 22, 33 and 2·12.
fn tangent<H: Hardening>(law: &H, at: &Return<f64>) -> [[f64; 4]; 4] {
    let (shear, bulk) = (law.elastic().shear_modulus(), bulk(law));
    std::array::from_fn(|i| {
        std::array::from_fn(|j| {
            let identity = match (i == j, i == 3) {
                (true, true) => 0.5,
                (true, false) => 1.0,
                (false, _) => 0.0,
            };
            let trace = if i < 3 && j < 3 { 1.0 } else { 0.0 };
            bulk * trace + 2.0 * shear * at.kept * (identity - trace / 3.0)
                - 2.0 * shear * at.turned * at.normal[i] * at.normal[j]
        })
    })
}

/// The return without stress across, for one number or for one of each of several points; what elastic strain and hardening store and what is dissipated,
/// J/m³. Iterations end where all have converged.
#[inline(always)]
fn ended<H: Hardening, T: Number>(
    law: &H,
    strain: &[T; 3],
    dt: f64,
    (old, new): (&[T], &mut [T]),
) -> (Return<T>, [T; 3]) {
    let elastic = law.elastic();
    let (young, poisson) = (elastic.young, elastic.poisson);
    let (x, y, xy) = (strain[0] - old[0], strain[1] - old[1], strain[2] - old[2]);
    // elastic strain across without flow
    let mut trial = [x, y, (x + y).scale(-poisson / (1.0 - poisson)), xy];
    let mut at = returned(law, &trial, old, dt);
    for _ in 0..ITERATIONS {
        let [a, b, across, c] = at.stress;
        let size = a.abs().most(b.abs()).most(c.abs());
        if (across.abs() - size.scale(ROUNDING)).largest() <= 0.0 {
            break;
        }
        trial[2] -= across / at.across(law);
        at = returned(law, &trial, old, dt);
    }
    let flow = at.slip.scale(1.5_f64.sqrt());
    new[0] = old[0] + flow * at.normal[0];
    new[1] = old[1] + flow * at.normal[1];
    new[2] = old[2] + (flow * at.normal[3]).scale(2.0);
    new[PLASTIC] = old[PLASTIC] + at.slip;
    let kept = (&old[PLASTIC..], &mut new[PLASTIC..]);
    let [hardening, dissipated] = law.spent(at.slip, at.size, kept);
    let [a, b, _, c] = at.stress;
    let direct = a * a + b * b - (a * b).scale(2.0 * poisson);
    let stored = direct.scale(0.5 / young) + (c * c).scale(0.5 / elastic.shear_modulus());
    (at, [stored, hardening, dissipated])
}

/// Stress and energies at the end of the step, of one point in each lane.
#[inline(always)]
pub(crate) fn of_lanes<H: Hardening, T: Number>(
    law: &H,
    strain: &[T; 3],
    dt: f64,
    history: (&[T], &mut [T]),
) -> ([T; 3], [T; 3]) {
    let (at, energies) = ended(law, strain, dt, history);
    let [a, b, _, c] = at.stress;
    ([a, b, c], energies)
}

/// See [`PlaneStress::update`].
pub(crate) fn update<H: Hardening>(
    law: &H,
    strain: &[f64; 3],
    dt: f64,
    history: (&[f64], &mut [f64]),
) -> PlaneStressResponse {
    let (at, [stored, hardening, dissipated]) = ended(law, strain, dt, history);
    let [a, b, _, c] = at.stress;
    PlaneStressResponse {
        stress: [a, b, c],
        tangent: condensed(&tangent(law, &at)),
        stored,
        hardening,
        dissipated,
    }
}

/// C without the strain across.
fn condensed(whole: &[[f64; 4]; 4]) -> [[f64; 3]; 3] {
    let plane = [0, 1, 3];
    plane.map(|i| plane.map(|j| whole[i][j] - whole[i][2] * whole[2][j] / whole[2][2]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, HardeningPoint, J2Plasticity, J2Table, JohnsonCook, Uniaxial};

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

    fn laws() -> Vec<Box<dyn PlaneStress>> {
        let point = |strain, stress| HardeningPoint { strain, stress };
        let points = [point(0.0, 3e8), point(1e-3, 3.5e8), point(5e-3, 4e8)];
        let cook = JohnsonCook {
            initial: STEEL,
            yield_stress: 3e8,
            hardening: 5e8,
            exponent: 0.3,
            rate_factor: 0.02,
            reference_rate: 1.0,
            thermal: None,
        };
        vec![
            Box::new(linear(0.0)),
            Box::new(linear(2e10)),
            Box::new(cook),
            Box::new(J2Table::new(STEEL, &points).unwrap()),
        ]
    }

    /// The history after a way of strains.
    fn after(law: &dyn PlaneStress, way: &[[f64; 3]], dt: f64) -> Vec<f64> {
        let mut old = vec![0.0; law.history_len()];
        for strain in way {
            let mut new = old.clone();
            law.update(strain, dt, (&old, &mut new));
            old = new;
        }
        old
    }

    const WAY: [[f64; 3]; 3] = [[2e-3, 1e-3, 1e-3], [4e-3, -1e-3, 2e-3], [1e-3, 2e-3, -3e-3]];

    #[test]
    fn the_tangent_is_the_symmetric_derivative_of_the_stress() {
        for law in laws() {
            let old = after(&*law, &WAY, 1e-4);
            for end in [
                [1.2e-3, 2.1e-3, -3e-3],
                [-3e-3, 4e-3, 5e-3],
                [6e-3, 6e-3, 0.0],
            ] {
                let at = |strain: &[f64; 3]| law.update(strain, 1e-4, (&old, &mut old.clone()));
                let tangent = at(&end).tangent;
                for j in 0..3 {
                    let step = 1e-8;
                    let moved = |by: f64| {
                        let mut strain = end;
                        strain[j] += by;
                        at(&strain).stress
                    };
                    let (after, before) = (moved(step), moved(-step));
                    for i in 0..3 {
                        let slope = (after[i] - before[i]) / (2.0 * step);
                        // the square of the step times third derivatives, and rounding over it
                        assert!((slope - tangent[i][j]).abs() < 1e-6 * STEEL.young);
                        assert!((tangent[i][j] - tangent[j][i]).abs() < 1e-12 * STEEL.young);
                    }
                }
            }
        }
    }

    #[test]
    fn a_strip_that_is_free_at_its_sides_has_uniaxial_stress() {
        let law = linear(2e10);
        let uniaxial: &dyn Uniaxial = &law;
        let strain = 4e-3;
        let mut history = vec![0.0; uniaxial.history_len()];
        let fresh = history.clone();
        let exact = uniaxial.update(strain, 1.0, (&fresh, &mut history));
        // plastic flow keeps the volume
        let across = -STEEL.poisson * exact.stress / STEEL.young - 0.5 * history[0];
        let plane: &dyn PlaneStress = &law;
        let (old, mut new) = (
            vec![0.0; plane.history_len()],
            vec![0.0; plane.history_len()],
        );
        let found = plane.update(&[strain, across, 0.0], 1.0, (&old, &mut new));
        // rounding of the iterations
        assert!((found.stress[0] / exact.stress - 1.0).abs() < 1e-12);
        assert!(found.stress[1].abs() < 1e-12 * exact.stress && found.stress[2] == 0.0);
        assert!((new[PLASTIC] / history[1] - 1.0).abs() < 1e-12);
        assert!((found.dissipated / exact.dissipated - 1.0).abs() < 1e-12);
        assert!((found.stored / exact.stored - 1.0).abs() < 1e-12);
    }

    #[test]
    fn pure_shear_yields_at_the_yield_stress_over_the_root_of_three() {
        let law: &dyn PlaneStress = &linear(0.0);
        let old = vec![0.0; law.history_len()];
        let found = law.update(&[0.0, 0.0, 1e-2], 1.0, (&old, &mut old.clone()));
        assert!((found.stress[2] * 3.0_f64.sqrt() / 3e8 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_work_of_small_steps_is_stored_and_dissipated() {
        for law in laws() {
            let mut old = vec![0.0; law.history_len()];
            let (mut work, mut dissipated) = (0.0, 0.0);
            let (mut before, mut last) = (PlaneStressResponse::default(), [0.0; 3]);
            let count = 50_000;
            for k in 1..=count {
                let t = f64::from(k) / f64::from(count);
                let strain = [
                    5e-3 * (7.0 * t).sin(),
                    -4e-3 * t,
                    3e-3 * (5.0 * t).cos() - 3e-3,
                ];
                let mut new = old.clone();
                let now = law.update(&strain, 1e-6, (&old, &mut new));
                for i in 0..3 {
                    work += 0.5 * (before.stress[i] + now.stress[i]) * (strain[i] - last[i]);
                    let known = law.stress(&strain, &new)[i];
                    assert!((known - now.stress[i]).abs() < 1e-10 * 3e8);
                }
                assert!(now.dissipated >= 0.0);
                dissipated += now.dissipated;
                (old, last, before) = (new, strain, now);
            }
            let spent = before.stored + before.hardening + dissipated;
            // first order in the step, 1e-6 of strain, over a strain of yield of 1.5e-3: 1e-3
            assert!((work - spent).abs() < 1e-3 * work, "{work} {spent}");
        }
    }
}
