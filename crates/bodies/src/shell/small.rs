//! Shells with small rotations: one constant stiffness for each element, or layers that flow.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Vec3;
use rayon::prelude::*;

use super::Shell;
use super::element::{Element, PER_NODE};
use super::layers::Layers;
use super::products::{Configuration, DIRECTOR, MOST};
use super::section::{AtPoint, STRAINS};
use super::strain::Strains;
use crate::scratch::ShellForces;
use crate::{Placement, Stored};

impl Element {
    /// Derivatives of the strains of a point by the unknowns, row by row: a rotation of a node moves the middle surface beside it by
    /// `θ × e D`.
    pub(super) fn rows(&self, point: usize) -> [[f64; 4 * PER_NODE]; STRAINS] {
        let mut rows = [[0.0; 4 * PER_NODE]; STRAINS];
        let found = self
            .form
            .derivatives(&self.reference.beside(self.offset), point);
        for (row, gradient) in rows.iter_mut().zip(&found) {
            for (node, [by_place, by_turn]) in gradient.iter().enumerate().take(self.count) {
                let director = self.reference.axes[node][DIRECTOR];
                let by_turn = by_turn + director.cross(by_place) * self.offset;
                let own = &mut row[PER_NODE * node..PER_NODE * (node + 1)];
                own[..3].copy_from_slice(by_place.as_slice());
                own[3..].copy_from_slice(by_turn.as_slice());
            }
        }
        rows
    }

    /// Diagonals of the stiffness against what one point does not see.
    pub(super) fn unseen(&self) -> impl Iterator<Item = AtPoint> {
        let lists = self.hourglass.iter();
        lists.flat_map(|hourglass| hourglass.diagonals())
    }

    /// K over the unknowns, row-major.
    pub(super) fn stiffness(&self) -> Vec<f64> {
        let n = PER_NODE * self.count;
        let mut k = vec![0.0; n * n];
        for (point, area) in self.working().enumerate() {
            let section = self.sections[point].tangent();
            add_product(&self.rows(point), &section, area, &mut k);
        }
        for (list, stiffness) in (1..).zip(self.unseen()) {
            let section = diagonal(&stiffness);
            add_product(&self.rows(list), &section, 1.0, &mut k);
        }
        k
    }

    /// Strains at a displacement.
    pub(super) fn small_strains(&self, u: &[f64]) -> Strains {
        let middle = self.reference.beside(self.offset);
        let mut change = Configuration {
            x: [Vec3::zeros(); MOST],
            axes: [[Vec3::zeros(); 3]; MOST],
        };
        for (node, &first) in self.first[..self.count].iter().enumerate() {
            let of = |k: usize| Vec3::new(u[first + k], u[first + k + 1], u[first + k + 2]);
            let (moved, turned) = (of(0), of(3));
            let axes = &self.reference.axes[node];
            change.axes[node] = axes.map(|axis| turned.cross(&axis));
            change.x[node] = moved + change.axes[node][DIRECTOR] * self.offset;
        }
        self.form.changes(&middle, &change)
    }

    /// Forces and moments at all points, times their areas, where the section flows, and the energies.
    pub(super) fn flow(
        &self,
        layers: &Layers,
        strains: &Strains,
        dt: f64,
        (old, new): (&[f64], &mut [f64]),
    ) -> (Strains, Stored) {
        let (mut forces, mut stored) = (Strains::default(), Stored::default());
        let kept = layers.history_len();
        let histories = old.chunks_exact(kept).zip(new.chunks_exact_mut(kept));
        for ((point, area), history) in self.form.areas.iter().enumerate().zip(histories) {
            let strain = &strains[point];
            let section = (strain, self.thickness[point]);
            let (found, own) = layers.update(section, dt, history);
            forces[point] = self.beside(point, strain, &found).map(|force| force * area);
            let mut alone = *strain;
            alone[..6].fill(0.0);
            let beside = self.sections[point].energy(&alone);
            stored.strain += area * (own.strain + beside);
            stored.hardening += area * own.hardening;
            stored.dissipated += area * own.dissipated;
        }
        if let Some(hourglass) = &self.hourglass {
            let [unseen, own] = hourglass.force(strains, &mut forces);
            stored.strain += unseen;
            stored.hourglass += own;
        }
        (forces, stored)
    }

