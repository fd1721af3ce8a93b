//! The rows of the gap operator N = ∂g/∂u, one per contact point, in one pool.

use crate::Places;

/// Gaps, normals and derivatives of the gaps of a list of contact points, at one configuration.
///
/// `ġ = N v + ∂g/∂t`, the last by the given motion of an obstacle, and a force P in a point acts on the unknowns as
/// `Nᵀ P`. A point that faces nothing has an infinite gap and an empty row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Where the entries of each point begin and end.
    spans: Vec<[u32; 2]>,
    dofs: Vec<u32>,
    coefficients: Vec<f64>,
    gaps: Vec<f64>,
    normals: Vec<[f64; 3]>,
    resultants: Vec<[f64; 3]>,
    rates: Vec<f64>,
    /// The point that entries are added to.
    at: usize,
}

impl Rows {
    /// Empties the pool and keeps its memory.
    pub fn clear(&mut self) {
        self.spans.clear();
        self.dofs.clear();
        self.coefficients.clear();
        self.gaps.clear();
        self.normals.clear();
        self.resultants.clear();
        self.rates.clear();
        self.at = 0;
    }

    /// Makes these the rows of `points` points that face nothing.
    pub fn open_all(&mut self, points: usize) {
        self.clear();
        self.spans.resize(points, [0; 2]);
        self.gaps.resize(points, f64::INFINITY);
        self.normals.resize(points, [0.0; 3]);
        self.resultants.resize(points, [0.0; 3]);
        self.rates.resize(points, 0.0);
    }

    /// Lets these points face nothing and drops the entries of all: the others must have none.
    pub fn reopen(&mut self, points: impl IntoIterator<Item = u32>) {
        self.dofs.clear();
        self.coefficients.clear();
        for point in points {
            self.open(point as usize);
        }
    }

    /// Lets a point, or the one after the last, face nothing.
    pub(crate) fn open(&mut self, point: usize) {
        self.begin(point, f64::INFINITY, [0.0; 3]);
        // an empty row is one in any pool
        self.spans[point] = [0; 2];
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.gaps.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.gaps.is_empty()
    }

    /// Unknowns and derivatives of the gap of a point by them (dimensionless).
    pub fn row(&self, point: usize) -> (&[u32], &[f64]) {
        let [begin, end] = self.spans[point].map(|place| place as usize);
        (&self.dofs[begin..end], &self.coefficients[begin..end])
    }

    /// Gap of a point in m, positive when open, infinite where it faces nothing.
    pub fn gap(&self, point: usize) -> f64 {
        self.gaps[point]
    }

    /// Unit normal at a point, from what it faces to its own side.
    pub fn normal(&self, point: usize) -> [f64; 3] {
        self.normals[point]
    }

    /// Resultant on the secondary side of a unit force in a point: the sum of the entries of its row there. It is the normal
    /// where the point has one place with a foot inside a face. The mean over places with different normals is
    /// shorter, and a foot held at the rim of a face adds what the force there is turned by.
    pub fn resultant(&self, point: usize) -> [f64; 3] {
        self.resultants[point]
    }

    /// Rate ∂g/∂t of the gap at bodies at rest, by the motion of the obstacle, m/s; zero against all that does not move by
    /// itself.
    pub fn rate(&self, point: usize) -> f64 {
        self.rates[point]
    }

    /// Product (N x) of the row of a point with a system vector.
    pub fn product(&self, point: usize, x: &[f64]) -> f64 {
        let (dofs, coefficients) = self.row(point);
        dofs.iter()
            .zip(coefficients)
            .map(|(&dof, n)| n * x[dof as usize])
            .sum()
    }

    /// Adds Nᵀ P of one point to a system vector.
    pub fn add_force(&self, point: usize, force: f64, f: &mut [f64]) {
        let (dofs, coefficients) = self.row(point);
        for (&dof, n) in dofs.iter().zip(coefficients) {
            f[dof as usize] += n * force;
        }
    }

    /// Appends one point of another pool.
    pub fn push_from(&mut self, other: &Rows, point: usize) {
        self.place_from(self.len(), other, point);
    }

    /// Makes a point, or the one after the last, that of another pool.
    pub fn place_from(&mut self, at: usize, other: &Rows, point: usize) {
        self.begin(at, other.gap(point), other.normal(point));
        self.resultants[at] = other.resultant(point);
        self.rates[at] = other.rate(point);
        let (dofs, coefficients) = other.row(point);
        self.dofs.extend_from_slice(dofs);
        self.coefficients.extend_from_slice(coefficients);
        self.close();
    }

