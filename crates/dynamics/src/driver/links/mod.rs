//! Links between zones and within a model: rows, multipliers, forces.

pub(crate) mod direct_links;
pub(crate) mod force_jump;
pub(crate) mod linking;
pub(crate) mod start;
pub(crate) mod turned;

use std::sync::Arc;

use crate::system::{LinkRow, System};
use force_jump::ForceJump;
use linking::Multipliers;

/// Links between zones and within a model: rows and multipliers.
pub(crate) struct Links {
    /// Forces of links in the step, N; empty without links.
    pub(crate) force: Vec<f64>,
    pub(crate) jump: ForceJump,
    pub(crate) multipliers: Multipliers,
    /// The rows of the links; those that turn as they are in the iteration.
    pub(crate) rows: Arc<Vec<LinkRow>>,
}

impl Links {
    /// Those of a system.
    pub(crate) fn of(system: &System) -> Links {
        let unknowns = match system.links.rows.is_empty() {
            true => 0,
            false => system.unknowns(),
        };
        Links {
            force: vec![0.0; unknowns],
            jump: ForceJump::default(),
            multipliers: Multipliers::new(system),
            rows: Arc::clone(&system.links.rows),
        }
    }
}
