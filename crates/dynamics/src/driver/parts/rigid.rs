//! Rigid motions of pieces, and what vectors span in them.
//!
//! A motion of the iterations is linear in its coordinates; a turn by a finite angle is not, and its linear motion stretches the
//! body by θ²/2. What is missing is added: `u = (exp(θ×) - 1 - θ×) d`, d from the centre of the piece.

use std::collections::BTreeMap;
use std::ops::Range;

use carom_algebra::basis::Amplitude;
use carom_algebra::rotation::Rotation;
use carom_algebra::tensor::{Mat3, Vec3};
use carom_algebra::unknowns::Kind;
use carom_bodies::{Body, Reduced};
use carom_contact::Rows;

use super::pieces::{Piece, Pieces};
use crate::system::System;

/// What of a unit vector counts as independent of others.
pub(crate) const INDEPENDENT: f64 = 1e-6;

/// What is left of the sum of terms that cancel, over the sum of their magnitudes.
pub(crate) const ROUNDING: f64 = 1e-12;

/// Rigid motions of pieces: u = Σ c_j r_j, those of a piece one after the other.
pub(crate) struct Rigid<'a> {
    system: &'a System,
    pieces: &'a Pieces,
    modes: Vec<Mode>,
    frames: Vec<Frame>,
    /// Places of the nodes, m.
    places: Vec<[f64; 3]>,
    /// The amplitudes of reduced bodies, by unknown.
    amplitudes: BTreeMap<usize, &'a Amplitude>,
    /// Rotations of the nodes of rigid bodies where their turns are among the motions.
    turned: BTreeMap<u32, Mat3>,
}

/// What scales the motions of a piece.
struct Frame {
    centre: [f64; 3],
    /// Largest distance of a node from the centre along an axis, m.
    size: f64,
    /// 1/√n, n nodes: motions have the norm of about one.
    unit: f64,
    /// Σ r_j² over its unknowns, motion by motion.
    squares: Vec<f64>,
}

impl Frame {
    /// The value of a motion at a translation or a small rotation of a node at a place.
    fn value(&self, mode: &Mode, (place, kind): (&[f64; 3], Kind)) -> f64 {
        match kind {
            Kind::Translation(axis) => {
                let x = [0, 1, 2].map(|j| (place[j] - self.centre[j]) / self.size);
                self.unit * mode.1(&x)[axis]
            }
            Kind::Rotation(axis) => self.unit / self.size * turn_of(mode)[axis],
            Kind::Amplitude(_) => 0.0,
        }
    }
}

