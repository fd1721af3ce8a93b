//! Reduced bodies: retained nodes and amplitudes of modes.
//!
//! Forces are `f = K q + C q̇` and inertia `M q̈` with q the unknowns of the retained nodes and the amplitudes. The matrices are
//! arrowheads: amplitudes couple with retained unknowns, not with each other. Bodies that are equal share them. The motion of the full
//! body is u = T q, from which stresses are recovered. What makes the matrices is not known here.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::arrowhead::Arrowhead;
use carom_algebra::basis::{Amplitude, Basis};
use carom_algebra::csr::Csr;
use carom_algebra::reduce::dot;
use carom_algebra::tensor::Mat3;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_mesh::ElementId;

use crate::reducible::Reducible;
use crate::{Placement, SectionForces, SectionStress, Stored};

/// A body and what it is reduced to, in the numbers of the mesh.
#[derive(Debug)]
pub struct Reduction {
    /// The full body, in numbers of its own.
    pub full: Reducible,
    /// Unknowns of the full body.
    pub unknowns: Unknowns,
    /// Node of the mesh of each node of the full body.
    pub mesh_node: Vec<u32>,
    /// Nodes of the mesh that are retained, ascending, with all their unknowns.
    pub retained: Vec<u32>,
    /// What of a rigid motion each amplitude is.
    pub amplitudes: Vec<Amplitude>,
    /// T: one row for each unknown of the full body, over the retained unknowns and the amplitudes.
    pub rows: Arc<[f64]>,
    /// K, M and C.
    pub matrices: Arc<ReducedMatrices>,
    /// Tᵀ M r for unit translations r along the axes, kg.
    pub inertia: [Vec<f64>; 3],
    /// rᵀ M r of the full body for the same, kg.
    pub translated: [f64; 3],
    /// Whether supports hold nodes that are not retained.
    pub is_grounded: bool,
    /// What supports hold of nodes that are not retained, by node of the mesh.
    pub held: Vec<(u32, Kind)>,
    /// Along which axes nothing holds the full body: K r = 0 of a translation r, beside rounding.
    pub is_free: [bool; 3],
    /// Whether the retained unknowns have no mass.
    pub is_massless: bool,
    /// Lumped masses of the nodes of the full body, by node of the mesh, kg.
    pub masses: Vec<(u32, f64)>,
    /// Centre of mass, m.
    pub centre: [f64; 3],
    /// Frequencies of the modes, Hz.
    pub frequencies: Vec<f64>,
    /// Frequencies (Hz) that the reduced body by itself has, ascending, and estimates of their errors, relative to those of the full
    /// body. None where they could not be computed.
    pub estimates: Option<Vec<[f64; 2]>>,
    /// Part of the mass, of what supports leave free, that the reduced body does not move with unit translations along the axes.
    /// None as above.
    pub unmoved: Option<[f64; 3]>,
}

/// The matrices of a reduced body, over the retained unknowns, node after node, and the amplitudes.
#[derive(Debug, PartialEq)]
pub struct ReducedMatrices {
    /// K, N/m.
    pub stiffness: Arrowhead,
    /// M, kg.
    pub mass: Arrowhead,
    /// C, N s/m, if the body is damped.
    pub damping: Option<Arrowhead>,
}

/// The mass of a reduced body on a system.
#[derive(Clone, Debug)]
pub struct ReducedMass {
    matrices: Arc<ReducedMatrices>,
    /// Unknowns of the system.
    unknowns: Arc<[u32]>,
}

impl ReducedMass {
    /// Adds `factor` M x (kg times the unit of x) to `y`, both system vectors.
    pub fn add_product(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        each_product(&self.matrices.mass, &self.unknowns, x, |i, part| {
            y[i] += factor * part;
        });
    }

    /// Visits the entries of M that are not zero, by unknowns of the system, kg.
    pub fn each_entry(&self, mut visit: impl FnMut(usize, usize, f64)) {
        for (a, &i) in self.unknowns.iter().enumerate() {
            for (b, &j) in self.unknowns.iter().enumerate() {
                let entry = self.matrices.mass.get(a, b);
                if entry != 0.0 {
                    visit(i as usize, j as usize, entry);
                }
            }
        }
    }

