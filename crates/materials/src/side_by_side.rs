//! Metals under plane stress at several points side by side, as many as a register has lanes at a time: the points of shells in explicit steps.
//!
//! The formulas are those of [`plane_stress`](crate::plane_stress), without the tangent in the plane. Iterations end where all lanes have converged.

use carom_algebra::number::Number;
use carom_algebra::packed::Packed;
use pulp::{Arch, Simd, WithSimd};

use crate::hardening::Hardening;
use crate::plane_points::{
    EachPoint, ITERATIONS, MAX_KEPT_IN_PLANE, PLASTIC, PlaneStressPoints, ROUNDING, SIDE,
};

/// The step of all points.
struct Step<'a, H> {
    law: &'a H,
    dt: f64,
    points: &'a mut PlaneStressPoints,
}

/// See [`PlaneStress::side_by_side`](crate::PlaneStress::side_by_side).
pub(crate) fn update<H: Hardening>(law: &H, dt: f64, points: &mut PlaneStressPoints) {
    Arch::new().dispatch(Step { law, dt, points });
}

impl<H: Hardening> WithSimd for Step<'_, H> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let zero = Packed::all(simd, 0.0);
        let kept = PLASTIC + 1 + self.law.further();
        for from in (0..SIDE).step_by(S::F64_LANES) {
            let read = |rows: &[EachPoint], out: &mut [Packed<S>]| {
                for (row, out) in rows.iter().zip(out) {
                    out.lanes_mut()
                        .copy_from_slice(&row[from..][..S::F64_LANES]);
                }
            };
            let (mut strain, mut old) = ([zero; 3], [zero; MAX_KEPT_IN_PLANE]);
            let mut new = [zero; MAX_KEPT_IN_PLANE];
            read(&self.points.strain, &mut strain);
            read(&self.points.old[..kept], &mut old);
            let history = (&old[..kept], &mut new[..kept]);
            let (stress, energies) = of_lanes(self.law, &strain, self.dt, history);
            let write = |values: &[Packed<S>], rows: &mut [EachPoint]| {
                for (value, row) in values.iter().zip(rows) {
                    row[from..][..S::F64_LANES].copy_from_slice(value.lanes());
                }
            };
            write(&stress, &mut self.points.stress);
            write(&energies, &mut self.points.energies);
            write(&new[..kept], &mut self.points.new);
        }
    }
}

/// The return of a trial elastic strain 11, 22, 33, 2·12: stress, flow n √(3/2) Δε_p as 11, 22 and 12, Δε_p, q, and the slope of σ₃₃.
struct Return<T> {
    stress: [T; 4],
    flow: [T; 3],
    slip: T,
    size: T,
    slope: T,
}

#[inline(always)]
fn returned<H: Hardening, T: Number>(law: &H, strain: &[T; 4], old: &[T], dt: f64) -> Return<T> {
    let elastic = law.elastic();
    let shear = elastic.shear_modulus();
    let bulk = elastic.young / (3.0 * (1.0 - 2.0 * elastic.poisson));
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
    let one = q.like(1.0);
    let tiny = q.like(f64::MIN_POSITIVE);
    let [slip, slope] = law.slip(q, 3.0 * shear, &old[PLASTIC..], dt);
    let lost = slip.scale(3.0 * shear) / q.most(tiny);
    let kept = one - lost;
    let unit = one / norm.most(tiny);
    let pressure = trace.scale(bulk);
    let stress = [
        s[0].mul_add(kept, pressure),
        s[1].mul_add(kept, pressure),
        s[2].mul_add(kept, pressure),
        s[3] * kept,
    ];
    let along = slip * unit;
    let flow = [s[0], s[1], s[3]].map(|s| (s * along).scale(1.5_f64.sqrt()));
    // that of the elastic law where nothing flows
    let flowing = q.like(3.0 * shear) / (slope + q.like(3.0 * shear)) - lost;
    let turned = q.like(0.0).if_below(slip, flowing, q.like(0.0));
    let normal = s[2] * unit;
    let slope = kept.scale_add(4.0 / 3.0 * shear, q.like(bulk))
        - (turned * normal * normal).scale(2.0 * shear);
    Return {
        stress,
        flow,
        slip,
        size: q * kept,
        slope,
    }
}

