//! Solids and bars at small strain: the mean strain of an element is `H = Σ_a u_a ⊗ g_a` with the mean gradients g_a of its shape functions, in axisymmetry with the
//! hoop strain `Σ_a h_a u_a`.

use carom_algebra::tensor::Mat3;
use rayon::prelude::*;

use super::state::{larger, von_mises};
use crate::Solid;
use crate::bar::Bar;
use crate::block::{Block, Physics, by_nodes, call_by_nodes};
use crate::chunk::element_nodes;
use crate::continuum::{self, Law};

/// Elements that a thread takes at least: waking it takes as long as some hundred.
const SHARE: usize = 1024;

/// Mean gradients of the elements of a solid.
#[derive(Debug)]
pub(super) struct MeanStrains(Vec<OfBlock>);

/// Of elements of one kind.
#[derive(Debug)]
struct OfBlock {
    /// Nodes of an element.
    nodes: usize,
    dim: usize,
    law: Stress,
    /// First unknown of each node of each element.
    first: Vec<u32>,
    /// g of each node of each element, 1/m.
    gradients: Vec<[f64; 3]>,
    /// h of the same, 1/m; empty but in axisymmetry.
    hoops: Vec<f64>,
}

/// Stress of a mean strain.
#[derive(Debug)]
enum Stress {
    /// E, Pa: of a bar, whose gradients are along its axis.
    Bar(f64),
    Continuum(Law),
}

impl MeanStrains {
    /// Whether the stress of a solid is linear in its displacement.
    pub(super) fn serve(solid: &Solid) -> bool {
        // what bolts keep is beside the displacement
        let bolted = !solid.layers.bolts().is_empty();
        solid.finite.is_none() && solid.flowing.is_none() && !bolted
    }

    /// None of solids that they do not serve.
    pub(super) fn new(solid: &Solid) -> Option<MeanStrains> {
        let of = |block: &Block| block.mean_strains(solid.dim);
        MeanStrains::serve(solid).then(|| MeanStrains(solid.blocks.iter().map(of).collect()))
    }

    /// See [`PeakStress::above`](super::PeakStress::above).
    pub(super) fn above(&self, floor: f64, u: &[f64]) -> Option<(f64, u32)> {
        let (mut found, mut begin) = (None, 0);
        for block in &self.0 {
            let count = block.first.len() / block.nodes;
            let values = (0..count).into_par_iter().with_min_len(SHARE);
            let values =
                values.map(|element| (block.von_mises(element, u), begin + element as u32));
            let most = values
                .filter(|(value, _)| *value > floor)
                .reduce_with(larger);
            found = found.into_iter().chain(most).reduce(larger);
            begin += count as u32;
        }
        found
    }
}

impl OfBlock {
    fn von_mises(&self, element: usize, u: &[f64]) -> f64 {
        let own = self.nodes * element..self.nodes * (element + 1);
        let moved = |first: u32| -> [f64; 3] {
            let u = &u[first as usize..][..self.dim];
            match *u {
                [x] => [x, 0.0, 0.0],
                [x, y] => [x, y, 0.0],
                _ => [u[0], u[1], u[2]],
            }
        };
        let mut h = [[0.0; 3]; 3];
        for (first, gradient) in self.first[own.clone()]
            .iter()
            .zip(&self.gradients[own.clone()])
        {
            let u = moved(*first);
            for (h, u) in h.iter_mut().zip(u) {
                for (h, g) in h.iter_mut().zip(gradient) {
                    *h += u * g;
                }
            }
        }
        if let Some(hoops) = self.hoops.get(own.clone()) {
            let nodes = self.first[own].iter().zip(hoops);
            h[2][2] += nodes
                .map(|(first, hoop)| hoop * u[*first as usize])
                .sum::<f64>();
        }
        match &self.law {
            Stress::Bar(young) => young * (h[0][0] + h[1][1] + h[2][2]).abs(),
            Stress::Continuum(law) => {
                let strain = Mat3::from_fn(|i, j| 0.5 * (h[i][j] + h[j][i]));
                von_mises(&law.stress(&strain))
            }
        }
    }
}

impl Block {
    fn mean_strains(&self, dim: usize) -> OfBlock {
        let mut of = OfBlock {
            nodes: self.kind.table().nodes,
            dim,
            law: match &self.physics {
                Physics::Bar(bar) => Stress::Bar(bar.young),
                Physics::Continuum(law) => Stress::Continuum(*law),
            },
            first: Vec::new(),
            gradients: Vec::new(),
            hoops: Vec::new(),
        };
        by_nodes!(self.kind => self.gradients_of(&mut of));
        of
    }

    fn gradients_of<const N: usize>(&self, of: &mut OfBlock) {
        for chunk in &self.chunks {
            let firsts = chunk.connectivity.iter();
            of.first
                .extend(firsts.map(|node| chunk.first[*node as usize]));
            for element in chunk.connectivity.chunks_exact(N) {
                let x = element_nodes::<N, _>(element, |node| chunk.x[node]);
                match &self.physics {
                    Physics::Bar(_) => {
                        let (axis, length) = Bar::axis(&x);
                        let of_end = |sign: f64| axis.map(|axis| sign * axis / length);
                        of.gradients.extend([of_end(-1.0), of_end(1.0)]);
                    }
                    Physics::Continuum(law) => {
                        let (gradients, hoops) =
                            continuum::mean_gradients(law, &self.stiffness_points, &x);
                        of.gradients.extend(gradients);
                        if law.axisymmetric {
                            of.hoops.extend(hoops);
                        }
                    }
                }
            }
        }
    }
}
