//! Metals under plane stress at several points side by side, as many as a register has lanes at a time: the points of shells in explicit steps.
//!
//! The formulas are those of [`plane_stress`](crate::plane_stress), without the tangent in the plane.

use carom_algebra::number::Number;
use carom_algebra::packed::Packed;
use pulp::{Arch, Simd, WithSimd};

use crate::hardening::Hardening;
use crate::plane_points::{EachPoint, MAX_KEPT_IN_PLANE, PLASTIC, PlaneStressPoints, SIDE};
use crate::plane_stress::of_lanes;

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
