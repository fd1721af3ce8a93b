//! Looks at the frequencies of elements that deform, chunk by chunk.
//!
//! To find the frequencies of an element costs as much as some hundred evaluations of its forces. Those of a chunk are found anew where a
//! length in one of its elements has changed by more than is asked for since they were found last, or an element was deleted;
//! an impact changes few of them.

use carom_mesh::ElementId;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::Placement;
use super::body::{Failed, Finite};
use super::cell::Element;
use super::element::Local;
use crate::block::{Block, Matrices, by_nodes, call_by_nodes};
use crate::chunk::{Chunk, element_nodes};
use crate::error::Error;
use crate::solid::Solid;
use crate::stability;

/// Bound of 2 over the stable step of an explicit scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrequencyBound {
    /// The bound, rad/s.
    pub frequency: f64,
    /// What a compression of rate 1/s adds to it at most by quadratic bulk viscosity, rad: ω² ρ l² b₂²/κ.
    pub by_compression: f64,
    /// The element with this bound, where it is known.
    pub cell: Option<ElementId>,
}

impl FrequencyBound {
    /// Without quadratic bulk viscosity.
    pub(crate) fn of(frequency: f64) -> FrequencyBound {
        FrequencyBound {
            frequency,
            by_compression: 0.0,
            cell: None,
        }
    }

    /// Of two bodies together.
    pub fn most(&self, other: &FrequencyBound) -> FrequencyBound {
        let faster = other.frequency > self.frequency;
        FrequencyBound {
            frequency: self.frequency.max(other.frequency),
            cell: if faster { other.cell } else { self.cell },
            by_compression: self.by_compression.max(other.by_compression),
        }
    }
}

/// What is known of the frequencies of the elements of a body: of those of each chunk as of the last look at it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Looks {
    chunks: Vec<Look>,
}

/// The elements of a chunk when their frequencies were found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Look {
    /// The bounds of [`FrequencyBound`], rad/s and rad.
    frequency: f64,
    by_compression: f64,
    /// Shortest distance of two nodes of an element, m.
    shortest: f64,
    /// Elements that were not deleted.
    left: usize,
    /// Places of the nodes of the chunk, m.
    x: Vec<[f64; 3]>,
}

/// What a look at a body tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Bound of the frequencies of its elements, each as of the last look at its chunk.
    pub bound: FrequencyBound,
    /// Shortest distance of two nodes of an element as of that look, m.
    pub shortest: f64,
    /// Largest change of such a distance since that look, relative.
    pub changed: f64,
    /// Whether the frequencies of any element were found anew.
    pub is_renewed: bool,
}

impl Default for Seen {
    /// Of no element.
    fn default() -> Seen {
        Seen {
            bound: FrequencyBound::default(),
            shortest: f64::INFINITY,
            changed: 0.0,
            is_renewed: false,
        }
    }
}

impl Seen {
    /// Of both.
    pub fn with(&self, other: &Seen) -> Seen {
        Seen {
            bound: self.bound.most(&other.bound),
            shortest: self.shortest.min(other.shortest),
            changed: self.changed.max(other.changed),
            is_renewed: self.is_renewed || other.is_renewed,
        }
    }
}

