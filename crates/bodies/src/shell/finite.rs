//! Shells with finite rotations: Green-Lagrange strains of the middle surface and of the directors.
//!
//! **Energy-momentum.** Strains s are bilinear in places and axes q, so that s₊ - s = ∂s(q_m) Δq with the means q_m, and Cayley's map gives
//! a₊ - a = (R θ) × a_m for each axis. So the forces ∂s(q_m)ᵀ H (s + s₊)/2 do the work ΔU over the step, and have no resultant and no moment in
//! its middle (Simo and Tarnow 1994, Int. J. Numer. Methods Eng. 37, 2527). The moments of inertia of a node are equal about all axes: it has no W × J W.

use carom_algebra::csr::Csr;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use rayon::prelude::*;

use super::products::{Configuration, MOST};
use super::section::STRAINS;
use super::strain::Strains;
use super::{Element, PER_NODE, Shell};
use crate::Placement;
use crate::scratch::ShellForces;
use crate::turning::{balanced, spatial};

/// Elements that one thread takes, at least.
const ELEMENTS: usize = 256;

/// The state of the nodes of an element.
pub(super) struct Now {
    pub configuration: Configuration,
    /// R at the start of the step, and θ since.
    starts: [Mat3; MOST],
    increments: [Vec3; MOST],
}

impl Element {
    pub(super) fn now(&self, frames: &[Rotation], u: &[f64]) -> Now {
        let mut now = Now {
            configuration: self.reference,
            starts: [Mat3::identity(); MOST],
            increments: [Vec3::zeros(); MOST],
        };
        for node in 0..self.count {
            let own = &u[self.first[node]..self.first[node] + PER_NODE];
            now.configuration.x[node] += Vec3::new(own[0], own[1], own[2]);
            let increment = Vec3::new(own[3], own[4], own[5]);
            let start = frames.get(self.frames[node]).copied().unwrap_or_default();
            now.starts[node] = start.matrix();
            let turned = now.starts[node] * Rotation::cayley(&increment).matrix();
            now.increments[node] = increment;
            for axis in &mut now.configuration.axes[node] {
                *axis = turned * *axis;
            }
        }
        now
    }

    /// Strains at the end of the step; where forces are taken, and the forces there.
    fn acting(&self, at: &Placement) -> (Now, Strains, Configuration, Strains) {
        let end = self.now(at.frames, at.u);
        let strains = self.form.strains(&end.configuration);
        let Some(from) = at.from else {
            let (place, forces) = (end.configuration, self.weighted(&strains));
            return (end, strains, place, forces);
        };
        let start = self.now(at.frames, from);
        let mut mean = self.form.strains(&start.configuration);
        for (mean, end) in mean.iter_mut().flatten().zip(strains.iter().flatten()) {
            *mean = 0.5 * (*mean + end);
        }
        let place = start.configuration.mean(&end.configuration);
        let forces = self.weighted(&mean);
        (end, strains, place, forces)
    }

    fn forces(&self, at: &Placement) -> ShellForces {
        let (end, strains, place, forces) = self.acting(at);
        let mut out = ShellForces {
            energy: self.energy(&strains),
            ..ShellForces::default()
        };
        let found = self.form.gradient(&place, &forces);
        for (node, [force, moment]) in found.iter().enumerate().take(self.count) {
            let moment = end.starts[node].tr_mul(moment);
            let moment = balanced(&moment, &end.increments[node], at.from.is_some());
            out.nodes[node][..3].copy_from_slice(force.as_slice());
            out.nodes[node][3..].copy_from_slice(moment.as_slice());
        }
        out
    }

    /// The symmetric part of ∂f/∂u, row-major.
    fn tangent(&self, at: &Placement) -> Vec<f64> {
        let n = PER_NODE * self.count;
        let mut k = vec![0.0; n * n];
        let (end, _, place, forces) = self.acting(at);
        // what a change of the increment turns in space; a translation stays what it is
        let turns: [Mat3; MOST] =
            std::array::from_fn(|node| spatial(&end.starts[node], &end.increments[node]));
        let section = self.elastic.tangent();
        for (point, area) in self.form.areas.iter().enumerate() {
            let found = self.form.derivatives(&place, point);
            let mut rows = [[0.0; MOST * PER_NODE]; STRAINS];
            for (row, gradient) in rows.iter_mut().zip(&found) {
                for (node, [by_place, by_turn]) in gradient.iter().enumerate().take(self.count) {
                    let by_turn = turns[node].tr_mul(by_turn);
                    let own = &mut row[PER_NODE * node..PER_NODE * (node + 1)];
                    own[..3].copy_from_slice(by_place.as_slice());
                    own[3..].copy_from_slice(by_turn.as_slice());
                }
            }
            for (stress, row) in section.iter().zip(&rows) {
                let mut product = [0.0; MOST * PER_NODE];
                for (factor, other) in stress.iter().zip(&rows).filter(|(c, _)| **c != 0.0) {
                    for (product, other) in product.iter_mut().zip(other) {
                        *product += area * factor * other;
                    }
                }
                for (k, left) in k.chunks_exact_mut(n).zip(row) {
                    for (k, right) in k.iter_mut().zip(&product) {
                        *k += left * right;
                    }
                }
            }
        }
        let to = |(node, part): (usize, usize)| match part {
            0 => Mat3::identity(),
            _ => turns[node],
        };
        self.form.curvature(&place, &forces, &mut |[a, b], block| {
            let block = to(a).transpose() * block * to(b);
            let [row, column] = [a, b].map(|(node, part)| PER_NODE * node + 3 * part);
            for i in 0..3 {
                for j in 0..3 {
                    k[(row + i) * n + column + j] += block[(i, j)];
                }
            }
        });
        k
    }
}

impl Shell {
    /// Forces are found side by side and added in the order of the elements.
    pub(super) fn finite_force(
        &self,
        at: &Placement,
        scratch: &mut Vec<ShellForces>,
        f: &mut [f64],
    ) -> f64 {
        scratch.resize_with(self.elements.len(), ShellForces::default);
        let elements = self.elements.par_iter().with_min_len(ELEMENTS);
        elements
            .zip(&mut scratch[..])
            .for_each(|(element, out)| *out = element.forces(at));
        let mut energy = 0.0;
        for (element, found) in self.elements.iter().zip(scratch.iter()) {
            energy += found.energy;
            for (force, &first) in found.nodes.iter().zip(&element.first[..element.count]) {
                for (f, force) in f[first..first + PER_NODE].iter_mut().zip(force) {
                    *f += force;
                }
            }
        }
        energy
    }

    pub(super) fn add_finite_tangent(&self, at: &Placement, by_u: f64, matrix: &mut Csr) {
        for (number, element) in self.elements.iter().enumerate() {
            let k = element.tangent(at);
            self.add(number, by_u, &k, &(0..usize::MAX), matrix);
        }
    }
}
