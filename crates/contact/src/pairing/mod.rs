//! From points and what they face to gaps, rows, tangential rows and curvature.
//!
//! Every contact point is a weighted sum of point stencils: one of weight 1 for a node or a Gauss point, the quadrature
//! points of its support for a multiplier of the mortar method. A stencil is one point of the secondary surface and its
//! closest point on the other side ([`stencil`]).

mod again;
pub(crate) mod block;
mod clip;
mod curvature;
mod foothold;
mod found;
mod in_reach;
mod look;
mod merge;
mod mortar;
mod near;
mod overlap;
mod pair;
mod round;
mod share;
mod stencil;
mod tie;
mod twice;

use carom_algebra::csr::Csr;

use self::block::Block;
use self::found::Look;
pub use self::in_reach::InReach;
use self::merge::Merge;
pub use self::near::{Near, OwnPart, Step};
use self::share::{Quadrature, Share};
use self::stencil::Stencil;
pub use self::tie::Tie;
use crate::faced::Faced;
use crate::{Places, Rows};

/// Contact points of a list of contacts at one configuration, with the derivatives that Newton's method and friction
/// ask for.
///
/// Cleared and filled again at each configuration; its memory is kept.
#[derive(Clone, Debug, Default)]
pub struct Pairing {
    /// Gaps, normals and rows N = ∂g/∂u.
    ///
    /// N is the derivative of the gap, also where the foot is at the rim of its face and the normal does not pass through
    /// the point (there [`Contact::pair`](crate::Contact::pair) leaves out the turning of the face). A force `Nᵀ P` has no resultant and no
    /// moment.
    pub rows: Rows,
    /// Rows T of the two tangents at a point: `T v` is the velocity in m/s at which the secondary slides over the primary
    /// along [`Rows::normal`] of that row; the gaps of these pools mean nothing. Unit vectors, square to each other and to the
    /// contact normal, that vary smoothly with it. [`Rows::rate`] of these rows is what the motion of an
    /// obstacle adds. A force along T has no resultant, but a moment where the gap is not closed. The second
    /// is empty in the plane, both are on a line.
    pub tangents: [Rows; 2],
    /// Reference area that each point stands for, m²: [`Point::area`](crate::Point::area), for a multiplier of the mortar
    /// method ∫ φ_A dΓ over what faces the primary surface now, if any does.
    pub areas: Vec<f64>,
    /// Over which times, from that of the places on, the rates of the tangents are means of the motion of an obstacle, s:
    /// over the step a point that sticks goes where the obstacle's particle goes, however far that turns. Where both are
    /// the same they are its velocity at that time. It stays until it is set.
    pub span: [f64; 2],
    stencils: Vec<Stencil>,
    /// Stencils of all points and their weights, point after point.
    terms: Vec<(u32, f64)>,
    /// Where the terms of each point begin and end.
    spans: Vec<[u32; 2]>,
    /// Points that face something, ascending, where only those within a reach do ([`Contact::pair_near`](crate::Contact::pair_near)).
    near: Vec<u32>,
    dim: usize,
    work: Work,
}

/// Scratch of the mortar method, and of looks at near points.
#[derive(Clone, Debug, Default)]
struct Work {
    /// What the looks of each group of points have found.
    looks: Vec<Vec<Look>>,
    found: Vec<u32>,
    quadrature: Vec<Quadrature>,
    shares: Vec<Share>,
    merge: Merge,
}

