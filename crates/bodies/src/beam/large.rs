//! Beams with finite rotations: geometrically exact elements after Simo and Reissner.
//!
//! The nodes have a place and a rotation R, whose increment θ of the step, angular velocity W and its rate are about axes that turn
//! with the node, as those of [rigid bodies](crate::Rigid); in the reference position R is the identity. The strains and the energy of
//! an element are those of [`strain`](super::strain). The shear stiffness is `1/(1/(κ G A) + L²/(12 E I))` (MacNeal 1978): an element
//! that bends little has the stiffness of the linear one, exact under forces at its nodes. Without shear deformation it is
//! `12 E I/L²`.
//!
//! **Energy-momentum.** The invariants s are bilinear in q, the places and directors: `s₊ - s = ∂s(q_m) Δq` with the means q_m,
//! and with Cayley's map `d₊ - d = (R θ) × d_m`. So the forces `∂s(q_m)ᵀ D`, D the mean of ∂U/∂s on the straight way between s and s₊, do
//! the work ΔU over the step, and have no resultant and no moment in its middle, because s does not change where all q turn. The
//! moments m in space are T = A Rᵀ m in the equation `J Ẇ + W × J W = T`, A = I - θ̂/2: that keeps the angular momentum R J W, and
//! θ·T = (R θ)·m the energy. D is found with four points of Gauss's rule: its error is of the order Δs⁹.
//!
//! Metal that flows: extension and bending are those of the fibres of one section of the element, which takes the strains of the small ones.
//! Shear and torsion stay elastic. There is no stress between two configurations then.
//!
//! Mass: of translations linear between the nodes (consistent) or half at each (lumped); of rotations at both half of ρ L I about the axes
//! of the section, also with Euler-Bernoulli: a constant tensor J about the axes of the node.
//!
//! Weights that are linear along an element are its mean in the stiffness, since its strains are uniform, and `∫ α N_a N_b`, `∫ α N_a` in the mass.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::Unknowns;

use super::element::EndWeights;
use super::section::BeamTheory;
use super::strain::{Elastic, Invariants, Matrix6, Pair, extension};
use super::{Beam, SectionForces, SectionStress};
use crate::flowing::{FibreSection, Flowing};
use crate::turning::{balanced, spatial};
use crate::{Error, Placement, Stored};

/// Beams on nodes with finite rotations.
#[derive(Debug)]
pub struct LargeBeam {
    /// Cells, nodes, axes and section.
    small: Beam,
    elements: Vec<Elastic>,
    /// Extension and bending of metal that flows.
    section: Option<FibreSection>,
    /// Reference way between the nodes of each element, m.
    ways: Vec<Vec3>,
    /// Frames of the nodes of each element.
    frames: Vec<[usize; 2]>,
    /// Tensors of inertia of an element at its two nodes about the axes of coordinates, kg m².
    inertia: Vec<[Mat3; 2]>,
}

/// The state of an element's nodes.
struct Ends {
    pair: Pair,
    /// R at the start of the step, and θ since.
    starts: [Mat3; 2],
    increments: [Vec3; 2],
}

/// The invariants of an element at the end of a step, and at its start where forces are taken between both.
struct Way {
    from: Option<Invariants>,
    to: Invariants,
}

impl Way {
    /// D.
    fn force(&self, elastic: &Elastic) -> Invariants {
        match &self.from {
            None => elastic.gradient(&self.to),
            Some(from) => elastic.mean_gradient([from, &self.to]),
        }
    }

    /// Its derivative by the invariants at the end, twice that of a mean.
    fn tangent(&self, elastic: &Elastic) -> Matrix6 {
        match &self.from {
            None => elastic.tangent(&self.to),
            Some(from) => elastic.mean_tangent([from, &self.to]),
        }
    }
}