impl Solid {
    /// Upper bound of the angular frequencies (rad/s) with lumped mass about a displacement: the largest magnitude of an
    /// eigenvalue of M_e⁻¹ K_e over the elements, with the tangents K_e there. [`Solid::frequency_bound`] is that of the
    /// undeformed body.
    ///
    /// An element that shortens in the direction of a wave keeps its mass, and its tangent grows. Costs about 2 n³ flops a
    /// dozen times for each element of n unknowns: not for every step.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn frequency_bound_at(&self, at: &Placement) -> Result<FrequencyBound, Error> {
        let seen = self.look(at, &mut Looks::default(), 0.0)?;
        Ok(seen.bound)
    }

    /// Compares the lengths in the elements with those of the last look, finds the frequencies anew in chunks where one has changed by
    /// more than `worth`, relative, and tells what is known then. A body whose forces are linear has always the same frequencies.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn look(&self, at: &Placement, looks: &mut Looks, worth: f64) -> Result<Seen, Error> {
        let Some(finite) = &self.finite else {
            return Ok(looks.constant(|| self.frequency_bound()));
        };
        let count = self.blocks().iter().map(|block| block.chunks.len()).sum();
        looks.chunks.resize_with(count, Look::default);
        let (mut seen, mut first, mut before) = (Seen::default(), 0, 0);
        let mut left = &mut looks.chunks[..];
        for block in self.blocks() {
            let (of_block, rest) = left.split_at_mut(block.chunks.len());
            left = rest;
            let (length, kept) = (block.chunk_length(), finite.kept_of_element(block));
            let pairs = block.chunks.par_iter().zip(of_block).enumerate();
            let of_chunk = |(k, (chunk, look)): (usize, (&Chunk, &mut Look))| {
                let begin = first + k * length;
                let from = before + kept * k * length;
                let elements = chunk.len(block.kind.table().nodes);
                let old = &at.old[from..from + kept * elements];
                let of = OfChunk {
                    body: self,
                    finite,
                    block,
                    chunk,
                    first: begin,
                    at: Placement { old, ..*at },
                };
                of.look(look, worth)
            };
            // of two chunks that fail the first is named, whatever the threads
            let both = |a: Result<Seen, Failed>, b: Result<Seen, Failed>| Ok(a?.with(&b?));
            let all = pairs.map(of_chunk).reduce(|| Ok(Seen::default()), both);
            seen = seen.with(&all.map_err(|failed| self.failed(failed))?);
            first += block.len();
            before += kept * block.len();
        }
        Ok(seen)
    }
}

impl Looks {
    /// Of a body whose frequencies never change; `find`: their bound, rad/s.
    pub(crate) fn constant(&mut self, find: impl FnOnce() -> f64) -> Seen {
        let is_renewed = self.chunks.is_empty();
        if is_renewed {
            self.chunks.push(Look {
                frequency: find(),
                ..Look::default()
            });
        }
        Seen {
            bound: FrequencyBound::of(self.chunks[0].frequency),
            is_renewed,
            ..Seen::default()
        }
    }
}

/// A chunk with the history of its elements.
struct OfChunk<'a> {
    body: &'a Solid,
    finite: &'a Finite,
    block: &'a Block,
    chunk: &'a Chunk,
    /// Place of its first element in the body.
    first: usize,
    at: Placement<'a>,
}

