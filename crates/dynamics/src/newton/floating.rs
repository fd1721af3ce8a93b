//! Parts that supports leave free in a static stage, and that contacts may hold.
//!
//! Their stiffness is singular. The matrix of the iterations has a proximal term on them,
//!
//! `A = K + σ |diag K|`, about the last iterate: it acts on the motion of the iteration, not on x,
//!
//! so that where the iterations end nothing of it is left: the balance of forces is tested without it. It is a small part
//! of the stiffness with which contacts hold the part, and iterations shrink errors by about that ratio; a motion that
//! nothing holds and nothing loads stays as it is. What is loaded along such a motion is moved on to the next contact;
//! where none is on its way there is no equilibrium near, and the body and its motion are named. Held is what a support
//! or the row of a contact that carries a force holds: a place at the bottom of a bowl is not searched.
//!
//! The proximal point algorithm: R. T. Rockafellar (1976), SIAM J. Control Optim. 14; here one Newton iteration to each of its.

use std::ops::Range;

use carom_contact::{Rows, Target};

use super::Newton;
use crate::coulomb::Slip;
use crate::error::Error;
use crate::system::System;

/// σ, unless the matrix asks for more.
pub(super) const WEIGHT: f64 = 1e-6;

/// Factor by which σ grows where the matrix is not positive definite: a body under pressure has negative stiffness in turns.
pub(super) const GROWTH: f64 = 8.0;

/// Largest σ.
pub(super) const LARGEST: f64 = 1.0;

/// Largest turn on the way to a contact, rad: places move along straight lines.
const TURN: f64 = 0.1;

/// What of a unit vector counts as independent of others.
const INDEPENDENT: f64 = 1e-6;

/// Parts that float, and σ in the attempt under way.
pub(super) struct Floating {
    /// Their unknowns, ascending.
    pub(super) parts: Vec<Range<usize>>,
    pub(super) weight: f64,
}

impl Floating {
    /// The parts of a static stage that supports leave free to move.
    ///
    /// # Errors
    /// One that no contact with anything else could hold.
    pub(super) fn new(system: &System) -> Result<Floating, Error> {
        let mut floating = Floating {
            parts: Vec::new(),
            weight: WEIGHT,
        };
        if system.nonlinear.preload.is_none() {
            return Ok(floating);
        }
        for part in &system.parts {
            let parts = [part.clone()];
            let rigid = Rigid::new(system, &parts, None);
            let Some(motion) = rigid.free_motion() else {
                continue;
            };
            if !touches(system, part) {
                return Err(Error::FreeMotion {
                    body: body_of(system, part),
                    motion: motion.to_string(),
                });
            }
            floating.parts.push(part.clone());
        }
        Ok(floating)
    }
}

/// Whether a contact has the part on one side and something else on the other.
fn touches(system: &System, part: &Range<usize>) -> bool {
    let inside = |node: u32| part.contains(&(system.dim * node as usize));
    system.contacts.iter().any(|contact| {
        let nodes = contact.points.iter().flat_map(|point| point.carriers());
        let own: Vec<bool> = nodes.map(|(node, _)| inside(node)).collect();
        let (some, others) = (own.contains(&true), own.contains(&false));
        match &contact.target {
            Target::Rigid(_) => some,
            Target::Surface(faces) => {
                let opposite = faces.iter().flat_map(|face| face.corners());
                let opposite: Vec<bool> = opposite.map(|&node| inside(node)).collect();
                some && opposite.contains(&false) || others && opposite.contains(&true)
            }
        }
    })
}

/// Name of the body at the first node of a part.
fn body_of(system: &System, part: &Range<usize>) -> String {
    let first = (part.start / system.dim) as u32;
    let owns = |masses: &Vec<(u32, f64)>| masses.iter().any(|(node, _)| *node == first);
    let body = system.body_masses.iter().position(owns).unwrap_or(0);
    system.bodies[body].name().to_string()
}

impl Newton {
    /// Whether parts float in the attempt under way.
    pub(super) fn floats(&self) -> bool {
        self.map.inertia.x == 0.0 && !self.floating.parts.is_empty()
    }

    /// Moves parts that are loaded along a rigid motion that nothing holds to the next contact on their way; whether that was
    /// any way at all. `scale`: the forces of the balance, N.
    ///
    /// # Errors
    /// No contact on the way; forces that cannot be taken where it ends.
    pub(super) fn approach(&mut self, scale: f64) -> Result<bool, Error> {
        let map = &self.map;
        let (motion, x) = (&self.state.motion, &self.vectors.x);
        let mut place = std::mem::take(&mut self.vectors.place);
        map.displacement.whole(motion, x, &[], &mut place);
        let rigid = Rigid::new(&self.system, &self.floating.parts, Some(&place));
        self.vectors.place = place;
        let held = self.held(&rigid);
        let vectors = &self.vectors;
        let left = (0..x.len()).filter(|&i| !self.system.fixed[i]);
        let mut c = rigid.of(left.map(|i| (i, vectors.residual[i] + vectors.contact[i])));
        held.take_from(&mut c);
        let least = (self.system.nonlinear.iteration.tolerance * scale).max(self.rounding());
        if norm(&c) <= least {
            return Ok(false);
        }
        let Some(way) = self.way_to_contact(&rigid, &c) else {
            let (part, motion) = rigid.name(&c);
            return Err(Error::Unheld {
                step: self.state.step + 1,
                time: self.state.time + self.dt,
                body: body_of(&self.system, part),
                motion: motion.to_string(),
            });
        };
        let way = way.min(TURN / rigid.turn(&c).max(f64::MIN_POSITIVE));
        if way * norm(&c) <= self.gap_tolerance() {
            return Ok(false);
        }
        let moved: Vec<(usize, f64)> = rigid.motion(&c).collect();
        for (i, u) in moved {
            if !self.system.fixed[i] {
                self.vectors.x[i] += way * u;
            }
        }
        self.evaluate(false)?;
        self.pair(false);
        Ok(true)
    }

