//! The stage of a step of a scheme of several.

use crate::system::System;

/// The stage of a step that an attempt computes.
pub(crate) struct SchemeStage {
    /// Its number, from 0.
    pub(crate) number: usize,
    /// The step that it belongs to, s.
    pub(crate) of: f64,
    /// Lengths of all stages as parts of the step.
    lengths: Vec<f64>,
}

impl SchemeStage {
    /// That of the first attempt of a system.
    pub(crate) fn first(system: &System) -> SchemeStage {
        SchemeStage {
            number: 0,
            of: 0.0,
            lengths: system.scheme.get().stages(),
        }
    }

    /// How many the scheme has.
    pub(crate) fn count(&self) -> usize {
        self.lengths.len()
    }

    /// Whether the scheme has several.
    pub(crate) fn is_one_of_several(&self) -> bool {
        self.lengths.len() > 1
    }

    /// Length of the stage, s.
    pub(crate) fn length(&self) -> f64 {
        self.lengths[self.number] * self.of
    }

    /// Length of the first stage of a step of `dt`, s.
    pub(crate) fn first_length(&self, dt: f64) -> f64 {
        match self.is_one_of_several() {
            true => self.lengths[0] * dt,
            false => dt,
        }
    }

    /// Time from the start of the step to that of the stage, s.
    pub(crate) fn begun(&self) -> f64 {
        match self.is_one_of_several() {
            true => self.lengths[..self.number].iter().sum::<f64>() * self.of,
            false => 0.0,
        }
    }

    /// What the maps depend on.
    pub(crate) fn key(&self) -> (usize, f64) {
        match self.is_one_of_several() {
            true => (self.number, self.of),
            false => (0, 0.0),
        }
    }
}