impl Pairing {
    /// Empties the pools and keeps their memory. To be called before the first contact is paired.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.tangents.iter_mut().for_each(Rows::clear);
        self.areas.clear();
        self.stencils.clear();
        self.terms.clear();
        self.spans.clear();
        self.near.clear();
    }

    /// Appends the points of `initial`, paired once at zero displacement, with gaps moved by N u: rows and tangents are those
    /// of the initial configuration, and nothing curves.
    pub fn append_moved(&mut self, initial: &Pairing, u: &[f64]) {
        self.dim = initial.dim;
        self.rows.append_moved(&initial.rows, u);
        for (rows, initial) in self.tangents.iter_mut().zip(&initial.tangents) {
            rows.append(initial);
        }
        self.areas.extend_from_slice(&initial.areas);
        let points = initial.len();
        self.spans.extend(std::iter::repeat_n([0; 2], points));
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of point stencils behind the points: what a pairing costs.
    pub fn stencils(&self) -> usize {
        self.stencils.len()
    }

    /// Adds factor · force · ∂²g/∂u² of a point to a matrix over all unknowns.
    ///
    /// `force` in N, positive in compression. The second derivative is that of the gap in [`Pairing::rows`], exact for
    /// every kind of face, foot inside, on an edge or in a corner, and left out where other nodes carry nodes of the stencil; for the
    /// mortar method with the quadrature points and
    /// their weights held. Panics if the pattern of the matrix lacks the pairs of [`Pairing::cliques`].
    pub fn add_curvature(&self, point: usize, force: f64, factor: f64, matrix: &mut Csr) {
        let terms = self.terms(point).iter();
        let loads = terms.map(|&(stencil, weight)| {
            let stencil = &self.stencils[stencil as usize];
            (stencil, weight * factor * force)
        });
        add_loads(loads, (self.dim, None), matrix);
    }

    /// Adds factor · Σ force · ∂²g/∂u² of some points: the sum of [`Pairing::add_curvature`] over them, each stencil looked
    /// at once however many multipliers share it. `forces`: points and forces in N; `loads`: scratch; `apart`: what couples the two sides is left
    /// out, and so is a side with an unknown that it does not take; the pairs within the faces are all that are needed.
    pub fn add_curvatures(
        &self,
        forces: impl Iterator<Item = (usize, f64)>,
        factor: f64,
        (loads, apart): (&mut Vec<f64>, Option<&dyn Fn(u32) -> bool>),
        matrix: &mut Csr,
    ) {
        loads.clear();
        loads.resize(self.stencils.len(), 0.0);
        for (point, force) in forces {
            for &(stencil, weight) in self.terms(point) {
                loads[stencil as usize] += weight * force;
            }
        }
        let loaded = self.stencils.iter().zip(&*loads);
        let loaded = loaded.filter(|(_, load)| **load != 0.0);
        let loaded = loaded.map(|(stencil, load)| (stencil, factor * load));
        add_loads(loaded, (self.dim, apart), matrix);
    }

    /// Lists of unknowns of which [`Pairing::add_curvature`] of a point fills all pairs: those of each stencil, once for
    /// stencils on the same nodes that follow each other.
    pub fn cliques(&self, point: usize, mut each: impl FnMut(&[u32])) {
        let mut last: Option<&Stencil> = None;
        for &(stencil, _) in self.terms(point) {
            let stencil = &self.stencils[stencil as usize];
            if !stencil.carried && !last.is_some_and(|last| last.is_like(stencil)) {
                let (unknowns, n) = stencil.unknowns(self.dim);
                each(&unknowns[..n]);
            }
            last = Some(stencil);
        }
    }

    /// The edge that a point of an edge faces; none of others.
    pub fn faced(&self, point: usize) -> Option<Faced> {
        let (stencil, _) = self.terms(point).first()?;
        self.stencils[*stencil as usize].faced
    }

    /// Least gap of the places that a point is the mean of, m, offsets left out; infinite of a point that faces nothing.
    pub(crate) fn least_gap(&self, point: usize) -> f64 {
        let terms = self.terms(point).iter();
        let gaps = terms.map(|(stencil, _)| self.stencils[*stencil as usize].gap().0);
        gaps.fold(f64::INFINITY, f64::min)
    }

    fn terms(&self, point: usize) -> &[(u32, f64)] {
        let [begin, end] = self.spans[point].map(|place| place as usize);
        &self.terms[begin..end]
    }

    /// Makes a point, or the one after the last, what one stencil is, standing for `area`; without one it faces nothing.
    fn place(&mut self, places: &Places, (at, area): (usize, f64), stencil: Option<&Stencil>) {
        let begin = self.begin(at, area);
        match stencil {
            Some(stencil) => {
                stencil.place(places, at, &mut self.rows, &mut self.tangents);
                self.terms.push((self.stencils.len() as u32, 1.0));
                self.stencils.push(stencil.clone());
            }
            None => self.open(at),
        }
        self.spans[at] = [begin, self.terms.len() as u32];
    }

    /// Makes a point, or the one after the last, the mean of stencils with the given weights, standing for their sum. Where that is
    /// not above `least` the point faces nothing, and stands for `area`.
    fn place_sum(
        &mut self,
        places: &Places,
        (at, area, least): (usize, f64, f64),
        shares: &[Share],
        merge: &mut Merge,
    ) {
        let total: f64 = shares.iter().map(|share| share.weight).sum();
        let begin = self.begin(at, if total > least { total } else { area });
        if total > least {
            merge.clear();
            for share in shares {
                let weight = share.weight / total;
                merge.add(&self.stencils[share.stencil as usize], weight, self.dim);
                self.terms.push((share.stencil, weight));
            }
            merge.place(places, at, &mut self.rows, &mut self.tangents);
        } else {
            self.open(at);
        }
        self.spans[at] = [begin, self.terms.len() as u32];
    }

    fn begin(&mut self, at: usize, area: f64) -> u32 {
        if at == self.areas.len() {
            self.areas.push(area);
            self.spans.push([0; 2]);
        }
        self.areas[at] = area;
        self.terms.len() as u32
    }

    /// Lets a point, or the one after the last, face nothing.
    fn open(&mut self, at: usize) {
        self.rows.open(at);
        for tangent in &mut self.tangents[..self.dim - 1] {
            tangent.open(at);
        }
    }
}

/// Adds the curvature of stencils times their loads; those that follow each other on the same nodes make one block.
fn add_loads<'a>(
    loads: impl Iterator<Item = (&'a Stencil, f64)>,
    (dim, apart): (usize, Option<&dyn Fn(u32) -> bool>),
    matrix: &mut Csr,
) {
    let mut block = Block::new(dim);
    let mut add = |block: &Block, first: &Stencil| {
        let (unknowns, n) = first.unknowns(dim);
        match apart {
            Some(takes) => {
                let own = first.carriers().count();
                block.add_sides_to((&unknowns[..n], own), takes, matrix);
            }
            None => block.add_to(&unknowns[..n], matrix),
        }
    };
    let mut first: Option<&Stencil> = None;
    // those of carried nodes are left to the iteration: they turn with the rotation too
    for (stencil, load) in loads.filter(|(stencil, _)| !stencil.carried) {
        if !first.is_some_and(|first| first.is_like(stencil)) {
            if let Some(first) = first {
                add(&block, first);
            }
            block.clear(stencil.relative().count());
            first = Some(stencil);
        }
        stencil.add_curvature(load, &mut block);
    }
    if let Some(first) = first {
        add(&block, first);
    }
}
