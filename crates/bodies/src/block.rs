//! Elements of one kind and one material, cut into chunks of a fixed number of elements.
//!
//! A chunk sums into its own node list, and the lists are added in chunk order: no atomics, and equal bits for any
//! number of threads.

use std::ops::Range;

use carom_algebra::lanes::Lanes;
use carom_algebra::tensor::Mat3;
use carom_elements::{Kind, MAX_NODES, Rule};
use carom_mesh::{ElementId, Mesh};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::bar::Bar;
use crate::chunk::{Chunk, element_nodes};
use crate::continuum::{self, Law, Points};
use crate::force::{Elastic, Kernel};

use crate::nodes::Nodes;
use crate::single;
use crate::weights::{CellWeights, ChunkWeights, ElementWeights, Unweighted, WIDEST, Weight};

/// Elements per chunk, whatever the number of threads: about 30 microseconds of work.
pub(crate) fn chunk_length(kind: Kind) -> usize {
    let element = kind.table();
    match (element.dim, element.nodes) {
        (0 | 1, _) => 4096,
        (_, ..=4) => 1024,
        (_, ..=10) => 256,
        _ => 32,
    }
}

/// Matrices of one element.
pub(crate) struct Matrices<'a> {
    /// System numbers of its nodes.
    pub(crate) nodes: &'a [u32],
    /// First unknowns of its nodes.
    pub(crate) first: &'a [u32],
    /// N/m, row-major over node-major unknowns; empty where it is not wanted.
    pub(crate) stiffness: &'a [f64],
    /// Scalar consistent mass in kg, row-major over nodes.
    pub(crate) mass: &'a [f64],
    /// Scalar lumped mass in kg.
    pub(crate) lumped: &'a [f64],
}

/// Calls the method for the number of nodes of a kind.
macro_rules! by_nodes {
    ($kind:expr => $block:ident.$method:ident $arguments:tt) => {
        carom_elements::kinds!(call_by_nodes ($kind) $block $method $arguments)
    };
}

