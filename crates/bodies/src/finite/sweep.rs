//! Sweeps over all elements of a body at finite strain.
//!
//! Chunks are computed in parallel, each into its own list, and added in their order: equal bits for any number of
//! threads.

use std::ops::Range;

use carom_algebra::csr::Csr;
use carom_algebra::tensor::Mat3;
use carom_elements::MAX_NODES;
use carom_materials::Want;
use pulp::Arch;
use rayon::prelude::*;

use super::body::{Failed, Finite, Outcome};
use super::cell::{Element, MAX_UNKNOWNS, Shape};
use super::element::{Fault, Local};
use super::kernel;
use super::tangents::Tangents;
use super::{Placement, Stored};
use crate::block::Block;
use crate::chunk::Chunk;
use crate::scratch::Scratch;

/// Entries of element tangents that are held at a time.
const HELD: usize = 1 << 19;

/// Elements whose tangents one thread computes at a time; chunks have a multiple of it, and it is one of all numbers of lanes.
const PIECE: usize = 32;

impl Finite {
    /// Numbers that the points of an element keep.
    pub(crate) fn kept_of_element(&self, block: &Block) -> usize {
        self.kept * self.shape.points(block)
    }

    /// Numbers that all points keep.
    pub(super) fn history_len(&self, blocks: &[Block]) -> usize {
        let blocks = blocks.iter();
        blocks
            .map(|block| block.len() * self.kept_of_element(block))
            .sum()
    }

    pub(super) fn start_history(&self, out: &mut [f64]) {
        let Some(law) = self.law.finite().filter(|_| self.kept > 0) else {
            return;
        };
        for point in out.chunks_exact_mut(self.kept) {
            let (of_law, rest) = point.split_at_mut(self.kept_by_law);
            law.start(of_law);
            rest.fill(0.0);
        }
    }

    /// Leaves all forces in the lists of the chunks.
    pub(super) fn force(
        &self,
        blocks: &[Block],
        at: &Placement,
        mut new: &mut [f64],
        scratch: &mut Scratch,
    ) -> Result<Stored, Failed> {
        scratch.prepare(blocks);
        let (mut stored, mut first, mut kept, mut chunk) = (Stored::default(), 0, 0, 0);
        for block in blocks {
            let length = block.len() * self.kept_of_element(block);
            let old = &at.old[kept..kept + length];
            let (own, rest) = std::mem::take(&mut new).split_at_mut(length);
            (new, kept) = (rest, kept + length);
            let chunks = chunk..chunk + block.chunks.len();
            chunk = chunks.end;
            let lists = &mut scratch.forces[chunks.clone()];
            let outcomes = &mut scratch.outcomes[chunks];
            self.sweep(
                block,
                &Placement { old, ..*at },
                own,
                (lists, &mut *outcomes),
            );
            for (chunk, outcome) in block.chunks.iter().zip(outcomes) {
                if let Some((place, fault)) = outcome.fault.take() {
                    return Err((first + place, fault));
                }
                stored.include(&outcome.stored);
                first += chunk.len(block.kind.table().nodes);
            }
        }
        Ok(stored)
    }

    /// Forces of the elements of one kind; `at.old` and `new` are theirs.
    fn sweep(
        &self,
        block: &Block,
        at: &Placement,
        new: &mut [f64],
        (lists, outcomes): (&mut [Vec<[f64; 3]>], &mut [Outcome]),
    ) {
        let kept = block.chunk_length() * self.kept_of_element(block);
        let work = |place: usize, new: &mut [f64], f: &mut [[f64; 3]], out: &mut Outcome| {
            let old = match kept {
                0 => at.old,
                _ => &at.old[place * kept..][..new.len()],
            };
            f.fill([0.0; 3]);
            let chunk = &block.chunks[place];
            *out = self.chunk((block, chunk), &Placement { old, ..*at }, new, f);
        };
        if outcomes.len() == 1 {
            // waking a thread takes as long as the work
            return work(0, new, &mut lists[0], &mut outcomes[0]);
        }
        let pieces = lists.par_iter_mut().zip(outcomes).enumerate();
        if kept == 0 {
            pieces.for_each(|(place, (f, out))| work(place, &mut [], f, out));
        } else {
            let histories = new.par_chunks_mut(kept);
            pieces
                .zip(histories)
                .for_each(|((place, (f, out)), new)| work(place, new, f, out));
        }
    }

