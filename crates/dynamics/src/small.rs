//! Whether what is assumed small has stayed small: strain and rotation of bodies at small strain, and what contacts of small
//! sliding are paired with.
//!
//! The driver looks at each of the first steps, at every 32nd then, and whenever the strain energy has grown by a quarter
//! since the largest at which it looked: near the largest strain of a run it therefore looks at it. The looks of the last
//! kind are few, since between a thousandth of the energy and all of it there are only so many quarters: 31.

use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::{Distortion, Extreme};
use carom_contact::{Rows, Search, Target};
use carom_mesh::Face;
use serde::{Deserialize, Serialize};

use crate::ledger::Ledger;
use crate::state::State;
use crate::system::System;

/// Steps before which there is a look at each.
const FIRST: u64 = 8;
/// Steps from one look to the next after them.
const EVERY: u64 = 32;
/// Strain energy over the largest at a look, at which there is another.
const GROWTH: f64 = 1.25;
/// Part of the largest energy of the run below which strain energy is no reason to look: rounding grows by quarters too.
const LEAST: f64 = 1e-3;

/// The largest value of something over the looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Largest {
    /// The value.
    pub value: f64,
    /// Where.
    pub place: u32,
    /// When, s.
    pub time: f64,
}

impl Largest {
    fn take(&mut self, value: f64, place: u32, time: f64) {
        if value > self.value {
            *self = Largest { value, place, time };
        }
    }

    fn extreme(&self) -> Extreme {
        Extreme {
            value: self.value,
            cell: self.place,
        }
    }
}

/// A body at small strain. Places are those in [`Body::cells`](carom_bodies::Body::cells).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallStrain {
    /// Rotation of an element, rad.
    pub rotation: Largest,
    /// Principal strain of an element, in size.
    pub strain: Largest,
}

/// A contact of small sliding, beside one that is paired anew. Places are nodes of the mesh; lengths are counted in faces: in
/// mean edges of the smallest face of the primary surface where the point was paired, or of the secondary one where there is
/// none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SmallSliding {
    /// Way along the surface, in faces, of a point with a force.
    pub slide: Largest,
    /// Turn of the normal of a point with a force, rad.
    pub turn: Largest,
    /// Gap, in faces, of a point with a force that is open where it is; infinite where nothing is opposite to it.
    pub invented: Largest,
    /// Depth, in faces, of a point without a force that penetrates where it is.
    pub lost: Largest,
}

/// What the looks have found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Smallness {
    /// By body; zeros at finite strain.
    pub bodies: Vec<SmallStrain>,
    /// By contact; zeros with finite sliding, and against rigid planes, where both kinds of sliding are the same.
    pub contacts: Vec<SmallSliding>,
    /// Looks so far.
    pub looks: u64,
    /// Largest strain energy at a look, J.
    energy: f64,
}

impl Smallness {
    pub(crate) fn of(system: &System) -> Smallness {
        Smallness {
            bodies: vec![SmallStrain::default(); system.bodies.len()],
            contacts: vec![SmallSliding::default(); system.contacts.len()],
            ..Smallness::default()
        }
    }

    /// Becomes a copy, without new memory.
    pub(crate) fn follow(&mut self, before: &Smallness) {
        self.bodies.clone_from(&before.bodies);
        self.contacts.clone_from(&before.contacts);
        (self.looks, self.energy) = (before.looks, before.energy);
    }

    /// Takes what a zone has found; its bodies and contacts by their numbers in the whole.
    pub(crate) fn gather(&mut self, zone: &Smallness, (bodies, contacts): (&[usize], &[usize])) {
        for (found, &body) in zone.bodies.iter().zip(bodies) {
            self.bodies[body] = *found;
        }
        for (found, &contact) in zone.contacts.iter().zip(contacts) {
            self.contacts[contact] = *found;
        }
        self.looks = self.looks.max(zone.looks);
    }

    fn is_due(&self, step: u64, ledger: &Ledger) -> bool {
        let energy = ledger.balance.strain;
        let grown = energy > GROWTH * self.energy.max(LEAST * ledger.largest_energy);
        step < FIRST || step.is_multiple_of(EVERY) || grown
    }
}

/// What a driver looks with.
#[derive(Debug)]
pub(crate) struct Watch {
    contacts: Vec<Option<Watched>>,
    rows: Rows,
    /// No displacement; empty where no contact is watched.
    still: Vec<f64>,
}

/// A contact of small sliding.
#[derive(Debug)]
struct Watched {
    search: Search,
    /// Where all nodes are at their reference places.
    initial: Rows,
    /// Length of the faces of each point, m.
    lengths: Vec<f64>,
}

impl Watch {
    pub(crate) fn new(system: &System) -> Watch {
        let mut still = Vec::new();
        let contacts = 0..system.contacts.len();
        let watched = contacts.map(|k| Watched::new(system, k, &mut still));
        Watch {
            contacts: watched.collect(),
            rows: Rows::default(),
            still,
        }
    }

    /// Looks at a state, the end of the given step, if it is time to.
    pub(crate) fn look(&mut self, system: &System, step: u64, state: &mut State) {
        let energy = state.ledger.balance.strain;
        let found = &mut state.records.small;
        if !found.is_due(step, &state.ledger) {
            return;
        }
        found.looks += 1;
        found.energy = found.energy.max(energy);
        let (u, time, looks) = (&state.motion.u[..], state.time, found.looks as usize);
        for (body, found) in system.bodies.iter().zip(&mut found.bodies) {
            let before = Distortion {
                rotation: found.rotation.extreme(),
                strain: found.strain.extreme(),
            };
            if let Some(Distortion { rotation, strain }) = body.distortion(u, looks, &before) {
                found.rotation.take(rotation.value, rotation.cell, time);
                found.strain.take(strain.value, strain.cell, time);
            }
        }
        for (k, watched) in self.contacts.iter_mut().enumerate() {
            if let Some(watched) = watched {
                if system.contacts[k].moves() {
                    watched.pair_initially(system, k, (state.time, &self.still));
                }
                watched.look(system, k, &mut self.rows, state);
            }
        }
    }
}