impl LargeBeam {
    /// The same beams with finite rotations. `x`: reference places by system number, m.
    ///
    /// # Errors
    /// An eccentric axis, hinges, a foundation.
    pub(crate) fn new(
        mut small: Beam,
        x: &dyn Fn(u32) -> [f64; 3],
        unknowns: &Unknowns,
    ) -> Result<LargeBeam, Error> {
        let section = small.flowing.take().map(Flowing::into_section);
        let refused = |what| Error::LargeBeam {
            body: small.name.clone(),
            what,
        };
        if small.section.offset != [0.0; 2] {
            return Err(refused("an offset"));
        }
        if small.released.iter().flatten().any(|released| *released) {
            return Err(refused("hinges"));
        }
        if !small.bolts().is_empty() {
            return Err(refused("cells that are tightened"));
        }
        if small.has_foundation() || small.has_fluid() {
            return Err(refused("a foundation or a fluid around them"));
        }
        let properties = &small.section.properties;
        let (young, shear) = (small.material.young, small.material.shear_modulus());
        let [about_y, about_z] = properties.second_moments;
        let element = |(&length, weights): (&f64, &EndWeights)| {
            // the strains of an element are uniform
            let weight = 0.5 * (weights.stiffness[0] + weights.stiffness[1]);
            let across = |area: f64, second: f64| {
                let bends = length * length / (12.0 * young * second);
                match small.section.theory {
                    BeamTheory::Timoshenko => 1.0 / (1.0 / (shear * area) + bends),
                    BeamTheory::EulerBernoulli => 1.0 / bends,
                }
            };
            let [along_y, along_z] = properties.shear_areas;
            let bending = |area: f64, second: f64| {
                let bends = length * length / (12.0 * young * second);
                extension(bends * across(area, second))
            };
            Elastic {
                length,
                extends: [bending(along_y, about_z), bending(along_z, about_y)],
                stiffness: [
                    young * properties.area,
                    across(along_y, about_z),
                    across(along_z, about_y),
                    shear * properties.torsion,
                    young * about_y,
                    young * about_z,
                ]
                .map(|stiffness| weight * stiffness),
            }
        };
        let half = |((axes, length), weights): ((&Mat3, &f64), &EndWeights)| {
            let local = Vec3::new(about_y + about_z, about_y, about_z);
            let local = Mat3::from_diagonal(&(local * (small.material.density * length)));
            let whole = axes.transpose() * local * axes;
            weights.shares().map(|share| whole * share)
        };
        let way = |nodes: &[u32; 2]| {
            let [from, to] = nodes.map(|node| Vec3::from(x(node)));
            to - from
        };
        let frames =
            |nodes: &[u32; 2]| nodes.map(|node| unknowns.frame(node).unwrap_or(usize::MAX));
        Ok(LargeBeam {
            section,
            elements: small
                .lengths
                .iter()
                .zip(&small.weights)
                .map(element)
                .collect(),
            inertia: small
                .axes
                .iter()
                .zip(&small.lengths)
                .zip(&small.weights)
                .map(half)
                .collect(),
            ways: small.nodes.iter().map(way).collect(),
            frames: small.nodes.iter().map(frames).collect(),
            small,
        })
    }

    /// The linear beams that they are where they turn little.
    pub fn small(&self) -> &Beam {
        &self.small
    }

    /// Translations and rotations of a node of an element, the latter about the axes of the node.
    fn of_node(&self, first: usize, values: &[f64]) -> [Vec3; 2] {
        let own = &values[first..first + self.small.per_node()];
        match self.small.dim {
            2 => [Vec3::new(own[0], own[1], 0.0), Vec3::new(0.0, 0.0, own[2])],
            _ => [
                Vec3::new(own[0], own[1], own[2]),
                Vec3::new(own[3], own[4], own[5]),
            ],
        }
    }

    fn ends(&self, element: usize, frames: &[Rotation], u: &[f64]) -> Ends {
        let nodes = self.small.first[element].map(|first| self.of_node(first, u));
        let starts =
            self.frames[element].map(|k| frames.get(k).copied().unwrap_or_default().matrix());
        let sections = self.small.axes[element].transpose();
        let turned = |a: usize| starts[a] * Rotation::cayley(&nodes[a][1]).matrix() * sections;
        Ends {
            pair: Pair {
                way: self.ways[element] + nodes[1][0] - nodes[0][0],
                directors: [turned(0), turned(1)],
            },
            starts,
            increments: [nodes[0][1], nodes[1][1]],
        }
    }

    fn invariants(&self, element: usize, ends: &Ends) -> Invariants {
        ends.pair.invariants(self.elements[element].length)
    }

    /// Where forces are taken in an element: the state of its nodes, the configuration, and the invariants between which D is taken.
    fn acting(&self, element: usize, at: &Placement) -> (Ends, Pair, Way) {
        let end = self.ends(element, at.frames, at.u);
        let to = self.invariants(element, &end);
        let Some(from) = at.from else {
            let pair = end.pair;
            return (end, pair, Way { from: None, to });
        };
        let start = self.ends(element, at.frames, from);
        let from = Some(self.invariants(element, &start));
        let pair = start.pair.mean(&end.pair);
        (end, pair, Way { from, to })
    }

