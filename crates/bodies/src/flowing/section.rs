//! A section as the sum of its fibres.
//!
//! With the strain ε of the axis and the curvatures κ_y, κ_z, the derivatives of the rotations of the section, a fibre at (y, z) has the
//! strain ε + z κ_y - y κ_z. Normal force and bending moments are N = Σ σ a, M_y = Σ z σ a, M_z = -Σ y σ a.

use carom_materials::{MAX_KEPT, Uniaxial};

use crate::Stored;

/// Strain of the axis, and curvatures about y and z, 1/m; or what does work on them: normal force, N, and moments, N m.
pub(crate) type Strains = [f64; 3];

/// A fibre of a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fibre {
    /// Its place along y and z from the centroid, m.
    pub place: [f64; 2],
    /// Its area, m².
    pub area: f64,
}

impl Fibre {
    /// What its strain takes of those of the section.
    fn arms(&self) -> Strains {
        let [y, z] = self.place;
        [1.0, z, -y]
    }

    fn strain(&self, of: &Strains) -> f64 {
        let [y, z] = self.place;
        of[0] + z * of[1] - y * of[2]
    }
}

/// A section of fibres of one law. Its centroid is the origin, and y and z are its principal axes.
#[derive(Debug)]
pub(crate) struct FibreSection {
    law: Box<dyn Uniaxial>,
    /// Numbers that the law keeps of a fibre.
    kept: usize,
    fibres: Vec<Fibre>,
    /// m².
    area: f64,
}

impl FibreSection {
    pub(crate) fn new(law: Box<dyn Uniaxial>, fibres: Vec<Fibre>) -> FibreSection {
        FibreSection {
            kept: law.history_len(),
            area: fibres.iter().map(|fibre| fibre.area).sum(),
            law,
            fibres,
        }
    }

    pub(crate) fn fibres(&self) -> usize {
        self.fibres.len()
    }

    /// Numbers that are kept of a section.
    pub(crate) fn history_len(&self) -> usize {
        self.kept * self.fibres.len()
    }

    /// Normal force and moments at the end of a step of `dt` (s) that began with the history `old`, and energies per length; writes the
    /// history there into `new`.
    pub(crate) fn update(
        &self,
        strains: &Strains,
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
    ) -> (Strains, Stored) {
        let (mut forces, mut stored) = ([0.0; 3], Stored::default());
        let histories = old.chunks_exact(self.kept);
        let histories = histories.zip(new.chunks_exact_mut(self.kept));
        for (fibre, history) in self.fibres.iter().zip(histories) {
            let found = self.law.update(fibre.strain(strains), dt, history);
            for (force, arm) in forces.iter_mut().zip(fibre.arms()) {
                *force += found.stress * fibre.area * arm;
            }
            stored.strain += found.stored * fibre.area;
            stored.hardening += found.hardening * fibre.area;
            stored.dissipated += found.dissipated * fibre.area;
        }
        (forces, stored)
    }

    /// Normal force and moments at the end of a step, and their derivative by the strains, which is symmetric.
    pub(crate) fn tangent(
        &self,
        strains: &Strains,
        dt: f64,
        old: &[f64],
    ) -> (Strains, [Strains; 3]) {
        let (mut forces, mut tangent) = ([0.0; 3], [[0.0; 3]; 3]);
        let mut new = [0.0; MAX_KEPT];
        for (fibre, old) in self.fibres.iter().zip(old.chunks_exact(self.kept)) {
            let history = (old, &mut new[..self.kept]);
            let found = self.law.update(fibre.strain(strains), dt, history);
            let arms = fibre.arms();
            for ((force, row), arm) in forces.iter_mut().zip(&mut tangent).zip(arms) {
                *force += found.stress * fibre.area * arm;
                let stiffness = found.tangent * fibre.area * arm;
                for (entry, arm) in row.iter_mut().zip(arms) {
                    *entry += stiffness * arm;
                }
            }
        }
        (forces, tangent)
    }

    /// Normal force and moments at strains whose history is known.
    pub(crate) fn forces(&self, strains: &Strains, history: &[f64]) -> Strains {
        let mut forces = [0.0; 3];
        for (fibre, history) in self.fibres.iter().zip(history.chunks_exact(self.kept)) {
            let stress = self.law.young() * (fibre.strain(strains) - history[0]);
            for (force, arm) in forces.iter_mut().zip(fibre.arms()) {
                *force += stress * fibre.area * arm;
            }
        }
        forces
    }

