//! Sums of the rows of stencils that share nodes.

use carom_algebra::tensor::Vec3;

use super::stencil::{Stencil, tangent_vectors};
use crate::{Places, Rows};

/// The sum being made: blocks of the rows N and T of each node, in the order in which nodes appear.
#[derive(Clone, Debug, Default)]
pub struct Merge {
    gap: f64,
    normal: Vec3,
    /// Resultants on the secondary side of unit forces along the normal and the tangents.
    resultants: [Vec3; 3],
    /// Rates by the motion of an obstacle, of the gap and along the tangents, m/s.
    rates: [f64; 3],
    blocks: Vec<(u32, [Vec3; 3])>,
    /// Moments of unit forces along the tangents about the nodes of the first of `blocks`, in m; of the others they are zero.
    moments: Vec<[Vec3; 2]>,
    /// Place of each node in `blocks`.
    places: Vec<u32>,
}

impl Merge {
    /// Begins a sum.
    pub fn clear(&mut self) {
        for (node, _) in self.blocks.drain(..) {
            self.places[node as usize] = u32::MAX;
        }
        self.moments.clear();
        self.gap = 0.0;
        self.normal = Vec3::zeros();
        self.resultants = [Vec3::zeros(); 3];
        self.rates = [0.0; 3];
    }

    /// Adds a stencil times a weight.
    pub fn add(&mut self, stencil: &Stencil, weight: f64, dim: usize) {
        let (gap, normal) = stencil.gap();
        self.gap += weight * gap;
        self.normal += Vec3::from(normal) * weight;
        let frame = tangent_vectors(&normal, dim);
        self.rates[0] += weight * stencil.rate(&normal);
        for (rate, tangent) in self.rates[1..].iter_mut().zip(&frame) {
            *rate += weight * stencil.slide(tangent);
        }
        let vectors = [normal, frame[0], frame[1]].map(|v| Vec3::from(v) * weight);
        let turning = stencil.turning();
        self.resultants[0] += stencil.resultant(turning.as_ref()) * weight;
        for (sum, tangent) in self.resultants[1..].iter_mut().zip(&vectors[1..]) {
            *sum += tangent;
        }
        for (i, (node, c)) in stencil.relative().enumerate() {
            let at = self.block(node);
            let block = &mut self.blocks[at].1;
            for (block, vector) in block.iter_mut().zip(&vectors) {
                *block += vector * c;
            }
            if let Some(turning) = &turning {
                block[0] += turning[i] * weight;
            }
            let reach = stencil.reach(i);
            if reach != 0.0 {
                let zero = [Vec3::zeros(); 2];
                self.moments.resize(self.moments.len().max(at + 1), zero);
                let arm = Vec3::from(normal) * (c * reach);
                for (moment, tangent) in self.moments[at].iter_mut().zip(&vectors[1..]) {
                    *moment += arm.cross(tangent);
                }
            }
        }
    }

    /// Place of a node in the blocks.
    fn block(&mut self, node: u32) -> usize {
        if self.places.len() <= node as usize {
            self.places.resize(node as usize + 1, u32::MAX);
        }
        let place = &mut self.places[node as usize];
        if *place == u32::MAX {
            *place = self.blocks.len() as u32;
            self.blocks.push((node, [Vec3::zeros(); 3]));
        }
        *place as usize
    }

    /// Makes a point of the rows, or the one after the last, that of the sum; its normal is the mean one, and the directions of the tangents are square to it.
    pub fn place(&self, places: &Places, at: usize, rows: &mut Rows, tangents: &mut [Rows; 2]) {
        let dim = places.dim();
        let length = self.normal.norm();
        let normal: [f64; 3] = match length > 0.0 {
            true => (self.normal / length).into(),
            false => [0.0; 3],
        };
        rows.begin(at, self.gap, normal);
        rows.set_resultant(self.resultants[0].into());
        rows.set_rate(self.rates[0]);
        let frame = tangent_vectors(&normal, dim);
        for (k, rows) in tangents[..dim - 1].iter_mut().enumerate() {
            rows.begin(at, 0.0, frame[k]);
            rows.set_resultant(self.resultants[k + 1].into());
            rows.set_rate(self.rates[k + 1]);
        }
        for (node, blocks) in &self.blocks {
            let alone = places.unknowns.carrier(*node).is_none();
            let own = places.unknowns.translations_of(*node);
            let add = |rows: &mut Rows, direction: &Vec3| match alone {
                true => rows.add_translations(own.start as u32, &direction.as_slice()[..own.len()]),
                false => rows.add_node(places, *node, &(*direction).into()),
            };
            add(rows, &blocks[0]);
            for (k, rows) in tangents[..dim - 1].iter_mut().enumerate() {
                add(rows, &blocks[k + 1]);
            }
        }
        for ((node, _), moments) in self.blocks.iter().zip(&self.moments) {
            for (rows, moment) in tangents[..dim - 1].iter_mut().zip(moments) {
                rows.add_moment(places, *node, &(*moment).into());
            }
        }
    }
}