    /// What supports and contacts that carry a force hold of the rigid motions.
    fn held(&self, rigid: &Rigid) -> Span {
        let mut held = Span::default();
        for i in self.floating.parts.iter().flat_map(Range::clone) {
            if self.system.fixed[i] {
                held.add(rigid.of([(i, 1.0)]));
            }
        }
        let tangents = &self.pairing.tangents[..self.system.tangents()];
        for point in self.carrying() {
            held.add(rigid.row(&self.pairing.rows, point));
            if self.slips.get(point) == Some(&Slip::Stick) {
                for rows in tangents {
                    held.add(rigid.row(rows, point));
                }
            }
        }
        held
    }

    /// Points that carry a force.
    fn carrying(&self) -> impl Iterator<Item = usize> + '_ {
        let forces = self.next.interface.force.iter().enumerate();
        forces
            .filter(|(_, force)| **force != 0.0)
            .map(|(point, _)| point)
    }

    /// Multiple of a rigid motion at which the first of the open points closes; none where none comes closer.
    fn way_to_contact(&self, rigid: &Rigid, c: &[f64]) -> Option<f64> {
        let mut way: Option<f64> = None;
        for point in 0..self.system.points() {
            if self.next.interface.force[point] != 0.0 || self.pairing.rows.gap(point).is_infinite()
            {
                continue;
            }
            let row = rigid.row(&self.pairing.rows, point);
            let rate: f64 = row.iter().zip(c).map(|(n, c)| n * c).sum();
            if rate < -INDEPENDENT * norm(&row) * norm(c) {
                let until = self.now(point).0.max(0.0) / -rate;
                way = Some(way.map_or(until, |way| way.min(until)));
            }
        }
        way
    }
}

/// Rigid motions of parts: u = Σ c_j r_j, those of a part one after the other.
struct Rigid<'a> {
    system: &'a System,
    parts: &'a [Range<usize>],
    modes: Vec<Mode>,
    frames: Vec<Frame>,
    /// Places of the nodes, m.
    places: Vec<[f64; 3]>,
}

/// What scales the motions of a part.
struct Frame {
    centre: [f64; 3],
    /// Largest distance of a node from the centre along an axis, m.
    size: f64,
    /// 1/√n, n nodes: motions have the norm of about one.
    unit: f64,
}