    /// Forces of the elements of a chunk, on its nodes; `at.old` and `new` are theirs.
    fn chunk(
        &self,
        (block, chunk): (&Block, &Chunk),
        at: &Placement,
        new: &mut [f64],
        f: &mut [[f64; 3]],
    ) -> Outcome {
        if kernel::takes(block.kind) {
            return Arch::new().dispatch(kernel::Sweep {
                finite: self,
                block,
                chunk,
                at,
                new,
                f,
            });
        }
        self.singly((block, chunk), at, new, f)
    }

    /// Takes the elements of a chunk one after the other.
    pub(super) fn singly(
        &self,
        (block, chunk): (&Block, &Chunk),
        at: &Placement,
        new: &mut [f64],
        f: &mut [[f64; 3]],
    ) -> Outcome {
        let (mut out, mut room) = (Outcome::default(), Element::room());
        let (nodes, dim) = (block.kind.table().nodes, self.shape.dim());
        let kept = self.kept_of_element(block);
        for (place, element) in chunk.connectivity.chunks_exact(nodes).enumerate() {
            room.set(&self.shape, block, chunk, place);
            let new = &mut new[kept * place..kept * (place + 1)];
            let mut f_e = [0.0; MAX_UNKNOWNS];
            let f_e = &mut f_e[..room.unknowns()];
            let old = kept * place..kept * (place + 1);
            let force = self.at_element(&room, at, old, |local| room.force(local, new, f_e));
            match force {
                Ok(stored) => out.stored.include(&stored),
                Err(fault) => {
                    out.fault = Some((place, fault));
                    return out;
                }
            }
            for (&node, f_a) in element.iter().zip(f_e.chunks_exact(dim)) {
                for (f, f_a) in f[node as usize].iter_mut().zip(f_a) {
                    *f += f_a;
                }
            }
        }
        out
    }

    /// Calls `then` with an element where it is. `kept`: its place in `at.old`.
    pub(super) fn at_element<T>(
        &self,
        element: &Element,
        at: &Placement,
        kept: std::ops::Range<usize>,
        then: impl FnOnce(&Local) -> Result<T, Fault>,
    ) -> Result<T, Fault> {
        let n = element.unknowns();
        let mut u = element.gather(at.u);
        if self.is_deleted(&at.old[kept.clone()]) {
            u = [0.0; MAX_UNKNOWNS];
        }
        let from = at.from.map(|from| element.gather(from));
        let Some(law) = self.law.finite() else {
            return Err(Fault::NoBetween);
        };
        then(&Local {
            law,
            u: &u[..n],
            from: from.as_ref().map(|from| &from[..n]),
            dt: at.dt,
            old: &at.old[kept],
            of_law: self.kept_by_law,
            viscosity: element.viscosity,
        })
    }

    /// Adds `factor` times all tangents to a matrix over all unknowns.
    pub(super) fn add_tangent(
        &self,
        blocks: &[Block],
        at: &Placement,
        factor: f64,
        matrix: &mut Csr,
    ) -> Result<(), Failed> {
        let (mut first, mut before) = (0, 0);
        let mut tangents = Vec::new();
        let dim = self.shape.dim();
        for block in blocks {
            let entries = (dim * block.kind.table().nodes).pow(2);
            let held = (HELD / (entries * PIECE)).max(1) * PIECE;
            let kept = self.kept_of_element(block);
            let old = &at.old[before..before + block.len() * kept];
            let at = Placement { old, ..*at };
            for begin in (0..block.len()).step_by(held) {
                let count = held.min(block.len() - begin);
                tangents.resize(count * entries, 0.0);
                self.tangents(block, &at, (begin, &mut tangents))
                    .map_err(|(place, fault)| (first + place, fault))?;
                for (place, k) in tangents.chunks_exact(entries).enumerate() {
                    let (first, nodes) = block.first(begin + place);
                    matrix.add_nodes(&first[..nodes], dim, (factor, k));
                }
            }
            first += block.len();
            before += block.len() * kept;
        }
        Ok(())
    }

