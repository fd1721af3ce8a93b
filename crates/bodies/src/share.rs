//! Some of the elements of a solid, as one of several processes computes them.

use std::ops::Range;

use carom_algebra::unknowns::Unknowns;
use carom_mesh::ElementId;

use crate::block::{Block, chunk_length};
use crate::body::Body;
use crate::chunk::Chunk;
use crate::finite::{Looks, Placement, Seen, Stored};
use crate::gather::Gather;
use crate::layers::Layers;
use crate::solid::Solid;
use crate::weights::ChunkWeights;
use crate::{Error, Scratch};

/// Some of the elements of a solid, with the places of what they keep among those of all.
#[derive(Debug)]
pub struct Share {
    solid: Solid,
    /// Place of each element among those of the whole.
    places: Vec<u32>,
    /// Where the histories of elements that follow each other are in that of the whole.
    histories: Vec<Range<usize>>,
    /// Histories of these elements at the start and at the end of a step.
    old: Vec<f64>,
    new: Vec<f64>,
    scratch: Scratch,
}

/// Why elements of a solid cannot be shared out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotShared {
    /// Its internal work has weights, as in an overlap.
    Weights,
    /// Its bars flow.
    Flowing,
    /// Its elements are deleted where they flow too far.
    Deletion,
}

impl NotShared {
    /// In words.
    pub fn text(self) -> &'static str {
        match self {
            NotShared::Weights => "weights of its internal work",
            NotShared::Flowing => "bars of a metal that flows",
            NotShared::Deletion => "elements that are deleted",
        }
    }
}

impl Solid {
    /// Whether its elements can be shared out, and if not, why.
    pub fn not_shared(&self) -> Option<NotShared> {
        let chunks = || self.blocks.iter().flat_map(|block| &block.chunks);
        if self.flowing.is_some() {
            return Some(NotShared::Flowing);
        }
        if self.has_deletion() {
            return Some(NotShared::Deletion);
        }
        let weighted = chunks().any(|chunk| chunk.weights_of_work().is_some());
        weighted.then_some(NotShared::Weights)
    }

    /// The elements at these places in [`Solid::cells`], ascending. Weights of their work are left out: what has any is not shared
    /// ([`Solid::not_shared`]).
    pub fn share(&self, places: Vec<u32>) -> Share {
        let (mut blocks, mut histories) = (Vec::new(), Vec::<Range<usize>>::new());
        let (mut first, mut kept) = (0, 0);
        for block in &self.blocks {
            let own = places.partition_point(|&place| (place as usize) < first)
                ..places.partition_point(|&place| (place as usize) < first + block.len());
            let own = places[own].iter().map(|&place| place as usize - first);
            let own: Vec<usize> = own.collect();
            let of_element = self.history_of_element(block);
            for place in own.iter().filter(|_| of_element > 0) {
                let range = kept + place * of_element..kept + (place + 1) * of_element;
                match histories.last_mut() {
                    Some(last) if last.end == range.start => last.end = range.end,
                    _ => histories.push(range),
                }
            }
            first += block.len();
            kept += of_element * block.len();
            if !own.is_empty() {
                blocks.push(block.some(&own));
            }
        }
        let length = histories.iter().map(ExactSizeIterator::len).sum();
        let cells = places.iter().map(|&place| self.cells()[place as usize]);
        let cells: Vec<ElementId> = cells.collect();
        let solid = self.with_blocks(cells, blocks);
        Share {
            solid,
            places,
            histories,
            old: vec![0.0; length],
            new: vec![0.0; length],
            scratch: Scratch::default(),
        }
    }

    /// The elements at these places as a body of a system that has their nodes alone. `number`: of the nodes there; `unknowns`: of that system.
    pub fn part(
        &self,
        places: Vec<u32>,
        number: impl Fn(u32) -> u32,
        unknowns: &Unknowns,
    ) -> Solid {
        let mut part = self.share(places).solid;
        for chunk in part.blocks.iter_mut().flat_map(|block| &mut block.chunks) {
            for (node, first) in chunk.nodes.iter_mut().zip(&mut chunk.first) {
                *node = number(*node);
                *first = unknowns.first(*node) as u32;
            }
        }
        part.gather = Gather::new(part.dim, &part.blocks);
        part
    }

    /// Nodes of the kind of element that has most of them.
    pub fn most_nodes(&self) -> usize {
        self.most_nodes
    }

    /// Tells a part of a body what is known of the whole: [`Solid::smallest_size`] (m), and [`Solid::most_nodes`].
    pub fn know_whole(&mut self, (smallest, most_nodes): (f64, usize)) {
        (self.smallest, self.most_nodes) = (smallest, most_nodes);
    }

    /// Numbers that each element keeps from one step to the next, in the order of [`Solid::cells`], which is that of the history.
    pub fn kept_of_elements(&self) -> impl Iterator<Item = usize> + '_ {
        let blocks = self.blocks.iter();
        blocks.flat_map(|block| std::iter::repeat_n(self.history_of_element(block), block.len()))
    }

    /// Numbers that an element of a block keeps.
    fn history_of_element(&self, block: &Block) -> usize {
        let finite = self.finite.as_ref();
        finite.map_or(0, |finite| finite.kept_of_element(block))
    }
}