    /// Normal stress at a place of the section, Pa: that of the nearest fibre, and where this has not flowed that of the place itself.
    pub(crate) fn stress(&self, strains: &Strains, place: [f64; 2], history: &[f64]) -> f64 {
        let distance = |fibre: &Fibre| {
            let [y, z] = fibre.place;
            (y - place[0]).powi(2) + (z - place[1]).powi(2)
        };
        let fibres = self.fibres.iter().zip(history.chunks_exact(self.kept));
        let nearest = fibres.min_by(|(a, _), (b, _)| distance(a).total_cmp(&distance(b)));
        nearest.map_or(0.0, |(fibre, history)| {
            let at = match self.law.plastic_strain(history) > 0.0 {
                true => fibre.place,
                false => place,
            };
            let here = Fibre {
                place: at,
                area: 0.0,
            };
            self.law.young() * (here.strain(strains) - history[0])
        })
    }

    /// Mean stress over the section at a strain of its axis, Pa; curvatures do not change it.
    pub(crate) fn mean_stress(&self, strain: f64, history: &[f64]) -> f64 {
        let histories = history.chunks_exact(self.kept);
        let flowed = self
            .fibres
            .iter()
            .zip(histories)
            .map(|(fibre, history)| fibre.area * history[0]);
        self.law.young() * (strain - flowed.sum::<f64>() / self.area)
    }

    /// Largest equivalent plastic strain of its fibres.
    pub(crate) fn plastic_strain(&self, history: &[f64]) -> f64 {
        let histories = history.chunks_exact(self.kept);
        let strains = histories.map(|history| self.law.plastic_strain(history));
        strains.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use carom_materials::{Elastic, J2Plasticity, Law};
    use carom_testing::Random;

    use super::*;
    use crate::SectionShape;

    #[test]
    fn the_tangent_is_the_derivative_of_the_forces() {
        let law = Law::J2Plasticity(J2Plasticity {
            initial: Elastic {
                density: 7800.0,
                young: 2e11,
                poisson: 0.3,
            },
            yield_stress: 3e8,
            hardening: 1e10,
        });
        let shape = SectionShape::I {
            height: 0.2,
            width: 0.1,
            web: 0.01,
            flange: 0.015,
        };
        let section = FibreSection::new(law.uniaxial().unwrap(), shape.fibres(8, 3));
        let mut random = Random(7);
        let mut strains = || [2e-3, 4e-2, 4e-2].map(|size: f64| random.between(-size, size));
        let fresh = vec![0.0; section.history_len()];
        for _ in 0..5 {
            let mut old = fresh.clone();
            section.update(&strains(), 1.0, (&fresh, &mut old));
            let end = strains();
            let (_, tangent) = section.tangent(&end, 1.0, &old);
            let steps = [1e-9, 1e-8, 1e-8];
            for j in 0..3 {
                let at = |step: f64| {
                    let mut moved = end;
                    moved[j] += step;
                    section.update(&moved, 1.0, (&old, &mut old.clone())).0
                };
                let (after, before) = (at(steps[j]), at(-steps[j]));
                for i in 0..3 {
                    let slope = (after[i] - before[i]) / (2.0 * steps[j]);
                    // a fibre may begin to flow within the step: one of 600, with 1/600 of the diagonal at most, and rounding
                    let scale = (tangent[i][i] * tangent[j][j]).sqrt();
                    assert!((slope - tangent[i][j]).abs() < 5e-3 * scale);
                }
            }
            let (forces, stored) = section.update(&end, 1.0, (&old, &mut old.clone()));
            assert!(stored.dissipated >= 0.0);
            let mut new = old.clone();
            section.update(&end, 1.0, (&old, &mut new));
            for (found, known) in forces.iter().zip(section.forces(&end, &new)) {
                // rounding of E ε over that of what is left of it
                assert!((found - known).abs() < 1e-12 * forces[0].abs().max(1e6));
            }
            let mean = section.mean_stress(end[0], &new) * section.area;
            assert!((mean - forces[0]).abs() < 1e-6);
        }
    }
}