impl<'a> Rigid<'a> {
    /// `u`: displacement of the nodes, m, of bodies at finite strain; one at small strain has the rigid motions of its reference
    /// places. `frames`: rotations at the start of the step, where the turns of rigid bodies are among the motions.
    pub(crate) fn new(
        system: &'a System,
        pieces: &'a Pieces,
        (u, frames): (&[f64], Option<&[Rotation]>),
    ) -> Rigid<'a> {
        let dim = system.dim;
        let turned = frames.map_or(BTreeMap::new(), |frames| rotations(system, frames, u));
        let mut places = system.x.clone();
        for (body, masses) in system.bodies.iter().zip(&system.body_masses) {
            if !body.has_finite_motion() {
                continue;
            }
            for &(node, _) in masses {
                let moved = system.unknowns.vector(node, u);
                for (place, u) in places[node as usize].iter_mut().zip(moved) {
                    *place += u;
                }
            }
        }
        for piece in pieces.iter().filter(|_| !turned.is_empty()) {
            for &node in &piece.nodes {
                let Some(carrier) = system.unknowns.carrier(node) else {
                    continue;
                };
                if let Some(turn) = turned.get(&carrier.node) {
                    let arm = turn * Vec3::from(carrier.arm);
                    let centre = places[carrier.node as usize];
                    places[node as usize] = [0, 1, 2].map(|i| centre[i] + arm[i]);
                }
            }
        }
        let frames = pieces.iter().map(|piece| {
            let nodes = || piece.nodes.iter().map(|&node| &places[node as usize]);
            let n = piece.nodes.len() as f64;
            let centre = [0, 1, 2].map(|i| nodes().map(|x| x[i]).sum::<f64>() / n);
            let far = |x: &[f64; 3]| (0..3).map(|i| (x[i] - centre[i]).abs()).fold(0.0, f64::max);
            let size = nodes().map(far).fold(0.0, f64::max);
            Frame {
                centre,
                // the turns of a single node have no length to be measured by
                size: if size > 0.0 { size } else { 1.0 },
                unit: 1.0 / n.sqrt(),
                squares: Vec::new(),
            }
        });
        let mut rigid = Rigid {
            system,
            pieces,
            modes: modes(dim, system.axisymmetric),
            frames: frames.collect(),
            places,
            amplitudes: system.unknowns.amplitudes().collect(),
            turned,
        };
        for (k, piece) in pieces.iter().enumerate() {
            let mut squares = vec![0.0; rigid.modes.len()];
            let unknowns = piece.unknowns.iter();
            for (_, values) in unknowns.filter_map(|&unknown| rigid.at(unknown)) {
                for (square, value) in squares.iter_mut().zip(values) {
                    *square += value * value;
                }
            }
            rigid.frames[k].squares = squares;
        }
        rigid
    }

    /// Number of the first coordinate that moves an unknown and the values of the motions of its piece there; none of an unknown in no
    /// piece.
    fn at(&self, unknown: usize) -> Option<(usize, impl Iterator<Item = f64> + '_)> {
        let piece = self.pieces.of(unknown)?;
        let frame = &self.frames[piece];
        let unknowns = &self.system.unknowns;
        let node = unknowns.node(unknown);
        let kind = unknowns.kind(unknown);
        let (mut amplitude, mut about) = (None, None);
        match kind {
            // a turn about an axis of the node; finite rotations of others are not linear in the coordinates
            Kind::Rotation(axis) if unknowns.frame(node).is_some() => {
                about = Some(self.turned.get(&node)?.column(axis));
            }
            Kind::Translation(_) | Kind::Rotation(_) => {}
            Kind::Amplitude(_) => amplitude = Some(*self.amplitudes.get(&unknown)?),
        }
        let place = &self.places[node as usize];
        let values = self.modes.iter().map(move |mode| match (amplitude, about) {
            (Some(of), _) => frame.unit * of_amplitude(mode, (&frame.centre, frame.size), of),
            (_, Some(axis)) => frame.unit / frame.size * axis.dot(&Vec3::from(turn_of(mode))),
            _ => frame.value(mode, (place, kind)),
        });
        Some((piece * self.modes.len(), values))
    }

    /// Rows on the motions of what supports hold inside reduced bodies.
    pub(crate) fn held_inside(&self) -> impl Iterator<Item = Vec<f64>> + '_ {
        let bodies = self.system.bodies.iter().filter_map(Body::as_reduced);
        bodies.flat_map(move |body| {
            let mut unknowns = body.unknowns().iter();
            let piece = unknowns.find_map(|unknown| self.pieces.of(*unknown as usize));
            let held = piece.into_iter().flat_map(move |piece| {
                let held = held_inside(self.system, body);
                held.map(move |of| (piece, of))
            });
            held.map(move |(piece, (node, kind))| {
                let (frame, place) = (&self.frames[piece], &self.places[node as usize]);
                let mut row = vec![0.0; self.pieces.len() * self.modes.len()];
                for (value, mode) in row[self.coordinates(piece)].iter_mut().zip(&self.modes) {
                    *value = frame.value(mode, (place, kind));
                }
                row
            })
        })
    }

    /// Σ f_i r_j(i) by coordinate j of unknowns i and their values f.
    pub(crate) fn of(&self, terms: impl IntoIterator<Item = (usize, f64)>) -> Vec<f64> {
        let mut sums = vec![0.0; self.pieces.len() * self.modes.len()];
        for (unknown, f) in terms {
            if let Some((first, values)) = self.at(unknown) {
                for (sum, value) in sums[first..].iter_mut().zip(values) {
                    *sum += f * value;
                }
            }
        }
        sums
    }

    /// The same of a row that may hold the motions: zero where all of it is what rounding leaves of its terms, as of a spring between two
    /// nodes of one piece.
    pub(crate) fn row(&self, terms: impl IntoIterator<Item = (usize, f64)>) -> Vec<f64> {
        let mut row = vec![0.0; self.pieces.len() * self.modes.len()];
        let mut sizes = row.clone();
        for (unknown, f) in terms {
            if let Some((first, values)) = self.at(unknown) {
                let sums = row[first..].iter_mut().zip(&mut sizes[first..]);
                for ((sum, size), value) in sums.zip(values) {
                    *sum += f * value;
                    *size += (f * value).abs();
                }
            }
        }
        if norm(&row) <= ROUNDING * norm(&sizes) {
            row.fill(0.0);
        }
        row
    }

    /// Coordinates of the rigid motion that is nearest to a motion of all unknowns.
    pub(crate) fn nearest(&self, dx: &[f64]) -> Vec<f64> {
        let unknowns = self.pieces.unknowns();
        let mut c = self.of(unknowns.map(|unknown| (unknown, dx[unknown])));
        let squares = self.frames.iter().flat_map(|frame| &frame.squares);
        for (c, square) in c.iter_mut().zip(squares) {
            *c /= square.max(f64::MIN_POSITIVE);
        }
        c
    }

    /// A row of contact on the motions.
    pub(crate) fn contact_row(&self, rows: &Rows, point: usize) -> Vec<f64> {
        let (unknowns, coefficients) = rows.row(point);
        let unknowns = unknowns.iter().map(|&unknown| unknown as usize);
        self.row(unknowns.zip(coefficients.iter().copied()))
    }

    /// Unknowns and their displacements in a motion.
    pub(crate) fn motion(&self, c: &[f64]) -> impl Iterator<Item = (usize, f64)> + '_ {
        let c = c.to_vec();
        self.pieces.unknowns().filter_map(move |unknown| {
            let (first, values) = self.at(unknown)?;
            Some((unknown, values.zip(&c[first..]).map(|(v, c)| v * c).sum()))
        })
    }

    /// Unknowns and what the finite turns of pieces in a motion add to its displacements.
    pub(crate) fn arc(&self, c: &[f64]) -> impl Iterator<Item = (usize, f64)> + '_ {
        let turns: Vec<[f64; 3]> = (0..self.pieces.len()).map(|k| self.angle(k, c)).collect();
        let pieces = self.pieces.iter().enumerate();
        let spinning = pieces.filter(|(_, piece)| piece.spins);
        spinning.flat_map(move |(k, piece)| {
            let (frame, turn) = (&self.frames[k], turns[k]);
            let unknowns = &self.system.unknowns;
            piece.unknowns.iter().filter_map(move |&unknown| {
                let Kind::Translation(axis) = unknowns.kind(unknown) else {
                    return None;
                };
                let place = &self.places[unknowns.node(unknown) as usize];
                let from = [0, 1, 2].map(|i| place[i] - frame.centre[i]);
                Some((unknown, beyond_linear(&turn, &from)[axis]))
            })
        })
    }

    /// Turn of a piece in a motion, a vector along its axis, rad.
    fn angle(&self, piece: usize, c: &[f64]) -> [f64; 3] {
        let (count, frame) = (self.modes.len(), &self.frames[piece]);
        let mut angle = [0.0; 3];
        for (c, mode) in c[piece * count..].iter().zip(&self.modes) {
            for (angle, axis) in angle.iter_mut().zip(turn_of(mode)) {
                *angle += c * axis * frame.unit / frame.size;
            }
        }
        angle
    }

    /// Largest displacement of a node of a piece in a motion, m.
    pub(crate) fn reach(&self, piece: usize, c: &[f64]) -> f64 {
        let of = |unknown: usize| -> f64 {
            let moved = self
                .at(unknown)
                .map(|(first, values)| values.zip(&c[first..]).map(|(v, c)| v * c).sum::<f64>());
            moved.unwrap_or(0.0)
        };
        let nodes = self.pieces[piece].nodes.iter();
        let unknowns = |node: &u32| self.system.unknowns.translations_of(*node);
        let lengths = nodes.map(|node| unknowns(node).map(|i| of(i).powi(2)).sum::<f64>());
        lengths.fold(0.0, f64::max).sqrt()
    }

    /// The coordinates of a piece.
    pub(crate) fn coordinates(&self, piece: usize) -> Range<usize> {
        let count = self.modes.len();
        piece * count..(piece + 1) * count
    }

    /// Largest turn in a motion, rad.
    pub(crate) fn turn(&self, c: &[f64]) -> f64 {
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

    /// The piece that moves most, and how.
    pub(crate) fn name(&self, c: &[f64]) -> (&Piece, &'static str) {
        let most = (0..c.len()).fold(0, |most, j| match c[j].abs() > c[most].abs() {
            true => j,
            false => most,
        });
        let count = self.modes.len();
        (&self.pieces[most / count], self.modes[most % count].0)
    }

    /// Turns of the pieces by finite angles that are those of a motion: nodes with finite rotations, and the angle of each in space, rad.
    pub(crate) fn turns(&self, c: &[f64]) -> impl Iterator<Item = (u32, [f64; 3])> + '_ {
        let angles: Vec<[f64; 3]> = (0..self.pieces.len()).map(|k| self.angle(k, c)).collect();
        let unknowns = &self.system.unknowns;
        unknowns.turning().iter().filter_map(move |&node| {
            let piece = self.pieces.of(unknowns.first(node))?;
            Some((node, angles[piece]))
        })
    }
}

