//! What the film strip needs, kept while a run goes: the motion at a few instants, in bounded memory.
//!
//! The stress of all cells costs as much as some twenty explicit steps, so instants are chosen beforehand: [`KEPT`] at equal distances
//! up to the end time. A run that ends earlier shows those that it has reached.

use carom_algebra::rotation::Rotation;
use carom_dynamics::{State, System};
use serde::{Deserialize, Serialize};

use crate::Error;
use crate::plot::{Frame, Scene, film_figure, quantity};
use crate::results::cells::{ShellFields, cell_stresses, cell_von_mises, deleted};
use crate::results::outlines::{Outlines, gap, size};

/// Instants kept, and instants shown: the distances of these are a multiple of the distances of those.
const KEPT: usize = 16;
const SHOWN: usize = 6;

/// Displacement, relative to the size of the model, below which the pictures of a linear run would all look the same.
const VISIBLE: f64 = 0.01;

/// The instants kept.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Film {
    stills: Vec<Still>,
    /// Time from one to the next, s.
    every: f64,
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
    /// Whether each cell is deleted; none where no body has deletion.
    deleted: Option<Vec<bool>>,
    /// Places with a contact force, m.
    marks: Vec<[f64; 3]>,
}

impl Film {
    /// Of a run up to the time `end`, s.
    pub(crate) fn new(end: f64) -> Film {
        Film {
            stills: Vec::new(),
            every: end / (KEPT - 1) as f64,
        }
    }

    /// Keeps the state if it is the first at or after the next instant.
    pub(crate) fn push(&mut self, system: &System, state: &State) {
        // a step that ends there to within rounding is there
        let reached = (state.time / self.every + 1e-6).floor();
        let kept = self.stills.last();
        let due = kept.is_none_or(|still| reached > (still.time / self.every + 1e-6).floor());
        if system.dim > 1 && due {
            self.keep(system, state);
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
            stress: cell_von_mises(&stress, ShellFields::new(system, motion, &stress).as_ref()),
            deleted: deleted(system, &motion.history),
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
        let outlines = Outlines::new(system, |_, _| true);
        if outlines.is_blank() {
            return None;
        }
        let frame = |still: &&Still| match &still.deleted {
            None => still.frame(system, &outlines),
            Some(deleted) => still.frame(system, &Outlines::new(system, |_, cell| !deleted[cell])),
        };
        let frames: Vec<Frame> = self.shown().iter().map(frame).collect();
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
