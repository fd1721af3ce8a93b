//! Looks at the frequencies of elements that deform, element by element.
//!
//! To find the frequency of an element costs as much as some hundred evaluations of its forces. It is found anew where a length in the
//! element has changed by more than is asked for since it was found last: an impact changes few of them. What is found depends on
//! the element alone, so that ranks which share elements find the same.

use carom_materials::Want;
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

/// What is known of the frequencies of the elements of a body, each as of the last look that found it anew.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Looks {
    /// The bounds of [`FrequencyBound`] of each element, rad/s and rad, in the order of [`Solid::cells`]; of a body whose frequencies never change one
    /// of all. Not a number where no look has been, zero of deleted elements.
    bounds: Vec<[f64; 2]>,
    /// Places of the nodes of each element when its frequency was found, relative to its first node, m: in single precision, since they are compared to
    /// a hundredth, and a run at finite strain holds 400 bytes a cell at most.
    places: Vec<f32>,
}

/// An element when its frequency was found.
struct Look<'a> {
    bound: &'a mut [f64; 2],
    places: &'a mut [f32],
}

/// What a look at a body tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Bound of the frequencies of its elements, each as of the last look that found it.
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

    /// Compares the lengths in the elements with those of the last look, finds the frequency anew of elements where one has changed by
    /// more than `worth`, relative, and tells what is known then. Tangents are those of unloading, since an element that flows is stiff
    /// again as soon as it turns back. A body whose forces are linear has always the same frequencies.
    ///
    /// # Errors
    /// As [`Solid::force`].
    pub fn look(&self, at: &Placement, looks: &mut Looks, worth: f64) -> Result<Seen, Error> {
        let Some(finite) = &self.finite else {
            return Ok(looks.constant(|| self.frequency_bound()));
        };
        let count = self.cells().len();
        let stride = self.places_of_look();
        looks.bounds.resize(count, [f64::NAN; 2]);
        looks.places.resize(stride * count, 0.0);
        let (mut seen, mut first, mut before) = (Seen::default(), 0, 0);
        let (mut bounds, mut places) = (&mut looks.bounds[..], &mut looks.places[..]);
        for block in self.blocks() {
            let (length, kept) = (block.chunk_length(), finite.kept_of_element(block));
            let (of_block, rest) = std::mem::take(&mut bounds).split_at_mut(block.len());
            bounds = rest;
            let (places_of_block, rest) =
                std::mem::take(&mut places).split_at_mut(stride * block.len());
            places = rest;
            let bounds = of_block.par_chunks_mut(length);
            let places = places_of_block.par_chunks_mut(stride * length);
            let chunks = block.chunks.par_iter().zip(bounds.zip(places)).enumerate();
            let of_chunk = |(k, (chunk, (bounds, places))): (usize, (&Chunk, _))| {
                let from = before + kept * k * length;
                let elements = chunk.len(block.kind.table().nodes);
                let old = &at.old[from..from + kept * elements];
                let of = OfChunk {
                    body: self,
                    finite,
                    block,
                    chunk,
                    first: first + k * length,
                    at: Placement { old, ..*at },
                };
                of.look((bounds, places, stride), worth)
            };
            // of two chunks that fail the first is named, whatever the threads
            let both = |a: Result<Seen, Failed>, b: Result<Seen, Failed>| Ok(a?.with(&b?));
            let all = chunks.map(of_chunk).reduce(|| Ok(Seen::default()), both);
            seen = seen.with(&all.map_err(|failed| self.failed(failed))?);
            first += block.len();
            before += kept * block.len();
        }
        Ok(seen)
    }

    /// Numbers of [`Looks`] for the places of an element: of the kind with most nodes, also where a rank has elements of others alone.
    fn places_of_look(&self) -> usize {
        3 * (self.most_nodes - 1)
    }

    /// Numbers that [`Looks::push`] gives of an element; none of a body whose frequencies never change.
    pub fn numbers_of_look(&self) -> Option<usize> {
        self.finite.is_some().then(|| 2 + self.places_of_look())
    }
}

impl Looks {
    /// Of a body whose frequencies never change; `find`: their bound, rad/s.
    pub(crate) fn constant(&mut self, find: impl FnOnce() -> f64) -> Seen {
        let is_renewed = self.bounds.is_empty();
        if is_renewed {
            self.bounds.push([find(), 0.0]);
        }
        Seen {
            bound: FrequencyBound::of(self.bounds[0][0]),
            is_renewed,
            ..Seen::default()
        }
    }

    /// Whether nothing is known yet.
    pub fn is_empty(&self) -> bool {
        self.bounds.is_empty()
    }

    /// Whether they are of a body with so many cells and [`Solid::numbers_of_look`], or of none.
    pub fn are_of(&self, cells: usize, numbers: Option<usize>) -> bool {
        let sizes = numbers.map_or((1, 0), |numbers| (cells, cells * (numbers - 2)));
        self.is_empty() || (self.bounds.len(), self.places.len()) == sizes
    }

    /// Appends what is known of an element to some numbers.
    pub fn push(&self, element: usize, numbers: &mut Vec<f64>) {
        let stride = self.places.len() / self.bounds.len();
        numbers.extend(self.bounds[element]);
        let places = &self.places[stride * element..][..stride];
        numbers.extend(places.iter().map(|place| f64::from(*place)));
    }