    /// Writes the tangents of as many elements of a block as there is room for, from one of them on, a multiple of [`PIECE`];
    /// `at.old` is that of the block.
    fn tangents(
        &self,
        block: &Block,
        at: &Placement,
        (begin, out): (usize, &mut [f64]),
    ) -> Result<(), Failed> {
        let entries = (self.shape.dim() * block.kind.table().nodes).pow(2);
        let several = self.takes_tangents(block);
        let work = |(place, out): (usize, &mut [f64])| {
            let first = begin + place * PIECE;
            if !several {
                return self.tangents_singly(block, at, (first, out));
            }
            let (chunk, within) = (first / block.chunk_length(), first % block.chunk_length());
            let tangents = Tangents {
                finite: self,
                block,
                chunk: &block.chunks[chunk],
                at,
                first: within,
                out,
            };
            let done = Arch::new().dispatch(tangents);
            done.map_err(|(place, fault)| (first - within + place, fault))
        };
        if out.len() <= PIECE * entries {
            // waking a thread takes as long as the work
            return work((0, out));
        }
        let pieces = out.par_chunks_mut(PIECE * entries).enumerate();
        let done: Vec<_> = pieces.map(work).collect();
        done.into_iter().collect()
    }

    /// The same of one element after the other.
    pub(super) fn tangents_singly(
        &self,
        block: &Block,
        at: &Placement,
        (begin, out): (usize, &mut [f64]),
    ) -> Result<(), Failed> {
        let kept = self.kept_of_element(block);
        let entries = (self.shape.dim() * block.kind.table().nodes).pow(2);
        let (mut element, mut new) = (Element::room(), vec![0.0; kept]);
        for (place, k) in out.chunks_exact_mut(entries).enumerate() {
            let place = begin + place;
            block.set(&mut element, &self.shape, place);
            let old = kept * place..kept * (place + 1);
            self.at_element(&element, at, old, |local| {
                element.tangent((local, Want::Tangent), &mut new, k)
            })
            .map_err(|fault| (place, fault))?;
        }
        Ok(())
    }

    /// Current volume (m³) and mean Cauchy stress (Pa) of the elements `of`; no number where the law gives none.
    pub(crate) fn stresses(
        &self,
        (blocks, of): (&[Block], Range<usize>),
        u: &[f64],
        history: &[f64],
    ) -> Vec<(f64, Mat3)> {
        let (mut out, mut first, mut kept) = (Vec::new(), 0, 0);
        let at = Placement {
            u,
            v: &[],
            from: None,
            frames: &[],
            dt: 0.0,
            old: history,
        };
        for block in blocks {
            let own = self.kept_of_element(block);
            let room = || (Element::room(), vec![0.0; own]);
            let asked = block.within(&of, first).into_par_iter();
            out.par_extend(asked.map_init(room, |(element, new), place| {
                block.set(element, &self.shape, place);
                let old = kept + own * place..kept + own * (place + 1);
                let stress = self.at_element(element, &at, old, |local| element.cauchy(local, new));
                stress.unwrap_or((f64::NAN, Mat3::repeat(f64::NAN)))
            }));
            first += block.len();
            kept += own * block.len();
        }
        out
    }

    /// Mean equivalent plastic strain of each element, by volume; none of a law without.
    pub(crate) fn plastic_strains(&self, blocks: &[Block], history: &[f64]) -> Option<Vec<f64>> {
        self.law.plastic_strain(history.get(..self.kept_by_law)?)?;
        let (mut out, mut points) = (Vec::new(), history.chunks_exact(self.kept));
        let mut room = Element::room();
        for block in blocks {
            for place in 0..block.len() {
                block.set(&mut room, &self.shape, place);
                let (mut volume, mut sum) = (0.0, 0.0);
                for (point, kept) in points.by_ref().take(room.points).enumerate() {
                    volume += room.volume(point);
                    let kept = &kept[..self.kept_by_law];
                    sum += room.volume(point) * self.law.plastic_strain(kept)?;
                }
                out.push(sum / volume);
            }
        }
        Some(out)
    }
}

impl Block {
    /// First unknowns of the nodes of the element at this place, and their number.
    fn first(&self, place: usize) -> ([u32; MAX_NODES], usize) {
        let (chunk, place) = (place / self.chunk_length(), place % self.chunk_length());
        let (chunk, nodes) = (&self.chunks[chunk], self.kind.table().nodes);
        let mut first = [0; MAX_NODES];
        let element = &chunk.connectivity[nodes * place..][..nodes];
        for (first, &node) in first.iter_mut().zip(element) {
            *first = chunk.first[node as usize];
        }
        (first, nodes)
    }

    /// Makes `element` the one at this place of the block.
    pub(super) fn set(&self, element: &mut Element, shape: &Shape, place: usize) {
        let (chunk, place) = (place / self.chunk_length(), place % self.chunk_length());
        element.set(shape, self, &self.chunks[chunk], place);
    }
}
