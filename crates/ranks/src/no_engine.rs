//! Ranks without an engine.

use crate::engine::{Graph, OwnRows, Unsolved};
use crate::link::Ranks;

/// The solver of a matrix; there is none without an engine.
pub enum Engine {}

impl Engine {
    /// x of A x = b, whole on all ranks, and the iterations taken.
    ///
    /// # Errors
    /// Iterations that do not end.
    pub fn solve(
        &mut self,
        _b: &[f64],
        _x: &mut [f64],
        _tolerance: f64,
    ) -> Result<usize, Unsolved> {
        match *self {}
    }
}

impl Ranks {
    /// The engine's solver of a matrix of which each rank gives its rows; none without an engine.
    ///
    /// # Errors
    /// What the engine says.
    pub fn engine(&self, _rows: &OwnRows) -> Result<Option<Engine>, String> {
        Ok(None)
    }

    /// The part of each element by the engine, in which elements of different parts share few faces; none without an engine.
    ///
    /// # Errors
    /// What the engine says.
    pub fn parts_of_graph(&self, _graph: &Graph) -> Result<Option<Vec<u32>>, String> {
        Ok(None)
    }
}