/// Stress and energies at the end of the step, one point in each lane.
#[inline(always)]
fn of_lanes<H: Hardening, T: Number>(
    law: &H,
    strain: &[T; 3],
    dt: f64,
    (old, new): (&[T], &mut [T]),
) -> ([T; 3], [T; 3]) {
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
        trial[2] -= across / at.slope;
        at = returned(law, &trial, old, dt);
    }
    new[0] = old[0] + at.flow[0];
    new[1] = old[1] + at.flow[1];
    new[2] = old[2] + at.flow[2].scale(2.0);
    new[PLASTIC] = old[PLASTIC] + at.slip;
    let kept = (&old[PLASTIC..], &mut new[PLASTIC..]);
    let [hardening, dissipated] = law.spent(at.slip, at.size, kept);
    let [a, b, _, c] = at.stress;
    let direct = a * a + b * b - (a * b).scale(2.0 * poisson);
    let stored = direct.scale(0.5 / young) + (c * c).scale(0.5 / elastic.shear_modulus());
    ([a, b, c], [stored, hardening, dissipated])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, HardeningPoint, J2Plasticity, J2Table, JohnsonCook, PlaneStress};

    const STEEL: Elastic = Elastic {
        density: 7800.0,
        young: 2e11,
        poisson: 0.3,
    };

    fn laws() -> Vec<Box<dyn PlaneStress>> {
        let point = |strain, stress| HardeningPoint { strain, stress };
        let points = [point(0.0, 3e8), point(1e-3, 3.5e8), point(5e-3, 4e8)];
        vec![
            Box::new(J2Plasticity {
                initial: STEEL,
                yield_stress: 3e8,
                hardening: 2e10,
            }),
            Box::new(JohnsonCook {
                initial: STEEL,
                yield_stress: 3e8,
                hardening: 5e8,
                exponent: 0.3,
                rate_factor: 0.02,
                reference_rate: 1.0,
                thermal: None,
            }),
            Box::new(J2Table::new(STEEL, &points).unwrap()),
        ]
    }

    /// Some points rest, some stay elastic, some flow one way and back.
    #[test]
    fn points_side_by_side_are_those_alone() {
        for law in laws() {
            let kept = law.history_len();
            let mut points = PlaneStressPoints::default();
            let mut alone = vec![[0.0; MAX_KEPT_IN_PLANE]; SIDE];
            for step in 1..40_u32 {
                let part = (0.4 * f64::from(step)).sin();
                for (k, old) in alone.iter_mut().enumerate() {
                    let size = 1e-3 * k as f64 * part;
                    let strain = [size, (0.2 * k as f64 - 0.6) * size, 0.7 * size];
                    (0..3).for_each(|i| points.strain[i][k] = strain[i]);
                    let mut new = *old;
                    let found = law.update(&strain, 1e-3, (&old[..kept], &mut new[..kept]));
                    *old = new;
                    points.energies[0][k] = found.stored;
                }
                let stored = points.energies[0];
                law.side_by_side(1e-3, &mut points);
                for (k, own) in alone.iter().enumerate() {
                    for i in 0..kept {
                        // the tolerance of the iterations over the strain of yield, in 40 steps
                        assert!((points.new[i][k] - own[i]).abs() < 1e-12, "{i} {k} {step}");
                    }
                    assert!((points.energies[0][k] - stored[k]).abs() < 1e-9 * 3e8 * 1e-3);
                    let strain = [0, 1, 2].map(|i| points.strain[i][k]);
                    let stress = law.stress(&strain, &own[..kept]);
                    for i in 0..3 {
                        assert!((points.stress[i][k] - stress[i]).abs() < 1e-9 * 3e8);
                    }
                }
                points.old = points.new;
            }
        }
    }
}
