//! Shells with small rotations: one constant stiffness for each element.

use std::ops::Range;

use carom_algebra::csr::Csr;

use super::section::STRAINS;
use super::{Element, PER_NODE, Shell};
use crate::Placement;

impl Element {
    /// Derivatives of the strains of a point by the unknowns, row by row: a rotation of a node moves the middle surface beside it by
    /// `θ × e D`.
    pub(super) fn rows(&self, point: usize, offset: f64) -> [[f64; 4 * PER_NODE]; STRAINS] {
        let mut rows = [[0.0; 4 * PER_NODE]; STRAINS];
        let found = self.form.derivatives(&self.reference.beside(offset), point);
        for (row, gradient) in rows.iter_mut().zip(&found) {
            for (node, [by_place, by_turn]) in gradient.iter().enumerate().take(self.count) {
                let director = self.reference.axes[node][2];
                let by_turn = by_turn + director.cross(by_place) * offset;
                let own = &mut row[PER_NODE * node..PER_NODE * (node + 1)];
                own[..3].copy_from_slice(by_place.as_slice());
                own[3..].copy_from_slice(by_turn.as_slice());
            }
        }
        rows
    }

    /// K over the unknowns, row-major.
    pub(super) fn stiffness(&self, offset: f64) -> Vec<f64> {
        let n = PER_NODE * self.count;
        let mut k = vec![0.0; n * n];
        let section = self.elastic.tangent();
        for (point, area) in self.form.areas.iter().enumerate() {
            let rows = self.rows(point, offset);
            for (stress, row) in section.iter().zip(&rows) {
                // the row of H B that belongs to this strain
                let mut product = [0.0; 4 * PER_NODE];
                for (factor, other) in stress.iter().zip(&rows).filter(|(c, _)| **c != 0.0) {
                    for (product, other) in product.iter_mut().zip(other) {
                        *product += area * factor * other;
                    }
                }
                for (k, left) in k.chunks_exact_mut(n).zip(row).filter(|(_, b)| **b != 0.0) {
                    for (k, right) in k.iter_mut().zip(&product) {
                        *k += left * right;
                    }
                }
            }
        }
        k
    }
}

impl Shell {
    /// Adds K u to `f` and returns the strain energy (J).
    pub(crate) fn internal_force(&self, u: &[f64], f: &mut [f64]) -> f64 {
        let mut energy = 0.0;
        self.each_force(&|i| u[i], &mut |i, force| {
            f[i] += force;
            energy += 0.5 * force * u[i];
        });
        energy
    }

    pub(super) fn small_force(&self, at: &Placement, f: &mut [f64]) -> f64 {
        let Some(from) = at.from else {
            return self.internal_force(at.u, f);
        };
        self.each_force(&|i| 0.5 * (from[i] + at.u[i]), &mut |i, force| {
            f[i] += force
        });
        let mut energy = 0.0;
        self.each_force(&|i| at.u[i], &mut |i, force| {
            energy += 0.5 * force * at.u[i]
        });
        energy
    }

    /// Visits the entries of K u of each element.
    fn each_force(&self, u: &dyn Fn(usize) -> f64, visit: &mut dyn FnMut(usize, f64)) {
        let mut own = [0.0; 4 * PER_NODE];
        for (element, range) in self.elements.iter().zip(self.starts.windows(2)) {
            for (own, i) in own.iter_mut().zip(element.unknowns()) {
                *own = u(i);
            }
            let n = PER_NODE * element.count;
            let k = &self.stiffness[range[0]..range[1]];
            for (i, row) in element.unknowns().zip(k.chunks_exact(n)) {
                visit(i, row.iter().zip(&own).map(|(k, u)| k * u).sum());
            }
        }
    }

    pub(super) fn add_stiffness(&self, factor: f64, part: &Range<usize>, matrix: &mut Csr) {
        for (element, range) in self.starts.windows(2).enumerate() {
            self.add(
                element,
                factor,
                &self.stiffness[range[0]..range[1]],
                part,
                matrix,
            );
        }
    }
}
