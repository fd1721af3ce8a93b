//! D as the product of the sparse rows of contact points with a diagonal mass.

/// Unknowns of a place, side by side: three translations or three rotations of a node, and one that is never used, so that a place
/// fills a register.
const LANES: usize = 4;

/// Unknowns of a place.
type Lanes = [f64; LANES];

/// Nobody.
const NONE: u32 = u32::MAX;

/// What differs from a common factor of a candidate's entries by rounding, over the largest entry: weights are sums over points of
/// integration.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// An unknown of the rows: the first of its place, and its inverse mass in 1/kg, zero where it is held.
#[derive(Clone, Copy, Debug)]
pub struct Unknown {
    /// The first unknown of the place, at most three before this one.
    pub first: u32,
    /// Inverse mass, 1/kg.
    pub inverse: f64,
}

/// The sparse rows N and the diagonal mass M of `D = N M⁻¹ Nᵀ`.
///
/// D itself is never made, so that memory and the cost of a product grow as the entries of N. A force in a contact point acts on all
/// nodes that it touches along the same axes: the entries of the rows k of a candidate at a node a are `w_a F_k`, with one weight for each node and one
/// frame F of the normal and the tangents for all of them. Where they are so to rounding, weights and frame are all that is kept; otherwise, as with arms of
/// rotations, all entries.
#[derive(Clone, Debug, Default)]
pub struct Lumped {
    /// Rows of a candidate: one, or its normal and its tangents.
    width: usize,
    candidates: Vec<Span>,
    /// Places that candidates act on, numbered from 0.
    places: Vec<u32>,
    /// Of each candidate its frame, `width` rows, and a weight for each place; or `width` rows for each place.
    values: Vec<f64>,
    /// Inverse masses of each place, 1/kg.
    inverse: Vec<Lanes>,
    /// Blocks of D over the rows of each candidate, row-major.
    blocks: Vec<f64>,
    filling: Filling,
}

/// Where places and values of a candidate begin, and whether it has a frame.
#[derive(Clone, Copy, Debug, Default)]
struct Span {
    places: u32,
    values: u32,
    framed: bool,
}

/// What is needed while rows are appended.
#[derive(Clone, Debug, Default)]
struct Filling {
    /// Number of a place, by its first unknown; nobody between [`Lumped::finish`] and [`Lumped::push`].
    number: Vec<u32>,
    /// First unknowns of the places.
    firsts: Vec<u32>,
    /// Where a place was last appended, by number.
    last: Vec<u32>,
    /// Rows of each place of the candidate under way.
    rows: Vec<[Lanes; 3]>,
}

/// Entries of a candidate.
enum Entries<'a> {
    /// Frame, and a weight for each place.
    Framed(&'a [Lanes], &'a [f64]),
    /// Rows of each place.
    Each(&'a [Lanes]),
}

impl Lumped {
    /// Removes all rows. `width`: rows of each candidate, three at most.
    pub fn clear(&mut self, width: usize) {
        self.width = width;
        self.candidates.clear();
        self.candidates.push(Span::default());
        self.places.clear();
        self.values.clear();
        self.inverse.clear();
        self.blocks.clear();
        self.filling.last.clear();
    }