impl OfChunk<'_> {
    fn look(&self, look: &mut Look, worth: f64) -> Result<Seen, Failed> {
        let elements = self.chunk.len(self.block.kind.table().nodes);
        let left = match self.finite.limit {
            None => elements,
            Some(_) => (0..elements)
                .filter(|&element| self.is_left(element))
                .count(),
        };
        let mut changed = match !look.x.is_empty() && left == look.left {
            true => by_nodes!(self.block.kind => self.change(look)),
            false => f64::INFINITY,
        };
        let is_renewed = changed.is_nan() || changed > worth;
        let mut cell = None;
        if is_renewed {
            look.left = left;
            look.x.clear();
            let places = 0..self.chunk.nodes.len();
            look.x.extend(places.map(|place| self.place(place)));
            look.shortest = by_nodes!(self.block.kind => self.shortest(look));
            let bound = self.bound()?;
            (look.frequency, look.by_compression) = (bound.frequency, bound.by_compression);
            (changed, cell) = (0.0, bound.cell);
        }
        Ok(Seen {
            bound: FrequencyBound {
                frequency: look.frequency,
                by_compression: look.by_compression,
                cell,
            },
            shortest: look.shortest,
            changed,
            is_renewed,
        })
    }

    fn kept(&self, element: usize) -> std::ops::Range<usize> {
        let kept = self.finite.kept_of_element(self.block);
        kept * element..kept * (element + 1)
    }

    fn is_left(&self, element: usize) -> bool {
        !self.finite.is_deleted(&self.at.old[self.kept(element)])
    }

    /// Where a node of the chunk is, m.
    #[inline(always)]
    fn place(&self, place: usize) -> [f64; 3] {
        let mut x = self.chunk.x[place];
        let first = self.chunk.first[place] as usize;
        for (i, x) in x.iter_mut().enumerate().take(self.finite.shape.dim()) {
            *x += self.at.u[first + i];
        }
        x
    }

    /// Largest change of a distance of two nodes of an element, relative.
    fn change<const N: usize>(&self, look: &Look) -> f64 {
        let mut range: [f64; 2] = [1.0; 2];
        for (number, element) in self.chunk.connectivity.chunks_exact(N).enumerate() {
            if !self.is_left(number) {
                continue;
            }
            let before = element_nodes::<N, _>(element, |node| look.x[node]);
            let now = element_nodes::<N, _>(element, |node| self.place(node));
            for a in 1..N {
                for b in 0..a {
                    let ratio = square(&now[a], &now[b]) / square(&before[a], &before[b]);
                    range = [range[0].min(ratio), range[1].max(ratio)];
                }
            }
        }
        let [least, most] = range.map(f64::sqrt);
        f64::max(1.0 - least, most - 1.0)
    }

    /// Shortest distance of two nodes of an element, m.
    fn shortest<const N: usize>(&self, look: &Look) -> f64 {
        let mut least = f64::INFINITY;
        for (number, element) in self.chunk.connectivity.chunks_exact(N).enumerate() {
            if !self.is_left(number) {
                continue;
            }
            let x = element_nodes::<N, _>(element, |node| look.x[node]);
            for a in 1..N {
                for b in 0..a {
                    least = least.min(square(&x[a], &x[b]));
                }
            }
        }
        least.sqrt()
    }

    /// Bound of the frequencies of its elements that are left: the largest magnitude of an eigenvalue of M_e⁻¹ K_e.
    fn bound(&self) -> Result<FrequencyBound, Failed> {
        let dim = self.finite.shape.dim();
        let (mut masses, mut bound) = (Vec::new(), FrequencyBound::default());
        let collect = &mut |element: &Matrices| masses.extend(element.lumped);
        self.block.matrices_of(self.chunk, dim, false, collect);
        let nodes = self.block.kind.table().nodes;
        let mut k = vec![0.0; (dim * nodes).pow(2)];
        let (mut scaled, mut memory) = (Vec::new(), Vec::new());
        let mut room = Box::new(Element::room());
        let mut new = vec![0.0; self.finite.kept_of_element(self.block)];
        let modulus = self.body.bulk_modulus();
        for (number, masses) in masses.chunks_exact(nodes).enumerate() {
            if !self.is_left(number) {
                continue;
            }
            room.set(&self.finite.shape, self.block, self.chunk, number);
            let tangent = |local: &Local| room.tangent(local, &mut new, &mut k);
            let kept = self.kept(number);
            let found = self.finite.at_element(&room, &self.at, kept, tangent);
            found.map_err(|fault| (self.first + number, fault))?;
            stability::scale(dim, &k, masses, &mut scaled);
            let norm = scaled.iter().map(|b| b * b).sum::<f64>().sqrt();
            let viscous = self.body.coefficients(self.first + number);
            // no eigenvalue is beyond the norm
            if viscous.is_some() || norm > bound.frequency * bound.frequency {
                let square = stability::largest_magnitude(&mut scaled, &mut memory);
                let frequency = self.body.damped_frequency(self.first + number, square);
                if frequency > bound.frequency {
                    bound.frequency = frequency;
                    bound.cell = Some(self.body.cells()[self.first + number]);
                }
                let quadratic = viscous.map_or(0.0, |[_, quadratic]| quadratic);
                bound.by_compression = bound.by_compression.max(quadratic / modulus * square);
            }
        }
        Ok(bound)
    }
}

/// Square of the distance of two places, m².
#[inline(always)]
fn square(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}