/// [`by_nodes`], with the list of kinds behind it.
macro_rules! call_by_nodes {
    (
        [($kind:expr) $block:ident $method:ident $arguments:tt]
        $($(#[$doc:meta])* $name:ident $module:ident $nodes:literal,)*
    ) => {
        match $kind {
            $(carom_elements::Kind::$name => $block.$method::<$nodes> $arguments,)*
        }
    };
}

pub(crate) use {by_nodes, call_by_nodes};

/// What is called for each element.
pub(crate) type Visit<'a> = dyn FnMut(&Matrices) + 'a;

/// The physics of the elements of a block.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Physics {
    Bar(Bar),
    Continuum(Law),
}

/// Elements of one kind and one material.
#[derive(Debug)]
pub(crate) struct Block {
    pub(crate) kind: Kind,
    pub(crate) physics: Physics,
    pub(crate) stiffness_points: Points,
    pub(crate) mass_points: Points,
    pub(crate) chunks: Vec<Chunk>,
}

impl Block {
    /// `rule`: where the internal work is taken; `weights`: of these elements in their order.
    pub(crate) fn new(
        (kind, rule): (Kind, &'static Rule),
        physics: Physics,
        of: &Nodes,
        weights: Option<&CellWeights>,
    ) -> Block {
        let per = kind.table().nodes;
        let length = chunk_length(kind) * per;
        let stiffness_points = Points::new(kind, rule);
        let chunk_weights = |first: usize, count: usize| {
            weights.map(|weights| {
                let values = first..first + count;
                let (inertia, stiffness) =
                    (&weights.inertia[values.clone()], &weights.stiffness[values]);
                ChunkWeights::new(inertia, stiffness, per, &stiffness_points)
            })
        };
        let chunks = of
            .elements
            .chunks(length)
            .enumerate()
            .map(|(place, elements)| {
                let weights = chunk_weights(place * length, elements.len());
                let mut nodes = elements.to_vec();
                nodes.sort_unstable();
                nodes.dedup();
                nodes.shrink_to_fit();
                let place = |node: &u32| nodes.partition_point(|n| n < node) as u32;
                Chunk {
                    connectivity: elements.iter().map(place).collect(),
                    x: nodes.iter().map(|&node| of.x[node as usize]).collect(),
                    first: nodes
                        .iter()
                        .map(|&node| of.unknowns.first(node) as u32)
                        .collect(),
                    nodes,
                    weights,
                    viscosity: Vec::new(),
                }
            });
        let chunks = chunks.collect();
        Block {
            kind,
            physics,
            stiffness_points,
            mass_points: Points::new(kind, kind.table().mass_rule),
            chunks,
        }
    }

    /// Internal forces (N, one entry per chunk node) and strain energy (J) of each chunk, for the displacement `u` (m,
    /// a system vector).
    pub(crate) fn forces(
        &self,
        dim: usize,
        u: &[f64],
        forces: &mut [Vec<[f64; 3]>],
        energies: &mut [f64],
    ) {
        let chunk = |((chunk, f), energy): ((&Chunk, &mut Vec<[f64; 3]>), &mut f64)| {
            f.fill([0.0; 3]);
            *energy = Arch::new().dispatch(Sweep {
                block: self,
                chunk,
                dim,
                u,
                f,
            });
        };
        if self.chunks.len() == 1 {
            // waking a thread takes as long as the work
            let all = self.chunks.iter().zip(forces).zip(energies);
            return all.for_each(chunk);
        }
        let chunks = self.chunks.par_iter().zip(forces).zip(energies);
        chunks.for_each(chunk);
    }

    /// Elements of all chunks but the last.
    pub(crate) fn chunk_length(&self) -> usize {
        chunk_length(self.kind)
    }

    /// Number of elements.
    pub(crate) fn len(&self) -> usize {
        let entries = self.chunks.iter().map(|chunk| chunk.connectivity.len());
        entries.sum::<usize>() / self.kind.table().nodes
    }

    /// Calls `visit` with the nodes of each element.
    pub(crate) fn elements(&self, visit: &mut dyn FnMut(&[u32])) {
        let mut nodes = [0; MAX_NODES];
        let nodes = &mut nodes[..self.kind.table().nodes];
        for chunk in &self.chunks {
            for element in chunk.connectivity.chunks_exact(nodes.len()) {
                for (node, &place) in nodes.iter_mut().zip(element) {
                    *node = chunk.nodes[place as usize];
                }
                visit(nodes);
            }
        }
    }

    /// Mean of the nodes of an element in the mesh, m.
    pub(crate) fn middle(&self, element: usize) -> [f64; 3] {
        let (chunk, nodes) = (element / self.chunk_length(), self.kind.table().nodes);
        let chunk = &self.chunks[chunk];
        let first = nodes * (element % self.chunk_length());
        let own = &chunk.connectivity[first..first + nodes];
        own.iter().fold([0.0; 3], |sum, &place| {
            [0, 1, 2].map(|i| sum[i] + chunk.x[place as usize][i] / nodes as f64)
        })
    }

    /// Calls `visit` with the axis and the volume (m³) of each bar.
    pub(crate) fn bars(&self, visit: &mut dyn FnMut(&[f64; 3], f64)) {
        let Physics::Bar(bar) = &self.physics else {
            return;
        };
        for chunk in &self.chunks {
            for element in chunk.connectivity.chunks_exact(2) {
                let x = [element[0], element[1]].map(|place| chunk.x[place as usize]);
                let (axis, length) = Bar::axis(&x);
                visit(&axis, bar.area * length);
            }
        }
    }

    /// Calls `visit` with the matrices of each element.
    pub(crate) fn matrices(&self, dim: usize, stiffness: bool, visit: &mut Visit) {
        for chunk in &self.chunks {
            self.matrices_of(chunk, dim, stiffness, visit);
        }
    }

    /// The same of each element of a chunk.
    pub(crate) fn matrices_of(
        &self,
        chunk: &Chunk,
        dim: usize,
        stiffness: bool,
        visit: &mut Visit,
    ) {
        by_nodes!(self.kind => self.visit(chunk, dim, stiffness, visit));
    }

    fn visit<const N: usize>(&self, chunk: &Chunk, dim: usize, stiffness: bool, visit: &mut Visit) {
        let mut k = vec![0.0; if stiffness { (dim * N).pow(2) } else { 0 }];
        let (mut m, mut lumped) = (vec![0.0; N * N], [0.0; N]);
        let (mass_points, stiffness_points) = (&self.mass_points, &self.stiffness_points);
        let mut w = ElementWeights::<N>::ones(mass_points, stiffness_points);
        for (place, element) in chunk.connectivity.chunks_exact(N).enumerate() {
            let x = element_nodes::<N, _>(element, |node| chunk.x[node]);
            if let Some(weights) = &chunk.weights {
                w.set(mass_points, weights, place);
            }
            match &self.physics {
                Physics::Bar(bar) => bar.mass(&w.nodes, &x, &mut m),
                Physics::Continuum(law) => {
                    continuum::mass(law, mass_points, &w.inertia, &x, &mut m)
                }
            }
            match &self.physics {
                _ if !stiffness => {}
                Physics::Bar(bar) => bar.stiffness(dim, w.stiffness[0], &x, &mut k),
                Physics::Continuum(law) => {
                    continuum::stiffness(law, stiffness_points, &w.stiffness, &x, &mut k)
                }
            }
            self.lump(&m, &mut lumped);
            visit(&Matrices {
                nodes: &element_nodes::<N, _>(element, |node| chunk.nodes[node]),
                first: &element_nodes::<N, _>(element, |node| chunk.first[node]),
                stiffness: &k,
                mass: &m,
                lumped: &lumped,
            });
        }
    }

    /// Lumped mass of an element from its consistent one: row sums of linear kinds, whose nodes are all corners, and the
    /// scaled diagonal of others.
    fn lump(&self, m: &[f64], lumped: &mut [f64]) {
        let n = lumped.len();
        if self.kind.table().is_quadratic() {
            let diagonal: f64 = m.iter().step_by(n + 1).sum();
            let scale = match diagonal == 0.0 {
                true => 0.0,
                false => m.iter().sum::<f64>() / diagonal,
            };
            for (lumped, own) in lumped.iter_mut().zip(m.iter().step_by(n + 1)) {
                *lumped = scale * own;
            }
            return;
        }
        for (lumped, row) in lumped.iter_mut().zip(m.chunks_exact(n)) {
            *lumped = row.iter().sum();
        }
    }

    /// For each element, whether its weights vary within it.
    pub(crate) fn varying(&self) -> Vec<bool> {
        let chunks = self.chunks.iter().flat_map(|chunk| {
            let nodes = self.kind.table().nodes;
            let count = chunk.connectivity.len() / nodes;
            (0..count).map(move |element| match &chunk.weights {
                Some(weights) => weights.varies(nodes, element),
                None => false,
            })
        });
        chunks.collect()
    }

    /// Place of an element whose stiffness has a negative weight, and that weight.
    pub(crate) fn negative_stiffness(&self) -> Option<(usize, f64)> {
        let mut chunks = self.chunks.iter().enumerate();
        chunks.find_map(|(place, chunk)| {
            let (element, weight) = chunk.weights.as_ref()?.negative_stiffness()?;
            Some((place * chunk_length(self.kind) + element, weight))
        })
    }

    /// Places of its elements that are among those `of` the body, `first` being the number of its first one there.
    pub(crate) fn within(&self, of: &Range<usize>, first: usize) -> Range<usize> {
        let [start, end] = [of.start, of.end].map(|k| k.saturating_sub(first).min(self.len()));
        start..end
    }

    /// Volume (m³) and mean stress (Pa) of the elements at some places, in the block's order; weights do not enter: it is the stress
    /// of the model.
    pub(crate) fn stresses(
        &self,
        (dim, of): (usize, Range<usize>),
        u: &[f64],
        out: &mut Vec<(f64, Mat3)>,
    ) {
        by_nodes!(self.kind => self.stress((dim, of), u, out));
    }

    fn stress<const N: usize>(
        &self,
        (dim, of): (usize, Range<usize>),
        u: &[f64],
        out: &mut Vec<(f64, Mat3)>,
    ) {
        let length = chunk_length(self.kind);
        for place in of {
            let chunk = &self.chunks[place / length];
            let element = &chunk.connectivity[N * (place % length)..][..N];
            let (x, u_e) = chunk.gather::<N>(element, dim, u);
            out.push(match &self.physics {
                Physics::Bar(bar) => bar.stress(&x, &u_e),
                Physics::Continuum(law) => continuum::stress(law, &self.stiffness_points, &x, &u_e),
            });
        }
    }
}

/// Cells of a mesh kind by kind, those of one kind in their order: as [`Solid::cells`](crate::Solid::cells) has them.
pub fn by_kind(mesh: &Mesh, cells: &[ElementId]) -> Vec<ElementId> {
    let of_kind = |kind: Kind| {
        let all = cells.iter().copied();
        all.filter(move |&cell| mesh.kind(cell) == kind)
    };
    Kind::ALL.into_iter().flat_map(of_kind).collect()
}

/// The internal forces of one chunk, by whatever instruction set.
struct Sweep<'a> {
    block: &'a Block,
    chunk: &'a Chunk,
    dim: usize,
    u: &'a [f64],
    f: &'a mut [[f64; 3]],
}

impl WithSimd for Sweep<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> f64 {
        // two registers for each number: their chains of operations fill each other's waiting time
        match S::F64_LANES {
            1 => self.run::<1>(),
            8 => self.run::<WIDEST>(),
            _ => self.run::<8>(),
        }
    }
}

