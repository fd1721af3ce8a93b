//! Rows of links that turn with their nodes: between places and directors.
//!
//! A row of an overlap of beams or shells with finite rotations and a solid is
//!
//! `h = Σ_n (D a_n)·(x_n - x_A) + Σ_B Σ_ac G_ac d_a·d_cᴮ = h in the reference position`
//!
//! with places x, directors d_cᴮ, the columns of the rotation of node B, and D the rotation of the node A of the mediator, whose directors are d_a: in the frame of A places and
//! directors of the others are linear. Σ a_n is zero. The own node's part of G does not change. In the reference position the row has the coefficients of the linear one.
//!
//! Of shells G is [given](carom_arlequin::Row::axes). Of beams it follows from the linear rows: with `x = Σ N_B (x_B + R_B P_B)` and
//! `T = ∫ N_A ζ ⊗ P_B` rotations have the coefficients `J = tr T - Tᵀ` in rows of moments, so `T = tr J/2 - Jᵀ`, and `G = ê_j T`.
//!
//! h is linear in each of the factors of its products, so that `h₊ - h` is the row at the means of places and directors times the change of both, which forces along the row over the step need
//! to do no work; and h does not change where all turn, so that these forces have no moment.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::{Kind, Unknowns};
use carom_arlequin::{AxisProducts, Row};
use carom_bodies::balanced;

use crate::error::Error;
use crate::link_row::LinkRow;
use crate::model::ModelLink;

/// Where rows are taken.
#[derive(Clone, Copy, Debug)]
pub struct Turned<'a> {
    /// Rotations at the start of the step.
    pub frames: &'a [Rotation],
    /// Displacement, m; of rotations the increment since the start of the step.
    pub u: &'a [f64],
    /// The displacement at the start of the step, where rows belong to the way between both.
    pub from: Option<&'a [f64]>,
}

/// Rows that turn.
#[derive(Debug, Default)]
pub struct TurningRows {
    rows: Vec<Turning>,
    x: Vec<[f64; 3]>,
}

#[derive(Debug)]
struct Turning {
    /// Number among the rows of the links.
    row: usize,
    /// The node of the mediator.
    lead: u32,
    /// Nodes with a.
    places: Vec<(u32, Vec3)>,
    /// Nodes with G.
    directors: Vec<(u32, Mat3)>,
    /// h in the reference position.
    reference: f64,
    /// Unknowns, and what they are.
    terms: Vec<(u32, Source)>,
}

#[derive(Clone, Copy, Debug)]
enum Source {
    Place(usize, usize),
    Director(usize, usize),
    Lead(usize),
}

/// A node's part of a row: of its translations and of its rotations.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    place: Vec3,
    turn: Vec3,
    turns: bool,
}

/// The parts of a row by node, in the order of its terms, and how many are inner ones.
type Parts = (Vec<(u32, Part)>, usize);

