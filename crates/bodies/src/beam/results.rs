//! What beams tell of a displacement: forces in their sections, stresses, how far they turn and bend.

use carom_algebra::tensor::{Mat3, Vec3};

use super::fibres::GAUSS;
use super::{Beam, SectionForces, SectionStress, unit};
use crate::distortion::{Distortion, Extreme};

impl Beam {
    /// Volume (m³) and mean stress (Pa) of each element: normal and shear forces over the area. Bending and torsion have no mean.
    pub(crate) fn stresses(&self, u: &[f64], history: &[f64]) -> Vec<(f64, Mat3)> {
        let area = self.section.properties.area;
        let of = |(element, forces): (usize, SectionForces)| {
            let axes = &self.axes[element];
            let mut local = Mat3::zeros();
            for (i, force) in forces.force.iter().enumerate() {
                (local[(0, i)], local[(i, 0)]) = (force / area, force / area);
            }
            (
                area * self.lengths[element],
                axes.transpose() * local * axes,
            )
        };
        self.section_forces(u, history)
            .into_iter()
            .enumerate()
            .map(of)
            .collect()
    }

    /// Forces and moments in the sections of each element, weights apart. `history`: of this body at `u`.
    pub fn section_forces(&self, u: &[f64], history: &[f64]) -> Vec<SectionForces> {
        let all = 0..self.nodes.len();
        all.map(|element| self.section_force(element, u, history))
            .collect()
    }

    /// The same of one element.
    pub(crate) fn section_force(
        &self,
        element: usize,
        u: &[f64],
        history: &[f64],
    ) -> SectionForces {
        let local = self.local(element, u);
        let f = match &self.flowing {
            None => {
                let k = self.whole_element(element).stiffness();
                k.map(|row| row.iter().zip(&local).map(|(k, u)| k * u).sum::<f64>())
            }
            Some(flowing) => self.flowed(flowing, (element, &local), (u, history)),
        };
        SectionForces {
            force: [f[6] + self.kept_force(element, history), f[7], f[8]],
            moment_first: [-f[3], -f[4], -f[5]],
            moment_second: [f[9], f[10], f[11]],
        }
    }

    /// See [`Body::section_stresses`](crate::Body::section_stresses).
    pub(crate) fn section_stresses(&self, u: &[f64], history: &[f64]) -> Vec<SectionStress> {
        let Some(places) = &self.places else {
            return vec![SectionStress::unknown(); self.nodes.len()];
        };
        let flowed = self.plastic_strains(history);
        let of = |(element, forces): (usize, SectionForces)| match (&self.flowing, &flowed) {
            (Some(flowing), Some(strains)) if strains[element] > 0.0 => {
                let fibre = |section, at| flowing.stress((element, section), at, (u, history));
                places.flowed(&forces, (GAUSS.len(), &fibre))
            }
            _ => places.stress(&forces),
        };
        let all = self.section_forces(u, history).into_iter().enumerate();
        all.map(of).collect()
    }

    /// The twelve unknowns of an element in its own axes, at the centroid.
    pub(super) fn local(&self, element: usize, u: &[f64]) -> [f64; 12] {
        let axes = &self.axes[element];
        let [y, z] = self.section.offset;
        let beside = axes.tr_mul(&Vec3::new(0.0, y, z));
        let mut local = [0.0; 12];
        for (local, first) in local.chunks_exact_mut(6).zip(self.first[element]) {
            let own = &u[first..first + self.per_node()];
            let (moved, turned) = match self.dim {
                2 => (Vec3::new(own[0], own[1], 0.0), unit(2) * own[2]),
                _ => (
                    Vec3::new(own[0], own[1], own[2]),
                    Vec3::new(own[3], own[4], own[5]),
                ),
            };
            let (moved, turned) = (axes * (moved + turned.cross(&beside)), axes * turned);
            local[..3].copy_from_slice(moved.as_slice());
            local[3..].copy_from_slice(turned.as_slice());
        }
        match &self.condensed[element] {
            Some(t) => t.map(|row| row.iter().zip(&local).map(|(t, u)| t * u).sum()),
            None => local,
        }
    }

    /// The largest rotation of a section, and the largest strain at the radius of gyration: `|N|/(E A) + |θ₂ - θ₁|/L √(I/A)`.
    pub(crate) fn distortion(&self, u: &[f64], before: &Distortion) -> Distortion {
        let properties = &self.section.properties;
        let [y, z] = properties
            .second_moments
            .map(|i| (i / properties.area).sqrt());
        let mut found = *before;
        for (cell, length) in self.lengths.iter().enumerate() {
            let local = self.local(cell, u);
            let cell = cell as u32;
            for turn in [&local[3..6], &local[9..12]] {
                let value = Vec3::new(turn[0], turn[1], turn[2]).norm();
                found.rotation = found.rotation.or(Extreme { value, cell });
            }
            let change = |i: usize| (local[6 + i] - local[i]) / length;
            let value = change(0).abs() + (change(4) * y).hypot(change(5) * z);
            found.strain = found.strain.or(Extreme { value, cell });
        }
        found
    }
}