/// Rotations of the nodes of rigid bodies at increments `u` since those at the start of the step.
fn rotations(system: &System, frames: &[Rotation], u: &[f64]) -> BTreeMap<u32, Mat3> {
    let rigid = system.bodies.iter().filter_map(Body::as_rigid);
    let rotation = |body: &carom_bodies::Rigid| {
        let node = body.node();
        let start = frames.get(system.unknowns.frame(node)?)?.matrix();
        let increment = Vec3::from(system.unknowns.spin(node, u));
        Some((node, start * Rotation::cayley(&increment).matrix()))
    };
    rigid.filter_map(rotation).collect()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// (exp(θ×) - 1 - θ×) d.
fn beyond_linear(turn: &[f64; 3], from: &[f64; 3]) -> [f64; 3] {
    let once = cross(turn, from);
    let twice = cross(turn, &once);
    let angle = norm(turn);
    // (sin θ - θ)/θ and (1 - cos θ)/θ², which differences would lose at small angles
    let odd = match angle < 1e-2 {
        true => -angle * angle / 6.0 * (1.0 - angle * angle / 20.0),
        false => angle.sin() / angle - 1.0,
    };
    let half = 0.5 * angle;
    let even = match angle == 0.0 {
        true => 0.5,
        false => 0.5 * (half.sin() / half).powi(2),
    };
    [0, 1, 2].map(|i| odd * once[i] + even * twice[i])
}

/// An orthonormal basis of what vectors span.
#[derive(Default)]
pub(crate) struct Span(Vec<Vec<f64>>);

impl Span {
    /// Adds a vector; whether it is independent of those before it.
    pub(crate) fn add(&mut self, mut vector: Vec<f64>) -> bool {
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
    pub(crate) fn take_from(&self, vector: &mut [f64]) {
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

pub(crate) fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// A motion in words, and its displacement at a place relative to the centre.
pub(crate) type Mode = (&'static str, fn(&[f64; 3]) -> [f64; 3]);

/// Rotation of a motion per unit, about the axes of coordinates.
pub(super) fn turn_of((_, shape): &Mode) -> [f64; 3] {
    if shape(&[0.0; 3]) != [0.0; 3] {
        return [0.0; 3];
    }
    let [of_x, of_y, of_z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|e| shape(&e));
    [of_y[2], of_z[0], of_x[1]]
}

/// The part of an amplitude in a motion of places relative to a centre over a size (m): a turn about the centre is one about the origin
/// less the way of the centre in it.
pub(super) fn of_amplitude(
    mode: &Mode,
    (centre, size): (&[f64; 3], f64),
    amplitude: &Amplitude,
) -> f64 {
    let dot = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let (turn, shift) = (turn_of(mode), mode.1(&[0.0; 3]));
    let way = dot(&cross(&turn, centre), &amplitude.translation);
    dot(&shift, &amplitude.translation) + (dot(&turn, &amplitude.rotation) - way) / size
}

/// What supports hold of the nodes that a reduced body has not retained.
pub(crate) fn held_inside<'a>(
    system: &'a System,
    body: &'a Reduced,
) -> impl Iterator<Item = (u32, Kind)> + 'a {
    let held = body.reduction().held.iter();
    held.map(|&(node, kind)| (system.number[node as usize], kind))
}

pub(crate) fn modes(dim: usize, axisymmetric: bool) -> Vec<Mode> {
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