    /// Appends a candidate: unknowns and entries of each of its rows. An unknown may come more than once.
    pub fn push<'a>(
        &mut self,
        rows: impl Iterator<Item = (&'a [u32], &'a [f64])>,
        of: impl Fn(u32) -> Unknown,
    ) {
        let begin = self.places.len();
        self.filling.rows.clear();
        for (k, (unknowns, entries)) in rows.enumerate() {
            for (&unknown, entry) in unknowns.iter().zip(entries) {
                let Unknown { first, inverse } = of(unknown);
                let lane = (unknown - first) as usize;
                let number = self.number(first);
                self.inverse[number as usize][lane] = inverse;
                let place = self.place(begin, number);
                self.filling.rows[place][k][lane] += entry;
            }
        }
        let framed = self.write();
        self.candidates
            .last_mut()
            .into_iter()
            .for_each(|span| span.framed = framed);
        self.candidates.push(Span {
            places: self.places.len() as u32,
            values: self.values.len() as u32,
            framed: false,
        });
    }

    /// Number of the place with this first unknown.
    fn number(&mut self, first: u32) -> u32 {
        let Filling {
            number,
            firsts,
            last,
            ..
        } = &mut self.filling;
        if number.len() <= first as usize {
            number.resize(first as usize + 1, NONE);
        }
        let own = &mut number[first as usize];
        if *own == NONE {
            *own = self.inverse.len() as u32;
            firsts.push(first);
            last.push(NONE);
            self.inverse.push([0.0; LANES]);
        }
        *own
    }

    /// Where the rows of a place are in those of the candidate whose places begin at `begin`.
    fn place(&mut self, begin: usize, number: u32) -> usize {
        let last = &mut self.filling.last[number as usize];
        if *last == NONE || (*last as usize) < begin {
            *last = self.places.len() as u32;
            self.places.push(number);
            self.filling.rows.push([[0.0; LANES]; 3]);
        }
        *last as usize - begin
    }

    /// Writes the entries and the block of the candidate under way. Returns whether it has a frame.
    fn write(&mut self) -> bool {
        let rows = &self.filling.rows;
        let places = &self.places[self.places.len() - rows.len()..];
        for k in 0..self.width {
            for l in 0..self.width {
                let terms = rows.iter().zip(places).map(|(rows, &place)| {
                    let inverse = &self.inverse[place as usize];
                    (0..LANES)
                        .map(|a| rows[k][a] * inverse[a] * rows[l][a])
                        .sum::<f64>()
                });
                self.blocks.push(terms.sum());
            }
        }
        let begin = self.values.len();
        if self.write_framed() {
            return true;
        }
        self.values.truncate(begin);
        for rows in &self.filling.rows {
            self.values.extend(rows[..self.width].as_flattened());
        }
        false
    }

    /// Writes the frame and the weights of the candidate under way, up to the first place that has no weight.
    fn write_framed(&mut self) -> bool {
        let rows = &self.filling.rows;
        let largest = rows.iter().max_by(|a, b| square(a).total_cmp(&square(b)));
        let Some(frame) = largest.filter(|frame| square(frame) > 0.0) else {
            return false;
        };
        self.values.extend(frame[..self.width].as_flattened());
        let entries = frame.as_flattened();
        let size = entries.iter().fold(0.0, |most, f| f64::max(most, f.abs()));
        for rows in rows {
            let weight = product(rows, frame) / square(frame);
            let both = rows.as_flattened().iter().zip(entries);
            let off = both.fold(0.0, |most, (n, f)| f64::max(most, (n - weight * f).abs()));
            if off > ROUNDING * size {
                return false;
            }
            self.values.push(weight);
        }
        true
    }

    /// Ends the rows: unknowns may have other numbers and masses from here on.
    pub fn finish(&mut self) {
        for first in self.filling.firsts.drain(..) {
            self.filling.number[first as usize] = NONE;
        }
    }

    /// Number of the rows.
    pub fn rows(&self) -> usize {
        self.width * self.candidates.len().saturating_sub(1)
    }

    /// Numbers that it holds: entries of N, as weights and frames or all, and of the blocks.
    pub fn numbers(&self) -> usize {
        self.values.len() + self.blocks.len()
    }

    /// Bytes that it holds in these numbers, in places and in masses.
    pub fn bytes(&self) -> usize {
        let spans = size_of::<Span>() * self.candidates.len();
        8 * (self.numbers() + self.count()) + 4 * self.places.len() + spans
    }

    /// Numbers of a vector over all unknowns.
    pub(crate) fn count(&self) -> usize {
        LANES * self.inverse.len()
    }

    /// Places and entries of a candidate.
    fn candidate(&self, i: usize) -> (&[u32], Entries<'_>) {
        let (own, next) = (self.candidates[i], self.candidates[i + 1]);
        let places = &self.places[own.places as usize..next.places as usize];
        let values = &self.values[own.values as usize..next.values as usize];
        let entries = match own.framed {
            true => {
                let (frame, weights) = values.split_at(LANES * self.width);
                Entries::Framed(frame.as_chunks().0, weights)
            }
            false => Entries::Each(values.as_chunks().0),
        };
        (places, entries)
    }

    /// (N x)_row.
    pub(crate) fn along(&self, row: usize, x: &[f64]) -> f64 {
        let (i, k) = (row / self.width, row % self.width);
        let (x, _) = x.as_chunks::<LANES>();
        let (places, entries) = self.candidate(i);
        match entries {
            Entries::Framed(frame, weights) => dot(&frame[k], &weighted(places, weights, x)),
            Entries::Each(rows) => {
                let own = rows.iter().skip(k).step_by(self.width);
                own.zip(places)
                    .map(|(row, &place)| dot(row, &x[place as usize]))
                    .sum()
            }
        }
    }

    /// N x in the rows of candidate `i`.
    pub(crate) fn along_all(&self, i: usize, x: &[f64]) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let (x, _) = x.as_chunks::<LANES>();
        let (places, entries) = self.candidate(i);
        match entries {
            Entries::Framed(frame, weights) => {
                let motion = weighted(places, weights, x);
                for (sum, row) in sums.iter_mut().zip(frame) {
                    *sum = dot(row, &motion);
                }
            }
            Entries::Each(rows) => {
                for (rows, &place) in rows.chunks_exact(self.width).zip(places) {
                    for (sum, row) in sums.iter_mut().zip(rows) {
                        *sum += dot(row, &x[place as usize]);
                    }
                }
            }
        }
        sums
    }

    /// x += M⁻¹ Nᵀ p of one row.
    pub(crate) fn add(&self, row: usize, p: f64, x: &mut [f64]) {
        let mut forces = [0.0; 3];
        forces[row % self.width] = p;
        self.add_all(row / self.width, &forces, x);
    }

    /// x += M⁻¹ Nᵀ p of the rows of candidate `i`.
    pub(crate) fn add_all(&self, i: usize, p: &[f64; 3], x: &mut [f64]) {
        let (x, _) = x.as_chunks_mut::<LANES>();
        let (places, entries) = self.candidate(i);
        match entries {
            Entries::Framed(frame, weights) => {
                let force = combined(frame, p);
                for (&place, weight) in places.iter().zip(weights) {
                    let (x, inverse) = (&mut x[place as usize], &self.inverse[place as usize]);
                    for a in 0..LANES {
                        x[a] += weight * force[a] * inverse[a];
                    }
                }
            }
            Entries::Each(rows) => {
                for (rows, &place) in rows.chunks_exact(self.width).zip(places) {
                    let (x, inverse) = (&mut x[place as usize], &self.inverse[place as usize]);
                    let force = combined(rows, p);
                    for a in 0..LANES {
                        x[a] += force[a] * inverse[a];
                    }
                }
            }
        }
    }

    /// x = M⁻¹ Nᵀ p.
    pub(crate) fn gather(&self, p: &[f64], x: &mut Vec<f64>) {
        x.clear();
        x.resize(self.count(), 0.0);
        for (i, p) in p.chunks_exact(self.width).enumerate() {
            let mut own = [0.0; 3];
            own[..self.width].copy_from_slice(p);
            if own != [0.0; 3] {
                self.add_all(i, &own, x);
            }
        }
    }

    /// Bounds of Σ |D_ij p_j|: |N| M⁻¹ |N|ᵀ |p|. `x`: scratch.
    pub(crate) fn sizes(&self, p: &[f64], x: &mut Vec<f64>, sizes: &mut Vec<f64>) {
        x.clear();
        x.resize(self.count(), 0.0);
        let (places_of, _) = x.as_chunks_mut::<LANES>();
        for (i, p) in p.chunks_exact(self.width).enumerate() {
            if p.iter().all(|p| *p == 0.0) {
                continue;
            }
            self.each_row(i, |k, place, row, weight| {
                let (x, inverse) = (&mut places_of[place], &self.inverse[place]);
                for a in 0..LANES {
                    x[a] += (weight * row[a] * p[k]).abs() * inverse[a];
                }
            });
        }
        sizes.clear();
        sizes.resize(self.rows(), 0.0);
        for i in 0..self.rows() / self.width {
            self.each_row(i, |k, place, row, weight| {
                let x = &places_of[place];
                let terms = (0..LANES).map(|a| (weight * row[a]).abs() * x[a]);
                sizes[i * self.width + k] += terms.sum::<f64>();
            });
        }
    }

    /// Calls `take` with row, place, entries and a factor of them for all rows of a candidate at all of its places.
    fn each_row(&self, i: usize, mut take: impl FnMut(usize, usize, &Lanes, f64)) {
        let (places, entries) = self.candidate(i);
        for (at, &place) in places.iter().enumerate() {
            for k in 0..self.width {
                let (row, weight) = match entries {
                    Entries::Framed(frame, weights) => (&frame[k], weights[at]),
                    Entries::Each(rows) => (&rows[at * self.width + k], 1.0),
                };
                take(k, place as usize, row, weight);
            }
        }
    }

    /// Entry of the block of candidate `i` over its own rows `k` and `l`.
    pub(crate) fn block(&self, i: usize, k: usize, l: usize) -> f64 {
        self.blocks[(i * self.width + k) * self.width + l]
    }

    /// Writes all entries of D, row-major: for few rows.
    pub fn dense(&self, dense: &mut Vec<f64>) {
        let n = self.rows();
        dense.clear();
        let mut x = Vec::new();
        for one in 0..n {
            x.clear();
            x.resize(self.count(), 0.0);
            self.add(one, 1.0, &mut x);
            dense.extend((0..n).map(|other| self.along(other, &x)));
        }
    }
}

/// Σ w_a x_a.
fn weighted(places: &[u32], weights: &[f64], x: &[Lanes]) -> Lanes {
    let mut sum = [0.0; LANES];
    for (&place, weight) in places.iter().zip(weights) {
        let x = &x[place as usize];
        for a in 0..LANES {
            sum[a] += weight * x[a];
        }
    }
    sum
}

/// Σ p_k F_k.
fn combined(rows: &[Lanes], p: &[f64; 3]) -> Lanes {
    let mut sum = [0.0; LANES];
    for (row, p) in rows.iter().zip(p) {
        for a in 0..LANES {
            sum[a] += p * row[a];
        }
    }
    sum
}

fn dot(a: &Lanes, b: &Lanes) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

fn product(a: &[Lanes; 3], b: &[Lanes; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| dot(a, b)).sum()
}

fn square(rows: &[Lanes; 3]) -> f64 {
    product(rows, rows)
}

#[cfg(test)]
mod tests;
