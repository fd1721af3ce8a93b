//! Sections of metal that flows: points through the thickness.
//!
//! A point at the height z has the strain ε + z κ under plane stress; N = Σ σ w, M = Σ z σ w over the two points of Gauss in each layer. The rule is exact for
//! an elastic section, and for one that flows throughout if the number of layers is even; between, the moment errs by 0.24/N² at most with N layers.

use carom_materials::{MAX_KEPT, PlaneStress, PlaneStressPoints, PlaneStressResponse};

use super::section::{AtPoint, STRAINS};
use crate::Stored;

/// 1/√3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Points through the thickness.
#[derive(Debug)]
pub(super) struct Layers {
    law: Box<dyn PlaneStress>,
    /// Numbers that the law keeps of a point.
    kept: usize,
    /// Height and weight of each, m.
    points: Vec<[f64; 2]>,
}

impl Layers {
    pub(super) fn new(law: Box<dyn PlaneStress>, thickness: f64, count: u32) -> Layers {
        let layer = thickness / f64::from(count);
        let of = |k: u32| {
            let middle = (f64::from(k) + 0.5) * layer - 0.5 * thickness;
            [-GAUSS, GAUSS].map(|x| [middle + 0.5 * x * layer, 0.5 * layer])
        };
        Layers {
            kept: law.history_len(),
            law,
            points: (0..count).flat_map(of).collect(),
        }
    }

    /// Numbers that are kept of a section.
    pub(super) fn history_len(&self) -> usize {
        self.kept * self.points.len()
    }

    /// Numbers that are kept of a point.
    pub(super) fn kept(&self) -> usize {
        self.kept
    }

    /// Height and weight of each point, m.
    pub(super) fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// The law at points side by side.
    pub(super) fn side_by_side(&self, dt: f64, points: &mut PlaneStressPoints) {
        self.law.side_by_side(dt, points);
    }

    fn strain(of: &AtPoint, z: f64) -> [f64; 3] {
        [0, 1, 2].map(|i| of[i] + z * of[3 + i])
    }

    fn add(forces: &mut AtPoint, stress: &[f64; 3], [z, w]: [f64; 2]) {
        for (i, stress) in stress.iter().enumerate() {
            forces[i] += w * stress;
            forces[3 + i] += w * z * stress;
        }
    }

    /// Membrane forces and moments at the end of a step of `dt` (s) that began with the history `old`, and energies per area; writes the history
    /// there into `new`.
    pub(super) fn update(
        &self,
        of: &AtPoint,
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
    ) -> (AtPoint, Stored) {
        let (mut forces, mut stored) = (AtPoint::default(), Stored::default());
        let histories = old.chunks_exact(self.kept);
        let histories = histories.zip(new.chunks_exact_mut(self.kept));
        for (&[z, w], history) in self.points.iter().zip(histories) {
            let found = self.law.update(&Layers::strain(of, z), dt, history);
            Layers::add(&mut forces, &found.stress, [z, w]);
            stored.strain += w * found.stored;
            stored.hardening += w * found.hardening;
            stored.dissipated += w * found.dissipated;
        }
        (forces, stored)
    }

    /// Membrane forces and moments at the end of a step, and their derivative by the strains, which is symmetric.
    pub(super) fn tangent(
        &self,
        of: &AtPoint,
        dt: f64,
        old: &[f64],
    ) -> (AtPoint, [AtPoint; STRAINS]) {
        let (mut forces, mut tangent) = (AtPoint::default(), [AtPoint::default(); STRAINS]);
        let mut new = [0.0; MAX_KEPT];
        for (&[z, w], old) in self.points.iter().zip(old.chunks_exact(self.kept)) {
            let history = (old, &mut new[..self.kept]);
            let PlaneStressResponse {
                stress, tangent: c, ..
            } = self.law.update(&Layers::strain(of, z), dt, history);
            Layers::add(&mut forces, &stress, [z, w]);
            for i in 0..3 {
                for j in 0..3 {
                    let entry = w * c[i][j];
                    tangent[i][j] += entry;
                    tangent[i][3 + j] += z * entry;
                    tangent[3 + i][j] += z * entry;
                    tangent[3 + i][3 + j] += z * z * entry;
                }
            }
        }
        (forces, tangent)
    }