impl Block {
    /// Some of its elements, by their places, with weights of their inertia, as mass scaling gives them, and none of their work.
    fn some(&self, places: &[usize]) -> Block {
        let (per, length) = (self.kind.table().nodes, chunk_length(self.kind));
        let chunk = |own: &[usize]| {
            let mut nodes = Vec::with_capacity(per * own.len());
            for &place in own {
                let chunk = &self.chunks[place / length];
                let element = &chunk.connectivity[per * (place % length)..][..per];
                let known = element.iter().map(|&node| node as usize);
                nodes.extend(known.map(|k| (chunk.nodes[k], chunk.first[k], place / length, k)));
            }
            let mut all = nodes.clone();
            all.sort_unstable();
            all.dedup_by_key(|node| node.0);
            let at = |node: &(u32, u32, usize, usize)| {
                all.partition_point(|other| other.0 < node.0) as u32
            };
            let viscosity = own.iter().filter_map(|&place| {
                let chunk = &self.chunks[place / length];
                chunk.viscosity.get(place % length).copied()
            });
            let inertia = own.iter().filter_map(|&place| {
                let weights = self.chunks[place / length].weights.as_ref();
                weights.map(|weights| weights.inertia_of(per, place % length))
            });
            let inertia = inertia.collect::<Vec<_>>().concat();
            let points = &self.stiffness_points;
            let weights =
                (!inertia.is_empty()).then(|| ChunkWeights::of_inertia(&inertia, per, points));
            Chunk {
                nodes: all.iter().map(|node| node.0).collect(),
                first: all.iter().map(|node| node.1).collect(),
                x: all
                    .iter()
                    .map(|node| self.chunks[node.2].x[node.3])
                    .collect(),
                connectivity: nodes.iter().map(at).collect(),
                weights,
                viscosity: viscosity.collect(),
            }
        };
        Block {
            kind: self.kind,
            physics: self.physics,
            stiffness_points: self.stiffness_points.clone(),
            mass_points: self.mass_points.clone(),
            chunks: places.chunks(length).map(chunk).collect(),
        }
    }
}

impl Share {
    /// The elements.
    pub fn solid(&self) -> &Solid {
        &self.solid
    }

    /// Place of each element among those of the whole.
    pub fn places(&self) -> &[u32] {
        &self.places
    }

    /// Where the histories of these elements are in that of the whole body.
    pub fn histories(&self) -> &[Range<usize>] {
        &self.histories
    }

    /// The elements as a body, and where their histories are in that of the whole body.
    pub fn into_body(self) -> (Body, Vec<Range<usize>>) {
        (Body::Solid(self.solid), self.histories)
    }

    /// As [`Solid::force`], of these elements; `at.old` and `new` are the histories of the whole body.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn force(
        &mut self,
        at: &Placement,
        new: &mut [f64],
        f: &mut [f64],
    ) -> Result<Stored, Error> {
        if self.places.is_empty() {
            return Ok(Stored::default());
        }
        self.take_histories(at.old);
        let own = Placement {
            old: &self.old,
            ..*at
        };
        let stored = self
            .solid
            .force(&own, &mut self.new, &mut self.scratch, f)?;
        for (range, own) in parts(&self.histories) {
            new[range].copy_from_slice(&self.new[own]);
        }
        Ok(stored)
    }

    /// As [`Solid::look`], of these elements; `at.old` is the history of the whole body.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn look(&mut self, at: &Placement, looks: &mut Looks, worth: f64) -> Result<Seen, Error> {
        if self.places.is_empty() {
            return Ok(Seen::default());
        }
        self.take_histories(at.old);
        let own = Placement {
            old: &self.old,
            ..*at
        };
        self.solid.look(&own, looks, worth)
    }

    /// Takes the histories of these elements out of that of the whole body.
    fn take_histories(&mut self, whole: &[f64]) {
        for (range, own) in parts(&self.histories) {
            self.old[own].copy_from_slice(&whole[range]);
        }
    }
}

/// Parts of the history of a whole body, each with its place in that of some elements.
fn parts(histories: &[Range<usize>]) -> impl Iterator<Item = (Range<usize>, Range<usize>)> + '_ {
    let mut first = 0;
    histories.iter().map(move |range| {
        let own = first..first + range.len();
        first = own.end;
        (range.clone(), own)
    })
}

impl Solid {
    /// The same with some of the elements.
    fn with_blocks(&self, cells: Vec<ElementId>, blocks: Vec<Block>) -> Solid {
        Solid {
            name: self.name.clone(),
            kinematics: self.kinematics,
            material: self.material,
            gather: Gather::new(self.dim, &blocks),
            cells,
            blocks,
            finite: self.finite.clone(),
            flowing: None,
            dim: self.dim,
            smallest: self.smallest,
            most_nodes: self.most_nodes,
            viscosity: self.viscosity,
            added_mass: 0.0,
            // ranks take no static stage, and what it tightens
            layers: Layers::default(),
        }
    }
}
