//! Shells with finite rotations: Green-Lagrange strains of the middle surface and of the directors.
//!
//! **Energy-momentum.** Strains s are bilinear in places and axes q, so that s₊ - s = ∂s(q_m) Δq with the means q_m, and Cayley's map gives
//! a₊ - a = (R θ) × a_m for each axis. So the forces ∂s(q_m)ᵀ H (s + s₊)/2 do the work ΔU over the step, and have no resultant and no moment in
//! its middle (Simo and Tarnow 1994, Int. J. Numer. Methods Eng. 37, 2527). The moments of inertia of a node are equal about all axes: it has no W × J W.

use carom_algebra::csr::Csr;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use rayon::prelude::*;

use super::Shell;
use super::element::{Element, PER_NODE};
use super::layers::Layers;
use super::products::{Configuration, DIRECTOR, MOST};
use super::section::STRAINS;
use super::small::{add_product, diagonal};
use super::strain::{AddBlock, Strains};
use crate::scratch::{Scratch, ShellForces};
use crate::turning::{balanced, spatial};
use crate::{Placement, Stored};

/// Elements that one thread takes, at least.
const ELEMENTS: usize = 256;

/// The state of the nodes of an element.
pub(super) struct Now {
    /// Of the middle surface.
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
        if self.offset != 0.0 {
            now.configuration = now.configuration.beside(self.offset);
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

    /// Forces and moments on the nodes, in their axes. `flow`: the layers of metal, and the history of the element.
    fn forces(&self, at: &Placement, flow: Option<(&Layers, &[f64], &mut [f64])>) -> ShellForces {
        let (end, place, forces, stored) = match flow {
            None => {
                let (end, strains, place, forces) = self.acting(at);
                (end, place, forces, self.stored(&strains))
            }
            Some((layers, old, new)) => {
                let end = self.now(at.frames, at.u);
                let strains = self.form.strains(&end.configuration);
                let (forces, stored) = self.flow(layers, &strains, at.dt, (old, new));
                let place = end.configuration;
                (end, place, forces, stored)
            }
        };
        let mut out = ShellForces {
            stored,
            ..ShellForces::default()
        };
        let found = self.form.gradient(&place, &forces);
        for (node, [force, moment]) in found.iter().enumerate().take(self.count) {
            // the middle moves by u + (Rθ) × e d
            let moment = moment + place.axes[node][DIRECTOR].cross(force) * self.offset;
            let moment = end.starts[node].tr_mul(&moment);
            let moment = balanced(&moment, &end.increments[node], at.from.is_some());
            out.nodes[node][..3].copy_from_slice(force.as_slice());
            out.nodes[node][3..].copy_from_slice(moment.as_slice());
        }
        out
    }

    /// The symmetric part of ∂f/∂u, row-major. `flow`: the layers of metal, and the history at the start of the step.
    fn tangent(&self, at: &Placement, flow: Option<(&Layers, &[f64])>) -> Vec<f64> {
        let n = PER_NODE * self.count;
        let mut k = vec![0.0; n * n];
        let (end, strains, place, mut forces) = self.acting(at);
        // what a change of the increment turns in space; a translation stays what it is
        let turns: [Mat3; MOST] =
            std::array::from_fn(|node| spatial(&end.starts[node], &end.increments[node]));
        let rows = |place: &Configuration, list: usize| {
            let found = self.form.derivatives(place, list);
            let mut rows = [[0.0; MOST * PER_NODE]; STRAINS];
            for (row, gradient) in rows.iter_mut().zip(&found) {
                for (node, [by_place, by_turn]) in gradient.iter().enumerate().take(self.count) {
                    let beside = place.axes[node][DIRECTOR].cross(by_place) * self.offset;
                    let by_turn = turns[node].tr_mul(&(by_turn + beside));
                    let own = &mut row[PER_NODE * node..PER_NODE * (node + 1)];
                    own[..3].copy_from_slice(by_place.as_slice());
                    own[3..].copy_from_slice(by_turn.as_slice());
                }
            }
            rows
        };
        for (point, area) in self.working().enumerate() {
            let section = match flow {
                None => self.sections[point].tangent(),
                Some((layers, old)) => {
                    let (own, section) = self.flowing(layers, point, (&strains[point], at.dt), old);
                    forces[point] = own.map(|force| force * area);
                    section
                }
            };
            add_product(&rows(&place, point), &section, area, &mut k);
        }
        for (list, stiffness) in (1..).zip(self.unseen()) {
            add_product(&rows(&place, list), &diagonal(&stiffness), 1.0, &mut k);
        }
        self.curve(&place, &forces, &mut |[a, b], block| {
            let to = |(node, part): (usize, usize)| match part {
                0 => Mat3::identity(),
                _ => turns[node],
            };
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

    /// [`Form::curvature`](super::strain::Form::curvature) by places and rotations of the nodes, beside which the middle surface is.
    fn curve(&self, place: &Configuration, forces: &Strains, add: &mut AddBlock) {
        let offset = self.offset;
        if offset == 0.0 {
            self.form.curvature(place, forces, add);
            return;
        }
        let arm = |node: usize| place.axes[node][DIRECTOR] * offset;
        // what a rotation ω moves: ω × e d
        let by_turn = |node: usize| -arm(node).cross_matrix();
        self.form.curvature(place, forces, &mut |[a, b], block| {
            add([a, b], block);
            if a.1 == 0 {
                add([(a.0, 1), b], &(by_turn(a.0).transpose() * block));
            }
            if b.1 == 0 {
                add([a, (b.0, 1)], &(block * by_turn(b.0)));
            }
            if a.1 == 0 && b.1 == 0 {
                let both = by_turn(a.0).transpose() * block * by_turn(b.0);
                add([(a.0, 1), (b.0, 1)], &both);
            }
        });
        let found = self.form.gradient(place, forces);
        for (node, [force, _]) in found.iter().enumerate().take(self.count) {
            let outer = arm(node) * force.transpose();
            let turning =
                (outer + outer.transpose()) * 0.5 - Mat3::identity() * arm(node).dot(force);
            add([(node, 1), (node, 1)], &turning);
        }
    }
}

impl Shell {
    /// Forces of elements are found side by side and added in their order.
    pub(super) fn finite_force(
        &self,
        at: &Placement,
        new: &mut [f64],
        scratch: &mut Scratch,
        f: &mut [f64],
    ) -> Stored {
        if let (Some(pass), None) = (&self.pass, at.from) {
            return pass.force(self.layers.as_ref(), at, new, (scratch, f));
        }
        let scratch = &mut scratch.shells;
        scratch.resize_with(self.elements.len(), ShellForces::default);
        let elements = self.elements.par_iter().with_min_len(ELEMENTS);
        let elements = elements.zip(&mut scratch[..]);
        match &self.layers {
            None => elements.for_each(|(element, out)| *out = element.forces(at, None)),
            Some(layers) => {
                let kept = self.kept_of_element();
                let histories = at.old.par_chunks(kept).zip(new.par_chunks_mut(kept));
                elements
                    .zip(histories)
                    .for_each(|((element, out), (old, new))| {
                        *out = element.forces(at, Some((layers, old, new)));
                    });
            }
        }
        self.gathered(scratch, f)
    }

    /// Adds the forces of elements, and returns the sum of their energies.
    pub(super) fn gathered(&self, scratch: &[ShellForces], f: &mut [f64]) -> Stored {
        let mut stored = Stored::default();
        for (element, found) in self.elements.iter().zip(scratch) {
            stored.include(&found.stored);
            for (force, &first) in found.nodes.iter().zip(&element.first[..element.count]) {
                for (f, force) in f[first..first + PER_NODE].iter_mut().zip(force) {
                    *f += force;
                }
            }
        }
        stored
    }

    pub(super) fn add_finite_tangent(&self, at: &Placement, by_u: f64, matrix: &mut Csr) {
        for (number, element) in self.elements.iter().enumerate() {
            let flow = self.layers.as_ref();
            let flow = flow.map(|layers| (layers, &at.old[self.history_of(number)]));
            let k = element.tangent(at, flow);
            self.add(number, by_u, &k, &(0..usize::MAX), matrix);
        }
    }
}