    /// Membrane forces and moments of the layers beside elastic shear and drilling.
    pub(super) fn beside(&self, point: usize, strain: &AtPoint, layers: &AtPoint) -> AtPoint {
        let elastic = self.sections[point].forces(strain);
        std::array::from_fn(|i| if i < 6 { layers[i] } else { elastic[i] })
    }

    /// Forces and moments at a point where the section flows, and their derivative.
    pub(super) fn flowing(
        &self,
        layers: &Layers,
        point: usize,
        (strain, dt): (&AtPoint, f64),
        old: &[f64],
    ) -> (AtPoint, [AtPoint; STRAINS]) {
        let kept = layers.history_len();
        let old = &old[kept * point..kept * (point + 1)];
        let (forces, mut section) = layers.tangent((strain, self.thickness[point]), dt, old);
        let elastic = self.sections[point].tangent();
        section[6..].copy_from_slice(&elastic[6..]);
        (self.beside(point, strain, &forces), section)
    }

    /// Forces and moments on the nodes of a section that flows, with small rotations.
    fn flowed(
        &self,
        layers: &Layers,
        at: &Placement,
        history: (&[f64], &mut [f64]),
    ) -> ShellForces {
        let strains = self.small_strains(at.u);
        let (forces, stored) = self.flow(layers, &strains, at.dt, history);
        let mut out = ShellForces {
            stored,
            ..ShellForces::default()
        };
        let by = self
            .form
            .gradient(&self.reference.beside(self.offset), &forces);
        for ((out, [by_place, by_turn]), axes) in
            out.nodes.iter_mut().zip(&by).zip(&self.reference.axes)
        {
            out[..3].copy_from_slice(by_place.as_slice());
            let by_turn = by_turn + axes[DIRECTOR].cross(by_place) * self.offset;
            out[3..].copy_from_slice(by_turn.as_slice());
        }
        out
    }
}

/// The matrix with this diagonal.
pub(super) fn diagonal(of: &AtPoint) -> [AtPoint; STRAINS] {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { of[i] } else { 0.0 }))
}

/// Adds area · Bᵀ H B to a matrix, row-major.
pub(super) fn add_product(
    rows: &[[f64; 4 * PER_NODE]; STRAINS],
    section: &[AtPoint; STRAINS],
    area: f64,
    k: &mut [f64],
) {
    let n = k.len().isqrt();
    for (stress, row) in section.iter().zip(rows) {
        // the row of H B that belongs to this strain
        let mut product = [0.0; 4 * PER_NODE];
        for (factor, other) in stress.iter().zip(rows).filter(|(c, _)| **c != 0.0) {
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

    /// Adds the forces of a section that flows.
    pub(super) fn small_flow(
        &self,
        layers: &Layers,
        at: &Placement,
        new: &mut [f64],
        (scratch, f): (&mut Vec<ShellForces>, &mut [f64]),
    ) -> Stored {
        scratch.resize_with(self.elements.len(), ShellForces::default);
        let kept = self.kept_of_element();
        let histories = at.old.par_chunks(kept).zip(new.par_chunks_mut(kept));
        let elements = self.elements.par_iter().zip(&mut scratch[..]);
        elements
            .zip(histories)
            .for_each(|((element, out), history)| {
                *out = element.flowed(layers, at, history);
            });
        self.gathered(scratch, f)
    }

    /// Adds the derivative of the forces of a section that flows.
    pub(super) fn add_small_tangent(
        &self,
        layers: &Layers,
        at: &Placement,
        by_u: f64,
        matrix: &mut Csr,
    ) {
        for (number, element) in self.elements.iter().enumerate() {
            let n = PER_NODE * element.count;
            let mut k = vec![0.0; n * n];
            let (strains, old) = (
                element.small_strains(at.u),
                &at.old[self.history_of(number)],
            );
            for (point, area) in element.form.areas.iter().enumerate() {
                let strain = (&strains[point], at.dt);
                let (_, section) = element.flowing(layers, point, strain, old);
                add_product(&element.rows(point), &section, *area, &mut k);
            }
            self.add(number, by_u, &k, &(0..usize::MAX), matrix);
        }
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
