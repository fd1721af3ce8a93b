//! Reduced bodies: retained nodes and amplitudes of modes, with dense matrices.
//!
//! Forces are `f = K q + C q̇` and inertia `M q̈` with q the unknowns of the retained nodes and the amplitudes. The motion of the full
//! body is u = T q, from which stresses are recovered. What makes the matrices is not known here.

use std::ops::Range;
use std::sync::Arc;

use carom_algebra::basis::{Amplitude, Basis};
use carom_algebra::csr::Csr;
use carom_algebra::reduce::dot;
use carom_algebra::tensor::Mat3;
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_mesh::ElementId;

use crate::reducible::Reducible;
use crate::{Placement, SectionForces, Stored};

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
    /// K over the retained unknowns, node after node, and the amplitudes; row-major, N/m.
    pub stiffness: Vec<f64>,
    /// M, kg.
    pub mass: Vec<f64>,
    /// C, N s/m, if the body is damped.
    pub damping: Option<Vec<f64>>,
    /// Tᵀ M r for unit translations r along the axes, kg.
    pub inertia: [Vec<f64>; 3],
    /// rᵀ M r of the full body for the same, kg.
    pub translated: [f64; 3],
    /// Whether supports hold nodes that are not retained.
    pub is_grounded: bool,
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
    unknowns: Vec<u32>,
    /// The same, as ranges of those that follow each other.
    runs: Vec<Range<usize>>,
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
        let mut runs: Vec<Range<usize>> = Vec::new();
        for next in nodes.iter().map(own) {
            match runs.last_mut() {
                Some(run) if run.end == next.start => run.end = next.end,
                _ => runs.push(next),
            }
        }
        Reduced {
            unknowns: runs.iter().cloned().flatten().map(|i| i as u32).collect(),
            runs,
            nodes,
            data,
        }
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
            self.unknowns.clone(),
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

    /// Visits the entries of a matrix times a vector of the system, by unknown.
    fn each_product(&self, matrix: &[f64], u: &[f64], visit: &mut dyn FnMut(usize, f64)) {
        for (row, i) in matrix.chunks_exact(self.unknowns.len()).zip(&self.unknowns) {
            let (mut product, mut rest) = (0.0, row);
            for run in &self.runs {
                let (own, others) = rest.split_at(run.len());
                product += dot(own, &u[run.clone()]);
                rest = others;
            }
            visit(*i as usize, product);
        }
    }

    /// Adds K u to `f` and returns the strain energy (J).
    pub(crate) fn internal_force(&self, u: &[f64], f: &mut [f64]) -> f64 {
        let mut energy = 0.0;
        self.each_product(&self.data.stiffness, u, &mut |i, force| {
            f[i] += force;
            energy += 0.5 * force * u[i];
        });
        energy
    }

    /// Adds the internal forces; see [`Body::force`](crate::Body::force).
    pub(crate) fn force(&self, at: &Placement, f: &mut [f64]) -> Stored {
        let strain = match at.from {
            None => self.internal_force(at.u, f),
            Some(from) => {
                let stiffness = &self.data.stiffness;
                let mut energy = 0.0;
                self.each_product(stiffness, at.u, &mut |i, force| {
                    f[i] += 0.5 * force;
                    energy += 0.5 * force * at.u[i];
                });
                self.each_product(stiffness, from, &mut |i, force| f[i] += 0.5 * force);
                energy
            }
        };
        Stored {
            strain,
            ..Stored::default()
        }
    }

    /// Adds C v to `f`.
    pub(crate) fn add_damping_force(&self, v: &[f64], f: &mut [f64]) {
        if let Some(damping) = &self.data.damping {
            self.each_product(damping, v, &mut |i, force| f[i] += force);
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
        let [stiffness, mass] = [&self.data.stiffness, &self.data.mass];
        let damping = self.data.damping.as_ref();
        let n = self.unknowns.len();
        for (a, &i) in self.unknowns.iter().enumerate() {
            for (b, &j) in self.unknowns.iter().enumerate() {
                let at = a * n + b;
                let c = damping.map_or(0.0, |damping| damping[at]);
                let value = factors[0] * stiffness[at] + factors[1] * c + factors[2] * mass[at];
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
        let data = &*self.data;
        let n = self.unknowns.len();
        let motion = self.rigid(axis);
        let rows = data.mass.chunks_exact(n).zip(&data.inertia[axis]);
        let missing = rows
            .map(|(row, exact)| exact - row.iter().zip(&motion).map(|(m, r)| m * r).sum::<f64>());
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