    /// Takes what [`Looks::push`] gave of one of `count` elements.
    pub fn take(&mut self, (element, count): (usize, usize), numbers: &[f64]) {
        let stride = numbers.len() - 2;
        self.bounds.resize(count, [f64::NAN; 2]);
        self.places.resize(stride * count, 0.0);
        self.bounds[element].copy_from_slice(&numbers[..2]);
        let places = &mut self.places[stride * element..][..stride];
        for (place, number) in places.iter_mut().zip(&numbers[2..]) {
            *place = *number as f32;
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
    fn look(
        &self,
        (bounds, places, stride): (&mut [[f64; 2]], &mut [f32], usize),
        worth: f64,
    ) -> Result<Seen, Failed> {
        let mut seen = Seen::default();
        let mut room: Option<Tangents> = None;
        let looks = bounds.iter_mut().zip(places.chunks_exact_mut(stride));
        for (number, (bound, places)) in looks.enumerate() {
            let mut look = Look { bound, places };
            if !self.is_left(number) {
                // of a deleted element there is no frequency
                seen.is_renewed |= look.bound[0] != 0.0;
                *look.bound = [0.0; 2];
                continue;
            }
            let mut lengths = by_nodes!(self.block.kind => self.compare(number, &look));
            let mut cell = None;
            let is_known = !look.bound[0].is_nan() && lengths.changed <= worth;
            if !is_known {
                lengths = by_nodes!(self.block.kind => self.keep(number, &mut look));
                let room = room.get_or_insert_with(|| Tangents::of(self));
                *look.bound = self.bound(number, room)?;
                cell = Some(self.body.cells()[self.first + number]);
                seen.is_renewed = true;
            }
            let [frequency, by_compression] = *look.bound;
            seen = seen.with(&Seen {
                bound: FrequencyBound {
                    frequency,
                    by_compression,
                    cell,
                },
                shortest: lengths.shortest,
                changed: lengths.changed,
                is_renewed: false,
            });
        }
        Ok(seen)
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

    /// Where the nodes of an element are, m.
    #[inline(always)]
    fn now<const N: usize>(&self, number: usize) -> [[f64; 3]; N] {
        let element = &self.chunk.connectivity[N * number..][..N];
        element_nodes::<N, _>(element, |node| self.place(node))
    }

    /// Shortest distance of two nodes as of the last look, and the largest change of such a distance since.
    #[inline(always)]
    fn compare<const N: usize>(&self, number: usize, look: &Look) -> Lengths {
        let (mut before, now) = ([[0.0; 3]; N], self.now::<N>(number));
        for (before, kept) in before[1..].iter_mut().zip(look.places.chunks_exact(3)) {
            *before = [0, 1, 2].map(|i| f64::from(kept[i]));
        }
        let (mut range, mut least): ([f64; 2], f64) = ([1.0; 2], f64::INFINITY);
        for a in 1..N {
            for b in 0..a {
                let length = square(&before[a], &before[b]);
                let ratio = square(&now[a], &now[b]) / length;
                range = [range[0].min(ratio), range[1].max(ratio)];
                least = least.min(length);
            }
        }
        let [low, high] = range.map(f64::sqrt);
        Lengths {
            shortest: least.sqrt(),
            changed: f64::max(1.0 - low, high - 1.0),
        }
    }

    /// Keeps where the nodes are.
    fn keep<const N: usize>(&self, number: usize, look: &mut Look) -> Lengths {
        let now = self.now::<N>(number);
        let kept = look.places.as_chunks_mut::<3>().0;
        for (kept, x) in kept.iter_mut().zip(&now[1..]) {
            *kept = [0, 1, 2].map(|i| (x[i] - now[0][i]) as f32);
        }
        Lengths {
            changed: 0.0,
            ..self.compare::<N>(number, look)
        }
    }

    /// Bounds of the frequency of an element: the largest magnitude of an eigenvalue of M_e⁻¹ K_e.
    fn bound(&self, number: usize, room: &mut Tangents) -> Result<[f64; 2], Failed> {
        let dim = self.finite.shape.dim();
        let Tangents {
            element,
            masses,
            k,
            new,
            scaled,
            memory,
        } = room;
        element.set(&self.finite.shape, self.block, self.chunk, number);
        let tangent = |local: &Local| element.tangent((local, Want::Unloading), new, k);
        let found = self
            .finite
            .at_element(element, &self.at, self.kept(number), tangent);
        found.map_err(|fault| (self.first + number, fault))?;
        let nodes = self.block.kind.table().nodes;
        stability::scale(dim, k, &masses[nodes * number..][..nodes], scaled);
        let square = stability::largest_magnitude(scaled, memory);
        let viscous = self.body.coefficients(self.first + number);
        let quadratic = viscous.map_or(0.0, |[_, quadratic]| quadratic);
        Ok([
            self.body.damped_frequency(self.first + number, square),
            quadratic / self.body.bulk_modulus() * square,
        ])
    }
}

/// Lengths in an element.
struct Lengths {
    /// Shortest distance of two nodes, m.
    shortest: f64,
    /// Largest change of such a distance, relative.
    changed: f64,
}

/// Room for the tangents of the elements of a chunk.
struct Tangents {
    element: Box<Element>,
    /// Lumped masses of the nodes of the elements, kg.
    masses: Vec<f64>,
    k: Vec<f64>,
    new: Vec<f64>,
    scaled: Vec<f64>,
    memory: Vec<f64>,
}

impl Tangents {
    fn of(chunk: &OfChunk) -> Tangents {
        let (dim, nodes) = (chunk.finite.shape.dim(), chunk.block.kind.table().nodes);
        let mut masses = Vec::new();
        let collect = &mut |element: &Matrices| masses.extend(element.lumped);
        chunk.block.matrices_of(chunk.chunk, dim, false, collect);
        Tangents {
            element: Box::new(Element::room()),
            masses,
            k: vec![0.0; (dim * nodes).pow(2)],
            new: vec![0.0; chunk.finite.kept_of_element(chunk.block)],
            scaled: Vec::new(),
            memory: Vec::new(),
        }
    }
}

/// Square of the distance of two places, m².
#[inline(always)]
fn square(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}