impl TurningRows {
    /// Appends a link to the rows, if nodes of it have frames; how many terms of each of its rows are inner ones. `first`: number of its first row.
    ///
    /// # Errors
    /// A mediator without all rows of a node.
    pub fn add(
        &mut self,
        link: &ModelLink,
        (number, unknowns, x): (&[u32], &Unknowns, &[[f64; 3]]),
        rows: &mut Vec<LinkRow>,
    ) -> Result<Option<Vec<usize>>, Error> {
        let dim = unknowns.dim();
        let turns = |node: u32| unknowns.frame(number[node as usize]).is_some();
        if !link.has_arms(dim, &turns) {
            return Ok(None);
        }
        self.x = x.to_vec();
        let mut groups: BTreeMap<u32, BTreeMap<u32, &Row>> = BTreeMap::new();
        for row in &link.rows {
            groups
                .entry(row.node)
                .or_default()
                .insert(row.component, row);
        }
        let modes = if dim == 2 { 3 } else { 6 };
        let mut inner = Vec::new();
        for (node, group) in groups {
            let given = group.values().any(|row| !row.axes.is_empty());
            if !given && group.len() != modes {
                return Err(Error::TurningRows {
                    link: link.name.clone(),
                    node,
                });
            }
            let parts = group.values().map(|row| parts(row, (number, unknowns)));
            let parts: Vec<Parts> = parts.collect();
            for (k, row) in group.values().enumerate() {
                let directors = match row.component as usize {
                    _ if given => of_products(&row.axes, number),
                    component if component < dim => of_place(&parts, component, dim),
                    component => of_moment(&parts, component - dim, dim),
                };
                let mut made = Turning {
                    row: rows.len(),
                    lead: number[node as usize],
                    places: parts[k]
                        .0
                        .iter()
                        .map(|(n, part)| (*n, part.place))
                        .collect(),
                    directors,
                    reference: 0.0,
                    terms: Vec::new(),
                };
                inner.push(made.find_terms(&parts[k], unknowns));
                let rest = Turned {
                    frames: &[],
                    u: &[],
                    from: None,
                };
                made.reference = made.value(&rest, (unknowns, x));
                let mut row = LinkRow::new();
                made.coefficients(&rest, (unknowns, x), &mut row);
                rows.push(row);
                self.rows.push(made);
            }
        }
        Ok(Some(inner))
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Number of the first row.
    pub(crate) fn first(&self) -> Option<usize> {
        self.rows.first().map(|turning| turning.row)
    }

    /// Writes the coefficients of the rows: what moves h, and the forces of a unit multiplier, of rotations as moments about the axes in which they balance.
    pub fn coefficients(&self, unknowns: &Unknowns, at: &Turned, rows: &mut [LinkRow]) {
        for turning in &self.rows {
            turning.coefficients(at, (unknowns, &self.x), &mut rows[turning.row]);
        }
    }

    /// Number and h of each row.
    pub fn values<'a>(
        &'a self,
        unknowns: &'a Unknowns,
        at: &'a Turned<'a>,
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let value = |turning: &'a Turning| {
            let h = turning.value(at, (unknowns, &self.x)) - turning.reference;
            (turning.row, h)
        };
        self.rows.iter().map(value)
    }

    /// Number of each row and what of ḧ the velocities `v` give by themselves.
    pub fn centripetal<'a>(
        &'a self,
        unknowns: &'a Unknowns,
        at: &'a Turned<'a>,
        v: &'a [f64],
    ) -> impl Iterator<Item = (usize, f64)> + 'a {
        let of = move |turning: &'a Turning| {
            (turning.row, turning.centripetal(at, (unknowns, &self.x), v))
        };
        self.rows.iter().map(of)
    }
}

/// The parts of a row by node.
fn parts(row: &Row, (number, unknowns): (&[u32], &Unknowns)) -> Parts {
    let dim = unknowns.dim();
    let mut parts: Vec<(u32, Part)> = Vec::new();
    let mut inner = 0;
    for (terms, sign) in [(&row.inner, 1.0), (&row.outer, -1.0)] {
        let from = parts.len();
        for term in terms {
            let node = number[term.node as usize];
            let known = parts[from..].iter().position(|(own, _)| *own == node);
            let place = known.map_or(parts.len(), |place| from + place);
            if known.is_none() {
                parts.push((node, Part::default()));
            }
            let part = &mut parts[place].1;
            let value = sign * term.coefficient;
            match term.component as usize {
                k if k < dim => part.place[k] += value,
                _ if dim == 2 => (part.turn.z, part.turns) = (part.turn.z + value, true),
                k => (part.turn[k - dim], part.turns) = (part.turn[k - dim] + value, true),
            }
        }
        if sign > 0.0 {
            inner = parts.len();
        }
    }
    (parts, inner)
}

/// What the rotations of a node do in a row.
fn turn_of(parts: &Parts, node: u32) -> Vec3 {
    let mut all = parts.0.iter();
    all.find(|(own, _)| *own == node)
        .map_or(Vec3::zeros(), |(_, part)| part.turn)
}