impl Sweep<'_> {
    #[inline(always)]
    fn run<const W: usize>(self) -> f64 {
        match self.chunk.weights_of_work() {
            None => self.kinds::<W>(Unweighted),
            Some(weights) => self.kinds::<W>(weights.at_points()),
        }
    }

    #[inline(always)]
    fn kinds<const W: usize>(self, w: impl Weight) -> f64 {
        let law = match &self.block.physics {
            Physics::Continuum(law) => law,
            Physics::Bar(bar) => {
                return match self.dim {
                    1 => self.batches::<W, 2, 1>(bar, w),
                    2 => self.batches::<W, 2, 2>(bar, w),
                    _ => self.batches::<W, 2, 3>(bar, w),
                };
            }
        };
        let points = &self.block.stiffness_points;
        match self.block.kind {
            Kind::Tri3 => self.batches::<W, 3, 2>(&Elastic::<3, 2, 1>::new(law, points), w),
            Kind::Tri6 => self.batches::<W, 6, 2>(&Elastic::<6, 2, 3>::new(law, points), w),
            Kind::Quad4 => self.batches::<W, 4, 2>(&Elastic::<4, 2, 2>::new(law, points), w),
            Kind::Tet4 => self.batches::<W, 4, 3>(&Elastic::<4, 3, 1>::new(law, points), w),
            Kind::Tet10 => self.batches::<W, 10, 3>(&Elastic::<10, 3, 4>::new(law, points), w),
            Kind::Wedge6 => self.batches::<W, 6, 3>(&Elastic::<6, 3, 3>::new(law, points), w),
            Kind::Hex8 => self.batches::<W, 8, 3>(&Elastic::<8, 3, 4>::new(law, points), w),
            kind => by_nodes!(kind => self.singly(law)),
        }
    }

    /// Takes the elements W at a time, and adds forces and energies in the order of the elements.
    #[inline(always)]
    fn batches<const W: usize, const N: usize, const D: usize>(
        self,
        kernel: &impl Kernel<N, D>,
        w: impl Weight,
    ) -> f64 {
        let mut energy = 0.0;
        for (place, batch) in self.chunk.connectivity.chunks(N * W).enumerate() {
            let (mut x, mut u) = ([[Lanes::ZERO; D]; N], [[Lanes::ZERO; D]; N]);
            self.chunk.lanes(batch, self.u, [&mut x, &mut u]);
            let mut f = [[Lanes::ZERO; D]; N];
            let energies = kernel.force::<W>(&x, &u, w.batch(place * W), &mut f);
            for (k, element) in batch.chunks_exact(N).enumerate() {
                energy += energies.0[k];
                for a in 0..N {
                    let sum = &mut self.f[element[a] as usize];
                    for i in 0..D {
                        sum[i] += f[a][i].0[k];
                    }
                }
            }
        }
        energy
    }

    /// Takes the elements one after the other.
    fn singly<const N: usize>(self, law: &Law) -> f64 {
        let points = &self.block.stiffness_points;
        let mut energy = 0.0;
        for (place, element) in self.chunk.connectivity.chunks_exact(N).enumerate() {
            let (x, u) = self.chunk.gather::<N>(element, self.dim, self.u);
            let weight = |q: usize| self.chunk.weight(place, q);
            let mut f = [[0.0; 3]; N];
            energy += single::force(law, points, weight, [&x, &u], &mut f);
            for (&node, f) in element.iter().zip(&f) {
                for i in 0..self.dim {
                    self.f[node as usize][i] += f[i];
                }
            }
        }
        energy
    }
}

