//! The looks of a driver at what is assumed small ([`crate::small`]).

use carom_algebra::unknowns::{Kind, Unknowns};
use carom_bodies::{Across, Bending, Body, Distortion};
use carom_contact::{Contact, Rows, Search, Target};
use carom_mesh::Face;

use crate::state::State;
use crate::system::System;

/// What a driver looks with.
#[derive(Debug)]
pub(crate) struct Watch {
    contacts: Vec<Option<Watched>>,
    between: Vec<Option<Between>>,
    rows: Rows,
    /// No displacement; empty where no contact is watched.
    still: Vec<f64>,
    /// Whether it is time to look at each assembly.
    due: Vec<bool>,
}

/// A contact seen from its other side.
#[derive(Debug)]
struct Between {
    contact: Contact,
    search: Search,
}

/// Depth up to which nodes of the primary side are looked for behind the secondary one, in sizes of the smallest element normal to both:
/// more than the whole element from which on a penetration is bad, by what bodies go from one look to the next.
const DEPTH: f64 = 2.25;

/// A contact of small sliding.
#[derive(Debug)]
struct Watched {
    search: Search,
    /// Where all nodes are at their reference places.
    initial: Rows,
    /// Length of the faces of each point, m.
    lengths: Vec<f64>,
}

/// What a look finds in a body: its distortion, or what was found before where that is larger, and how far it locks in bending.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct OfBody {
    pub(crate) distortion: Option<Distortion>,
    pub(crate) bending: Option<Bending>,
    pub(crate) across: Option<Across>,
}

/// What is found in a body, by its number, at a displacement (m), by the number of the look; `before`: its distortion so far.
pub(crate) type LookAt<'a> = dyn Fn(usize, (&[f64], usize), &Distortion) -> OfBody + 'a;

impl Watch {
    pub(crate) fn new(system: &System) -> Watch {
        let mut still = Vec::new();
        let contacts = 0..system.contacts.len();
        let watched = contacts.map(|k| Watched::new(system, k, &mut still));
        let contacts = 0..system.contacts.len();
        Watch {
            contacts: watched.collect(),
            between: contacts.map(|k| Between::new(system, k)).collect(),
            rows: Rows::default(),
            still,
            due: Vec::new(),
        }
    }

    /// Looks at the assemblies of a state, the end of the given step, at which it is time to.
    pub(crate) fn look_alone(&mut self, system: &System, step: u64, state: &mut State) {
        let mut due = std::mem::take(&mut self.due);
        due.clear();
        due.extend((0..system.assemblies.all.len()).map(|number| is_due(state, step, number)));
        if due.contains(&true) {
            let of = |body: usize, (u, looks): (&[f64], usize), before: &Distortion| OfBody {
                distortion: system.bodies[body].distortion(u, looks, before),
                bending: system.bodies[body].bending(u),
                across: system.bodies[body].across(u),
            };
            self.look((system, &due), &of, state);
        }
        self.due = due;
    }

    /// Looks at the assemblies of a state that are due.
    pub(crate) fn look(
        &mut self,
        (system, due): (&System, &[bool]),
        look_at: &LookAt,
        state: &mut State,
    ) {
        for (assembly, _) in due.iter().enumerate().filter(|(_, due)| **due) {
            let [energy, _] = energies(state, assembly);
            state.records.small.count(assembly, energy);
        }
        let assemblies = &system.assemblies;
        let of_body = |body: usize| assemblies.of_part[system.part_of_body[body]];
        let is_due = |contact: usize| due[assemblies.of_contact(system, contact)];
        let found = &mut state.records.small;
        let (u, time) = (&state.motion.u[..], state.time);
        for (body, of) in found.bodies.iter_mut().enumerate() {
            let assembly = of_body(body);
            if !due[assembly] {
                continue;
            }
            let before = Distortion {
                rotation: of.rotation.extreme(),
                strain: of.strain.extreme(),
            };
            let looks = found.looked[assembly].looks as usize;
            let OfBody {
                distortion,
                bending,
                across,
            } = look_at(body, (u, looks), &before);
            if let Some(bending) = bending {
                of.locking.take(bending, time);
            }
            if let Some(moved) = across {
                of.across.take(moved.across, moved.place, time);
                of.along = of.along.max(moved.along);
            }
            if let Some(Distortion { rotation, strain }) = distortion {
                of.rotation.take(rotation.value, rotation.cell, time);
                of.strain.take(strain.value, strain.cell, time);
            }
        }
        for (k, between) in self.between.iter_mut().enumerate() {
            if let Some(between) = between.as_mut().filter(|_| is_due(k)) {
                between.look(system, k, &mut self.rows, state);
            }
        }
        for (k, watched) in self.contacts.iter_mut().enumerate() {
            if let Some(watched) = watched.as_mut().filter(|_| is_due(k)) {
                if system.contacts[k].moves() {
                    watched.pair_initially(system, k, (state.time, &self.still));
                }
                watched.look(system, k, &mut self.rows, state);
            }
        }
    }
}

/// Strain energy of an assembly and its largest energy, J: in its own frame, with what materials dissipated; that of all bodies where
/// they are not told by assembly.
fn energies(state: &State, assembly: usize) -> [f64; 2] {
    match state.assemblies.all.get(assembly) {
        Some(own) => [own.taken(), own.largest],
        None => [state.ledger.balance.strain, state.ledger.largest_energy],
    }
}

/// Whether it is time to look at an assembly at the end of a step.
pub(crate) fn is_due(state: &State, step: u64, assembly: usize) -> bool {
    state.records.small.looked[assembly].is_due(step, energies(state, assembly))
}

impl Between {
    /// None of contacts that have no other side to look from, and where deleted elements leave it.
    fn new(system: &System, number: usize) -> Option<Between> {
        let touching = system.contacts[number].bodies.iter();
        let mut bodies = touching.map(|&body| &system.bodies[body]);
        if bodies.any(Body::has_deletion) {
            return None;
        }
        let depth = DEPTH * system.depth_of_elements(number);
        let faces = &system.contacts[number].secondary_faces;
        let contact = system.contacts[number].reversed(faces, &system.x, depth)?;
        Some(Between {
            contact,
            search: Search::default(),
        })
    }

    fn look(&mut self, system: &System, number: usize, rows: &mut Rows, state: &mut State) {
        let places = system.places(state.time, &state.motion.u, &state.motion.frames);
        rows.clear();
        self.contact.pair(&places, &mut self.search, rows);
        let deepest = &mut state.records.contacts[number].between;
        for (k, point) in self.contact.points.iter().enumerate() {
            let node = system.mesh_node[point.node() as usize];
            deepest.take(-rows.gap(k), node, state.time);
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
        let own = shortest(system, &system.contacts[number].secondary_faces);
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
        let element = match system.is_of_many(number) {
            true => {
                let sizes = system.contacts[number].bodies.iter();
                sizes.fold(f64::INFINITY, |least, &body| {
                    least.min(system.bodies[body].smallest_size())
                })
            }
            false => system.bodies[system.contacts[number].secondary_body].smallest_size(),
        };
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
        let places = system.places(time, still, &system.initial.frames);
        let contact = &system.contacts[number];
        contact.pair(&places, &mut self.search, &mut self.initial);
    }

    fn look(&mut self, system: &System, number: usize, rows: &mut Rows, state: &mut State) {
        let contact = &system.contacts[number];
        let places = system.places(state.time, &state.motion.u, &state.motion.frames);
        rows.clear();
        contact.pair(&places, &mut self.search, rows);
        let slides = matches!(contact.target, Target::Surface(_));
        let first = system.contacts[number].range.start;
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