    /// Whether its unknowns are among these; those of a body are in one connected part.
    pub fn is_in(&self, part: &Range<usize>) -> bool {
        let first = self.unknowns.first();
        first.is_some_and(|unknown| part.contains(&(*unknown as usize)))
    }
}

/// Visits parts of the entries of a matrix times a vector of the system, by unknown; an entry is the sum of its parts.
#[inline]
fn each_product(
    matrix: &Arrowhead,
    unknowns: &[u32],
    u: &[f64],
    mut visit: impl FnMut(usize, f64),
) {
    let at = |own: usize| unknowns[own] as usize;
    matrix.each_product(|own| u[at(own)], |own, part| visit(at(own), part));
}

impl Reduction {
    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.inertia[0].len()
    }

    /// Number of frequencies from the lowest that are within `error` of those of the full body by estimate, and the last of them, Hz.
    pub fn band(&self, error: f64) -> Option<(usize, f64)> {
        let estimates = self.estimates.as_ref()?;
        let count = estimates
            .iter()
            .take_while(|[_, own]| *own <= error)
            .count();
        Some((count, estimates[count.checked_sub(1)?][0]))
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A reduced body on a system.
#[derive(Debug)]
pub struct Reduced {
    data: Arc<Reduction>,
    /// Retained nodes, and the node of the amplitudes.
    nodes: Vec<u32>,
    /// Unknowns of the system.
    unknowns: Arc<[u32]>,
    /// Free translations over its unknowns, and the first retained translation along the axis of each, by own number.
    free: Vec<(Vec<f64>, usize)>,
}

impl Reduced {
    /// `number`: system number of each mesh node; `amplitudes`: the node of the amplitudes; `unknowns`: of the system.
    pub fn new(
        data: Arc<Reduction>,
        number: &[u32],
        (amplitudes, unknowns): (u32, &Unknowns),
    ) -> Reduced {
        let retained = data.retained.iter().map(|&node| number[node as usize]);
        let nodes: Vec<u32> = retained.chain([amplitudes]).collect();
        // a node may have rotations that this body does not know
        let own = |&node: &u32| match node == amplitudes {
            true => unknowns.of(node),
            false => {
                let first = unknowns.first(node);
                first..first + data.unknowns.of(0).len()
            }
        };
        let own = nodes.iter().flat_map(own);
        let mut body = Reduced {
            unknowns: own.map(|unknown| unknown as u32).collect(),
            nodes,
            data,
            free: Vec::new(),
        };
        for axis in (0..3).filter(|&axis| body.data.is_free[axis]) {
            let first = body.translation(axis).iter().position(|r| *r == 1.0);
            let motion = body.rigid(axis);
            body.free.extend(first.map(|first| (motion, first)));
        }
        body
    }

    /// Motions of the nodes that are not retained, for the unknowns of the system.
    pub fn basis(&self, number: &[u32]) -> Basis {
        let data = &*self.data;
        let mut first = Vec::new();
        for (node, &mesh_node) in data.mesh_node.iter().enumerate() {
            if data.retained.binary_search(&mesh_node).is_err() {
                let row = data.unknowns.first(node as u32) as u32;
                first.push((number[mesh_node as usize], row));
            }
        }
        let own = self.unknowns.len() - data.amplitudes.len();
        let amplitudes = self.unknowns[own..].iter().map(|unknown| *unknown as usize);
        let amplitudes = amplitudes.zip(data.amplitudes.iter().copied()).collect();
        Basis::new(
            self.unknowns.to_vec(),
            Arc::clone(&data.rows),
            first,
            amplitudes,
        )
    }

    /// What it is.
    pub fn reduction(&self) -> &Reduction {
        &self.data
    }

    /// Name as in the case file.
    pub fn name(&self) -> &str {
        self.data.full.name()
    }

    /// Retained nodes, and the node of the amplitudes.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Its unknowns in the system.
    pub fn unknowns(&self) -> &[u32] {
        &self.unknowns
    }

    /// Cells of the mesh.
    pub fn cells(&self) -> &[ElementId] {
        self.data.full.cells()
    }

    /// Its unknowns, and Tᵀ M r of each for a unit translation r along an axis, kg: of a velocity the momentum.
    pub fn inertia(&self, axis: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let unknowns = self.unknowns.iter().map(|unknown| *unknown as usize);
        unknowns.zip(self.data.inertia[axis].iter().copied())
    }

    pub(crate) fn each_element(&self, visit: &mut dyn FnMut(&[u32])) {
        visit(&self.nodes);
    }

    /// M.
    pub fn mass(&self) -> ReducedMass {
        ReducedMass {
            matrices: Arc::clone(&self.data.matrices),
            unknowns: Arc::clone(&self.unknowns),
        }
    }

    /// Adds `factor` K u to `f` and returns the strain energy (J).
    ///
    /// Where translations r are free, it is Pᵀ K P u with P = 1 - Σ r eᵀ, e the first retained translation along the axis of r: the same but for rounding. K r
    /// is the rounding of K times the motion, which in a long way, and with modes that are stiff, would push the body; the sum of the forces is zero so.
    fn add_stiffness_force(&self, factor: f64, u: &[f64], f: &mut [f64]) -> f64 {
        let mut energy = 0.0;
        if !self.free.is_empty() {
            let mut sums = [0.0; 3];
            let at = |own: usize| self.unknowns[own] as usize;
            let deformed = |own: usize| {
                let free = self.free.iter();
                free.fold(u[at(own)], |u_own, (motion, first)| {
                    u_own - motion[own] * u[at(*first)]
                })
            };
            let stiffness = &self.data.matrices.stiffness;
            stiffness.each_product(deformed, |own, part| {
                f[at(own)] += factor * part;
                energy += 0.5 * part * deformed(own);
                for (sum, (motion, _)) in sums.iter_mut().zip(&self.free) {
                    *sum += motion[own] * part;
                }
            });
            for (sum, (_, first)) in sums.iter().zip(&self.free) {
                f[at(*first)] -= factor * sum;
            }
            return energy;
        }
        each_product(
            &self.data.matrices.stiffness,
            &self.unknowns,
            u,
            |i, part| {
                f[i] += factor * part;
                energy += 0.5 * part * u[i];
            },
        );
        energy
    }

    /// Adds K u to `f` and returns the strain energy (J).
    pub(crate) fn internal_force(&self, u: &[f64], f: &mut [f64]) -> f64 {
        self.add_stiffness_force(1.0, u, f)
    }

    /// Adds the internal forces; see [`Body::force`](crate::Body::force).
    pub(crate) fn force(&self, at: &Placement, f: &mut [f64]) -> Stored {
        let strain = match at.from {
            None => self.internal_force(at.u, f),
            Some(from) => {
                self.add_stiffness_force(0.5, from, f);
                self.add_stiffness_force(0.5, at.u, f)
            }
        };
        Stored {
            strain,
            ..Stored::default()
        }
    }

    /// Adds C v to `f`.
    pub(crate) fn add_damping_force(&self, v: &[f64], f: &mut [f64]) {
        if let Some(damping) = &self.data.matrices.damping {
            each_product(damping, &self.unknowns, v, |i, part| f[i] += part);
        }
    }

    /// Adds `by_u` K + `by_v` C to a matrix over all unknowns; see [`Body::add_tangent`](crate::Body::add_tangent).
    pub(crate) fn add_tangent(&self, at: &Placement, [by_u, by_v]: [f64; 2], matrix: &mut Csr) {
        let share = if at.from.is_some() { 0.5 } else { 1.0 };
        self.assemble([share * by_u, by_v, 0.0], &(0..usize::MAX), matrix);
    }

    /// Adds `factors` of K, C and M; see [`Body::assemble`](crate::Body::assemble).
    pub(crate) fn assemble(&self, factors: [f64; 3], part: &Range<usize>, matrix: &mut Csr) {
        let in_part = |unknown: &u32| part.contains(&(*unknown as usize));
        if !self.unknowns.first().is_some_and(in_part) {
            return;
        }
        let ReducedMatrices {
            stiffness,
            mass,
            damping,
        } = &*self.data.matrices;
        for (a, &i) in self.unknowns.iter().enumerate() {
            for (b, &j) in self.unknowns.iter().enumerate() {
                let [k, m] = [stiffness, mass].map(|matrix| matrix.get(a, b));
                let c = damping.as_ref().map_or(0.0, |damping| damping.get(a, b));
                let value = factors[0] * k + factors[1] * c + factors[2] * m;
                matrix.add(i as usize - part.start, j as usize - part.start, value);
            }
        }
    }

    /// The motion of the full body.
    fn recover(&self, u: &[f64]) -> Vec<f64> {
        let width = self.unknowns.len();
        let q: Vec<f64> = self.unknowns.iter().map(|i| u[*i as usize]).collect();
        let rows = self.data.rows.chunks_exact(width);
        rows.map(|row| row.iter().zip(&q).map(|(t, q)| t * q).sum())
            .collect()
    }

    /// Volume (m³) and mean stress (Pa) of each element.
    pub(crate) fn stresses(&self, u: &[f64]) -> Vec<(f64, Mat3)> {
        self.data.full.stresses(&self.recover(u))
    }

    /// Forces and moments in the sections of beams.
    pub(crate) fn section_forces(&self, u: &[f64]) -> Option<Vec<SectionForces>> {
        self.data.full.section_forces(&self.recover(u))
    }

    /// Whether it is one of beams.
    pub fn has_sections(&self) -> bool {
        self.data.full.has_sections()
    }

    /// The largest stresses in the sections of beams.
    pub(crate) fn section_stresses(&self, u: &[f64]) -> Option<Vec<SectionStress>> {
        self.data.full.section_stresses(&self.recover(u))
    }

    /// The amplitudes of a uniform motion (m or m/s), and their unknowns.
    pub fn uniform(&self, motion: [f64; 3]) -> impl Iterator<Item = (usize, f64)> + '_ {
        let own = self.unknowns.len() - self.data.amplitudes.len();
        let unknowns = self.unknowns[own..].iter().map(|unknown| *unknown as usize);
        let value = move |amplitude: &Amplitude| {
            let terms = amplitude.translation.iter().zip(motion);
            terms.map(|(part, motion)| part * motion).sum::<f64>()
        };
        unknowns.zip(self.data.amplitudes.iter().map(value))
    }

    /// What Tᵀ M r is beyond M of a unit translation of the retained nodes and its amplitudes, by unknown, kg: zero where the
    /// basis holds the translation.
    pub fn missing(&self, axis: usize) -> Vec<(usize, f64)> {
        let motion = self.rigid(axis);
        let mut missing = self.data.inertia[axis].clone();
        let mass = &self.data.matrices.mass;
        mass.each_product(|own| motion[own], |own, part| missing[own] -= part);
        let unknowns = self.unknowns.iter().map(|unknown| *unknown as usize);
        unknowns.zip(missing).collect()
    }

    /// What rᵀ M r of the full body is beyond that of a unit translation of the retained nodes and its amplitudes, kg.
    pub fn missing_mass(&self, axis: usize) -> f64 {
        let data = &*self.data;
        data.translated[axis] - dot(&data.inertia[axis], &self.rigid(axis))
    }

    /// A unit translation of the retained nodes along an axis, and its amplitudes.
    fn rigid(&self, axis: usize) -> Vec<f64> {
        let data = &*self.data;
        let mut motion = self.translation(axis);
        let own = motion.len() - data.amplitudes.len();
        for (motion, amplitude) in motion[own..].iter_mut().zip(&data.amplitudes) {
            *motion = amplitude.translation[axis];
        }
        motion
    }

    /// 1 for the retained translations along an axis.
    fn translation(&self, axis: usize) -> Vec<f64> {
        let per = self.data.unknowns.of(0);
        let mut motion = vec![0.0; self.unknowns.len()];
        for node in 0..self.data.retained.len() {
            for unknown in per.clone() {
                if self.data.unknowns.kind(unknown) == Kind::Translation(axis) {
                    motion[node * per.len() + unknown] = 1.0;
                }
            }
        }
        motion
    }
}