    /// Membrane forces and moments at strains whose history is known.
    pub(super) fn forces(&self, of: &AtPoint, history: &[f64]) -> AtPoint {
        let mut forces = AtPoint::default();
        for (&[z, w], history) in self.points.iter().zip(history.chunks_exact(self.kept)) {
            let stress = self.law.stress(&Layers::strain(of, z), history);
            Layers::add(&mut forces, &stress, [z, w]);
        }
        forces
    }

    /// Stresses of the outermost points, that to which the normal points first.
    pub(super) fn outermost(&self, of: &AtPoint, history: &[f64]) -> [[f64; 3]; 2] {
        let at = |k: usize| {
            let own = &history[self.kept * k..self.kept * (k + 1)];
            self.law.stress(&Layers::strain(of, self.points[k][0]), own)
        };
        [at(self.points.len() - 1), at(0)]
    }

    /// Largest equivalent plastic strain.
    pub(super) fn plastic_strain(&self, history: &[f64]) -> f64 {
        let histories = history.chunks_exact(self.kept);
        let strains = histories.map(|history| self.law.plastic_strain(history));
        strains.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use carom_materials::{Elastic, J2Plasticity, Law};

    use super::*;

    const STEEL: J2Plasticity = J2Plasticity {
        initial: Elastic {
            density: 7800.0,
            young: 2e11,
            poisson: 0.4999,
        },
        yield_stress: 3e8,
        hardening: 0.0,
    };

    fn layers(count: u32) -> Layers {
        let law = Law::J2Plasticity(STEEL).plane_stress().unwrap();
        Layers::new(law, 0.01, count)
    }

    /// Moment of a strip that is bent by κ and free at its sides. Without a change of volume it is bent across by -κ/2 where it flows and where it does not.
    fn moment(layers: &Layers, curvature: f64) -> f64 {
        let across = -STEEL.initial.poisson * curvature;
        let strain = [0.0, 0.0, 0.0, curvature, across, 0.0, 0.0, 0.0, 0.0];
        let old = vec![0.0; layers.history_len()];
        let (forces, stored) = layers.update(&strain, 1.0, (&old, &mut old.clone()));
        assert!(stored.dissipated >= 0.0 && forces[0].abs() < 1e-6);
        forces[3]
    }

    #[test]
    fn the_moment_over_the_curvature_is_that_of_a_rectangle() {
        let (h, yield_stress): (f64, f64) = (0.01, 3e8);
        let first = 2.0 * yield_stress / (STEEL.initial.young * h);
        for count in [2, 4, 8] {
            let layers = layers(count);
            let bound = 0.24 / f64::from(count).powi(2);
            for part in [0.5, 1.0, 1.3, 2.0, 3.0, 10.0_f64] {
                let whole = yield_stress * h * h / 4.0;
                let exact = match part <= 1.0 {
                    true => whole * part / 1.5,
                    false => whole * (1.0 - part.powi(-2) / 3.0),
                };
                let found = moment(&layers, part * first);
                // the bound of the rule, and the part 2e-4 of the volume that changes
                assert!(
                    (found / exact - 1.0).abs() < bound + 1e-3,
                    "{count} {part}: {found} {exact}"
                );
            }
        }
    }

    #[test]
    fn the_tangent_is_the_derivative_of_the_forces() {
        let layers = layers(4);
        let fresh = vec![0.0; layers.history_len()];
        let mut old = fresh.clone();
        let way = [1e-3, -2e-3, 1e-3, 0.5, -0.3, 0.4, 0.0, 0.0, 0.0];
        layers.update(&way, 1.0, (&fresh, &mut old));
        let end = [2e-3, -1e-3, 2e-3, 0.7, 0.2, -0.6, 0.0, 0.0, 0.0];
        let (_, tangent) = layers.tangent(&end, 1.0, &old);
        for j in 0..6 {
            let step = if j < 3 { 1e-9 } else { 1e-7 };
            let at = |by: f64| {
                let mut moved = end;
                moved[j] += by;
                layers.update(&moved, 1.0, (&old, &mut old.clone())).0
            };
            let (after, before) = (at(step), at(-step));
            for i in 0..6 {
                let slope = (after[i] - before[i]) / (2.0 * step);
                let scale = (tangent[i][i] * tangent[j][j]).sqrt();
                // rounding over the step
                assert!((slope - tangent[i][j]).abs() < 1e-4 * scale, "{i} {j}");
            }
        }
    }
}