    /// Adds internal forces and W × J W, writes the history; see [`Body::force`](crate::Body::force).
    pub(crate) fn force(
        &self,
        at: &Placement,
        new: &mut [f64],
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        if self.section.is_some() && at.from.is_some() {
            return Err(self.small.no_between());
        }
        let mut stored = Stored::default();
        for element in 0..self.elements.len() {
            let length = self.elements[element].length;
            let (end, pair, d) = match &self.section {
                None => {
                    let (end, pair, way) = self.acting(element, at);
                    let elastic = &self.elements[element];
                    stored.strain += elastic.energy(&way.to);
                    (end, pair, way.force(elastic))
                }
                Some(section) => {
                    let range = self.history_of(section, element);
                    let history = (&at.old[range.clone()], &mut new[range]);
                    self.flow(section, (element, at), history, &mut stored)
                }
            };
            let rows = pair.derivatives(length);
            let own: [f64; 12] = std::array::from_fn(|k| (0..6).map(|i| rows[i][k] * d[i]).sum());
            for (node, own) in own.chunks_exact(6).enumerate() {
                let force = Vec3::new(own[0], own[1], own[2]);
                let moment = end.starts[node].tr_mul(&Vec3::new(own[3], own[4], own[5]));
                let moment = balanced(&moment, &end.increments[node], at.from.is_some());
                self.add_node(self.small.first[element][node], [&force, &moment], f);
            }
            self.add_gyroscopic(element, at.v, f);
        }
        Ok(stored)
    }

    /// Place of the history of an element in that of all.
    fn history_of(&self, section: &FibreSection, element: usize) -> Range<usize> {
        let kept = section.history_len();
        kept * element..kept * (element + 1)
    }

    /// State of the nodes, configuration and D at the end of a step in which the section flows; adds its energies.
    fn flow(
        &self,
        section: &FibreSection,
        (element, at): (usize, &Placement),
        history: (&[f64], &mut [f64]),
        stored: &mut Stored,
    ) -> (Ends, Pair, Invariants) {
        let elastic = &self.elements[element];
        let end = self.ends(element, at.frames, at.u);
        let s = self.invariants(element, &end);
        let strains = elastic.strains(&s);
        let (forces, own) = section.update(&Elastic::flowing(&strains), at.dt, history);
        stored.strain += elastic.energy_beside(&strains) + elastic.length * own.strain;
        stored.hardening += elastic.length * own.hardening;
        stored.dissipated += elastic.length * own.dissipated;
        let d = elastic.gradient_of(&s, &elastic.stresses_with(&strains, &forces));
        let pair = end.pair;
        (end, pair, d)
    }

    /// State of the nodes, configuration and D of [`LargeBeam::acting`], and the derivative of D by the invariants at the end, twice that of a mean.
    fn linearised(&self, element: usize, at: &Placement) -> (Ends, Pair, Invariants, Matrix6) {
        let elastic = &self.elements[element];
        let Some(section) = &self.section else {
            let (end, pair, way) = self.acting(element, at);
            return (end, pair, way.force(elastic), way.tangent(elastic));
        };
        let end = self.ends(element, at.frames, at.u);
        let s = self.invariants(element, &end);
        let strains = elastic.strains(&s);
        let old = &at.old[self.history_of(section, element)];
        let (forces, tangent) = section.tangent(&Elastic::flowing(&strains), at.dt, old);
        let stresses = elastic.stresses_with(&strains, &forces);
        let d = elastic.gradient_of(&s, &stresses);
        let pair = end.pair;
        let tangent = elastic.tangent_with(&s, (&stresses, &tangent));
        (end, pair, d, tangent)
    }

    /// Numbers that its fibres keep from one step to the next.
    pub(crate) fn history_len(&self) -> usize {
        let kept = |section: &FibreSection| section.history_len();
        self.elements.len() * self.section.as_ref().map_or(0, kept)
    }

    /// Largest equivalent plastic strain of the fibres of each element; none where nothing flows.
    pub(crate) fn plastic_strains(&self, history: &[f64]) -> Option<Vec<f64>> {
        let section = self.section.as_ref()?;
        let of = |element| section.plastic_strain(&history[self.history_of(section, element)]);
        Some((0..self.elements.len()).map(of).collect())
    }

    /// Adds a force and a moment to the entries of a node.
    fn add_node(&self, first: usize, [force, moment]: [&Vec3; 2], f: &mut [f64]) {
        let dim = self.small.dim;
        for i in 0..dim {
            f[first + i] += force[i];
        }
        match dim {
            2 => f[first + 2] += moment.z,
            _ => (0..3).for_each(|i| f[first + 3 + i] += moment[i]),
        }
    }