/// Nodes with rotations in some rows.
fn turned(rows: &[Parts]) -> Vec<u32> {
    let all = rows.iter().flat_map(|(parts, _)| parts);
    let mut nodes: Vec<u32> = all
        .filter(|(_, part)| part.turns)
        .map(|(n, _)| *n)
        .collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// G as it is given.
fn of_products(axes: &[AxisProducts], number: &[u32]) -> Vec<(u32, Mat3)> {
    let of = |own: &AxisProducts| {
        let g = Mat3::from_fn(|a, c| own.factors[a][c]);
        (number[own.node as usize], g)
    };
    axes.iter().map(of).collect()
}

/// G of the row of a place: the row of axis i is p × e_i on the rotations of a node with the arm p.
fn of_place(parts: &[Parts], axis: usize, dim: usize) -> Vec<(u32, Mat3)> {
    let arm = |node: u32| {
        let [x, y] = [0, 1].map(|i| turn_of(&parts[i], node));
        let p = Vec3::new(y.z, -x.z, if dim == 2 { 0.0 } else { x.y });
        let mut g = Mat3::zeros();
        g.set_row(axis, &p.transpose());
        (node, g)
    };
    turned(&parts[..dim]).into_iter().map(arm).collect()
}

/// G of the row of a moment.
fn of_moment(parts: &[Parts], row: usize, dim: usize) -> Vec<(u32, Mat3)> {
    let moments = &parts[dim..];
    let of = |node: u32| {
        let (t, axis) = match dim {
            2 => {
                let half = 0.5 * turn_of(&moments[0], node).z;
                (Mat3::from_diagonal(&Vec3::new(half, half, 0.0)), 2)
            }
            _ => {
                let rows = [0, 1, 2].map(|j| turn_of(&moments[j], node).transpose());
                let j = Mat3::from_rows(&rows);
                (Mat3::identity() * (0.5 * j.trace()) - j.transpose(), row)
            }
        };
        let mut axis_vector = Vec3::zeros();
        axis_vector[axis] = 1.0;
        (node, axis_vector.cross_matrix() * t)
    };
    turned(moments).into_iter().map(of).collect()
}

/// Rotation of a node, or its mean over the step.
fn matrix(node: u32, unknowns: &Unknowns, at: &Turned) -> Mat3 {
    if at.u.is_empty() {
        return Mat3::identity();
    }
    let start = start_of(node, unknowns, at).matrix();
    let turned = |u: &[f64]| Rotation::cayley(&unknowns.spin(node, u).into()).matrix();
    match at.from {
        None => start * turned(at.u),
        Some(from) => start * (turned(at.u) + turned(from)) * 0.5,
    }
}

fn start_of(node: u32, unknowns: &Unknowns, at: &Turned) -> Rotation {
    let frame = unknowns.frame(node);
    let frame = frame.and_then(|frame| at.frames.get(frame));
    frame.copied().unwrap_or_default()
}

/// Displacement of a node, or its mean over the step.
fn moved(node: u32, unknowns: &Unknowns, at: &Turned) -> Vec3 {
    if at.u.is_empty() {
        return Vec3::zeros();
    }
    let now = Vec3::from(unknowns.vector(node, at.u));
    match at.from {
        None => now,
        Some(from) => (now + Vec3::from(unknowns.vector(node, from))) * 0.5,
    }
}

impl Turning {
    /// Takes the own node from G, and lists the unknowns in the order of the parts; how many are inner ones.
    fn find_terms(&mut self, (parts, inner): &Parts, unknowns: &Unknowns) -> usize {
        self.directors.retain(|(node, _)| *node != self.lead);
        let mut count = 0;
        for (k, (node, _)) in parts.iter().enumerate() {
            for (i, unknown) in unknowns.translations_of(*node).enumerate() {
                self.terms.push((unknown as u32, Source::Place(k, i)));
            }
            let of_director = self.directors.iter().position(|(own, _)| own == node);
            for unknown in unknowns.rotations_of(*node) {
                let Kind::Rotation(axis) = unknowns.kind(unknown) else {
                    continue;
                };
                let source = match (self.lead == *node, of_director) {
                    (true, _) => Source::Lead(axis),
                    (false, Some(place)) => Source::Director(place, axis),
                    (false, None) => continue,
                };
                self.terms.push((unknown as u32, source));
            }
            if k + 1 == *inner {
                count = self.terms.len();
            }
        }
        count
    }

    /// From the node of the mediator to a node.
    fn arm(&self, node: u32, (unknowns, x): (&Unknowns, &[[f64; 3]]), at: &Turned) -> Vec3 {
        let place = |node: u32| Vec3::from(x[node as usize]) + moved(node, unknowns, at);
        place(node) - place(self.lead)
    }

    fn value(&self, at: &Turned, (unknowns, x): (&Unknowns, &[[f64; 3]])) -> f64 {
        let d = matrix(self.lead, unknowns, at);
        let places = self.places.iter();
        let places = places.map(|(node, a)| (d * a).dot(&self.arm(*node, (unknowns, x), at)));
        let directors = self.directors.iter();
        let directors = directors.map(|(node, g)| d.tr_mul(&matrix(*node, unknowns, at)).dot(g));
        places.sum::<f64>() + directors.sum::<f64>()
    }

    fn coefficients(
        &self,
        at: &Turned,
        (unknowns, x): (&Unknowns, &[[f64; 3]]),
        row: &mut LinkRow,
    ) {
        let d = matrix(self.lead, unknowns, at);
        let balance = |node: u32, moment: &Vec3| -> Vec3 {
            if at.u.is_empty() {
                return *moment;
            }
            let increment = unknowns.spin(node, at.u).into();
            let moment = start_of(node, unknowns, at).matrix().tr_mul(moment);
            balanced(&moment, &increment, at.from.is_some())
        };
        let mut lead = Vec3::zeros();
        let mut turns = Vec::with_capacity(self.directors.len());
        for (node, g) in &self.directors {
            let own = matrix(*node, unknowns, at);
            // Σ G_ac d_a × d_cᴮ
            let pull = own * g.transpose();
            let moment = (0..3).fold(Vec3::zeros(), |sum, a| {
                sum + d.column(a).cross(&pull.column(a))
            });
            lead += moment;
            turns.push(balance(*node, &-moment));
        }
        for (node, a) in &self.places {
            lead += (d * a).cross(&self.arm(*node, (unknowns, x), at));
        }
        let lead = balance(self.lead, &lead);
        row.clear();
        row.extend(self.terms.iter().map(|&(unknown, source)| {
            let c = match source {
                Source::Place(k, axis) => (d.row(axis) * self.places[k].1).x,
                Source::Director(k, axis) => turns[k][axis],
                Source::Lead(axis) => lead[axis],
            };
            (unknown, c)
        }));
    }

    fn centripetal(&self, at: &Turned, (unknowns, x): (&Unknowns, &[[f64; 3]]), v: &[f64]) -> f64 {
        let spin = |node: u32| -> (Mat3, Vec3) {
            let own = matrix(node, unknowns, at);
            (own, own * Vec3::from(unknowns.spin(node, v)))
        };
        let (d, w) = spin(self.lead);
        let turn = w.cross_matrix();
        let rate = |node: u32| Vec3::from(unknowns.vector(node, v));
        let origin = rate(self.lead);
        let mut sum = 0.0;
        for (node, a) in &self.places {
            let a = d * a;
            let arm = self.arm(*node, (unknowns, x), at);
            sum += 2.0 * (turn * a).dot(&(rate(*node) - origin)) + (turn * turn * a).dot(&arm);
        }
        for (node, g) in &self.directors {
            let (own, w) = spin(*node);
            let other = w.cross_matrix();
            let second = (turn * turn * d).tr_mul(&own)
                + (turn * d).tr_mul(&(other * own)) * 2.0
                + d.tr_mul(&(other * other * own));
            sum += second.dot(g);
        }
        sum
    }
}
