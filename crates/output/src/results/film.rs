//! What the film strip needs, kept while a run goes: the motion at a few instants, in bounded memory.
//!
//! Every accepted state is a candidate. When more than [`KEPT`] are kept, every other one is dropped, and from then on only
//! one step in twice as many is taken.

use carom_algebra::rotation::Rotation;
use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::plot::{Frame, Scene, film_figure, quantity};
use crate::results::cells::{cell_stresses, von_mises};
use crate::results::outlines::{Outlines, gap, size};

/// Instants kept at most, and instants shown.
const KEPT: usize = 24;
const SHOWN: usize = 6;

/// Displacement, relative to the size of the model, below which the pictures of a linear run would all look the same.
const VISIBLE: f64 = 0.01;

/// The instants kept.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Film {
    stills: Vec<Still>,
    /// Steps between two of them, as a power of two.
    doublings: u32,
}

/// An instant.
#[derive(Debug, Serialize, Deserialize)]
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
        let outlines = Outlines::new(system, |_| true);
        if outlines.is_blank() {
            return None;
        }
        let shown = self.shown();
        let frames: Vec<Frame> = shown
            .iter()
            .map(|still| still.frame(system, &outlines))
            .collect();
        let scene = Scene {
            title: "Motion",
            dim: system.dim,
            field: ("von Mises stress", "Pa"),
            gap: &|time, place| gap(system, time, place),
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

impl Still {
    /// Its picture.
    fn frame(&self, system: &System, outlines: &Outlines) -> Frame {
        let places = system.places(self.time, &self.u, &self.frames);
        let frame = Frame {
            time: self.time,
            caption: format!("t = {}", quantity(self.time, "s")),
            marks: self.marks.clone(),
            ..Frame::default()
        };
        outlines.frame(
            system,
            &|node| places.of(*node),
            &|_, cell| self.stress[cell],
            frame,
        )
    }
}