    fn add_gyroscopic(&self, element: usize, v: &[f64], f: &mut [f64]) {
        if self.small.dim < 3 {
            return;
        }
        let own = self.small.first[element]
            .into_iter()
            .zip(&self.inertia[element]);
        for (first, inertia) in own {
            let [_, spin] = self.of_node(first, v);
            let moment = spin.cross(&(inertia * spin));
            self.add_node(first, [&Vec3::zeros(), &moment], f);
        }
    }

    /// Adds `by_u` ∂f/∂u + `by_v` ∂f/∂v, their symmetric parts, of forces between two configurations at the means of both.
    pub(crate) fn add_tangent(&self, at: &Placement, [by_u, by_v]: [f64; 2], matrix: &mut Csr) {
        let share = if at.from.is_some() { 0.5 } else { 1.0 };
        for element in 0..self.elements.len() {
            let length = self.elements[element].length;
            let (end, pair, d, inner) = self.linearised(element, at);
            let rows = pair.derivatives(length);
            let mut k = pair.curvature(length, &d);
            for a in 0..12 {
                for i in 0..6 {
                    let left: f64 = (0..6).map(|j| rows[j][a] * inner[j][i]).sum();
                    for b in 0..12 {
                        k[a][b] += left * rows[i][b];
                    }
                }
            }
            let turns = [0, 1].map(|a| spatial(&end.starts[a], &end.increments[a]));
            let column = |a: usize, part: usize| match part {
                0 => Mat3::identity(),
                _ => turns[a],
            };
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                for (p, q) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let block = Mat3::from_fn(|i, j| k[6 * a + 3 * p + i][6 * b + 3 * q + j]);
                    let own = column(a, p).transpose() * block * column(b, q) * (share * by_u);
                    self.add_block(element, [(a, p), (b, q)], &own, matrix);
                }
            }
            self.add_gyroscopic_tangent(element, at.v, by_v, matrix);
        }
    }

    fn add_gyroscopic_tangent(&self, element: usize, v: &[f64], by_v: f64, matrix: &mut Csr) {
        if self.small.dim < 3 || by_v == 0.0 {
            return;
        }
        for (node, first) in self.small.first[element].into_iter().enumerate() {
            let [_, spin] = self.of_node(first, v);
            let inertia = &self.inertia[element][node];
            let slope = spin.cross_matrix() * inertia - (inertia * spin).cross_matrix();
            let mean = (slope + slope.transpose()) * (0.5 * by_v);
            self.add_block(element, [(node, 1), (node, 1)], &mean, matrix);
        }
    }

    /// Adds a block over the translations (part 0) or the rotations (part 1) of two nodes.
    fn add_block(
        &self,
        element: usize,
        [(a, p), (b, q)]: [(usize, usize); 2],
        own: &Mat3,
        to: &mut Csr,
    ) {
        let dim = self.small.dim;
        let places = |node: usize, part: usize| {
            let first = self.small.first[element][node];
            let all: [Option<usize>; 3] = match (part, dim) {
                (0, _) => [0, 1, 2].map(|i| (i < dim).then_some(first + i)),
                (_, 2) => [None, None, Some(first + 2)],
                _ => [0, 1, 2].map(|i| Some(first + 3 + i)),
            };
            all
        };
        let columns = places(b, q);
        for (i, row) in places(a, p).into_iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                if let (Some(row), Some(column)) = (row, *column) {
                    to.add(row, column, own[(i, j)]);
                }
            }
        }
    }

    /// Adds `mass` M; see [`Body::assemble`](crate::Body::assemble).
    pub(crate) fn add_mass(&self, mass: f64, part: &Range<usize>, matrix: &mut Csr) {
        let dim = self.small.dim;
        for (element, first) in self.small.first.iter().enumerate() {
            if !part.contains(&first[0]) {
                continue;
            }
            let whole = mass * self.weight(element);
            let products = self.small.weights[element].products();
            let nodes = first.map(|first| first - part.start);
            for (a, &row) in nodes.iter().enumerate() {
                for (b, &column) in nodes.iter().enumerate() {
                    let m = whole * products[a][b];
                    (0..dim).for_each(|i| matrix.add(row + i, column + i, m));
                }
                let inertia = self.inertia[element][a] * mass;
                match dim {
                    2 => matrix.add(row + 2, row + 2, inertia[(2, 2)]),
                    _ => {
                        for i in 0..3 {
                            for j in 0..3 {
                                matrix.add(row + 3 + i, row + 3 + j, inertia[(i, j)]);
                            }
                        }
                    }
                }
            }
        }
    }

    fn weight(&self, element: usize) -> f64 {
        let line = self.small.material.density * self.small.section.properties.area;
        line * self.elements[element].length
    }

    /// Adds the diagonal of the lumped mass.
    pub(crate) fn add_lumped_mass(&self, mass: &mut [f64]) {
        let dim = self.small.dim;
        for (element, first) in self.small.first.iter().enumerate() {
            let shares = self.small.weights[element].shares();
            for (a, &first) in first.iter().enumerate() {
                for m in &mut mass[first..first + dim] {
                    *m += shares[a] * self.weight(element);
                }
                let inertia = &self.inertia[element][a];
                match dim {
                    2 => mass[first + 2] += inertia[(2, 2)],
                    _ => (0..3).for_each(|i| mass[first + 3 + i] += inertia[(i, i)]),
                }
            }
        }
    }

    /// Whether the lumped mass is diagonal in the axes of coordinates.
    pub(crate) fn lumps(&self) -> bool {
        self.small.dim == 2
            || self.inertia.iter().flatten().all(|inertia| {
                let off = [inertia[(0, 1)], inertia[(1, 2)], inertia[(0, 2)]];
                off.iter()
                    .all(|i| i.abs() <= super::ROUNDING * inertia.trace())
            })
    }

    /// Volume (m³) and mean stress (Pa) of each element: the normal force along the line between its nodes, over the area.
    pub(crate) fn stresses(&self, u: &[f64], history: &[f64]) -> Vec<(f64, Mat3)> {
        let of = |element: usize| {
            let [from, to] = self.small.first[element].map(|first| self.of_node(first, u)[0]);
            let (way, length) = (
                self.ways[element] + to - from,
                self.elements[element].length,
            );
            let (now, along) = (way.norm(), way.normalize());
            let strain = now / length - 1.0;
            let stress = match &self.section {
                None => self.small.material.young * strain,
                Some(section) => {
                    section.mean_stress(strain, &history[self.history_of(section, element)])
                }
            };
            let volume = self.small.section.properties.area * length;
            (volume, along * along.transpose() * stress)
        };
        (0..self.elements.len()).map(of).collect()
    }

    /// Forces in the sections and moments at their ends at these rotations and displacements, in the axes in the middle of each element.
    /// `history`: of this body there.
    pub(crate) fn section_forces(
        &self,
        frames: &[Rotation],
        u: &[f64],
        history: &[f64],
    ) -> Vec<SectionForces> {
        let of = |element: usize| {
            let s = self.invariants(element, &self.ends(element, frames, u));
            let elastic = &self.elements[element];
            let f = match &self.section {
                None => {
                    let [one, two] = self.small.weights[element].stiffness;
                    elastic.stresses(&s).map(|f| f / (0.5 * (one + two)))
                }
                Some(section) => {
                    let strains = elastic.strains(&s);
                    let history = &history[self.history_of(section, element)];
                    let flowing = section.forces(&Elastic::flowing(&strains), history);
                    elastic.stresses_with(&strains, &flowing)
                }
            };
            let strains = elastic.strains(&s);
            let f = elastic.across_the_chord(&strains, &f);
            let (force, moment) = (Vec3::new(f[0], f[1], f[2]), Vec3::new(f[3], f[4], f[5]));
            // m' + x' × n = 0 from the middle to the ends
            let half = elastic.chord(&strains) * (0.5 * elastic.length);
            let lever = half.cross(&force);
            SectionForces {
                force: force.into(),
                moment_first: (moment + lever).into(),
                moment_second: (moment - lever).into(),
            }
        };
        (0..self.elements.len()).map(of).collect()
    }

    /// See [`Body::section_stresses`](crate::Body::section_stresses).
    pub(crate) fn section_stresses(
        &self,
        frames: &[Rotation],
        u: &[f64],
        history: &[f64],
    ) -> Vec<SectionStress> {
        let Some(places) = &self.small.places else {
            return vec![SectionStress::unknown(); self.elements.len()];
        };
        let of = |(element, forces): (usize, SectionForces)| {
            let Some(section) = &self.section else {
                return places.stress(&forces);
            };
            let history = &history[self.history_of(section, element)];
            if section.plastic_strain(history) == 0.0 {
                return places.stress(&forces);
            }
            let s = self.invariants(element, &self.ends(element, frames, u));
            let strains = Elastic::flowing(&self.elements[element].strains(&s));
            let fibre = |_, at| section.stress(&strains, at, history);
            places.flowed(&forces, (1, &fibre))
        };
        let all = self.section_forces(frames, u, history).into_iter();
        all.enumerate().map(of).collect()
    }
}
