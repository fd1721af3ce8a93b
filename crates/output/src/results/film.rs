//! What the film strip needs, kept while a run goes: the motion at a few instants, in bounded memory.
//!
//! Every accepted state is a candidate. When more than [`KEPT`] are kept, every other one is dropped, and from then on only
//! one step in twice as many is taken.

use std::collections::BTreeMap;

use carom_algebra::rotation::Rotation;
use carom_contact::Target;
use carom_dynamics::{State, System};

use crate::Error;
use crate::plot::{Frame, Patch, Scene, film_figure};
use crate::results::cells::{cell_stresses, von_mises};

/// Instants kept at most, and instants shown.
const KEPT: usize = 24;
const SHOWN: usize = 6;

/// Displacement, relative to the size of the model, below which the pictures of a linear run would all look the same.
const VISIBLE: f64 = 0.01;

/// The instants kept.
#[derive(Debug, Default)]
pub(crate) struct Film {
    stills: Vec<Still>,
    /// Steps between two of them, as a power of two.
    doublings: u32,
}

/// An instant.
#[derive(Debug)]
struct Still {
    step: u64,
    time: f64,
    u: Vec<f64>,
    frames: Vec<Rotation>,
    /// Equivalent stress of the cells, Pa.
    stress: Vec<f64>,
    /// Places with a contact force, m.
    marks: Vec<[f64; 3]>,
}

impl Film {
    /// Keeps the state if its turn has come.
    pub(crate) fn push(&mut self, system: &System, state: &State) {
        if system.dim < 2 || !state.step.is_multiple_of(1 << self.doublings) {
            return;
        }
        self.keep(system, state);
        if self.stills.len() > KEPT {
            self.doublings += 1;
            let every = 1u64 << self.doublings;
            self.stills.retain(|still| still.step.is_multiple_of(every));
        }
    }

    /// Keeps the last state, whatever its turn.
    pub(crate) fn finish(&mut self, system: &System, state: &State) {
        let last = self.stills.last().map(|still| still.step);
        if system.dim > 1 && last != Some(state.step) {
            self.keep(system, state);
        }
    }

    fn keep(&mut self, system: &System, state: &State) {
        let (motion, interface) = (&state.motion, &state.interface);
        let places = system.places(state.time, &motion.u, &motion.frames);
        let mut marks = Vec::new();
        if system.dim == 2 {
            for (k, contact) in system.contacts.iter().enumerate() {
                let forces = &interface.force[system.first_point[k]..];
                let closed = contact
                    .points
                    .iter()
                    .zip(forces)
                    .filter(|(_, f)| **f != 0.0);
                marks.extend(closed.map(|(point, _)| point.place(&places)));
            }
        }
        let stress = cell_stresses(system, &motion.u, &motion.history);
        self.stills.push(Still {
            step: state.step,
            time: state.time,
            u: motion.u.clone(),
            frames: motion.frames.clone(),
            stress: stress.iter().map(von_mises).collect(),
            marks,
        });
    }

    /// The film strip; none in one dimension, none of points and springs alone, and none of a linear run in which nothing is seen to
    /// move.
    pub(crate) fn draw(&self, system: &System) -> Option<Result<String, Error>> {
        let moved = |still: &Still| still.u.iter().fold(0.0_f64, |m, u| m.max(u.abs()));
        let largest = self.stills.iter().map(moved).fold(0.0, f64::max);
        if self.stills.len() < 2 || !(system.is_nonlinear() || largest > VISIBLE * size(system)) {
            return None;
        }
        let outlines = Outlines::new(system);
        if outlines.patches.is_empty() && outlines.rims.is_empty() {
            return None;
        }
        let shown = self.shown();
        let frames: Vec<Frame> = shown
            .iter()
            .map(|still| outlines.frame(system, still))
            .collect();
        let gap = |time: f64, place: [f64; 3]| {
            let place = match system.axisymmetric {
                true => [place[0].abs(), place[1], place[2]],
                false => place,
            };
            let obstacles = system
                .contacts
                .iter()
                .filter_map(|contact| match &contact.target {
                    Target::Rigid(obstacle) => Some(obstacle.at(time).distance(&place).gap),
                    Target::Surface(_) => None,
                });
            obstacles.fold(f64::INFINITY, f64::min)
        };
        let scene = Scene {
            dim: system.dim,
            field: ("von Mises stress", "Pa"),
            gap: &gap,
        };
        Some(film_figure(&scene, &frames))
    }

    /// Those nearest to instants at equal distances, each once.
    fn shown(&self) -> Vec<&Still> {
        let (Some(first), Some(last)) = (self.stills.first(), self.stills.last()) else {
            return Vec::new();
        };
        let mut shown: Vec<&Still> = Vec::new();
        for k in 0..SHOWN {
            let time = first.time + (last.time - first.time) * k as f64 / (SHOWN - 1) as f64;
            let off = |still: &&Still| (still.time - time).abs();
            let nearest = self.stills.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
            let next = nearest.filter(|still| shown.last().is_none_or(|s| s.step < still.step));
            shown.extend(next);
        }
        shown
    }
}