#[cfg(test)]
mod tests {
    use carom_materials::Elastic;
    use pulp::Scalar;

    use carom_algebra::unknowns::Unknowns;

    use super::*;
    use crate::Kinematics;

    const MATERIAL: Elastic = Elastic {
        density: 1.0,
        young: 2.0,
        poisson: 0.3,
    };

    /// Elements that share no node: `count` reference cells, each moved, and their corners too.
    fn block(
        kind: Kind,
        kinematics: Kinematics,
        count: usize,
        weighted: bool,
    ) -> (Block, Vec<f64>) {
        let element = kind.table();
        let total = count * element.nodes;
        let x = (0..total).map(|node| {
            let wave = |i: usize| 0.1 * ((3 * node + i) as f64).sin();
            let corner = element.reference[node % element.nodes];
            [
                3.0 + corner[0] + wave(0),
                corner[1] + wave(1),
                corner[2] + wave(2),
            ]
        });
        let physics = match kinematics {
            Kinematics::Bar { area } => Physics::Bar(Bar {
                young: MATERIAL.young,
                area,
                density: MATERIAL.density,
            }),
            _ => Physics::Continuum(Law::new(kinematics, MATERIAL, element.dim)),
        };
        let elements: Vec<u32> = (0..total as u32).collect();
        let weights = weighted.then(|| CellWeights {
            inertia: vec![1.0; total],
            stiffness: (0..total).map(|a| (a as f64).sin().powi(2)).collect(),
        });
        let block = Block::new(
            (kind, element.stiffness_rule),
            physics,
            &Nodes {
                elements: &elements,
                x: &x.collect::<Vec<_>>(),
                unknowns: &Unknowns::translations(element.dim, total),
            },
            weights.as_ref(),
        );
        let u = (0..element.dim * total).map(|i| (i as f64).cos());
        (block, u.collect())
    }

