//! Elements of one kind and one material, cut into chunks of a fixed number of elements.
//!
//! A chunk sums into its own node list, and the lists are added in chunk order: no atomics, and equal bits for any
//! number of threads.

use carom_algebra::tensor::Mat3;
use carom_elements::Kind;

use crate::bar::Bar;
use crate::continuum::{self, Law, Points};

/// Elements per chunk, whatever the number of threads.
const CHUNK: usize = 256;

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
    stiffness_points: Points,
    mass_points: Points,
    pub(crate) chunks: Vec<Chunk>,
}

/// A fixed number of neighbouring elements with their own node list.
#[derive(Debug)]
pub(crate) struct Chunk {
    /// System numbers of the nodes.
    pub(crate) nodes: Vec<u32>,
    /// Coordinates of the nodes in m.
    x: Vec<[f64; 3]>,
    /// Nodes of each element, as places in `nodes`.
    connectivity: Vec<u32>,
}

/// Buffers of the internal-force sweep: one list of nodal forces and one energy per chunk.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(crate) forces: Vec<Vec<[f64; 3]>>,
    pub(crate) energies: Vec<f64>,
}

impl Block {
    /// `elements`: system numbers of the nodes of each element, flat; `x`: coordinates by system number.
    pub(crate) fn new(kind: Kind, physics: Physics, elements: &[u32], x: &[[f64; 3]]) -> Block {
        let per = kind.table().nodes;
        let chunks = elements.chunks(CHUNK * per).map(|elements| {
            let mut nodes = elements.to_vec();
            nodes.sort_unstable();
            nodes.dedup();
            let place = |node: &u32| nodes.partition_point(|n| n < node) as u32;
            Chunk {
                connectivity: elements.iter().map(place).collect(),
                x: nodes.iter().map(|&node| x[node as usize]).collect(),
                nodes,
            }
        });
        Block {
            kind,
            physics,
            stiffness_points: Points::new(kind, kind.table().stiffness_rule),
            mass_points: Points::new(kind, kind.table().mass_rule),
            chunks: chunks.collect(),
        }
    }

    /// Internal forces of one chunk into `f` (N, one entry per chunk node) for the displacement `u` (m, system
    /// vector with `dim` entries per node); returns the strain energy (J).
    pub(crate) fn force(&self, chunk: &Chunk, dim: usize, u: &[f64], f: &mut [[f64; 3]]) -> f64 {
        f.fill([0.0; 3]);
        match self.kind {
            Kind::Point1 => 0.0,
            Kind::Bar2 => self.sweep::<2>(chunk, dim, u, f),
            Kind::Tri3 => self.sweep::<3>(chunk, dim, u, f),
            Kind::Quad4 | Kind::Tet4 => self.sweep::<4>(chunk, dim, u, f),
            Kind::Hex8 => self.sweep::<8>(chunk, dim, u, f),
        }
    }

    fn sweep<const N: usize>(
        &self,
        chunk: &Chunk,
        dim: usize,
        u: &[f64],
        f: &mut [[f64; 3]],
    ) -> f64 {
        let mut energy = 0.0;
        for element in chunk.connectivity.chunks_exact(N) {
            let (x, u_e) = chunk.gather::<N>(element, dim, u);
            let mut f_e = [[0.0; 3]; N];
            energy += match &self.physics {
                Physics::Bar(bar) => bar.force(&x, &u_e, &mut f_e),
                Physics::Continuum(law) => {
                    continuum::force(law, &self.stiffness_points, &x, &u_e, &mut f_e)
                }
            };
            for (&node, f_a) in element.iter().zip(&f_e) {
                let sum = &mut f[node as usize];
                *sum = [sum[0] + f_a[0], sum[1] + f_a[1], sum[2] + f_a[2]];
            }
        }
        energy
    }

    /// Calls `visit(nodes, stiffness, mass)` for each element: system numbers of its nodes, stiffness (N/m, row-major
    /// over node-major unknowns) and scalar consistent mass (kg, row-major over nodes).
    pub(crate) fn matrices(&self, dim: usize, visit: &mut dyn FnMut(&[u32], &[f64], &[f64])) {
        match self.kind {
            Kind::Point1 => {}
            Kind::Bar2 => self.visit::<2>(dim, visit),
            Kind::Tri3 => self.visit::<3>(dim, visit),
            Kind::Quad4 | Kind::Tet4 => self.visit::<4>(dim, visit),
            Kind::Hex8 => self.visit::<8>(dim, visit),
        }
    }

    fn visit<const N: usize>(&self, dim: usize, visit: &mut dyn FnMut(&[u32], &[f64], &[f64])) {
        let mut k = vec![0.0; (dim * N).pow(2)];
        let mut m = vec![0.0; N * N];
        for chunk in &self.chunks {
            for element in chunk.connectivity.chunks_exact(N) {
                let x = element_nodes::<N, _>(element, |node| chunk.x[node]);
                match &self.physics {
                    Physics::Bar(bar) => {
                        bar.stiffness(dim, &x, &mut k);
                        bar.mass(&x, &mut m);
                    }
                    Physics::Continuum(law) => {
                        continuum::stiffness(law, &self.stiffness_points, &x, &mut k);
                        continuum::mass(law, &self.mass_points, &x, &mut m);
                    }
                }
                visit(
                    &element_nodes::<N, _>(element, |node| chunk.nodes[node]),
                    &k,
                    &m,
                );
            }
        }
    }

    /// Volume (m³) and mean stress (Pa) of each element, in the block's order.
    pub(crate) fn stresses(&self, dim: usize, u: &[f64], out: &mut Vec<(f64, Mat3)>) {
        match self.kind {
            Kind::Point1 => {}
            Kind::Bar2 => self.stress::<2>(dim, u, out),
            Kind::Tri3 => self.stress::<3>(dim, u, out),
            Kind::Quad4 | Kind::Tet4 => self.stress::<4>(dim, u, out),
            Kind::Hex8 => self.stress::<8>(dim, u, out),
        }
    }

    fn stress<const N: usize>(&self, dim: usize, u: &[f64], out: &mut Vec<(f64, Mat3)>) {
        for chunk in &self.chunks {
            for element in chunk.connectivity.chunks_exact(N) {
                let (x, u_e) = chunk.gather::<N>(element, dim, u);
                out.push(match &self.physics {
                    Physics::Bar(bar) => bar.stress(&x, &u_e),
                    Physics::Continuum(law) => {
                        continuum::stress(law, &self.stiffness_points, &x, &u_e)
                    }
                });
            }
        }
    }
}

impl Chunk {
    fn gather<const N: usize>(
        &self,
        element: &[u32],
        dim: usize,
        u: &[f64],
    ) -> ([[f64; 3]; N], [[f64; 3]; N]) {
        let x = element_nodes::<N, _>(element, |node| self.x[node]);
        let u = element_nodes::<N, _>(element, |node| {
            let first = dim * self.nodes[node] as usize;
            let mut u_a = [0.0; 3];
            u_a[..dim].copy_from_slice(&u[first..first + dim]);
            u_a
        });
        (x, u)
    }
}

#[inline]
fn element_nodes<const N: usize, T>(element: &[u32], of: impl Fn(usize) -> T) -> [T; N] {
    std::array::from_fn(|a| of(element[a] as usize))
}