    /// Appends the points of another pool.
    pub(crate) fn append(&mut self, other: &Rows) {
        for point in 0..other.len() {
            self.push_from(other, point);
        }
    }

    /// Appends the points of `initial`, paired once at zero displacement, with gaps moved by N u.
    pub fn append_moved(&mut self, initial: &Rows, u: &[f64]) {
        let first = self.len();
        self.append(initial);
        self.move_from(first, u);
    }

    /// Moves the gaps of the points from `first` on by N u, u in m, as if the rows stood.
    pub fn move_from(&mut self, first: usize, u: &[f64]) {
        for point in first..self.len() {
            self.gaps[point] += self.product(point, u);
        }
    }

    /// Moves the gaps of the points from `first` on to those of `initial`, whose rows they have, moved by N u.
    pub fn move_again(&mut self, first: usize, initial: &Rows, u: &[f64]) {
        for (point, gap) in (first..).zip(&initial.gaps) {
            self.gaps[point] = gap + self.product(point, u);
        }
    }

    /// Begins a point of the given gap and normal, which is its resultant as well.
    pub(crate) fn push(&mut self, gap: f64, normal: [f64; 3]) {
        self.begin(self.len(), gap, normal);
    }

    /// Begins a point, or the one after the last, of the given gap and normal, which is its resultant as well.
    pub(crate) fn begin(&mut self, point: usize, gap: f64, normal: [f64; 3]) {
        if point == self.len() {
            self.spans.push([0; 2]);
            self.gaps.push(gap);
            self.normals.push(normal);
            self.resultants.push(normal);
            self.rates.push(0.0);
        }
        self.spans[point] = [self.dofs.len() as u32; 2];
        self.gaps[point] = gap;
        (self.normals[point], self.resultants[point]) = (normal, normal);
        self.rates[point] = 0.0;
        self.at = point;
    }

    /// Adds an offset in m to the gap of a point.
    pub(crate) fn shift(&mut self, point: usize, offset: f64) {
        self.gaps[point] += offset;
    }

    /// Gives a point another gap, m.
    pub(crate) fn set_gap(&mut self, point: usize, gap: f64) {
        self.gaps[point] = gap;
    }

    /// Gives the point begun last another resultant.
    pub(crate) fn set_resultant(&mut self, resultant: [f64; 3]) {
        self.resultants[self.at] = resultant;
    }

    /// Gives the point begun last the rate of its gap by the obstacle's motion, m/s.
    pub(crate) fn set_rate(&mut self, rate: f64) {
        self.rates[self.at] = rate;
    }

    /// Adds to the row of the point begun last the motion of a node along `direction`.
    pub(crate) fn add_node(&mut self, places: &Places, node: u32, direction: &[f64; 3]) {
        // nodes that one node carries share its unknowns
        let carried = places.unknowns.carrier(node).is_some();
        places.each_derivative(node, direction, |unknown, n| {
            self.add(unknown as u32, n, carried);
        });
        self.close();
    }

    /// The same of a node that nothing carries, whose translations begin with this unknown and have no entry yet.
    pub(crate) fn add_translations(&mut self, first: u32, direction: &[f64]) {
        for (unknown, &n) in (first..).zip(direction) {
            if n != 0.0 {
                self.dofs.push(unknown);
                self.coefficients.push(n);
            }
        }
        self.close();
    }

    /// Adds to the row of the point begun last what a moment on a node does, of a unit force in m.
    pub(crate) fn add_moment(&mut self, places: &Places, node: u32, moment: &[f64; 3]) {
        let carried = places.unknowns.carrier(node).is_some();
        places.each_moment(node, moment, |unknown, n| {
            self.add(unknown as u32, n, carried);
        });
        self.close();
    }

    /// Adds an entry to the row under way, or to its entry of the unknown where it may have one.
    fn add(&mut self, unknown: u32, n: f64, repeats: bool) {
        if n == 0.0 {
            return;
        }
        let begin = self.spans[self.at][0] as usize;
        let mut own = self.dofs[begin..].iter().take_while(|_| repeats);
        match own.position(|dof| *dof == unknown) {
            Some(place) => self.coefficients[begin + place] += n,
            None => {
                self.dofs.push(unknown);
                self.coefficients.push(n);
            }
        }
    }

    fn close(&mut self) {
        self.spans[self.at][1] = self.dofs.len() as u32;
    }
}