    #[test]
    fn every_instruction_set_gives_the_same_forces_and_energy() {
        for (kind, kinematics) in [
            (Kind::Bar2, Kinematics::Bar { area: 0.3 }),
            (Kind::Tri3, Kinematics::PlaneStress { thickness: 0.2 }),
            (Kind::Quad4, Kinematics::Axisymmetric),
            (Kind::Tri6, Kinematics::Axisymmetric),
            (Kind::Tet4, Kinematics::Solid),
            (Kind::Tet10, Kinematics::Solid),
            (Kind::Wedge6, Kinematics::Solid),
            (Kind::Hex8, Kinematics::Solid),
        ] {
            let counts = [1, 7, 8, 9, 16, 17, 50].into_iter();
            for (count, weighted) in counts.flat_map(|n| [(n, false), (n, true)]) {
                let (block, u) = block(kind, kinematics, count, weighted);
                let dim = kind.table().dim;
                let chunk = &block.chunks[0];
                let (mut best, mut plain) = (vec![[0.0; 3]; chunk.nodes.len()], Vec::new());
                plain.clone_from(&best);
                let sweep = |f| Sweep {
                    block: &block,
                    chunk,
                    dim,
                    u: &u,
                    f,
                };
                let energy = Arch::new().dispatch(sweep(&mut best));
                let plain_energy = Scalar.vectorize(sweep(&mut plain));
                assert!((energy - plain_energy).abs() < 1e-13 * energy, "{kind:?}");
                let largest = plain.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
                for (a, b) in best.iter().flatten().zip(plain.iter().flatten()) {
                    assert!((a - b).abs() < 1e-13 * largest, "{kind:?} {count}: {a} {b}");
                }
            }
        }
    }
}