impl<'a> Rigid<'a> {
    /// `u`: displacement of the nodes, m, of bodies at finite strain; a linear body has the rigid motions of its reference
    /// places.
    fn new(system: &'a System, parts: &'a [Range<usize>], u: Option<&[f64]>) -> Rigid<'a> {
        let dim = system.dim;
        let mut places = system.x.clone();
        for (body, masses) in system.bodies.iter().zip(&system.body_masses) {
            let Some(u) = u.filter(|_| !body.is_linear()) else {
                continue;
            };
            for &(node, _) in masses {
                let node = node as usize;
                for i in 0..dim {
                    places[node][i] = system.x[node][i] + u[dim * node + i];
                }
            }
        }
        let frames = parts.iter().map(|part| {
            let nodes = &places[part.start / dim..part.end / dim];
            let n = nodes.len() as f64;
            let centre = [0, 1, 2].map(|i| nodes.iter().map(|x| x[i]).sum::<f64>() / n);
            let far = |x: &[f64; 3]| (0..3).map(|i| (x[i] - centre[i]).abs()).fold(0.0, f64::max);
            Frame {
                centre,
                size: nodes.iter().map(far).fold(f64::MIN_POSITIVE, f64::max),
                unit: 1.0 / n.sqrt(),
            }
        });
        Rigid {
            system,
            parts,
            modes: modes(dim, system.axisymmetric),
            frames: frames.collect(),
            places,
        }
    }

    /// Number of the first coordinate that moves an unknown and the values of the motions of its part there; none of a part
    /// that does not float.
    fn at(&self, unknown: usize) -> Option<(usize, impl Iterator<Item = f64> + '_)> {
        let part = self.parts.partition_point(|part| part.end <= unknown);
        if !self.parts.get(part)?.contains(&unknown) {
            return None;
        }
        let frame = &self.frames[part];
        let (node, i) = (unknown / self.system.dim, unknown % self.system.dim);
        let place = &self.places[node];
        let x = [0, 1, 2].map(|j| (place[j] - frame.centre[j]) / frame.size);
        let values = self
            .modes
            .iter()
            .map(move |mode| frame.unit * mode.1(&x)[i]);
        Some((part * self.modes.len(), values))
    }

    /// Σ f_i r_j(i) by coordinate j of unknowns i and their values f.
    fn of(&self, terms: impl IntoIterator<Item = (usize, f64)>) -> Vec<f64> {
        let mut sums = vec![0.0; self.parts.len() * self.modes.len()];
        for (unknown, f) in terms {
            if let Some((first, values)) = self.at(unknown) {
                for (sum, value) in sums[first..].iter_mut().zip(values) {
                    *sum += f * value;
                }
            }
        }
        sums
    }

    /// A row of contact on the motions.
    fn row(&self, rows: &Rows, point: usize) -> Vec<f64> {
        let (unknowns, coefficients) = rows.row(point);
        let unknowns = unknowns.iter().map(|&unknown| unknown as usize);
        self.of(unknowns.zip(coefficients.iter().copied()))
    }

    /// Unknowns and their displacements in a motion.
    fn motion(&self, c: &[f64]) -> impl Iterator<Item = (usize, f64)> + '_ {
        let c = c.to_vec();
        let unknowns = self.parts.iter().flat_map(Range::clone);
        unknowns.filter_map(move |unknown| {
            let (first, values) = self.at(unknown)?;
            Some((unknown, values.zip(&c[first..]).map(|(v, c)| v * c).sum()))
        })
    }

    /// Largest turn in a motion, rad.
    fn turn(&self, c: &[f64]) -> f64 {
        let count = self.modes.len();
        let turns = c.iter().enumerate().map(|(j, c)| {
            let (frame, (_, shape)) = (&self.frames[j / count], self.modes[j % count]);
            // a turn leaves the centre where it is
            match shape(&[0.0; 3]) == [0.0; 3] {
                true => c.abs() * frame.unit / frame.size,
                false => 0.0,
            }
        });
        turns.fold(0.0, f64::max)
    }

    /// The part that moves most, and how.
    fn name(&self, c: &[f64]) -> (&Range<usize>, &'static str) {
        let most = (0..c.len()).fold(0, |most, j| match c[j].abs() > c[most].abs() {
            true => j,
            false => most,
        });
        let count = self.modes.len();
        (&self.parts[most / count], self.modes[most % count].0)
    }

    /// The first of the motions that supports do not hold, with those before it held.
    fn free_motion(&self) -> Option<&'static str> {
        let mut held = Span::default();
        for i in self.parts.iter().flat_map(Range::clone) {
            if self.system.fixed[i] {
                held.add(self.of([(i, 1.0)]));
            }
        }
        let mut modes = self.modes.iter().enumerate();
        modes.find_map(|(j, mode)| {
            let mut unit = vec![0.0; self.modes.len()];
            unit[j] = 1.0;
            held.add(unit).then_some(mode.0)
        })
    }
}

/// An orthonormal basis of what vectors span.
#[derive(Default)]
struct Span(Vec<Vec<f64>>);

impl Span {
    /// Adds a vector; whether it is independent of those before it.
    fn add(&mut self, mut vector: Vec<f64>) -> bool {
        let length = norm(&vector);
        if self.0.len() == vector.len() || length == 0.0 {
            return false;
        }
        vector.iter_mut().for_each(|v| *v /= length);
        self.take_from(&mut vector);
        let length = norm(&vector);
        if length <= INDEPENDENT {
            return false;
        }
        vector.iter_mut().for_each(|v| *v /= length);
        self.0.push(vector);
        true
    }

    /// Takes from a vector its part in the span: twice, for what rounding leaves the first time.
    fn take_from(&self, vector: &mut [f64]) {
        for _ in 0..2 {
            for e in &self.0 {
                let part: f64 = e.iter().zip(&*vector).map(|(e, v)| e * v).sum();
                for (v, e) in vector.iter_mut().zip(e) {
                    *v -= part * e;
                }
            }
        }
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// A motion in words, and its displacement at a place relative to the centre.
type Mode = (&'static str, fn(&[f64; 3]) -> [f64; 3]);

fn modes(dim: usize, axisymmetric: bool) -> Vec<Mode> {
    if axisymmetric {
        return vec![("move along its axis", |_| [0.0, 1.0, 0.0])];
    }
    let mut modes: Vec<Mode> = vec![("move along x", |_| [1.0, 0.0, 0.0])];
    if dim > 1 {
        modes.push(("move along y", |_| [0.0, 1.0, 0.0]));
    }
    if dim > 2 {
        modes.push(("move along z", |_| [0.0, 0.0, 1.0]));
        modes.push(("turn about x", |x| [0.0, -x[2], x[1]]));
        modes.push(("turn about y", |x| [x[2], 0.0, -x[0]]));
    }
    if dim > 1 {
        modes.push(("turn about z", |x| [-x[1], x[0], 0.0]));
    }
    modes
}