impl Watched {
    fn new(system: &System, number: usize, still: &mut Vec<f64>) -> Option<Watched> {
        let contact = &system.contacts[number];
        if !contact.pairs_once() {
            return None;
        }
        let mut watched = Watched {
            search: Search::default(),
            initial: Rows::default(),
            lengths: Vec::new(),
        };
        still.resize(system.unknowns(), 0.0);
        watched.pair_initially(system, number, (0.0, still));
        let own = shortest(system, &system.secondary_faces[number]);
        let other = match &contact.target {
            Target::Surface(faces) => shortest(system, faces),
            Target::Rigid(_) => vec![f64::INFINITY; system.x.len()],
        };
        let least = |lengths: &[f64], nodes: &mut dyn Iterator<Item = u32>| {
            nodes.fold(f64::INFINITY, |least, node| {
                least.min(lengths[node as usize])
            })
        };
        // ends of bars have no length
        let element = system.bodies[system.sides[number].0].smallest_size();
        watched.lengths = (0..contact.points.len())
            .map(|point| {
                let (unknowns, _) = watched.initial.row(point);
                let mut nodes = unknowns.iter().map(|&i| system.unknowns.node(i as usize));
                let length = least(&other, &mut nodes);
                let mut carriers = contact.points[point].carriers().map(|(node, _)| node);
                let length = match length.is_finite() {
                    true => length,
                    false => least(&own, &mut carriers),
                };
                if length.is_finite() { length } else { element }
            })
            .collect();
        Some(watched)
    }

    /// Pairs the points at their reference places, with an obstacle where it is at a time (s).
    fn pair_initially(&mut self, system: &System, number: usize, (time, still): (f64, &[f64])) {
        self.initial.clear();
        let places = system.places(time, still, &system.initial_frames);
        let contact = &system.contacts[number];
        contact.pair(&places, &mut self.search, &mut self.initial);
    }

    fn look(&mut self, system: &System, number: usize, rows: &mut Rows, state: &mut State) {
        let contact = &system.contacts[number];
        let places = system.places(state.time, &state.motion.u, &state.motion.frames);
        rows.clear();
        contact.pair(&places, &mut self.search, rows);
        let slides = matches!(contact.target, Target::Surface(_));
        let first = system.first_point[number];
        for point in 0..rows.len() {
            let length = self.lengths[point];
            let force = state.interface.force[first + point];
            let (small, gap) = (state.interface.gap[first + point], rows.gap(point));
            let found = &mut state.records.small.contacts[number];
            let node = system.mesh_node[contact.points[point].node() as usize];
            let time = state.time;
            if force > 0.0 {
                if slides {
                    let way = slide(&self.initial, point, (&system.unknowns, &state.motion.u));
                    found.slide.take(way / length, node, time);
                }
                if gap.is_finite() {
                    let angle = angle(&self.initial.normal(point), &rows.normal(point));
                    found.turn.take(angle, node, time);
                }
                found
                    .invented
                    .take((gap - small.max(0.0)) / length, node, time);
            } else if gap < 0.0 {
                let depth = (small - gap).min(-gap);
                found.lost.take(depth / length, node, time);
            }
        }
    }
}

/// Way of a point along the surface that it was paired with, m: the relative displacement that a row is the normal part of.
fn slide(rows: &Rows, point: usize, (map, u): (&Unknowns, &[f64])) -> f64 {
    let normal = rows.normal(point);
    let (unknowns, coefficients) = rows.row(point);
    // an entry of the row is s n_i, of a node with the share s in the relative motion: s = Σ_i (s n_i) n_i
    let mut way = [0.0; 3];
    for (&unknown, c) in unknowns.iter().zip(coefficients) {
        let Kind::Translation(axis) = map.kind(unknown as usize) else {
            continue;
        };
        let share = c * normal[axis];
        let moved = map.vector(map.node(unknown as usize), u);
        for (way, u) in way.iter_mut().zip(moved) {
            *way += share * u;
        }
    }
    let along: f64 = (0..3).map(|i| way[i] * normal[i]).sum();
    let across = [0, 1, 2].map(|i| way[i] - along * normal[i]);
    across.iter().map(|w| w * w).sum::<f64>().sqrt()
}

/// Angle between unit vectors, rad.
fn angle(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let difference = [0, 1, 2].map(|i| a[i] - b[i]);
    let chord = difference.iter().map(|d| d * d).sum::<f64>().sqrt();
    2.0 * (0.5 * chord).min(1.0).asin()
}

/// For each node the length of the smallest of these faces that has it, m; infinite where none has, or where they are points.
fn shortest(system: &System, faces: &[Face]) -> Vec<f64> {
    let mut lengths = vec![f64::INFINITY; system.x.len()];
    for face in faces.iter().filter(|face| face.kind.table().dim > 0) {
        let length = face.length(&system.x);
        for &node in face.corners() {
            let shortest = &mut lengths[node as usize];
            *shortest = shortest.min(length);
        }
    }
    lengths
}
