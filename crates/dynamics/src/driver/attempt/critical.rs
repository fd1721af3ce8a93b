//! When the critical step of elements at finite strain may have changed.

use carom_bodies::Body;
use rayon::prelude::*;

use super::Attempt;
use crate::system::System;

/// Nodes whose velocities are compared at a time.
pub(crate) const NODES: usize = 4096;

/// Part of the critical step that is taken, for what elements change until they are looked at again.
pub(crate) const PART: f64 = 0.9;

/// Whether the critical step of a body changes with its shape; the bound of springs holds for all elongations, and that of bars and beams
/// whose metal flows is the elastic one.
pub(crate) fn changes(body: &Body) -> bool {
    body.as_solid().is_some() && body.has_finite_motion()
}

/// Largest square of |v - w| over the nodes of a part, m²/s².
pub(crate) fn fastest(system: &System, part: usize, (w, v): (&[f64; 3], &[f64])) -> f64 {
    let square = |node: usize| {
        let mut sum = 0.0;
        for (axis, unknown) in system.unknowns.translations_of(node as u32).enumerate() {
            sum += (v[unknown] - w[axis]).powi(2);
        }
        sum
    };
    let nodes = system.nodes_of(&system.parts[part]).into_par_iter();
    let squares = nodes.with_min_len(NODES).map(square);
    squares.reduce(|| 0.0, f64::max)
}

impl Attempt {
    /// Part of the critical step that a step may have, s, with the bulk viscosity of the fastest compression in the last step.
    pub(crate) fn stable_step(&self) -> f64 {
        let control = &self.state.control;
        let more = self.state.shapes.by_compression * control.compression;
        match more > 0.0 {
            true => 1.0 / (1.0 / control.stable + 0.5 * more / PART),
            false => control.stable,
        }
    }
}
