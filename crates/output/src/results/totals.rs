//! What a run keeps for its summary.

use std::time::Duration;

use carom_dynamics::{Control, Ledger, Records};
use serde::{Deserialize, Serialize};

/// What is counted over the steps.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct Totals {
    /// Passes of the status loop.
    pub(crate) passes: u64,
    /// Most passes in a step.
    pub(crate) most_passes: u64,
    /// Accepted states with an energy or a force that is not finite.
    pub(crate) not_finite: u64,
    /// Time spent in here by the run itself.
    pub(crate) spent: Duration,
}

/// The last accepted state, as far as the summary needs it.
#[derive(Debug, Default)]
pub(crate) struct Last {
    pub(crate) step: u64,
    pub(crate) time: f64,
    pub(crate) control: Control,
    pub(crate) ledger: Ledger,
    pub(crate) records: Records,
    /// Largest residual of the momentum that contacts give to a body, and largest momentum of one, N s; `None` where nothing moves.
    pub(crate) exchange: Option<[f64; 2]>,
    /// Mean velocity of the bodies, m/s.
    pub(crate) velocities: Vec<[f64; 3]>,
    /// Whether each contact has a force.
    pub(crate) closed: Vec<bool>,
    /// Largest crush of a point of each contact that stays, m.
    pub(crate) crushes: Vec<f64>,
}