/// Longest side of the box around the undeformed model, m.
fn size(system: &System) -> f64 {
    let side = |i: usize| {
        let values = system.x.iter().map(|x| x[i]);
        let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| {
            [low.min(x), high.max(x)]
        });
        high - low
    };
    (0..system.dim).map(side).fold(0.0, f64::max)
}

/// What is drawn of the mesh, in system numbers of the nodes.
struct Outlines {
    /// Nodes in turn around each patch, and its cell.
    patches: Vec<(Vec<u32>, usize)>,
    /// Outer edges of plane bodies, and cells that are lines.
    rims: Vec<Vec<u32>>,
}

impl Outlines {
    /// All cells and the outer edges of a plane model, the outer faces of a solid.
    fn new(system: &System) -> Outlines {
        let mut outlines = Outlines {
            patches: Vec::new(),
            rims: Vec::new(),
        };
        let mut cell = 0;
        for body in &system.bodies {
            if body.as_discrete().is_some() {
                cell += body.cells().len();
                continue;
            }
            // the faces that only one cell of the body has
            let mut outer: BTreeMap<Vec<u32>, Option<(Vec<u32>, usize)>> = BTreeMap::new();
            for &element in body.cells() {
                let nodes = system.mesh.element_nodes(element);
                let number = |local: &usize| system.number[nodes[*local] as usize];
                let table = system.mesh.kind(element).table();
                if table.dim == 1 {
                    let all: Vec<u32> = (0..nodes.len()).map(|local| number(&local)).collect();
                    outlines.rims.push(along(&all));
                    cell += 1;
                    continue;
                }
                for face in table.faces {
                    let own: Vec<u32> = face.nodes.iter().map(number).collect();
                    let mut key = own.clone();
                    key.sort_unstable();
                    let around = match system.dim {
                        2 => along(&own),
                        _ => ring(face.kind.table().faces.iter().map(|f| f.nodes), &own),
                    };
                    let entry = outer.entry(key);
                    entry
                        .and_modify(|twice| *twice = None)
                        .or_insert(Some((around, cell)));
                }
                if system.dim == 2 {
                    let all: Vec<u32> = (0..nodes.len()).map(|local| number(&local)).collect();
                    let around = ring(table.faces.iter().map(|f| f.nodes), &all);
                    outlines.patches.push((around, cell));
                }
                cell += 1;
            }
            let outer = outer.into_values().flatten();
            match system.dim {
                2 => outlines.rims.extend(outer.map(|(rim, _)| rim)),
                // the ends of a line have no area to be seen
                _ => outlines
                    .patches
                    .extend(outer.filter(|(ring, _)| ring.len() > 2)),
            }
        }
        outlines
    }

    /// The picture of an instant; of an axisymmetric model both halves of the section.
    fn frame(&self, system: &System, still: &Still) -> Frame {
        let places = system.places(still.time, &still.u, &still.frames);
        let place = |node: &u32| places.of(*node);
        let patch = |(nodes, cell): &(Vec<u32>, usize)| Patch {
            points: nodes.iter().map(place).collect(),
            value: still.stress[*cell],
        };
        let mut frame = Frame {
            time: still.time,
            patches: self.patches.iter().map(patch).collect(),
            rims: self
                .rims
                .iter()
                .map(|rim| rim.iter().map(place).collect())
                .collect(),
            marks: still.marks.clone(),
        };
        if system.axisymmetric {
            mirror(&mut frame);
        }
        frame
    }
}

/// Adds the other half of a section through the axis.
fn mirror(frame: &mut Frame) {
    let other = |[r, z, y]: &[f64; 3]| [-r, *z, *y];
    let patches: Vec<Patch> = frame
        .patches
        .iter()
        .map(|patch| Patch {
            points: patch.points.iter().map(other).collect(),
            value: patch.value,
        })
        .collect();
    // edges on the axis are inside the body
    let on_axis = |rim: &Vec<[f64; 3]>| rim.iter().all(|x| x[0] == 0.0);
    frame.rims.retain(|rim| !on_axis(rim));
    let rims = frame.rims.iter().map(|rim| rim.iter().map(other).collect());
    let rims: Vec<Vec<[f64; 3]>> = rims.collect();
    let marks: Vec<[f64; 3]> = frame.marks.iter().map(other).collect();
    frame.patches.extend(patches);
    frame.rims.extend(rims);
    frame.marks.extend(marks);
}

/// An edge from end to end: its middle, which comes last in the list of its nodes, between the ends.
fn along(edge: &[u32]) -> Vec<u32> {
    match edge {
        [from, to, middle] => vec![*from, *middle, *to],
        _ => edge.to_vec(),
    }
}

/// The nodes around a cell or a face, with those in the middle of its edges.
fn ring<'a>(edges: impl Iterator<Item = &'a [usize]>, nodes: &[u32]) -> Vec<u32> {
    let mut ring = Vec::new();
    for edge in edges {
        // the end of an edge is the beginning of the next
        let inner = std::iter::once(edge[0]).chain(edge.get(2).copied());
        ring.extend(inner.map(|local| nodes[local]));
    }
    ring
}
